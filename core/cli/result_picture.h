// ResultPicture: a mechanism at an instant of a result, for `freeplay show`.
#pragma once

#include <string>
#include <vector>

#include "drawing/mechanism_drawing.h"

namespace freeplay {

/// As typed; empty where it was not.
struct ResultPictureOptions {
  std::string at, every;
  std::vector<std::string> traces, magnify;

  bool any() const { return !at.empty() || !every.empty() || !traces.empty() || !magnify.empty(); }
};

/// What `picture` refers to stays with it.
struct ResultPicture {
  std::vector<double> q;
  MechanismPicture picture;
};

/// From the rows of the result up to the instant, or of all. Throws Error{usage} "bad-value", "unknown-name",
/// "unknown-channel" and Error{file} "unreadable-result".
ResultPicture result_picture(const std::string& result, const System& system, const ResultPictureOptions& options);

}  // namespace freeplay
