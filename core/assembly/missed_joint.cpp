#include "assembly/missed_joint.h"

#include <algorithm>

#include <Eigen/Core>
#include <fmt/format.h>

#include "base/index.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

constexpr double closes_within = 0.1;  // by the size of the model: given poses are guesses
constexpr std::string_view at_origin = "/origin", at_com = "/com";

bool acts_on_an_axis(const JointElement& joint) {
  return is_force_element(joint) && joint.ideal_layout().coordinate != Coordinate::none;
}

class Frames {
 public:
  Frames(const System& closed, const Evaluation& at_start)
      : model_(closed.model()), closed_(closed), at_start_(at_start) {}

  MissedJoint find(const std::function<bool(BodyId)>& is_moving) const {
    MissedJoint found{std::vector<char>(model_.bodies.size(), 0), {}};
    const auto moves = [&](BodyId body) { return body != ground && is_moving(body); };
    const auto note = [&](const Marker& frame) {
      if (found.frame.empty()) found.frame = in_words(frame);
    };
    for (const Marker& frame : model_.frames) {
      if (moves(frame.body) || !is_left_over(frame)) continue;
      std::ranges::fill(found.bodies, 1);
      note(frame);
    }
    for (const Marker& frame : model_.frames) {
      if (is_used(frame) || !marks_a_joint(frame)) continue;
      for (const Marker& other : model_.frames) {
        if (frame.body == other.body || !(moves(frame.body) || moves(other.body)) || !closes(frame, other)) continue;
        for (const BodyId body : {frame.body, other.body}) {
          if (body != ground) found.bodies[at(body)] = 1;
        }
        note(frame);
      }
    }
    return found;
  }

 private:
  std::string in_words(const Marker& frame) const {
    if (!frame.name.ends_with(at_origin)) return fmt::format("frame '{}'", frame.name);
    return fmt::format("the origin of '{}'", frame.name.substr(0, frame.name.size() - at_origin.size()));
  }

  bool closes(const Marker& frame, const Marker& other) const {
    return !other.name.ends_with(at_com) &&
           (place_of(other) - place_of(frame)).norm() <= closes_within * closed_.size() &&
           !are_joined(frame.body, other.body);
  }

  /// Frames that the file names do, and origins that it puts elsewhere than at the centre of mass.
  bool marks_a_joint(const Marker& frame) const {
    if (!frame.name.ends_with(at_origin)) return !frame.name.ends_with(at_com);
    if (frame.body == ground) return false;
    const Body& body = model_.bodies[at(frame.body)];
    return (body.position || body.angle || body.rotation) && body.com != Vector3{};
  }

  /// A frame of the model file that nothing at all stands on.
  bool is_left_over(const Marker& frame) const {
    if (frame.name.ends_with(at_origin) || frame.name.ends_with(at_com)) return false;
    if (frame.body != ground && model_.bodies[at(frame.body)].location.file != model_.file) return false;
    return std::ranges::none_of(model_.markers, [&](const Marker& used) { return used.name == frame.name; });
  }

  /// By more than forces along or about an axis, as of friction: these act at joints, and hold nothing.
  bool is_used(const Marker& frame) const {
    for (int m = 0; m < static_cast<int>(model_.markers.size()); ++m) {
      if (model_.markers[at(m)].name == frame.name && !serves_axes_alone(m)) return true;
    }
    return false;
  }
  bool serves_axes_alone(int marker) const {
    bool any = false;
    for (const JointElement& joint : model_.joints) {
      if (joint.gear >= 0 || (joint.marker_a != marker && joint.marker_b != marker)) continue;
      if (!acts_on_an_axis(joint)) return false;
      any = true;
    }
    const auto at_marker = [&](const AppliedForce& force) { return force.marker == marker; };
    return any && std::ranges::none_of(model_.forces, at_marker) &&
           std::ranges::count(model_.settings.frames, marker) == 0;
  }

  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }
  bool are_joined(BodyId one, BodyId other) const {
    return std::ranges::any_of(model_.joints, [&](const JointElement& joint) {
      const BodyId a = body_of(joint.marker_a), b = body_of(joint.marker_b);
      return joint.gear < 0 && !acts_on_an_axis(joint) && ((a == one && b == other) || (a == other && b == one));
    });
  }

  Eigen::Vector3d place_of(const Marker& frame) const {
    const Eigen::Vector3d in_body(frame.position.data());
    if (frame.body == ground) return in_body;
    const Pose pose = closed_.coordinates().frame_pose(frame.body, at_start_.q);
    return Eigen::Vector3d(pose.position) +
           Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.rotation) * in_body;
  }

  const Model& model_;
  const System& closed_;
  const Evaluation& at_start_;
};

}  // namespace

MissedJoint missed_joint(const System& closed, const Evaluation& at_start,
                         const std::function<bool(BodyId)>& is_moving) {
  return Frames(closed, at_start).find(is_moving);
}

}  // namespace freeplay
