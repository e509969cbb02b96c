// BodyGroups: bodies that joints, gears and springs hold together other than through ground.
#pragma once

#include <vector>

#include "base/index.h"
#include "model/model.h"

namespace freeplay {

/// Groups have numbers below the number of bodies, not all of which occur.
class BodyGroups {
 public:
  explicit BodyGroups(const Model& model);

  static constexpr int of_nothing = -1;
  int of_body(BodyId body) const { return body == ground ? of_nothing : of_[at(body)]; }
  int of_marker(int marker) const { return of_body(body(marker)); }
  int of_joint(int joint) const { return of_body(moved(joint)); }

 private:
  BodyId body(int marker) const;
  BodyId moved(int joint) const;

  const Model& model_;
  std::vector<int> of_;
};

}  // namespace freeplay
