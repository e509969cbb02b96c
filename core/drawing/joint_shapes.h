// JointShapes: the outlines that joints give of the bodies they stand on.
#pragma once

#include <vector>

#include "model/model.h"
#include "svg/page.h"

namespace freeplay {

struct JointShape {
  int marker;
  std::vector<svg::Point> points;  ///< in the axes of the body [m]
};

class JointShapes {
 public:
  explicit JointShapes(const Model& model);
  static std::vector<JointShape> of(const Model& model, const JointElement& joint);
  const std::vector<JointShape>& all() const { return all_; }
  /// Whether nothing but an outline is at a marker, which then is no point of its body: as the middle of a hollow.
  bool stands_for(std::size_t marker) const { return outlined_[marker] != 0; }

 private:
  std::vector<JointShape> all_;
  std::vector<char> outlined_;
};

}  // namespace freeplay
