#include "assembly/doubled_plays.h"

#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double same_joint_place = 1e-6;  // by the size of the model

class DoubledPlays {
 public:
  DoubledPlays(const System& closed, const Evaluation& shut)
      : model_(closed.model()), shut_(shut), near_(same_joint_place * closed.size()) {}

  bool are_same(const JointElement& one, const JointElement& other) const {
    if (!one.has_play || !other.has_play || one.component != other.component) return false;
    return (meets(one.marker_a, other.marker_a) && meets(one.marker_b, other.marker_b)) ||
           (meets(one.marker_a, other.marker_b) && meets(one.marker_b, other.marker_a));
  }

 private:
  bool meets(int marker, int other) const {
    const auto place = [&](int m) { return Eigen::Map<const Eigen::Vector3d>(shut_.markers[at(m)].position); };
    return model_.markers[at(marker)].body == model_.markers[at(other)].body &&
           (place(marker) - place(other)).norm() <= near_;
  }

  const Model& model_;
  const Evaluation& shut_;
  double near_;
};

}  // namespace

void doubt_doubled_plays(
    const System& closed, const Evaluation& shut,
    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt) {
  const DoubledPlays plays(closed, shut);
  const std::vector<JointElement>& joints = closed.model().joints;
  for (std::size_t k = 1; k < joints.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      if (!plays.are_same(joints[i], joints[k])) continue;
      doubt("duplicate-joint",
            fmt::format("joint '{}' has the same play as '{}' between the same places of the same two bodies: each "
                        "carries a part of the load; delete one of them",
                        joints[k].name, joints[i].name),
            joints[k]);
      break;
    }
  }
}

}  // namespace freeplay
