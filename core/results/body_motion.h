// BodyMotion: where the bodies of a model were, by the rows of a result.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "results/reader.h"
#include "system/system.h"

namespace freeplay {

class BodyMotion {
 public:
  /// `reader` and `system` outlive it. Throws Error{usage} "unknown-channel" where the result has no pose of a body.
  BodyMotion(ResultReader& reader, const System& system);

  /// Each row up to `until` [s]: its time, coordinates of `system`, and the value of `also`, a column of the reader.
  /// False ends it.
  using Take = std::function<bool(double time, std::span<const double> q, double also)>;
  void rows(double until, std::size_t also, const Take& take);

 private:
  ResultReader& reader_;
  const System& system_;
  std::vector<std::size_t> columns_;  // time, then poses of bodies
};

}  // namespace freeplay
