#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/disjoint_sets.h"
#include "base/index.h"
#include "sdf/scene.h"
#include "urdf/name_pool.h"

namespace freeplay::sdf {
namespace {

using urdf::Joint;
using urdf::JointType;
using Kind = SceneJoint::Kind;

constexpr double same_direction = 1e-6;  // [rad]

/// Swaps the ends of a joint; its coordinate keeps its sense.
void turn_round(Joint& joint) {
  std::swap(joint.parent, joint.child);
  joint.axis = -joint.axis;
  if (joint.type != JointType::universal) return;
  Eigen::Matrix3d swapped;  // what was y is x
  swapped << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  joint.parent.frame.linear() *= swapped;
  joint.child.frame.linear() *= swapped;
}

class RobotBuilder {
 public:
  RobotBuilder(Scene& scene, Messages& messages) : scene_(scene), messages_(messages) {}

  urdf::Robot build() {
    robot_.spot = scene_.spot;
    robot_.gravity = scene_.gravity;
    robot_.gravity_spot = scene_.gravity_spot;
    for (const char* own : {"world", "ground", "origin", "com"}) names_.take(own);
    find_only_model();
    add_links();
    for (SceneJoint& joint : scene_.joints) {
      if (joint.kind != Kind::gear) add_joint(joint);
    }
    if (messages_.failed()) return std::move(robot_);
    name_leaders();
    for (const SceneJoint& joint : scene_.joints) {
      if (joint.kind == Kind::gear) add_gear(joint);
    }
    hang_links();
    add_frames();
    return std::move(robot_);
  }

 private:
  Frames& frames() { return scene_.frames; }

  // --- links -------------------------------------------------------------------------------------------------------

  /// The model that moves, where one alone does: its parts are called as the file calls them.
  void find_only_model() {
    std::vector<int> moving, all;
    for (int i = 1; i < frames().size(); ++i) {
      if (frames()[i].kind != Frame::Kind::model || frames()[i].scope != Frames::world) continue;
      all.push_back(i);
      if (!frames()[i].is_static) moving.push_back(i);
    }
    if (all.size() == 1) only_model_ = all[0];
    if (moving.size() == 1) only_model_ = moving[0];
  }

  std::string fresh_name(int frame, const char* kind) {
    const std::string own = frames().path(frame, only_model_), given = names_.fresh(own);
    if (given != own) {
      messages_.warning(frames()[frame].spot, "urdf-renamed",
                        fmt::format("the {} '{}' is called '{}' here", kind, own, given));
    }
    return given;
  }

  int add_link(urdf::Link link, int frame) {
    robot_.links.push_back(std::move(link));
    poses_.push_back(frames().pose(frame));
    links_[frame] = static_cast<int>(robot_.links.size()) - 1;
    return links_[frame];
  }

  void add_links() {
    urdf::Link world;
    world.name = "world";
    world.spot = world.element = world.mass_spot = world.inertia_spot = scene_.spot;
    add_link(std::move(world), Frames::world);
    for (SceneLink& source : scene_.links) {
      source.link.name = fresh_name(source.frame, "link");
      const int link = add_link(std::move(source.link), source.frame);
      stands_.resize(at(link) + 1);
      stands_[at(link)] = source.is_static;
      if (source.is_static) hang(0, link);
    }
    stands_.resize(robot_.links.size());
    stands_[0] = true;
  }

  /// A fixed joint, or one that lets the link float.
  void hang(int parent, int link, JointType type = JointType::fixed) {
    Joint joint;
    joint.type = type;
    joint.name = robot_.links[at(link)].name;  // which no joint of the file has
    joint.spot = joint.type_spot = joint.axis_spot = robot_.links[at(link)].spot;
    joint.element = robot_.links[at(link)].element;
    joint.axis_given = true;
    joint.parent = {parent, urdf::inverse_pose(poses_[at(parent)]) * poses_[at(link)], joint.spot, joint.spot};
    joint.child = {link, Eigen::Isometry3d::Identity(), joint.spot, joint.spot};
    robot_.joints.push_back(std::move(joint));
  }

  /// Plain frames are links without mass on what carries them.
  void add_frames() {
    for (int i = 1; i < frames().size(); ++i) {
      if (frames()[i].kind != Frame::Kind::plain) continue;
      urdf::Link link;
      link.name = fresh_name(i, "frame");
      link.spot = link.element = link.mass_spot = link.inertia_spot = frames()[i].spot;
      hang(link_of(i), add_link(std::move(link), i));
    }
  }

  int link_of(int frame) {
    const auto found = links_.find(frames().carrier(frame));
    return found == links_.end() ? 0 : found->second;
  }

  // --- joints ------------------------------------------------------------------------------------------------------

  urdf::End end_of(const SceneJoint& source, const Frame::Name& name, bool may_be_world) {
    const int scope = frames()[source.frame].scope;
    urdf::End end;
    end.spot = end.frame_spot = name.spot;
    const bool is_world = name.text == "world" && may_be_world;
    const int frame = is_world || name.text.empty() ? Frames::world : frames().find(scope, name);
    if (frame != Frames::none) end.link = link_of(frame);
    return end;
  }

  void add_joint(SceneJoint& source) {
    Joint joint = source.joint;
    joint.parent = end_of(source, source.parent, true);
    // An unknown child is reported where the joint's frame looks for it.
    joint.child = {link_of(source.frame), Eigen::Isometry3d::Identity(), source.child.spot, source.child.spot};
    if (joint.parent.link == urdf::no_link || messages_.failed()) return;
    if (joint.parent.link == joint.child.link && joint.child.link != 0) {
      messages_.error(joint.child.spot, "bad-urdf", fmt::format("joint '{}' joins a link to itself", joint.name));
      return;
    }
    if (stands_[at(joint.parent.link)] && stands_[at(joint.child.link)]) {
      messages_.ignore("joint between parts that stand still", joint.name);
      return;
    }
    joint.name = fresh_name(source.frame, "joint");
    const Eigen::Isometry3d place = frames().pose(source.frame);
    joint.parent.frame = urdf::inverse_pose(poses_[at(joint.parent.link)]) * place;
    joint.child.frame = urdf::inverse_pose(poses_[at(joint.child.link)]) * place;
    set_axes(source, joint);
    indices_[source.frame] = robot_.joints.size();
    robot_.joints.push_back(std::move(joint));
  }

  /// Leaders are called as they are here; an unknown one is reported later.
  void name_leaders() {
    for (const auto& [frame, index] : indices_) {
      auto& mimic = robot_.joints[index].mimic;
      if (!mimic) continue;
      const auto leader = indices_.find(frames().look_up(frames()[frame].scope, mimic->joint));
      if (leader != indices_.end()) mimic->joint = robot_.joints[leader->second].name;
    }
  }

  /// Unit vector of an axis in the joint's frame.
  Eigen::Vector3d direction(const SceneJoint& source, const SceneAxis& axis) {
    if (axis.expressed_in.text.empty()) return axis.xyz;
    const int frame = frames().find(frames()[source.frame].scope, axis.expressed_in);
    if (frame == Frames::none) return axis.xyz;
    return frames().pose(source.frame).linear().transpose() * (frames().pose(frame).linear() * axis.xyz);
  }

  void set_axes(const SceneJoint& source, Joint& joint) {
    if (!source.axis.given) return;
    joint.axis_spot = source.axis.spot;
    joint.axis = direction(source, source.axis);
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (source.kind == Kind::screw) {
      turn = urdf::least_turn(Eigen::Vector3d::UnitZ(), joint.axis);
    } else if (source.kind == Kind::universal) {
      const Eigen::Vector3d second = direction(source, source.second);
      if (std::abs(second.dot(joint.axis)) > same_direction) {
        messages_.error(source.second.spot, "bad-urdf",
                        fmt::format("the axes of joint '{}' must be at a right angle to each other", joint.name));
        return;
      }
      const Eigen::Vector3d third = joint.axis.cross(second).normalized();
      turn << joint.axis, third.cross(joint.axis), third;
    }
    joint.parent.frame.linear() *= turn;
    joint.child.frame.linear() *= turn;
  }

  // --- gears -------------------------------------------------------------------------------------------------------

  struct Turning {
    std::size_t joint = 0;
    double sign =
        0.0;  ///< of the joint's coordinate in the angle from the reference to the other link; 0: no such joint
  };

  /// The pin that turns a link about the reference, along the axis in the world.
  Turning pin_between(int reference, int link, const std::optional<Eigen::Vector3d>& axis) {
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      const Joint& joint = robot_.joints[i];
      const bool forward = joint.parent.link == reference && joint.child.link == link;
      const bool backward = joint.parent.link == link && joint.child.link == reference;
      if (joint.type != JointType::revolute || (!forward && !backward)) continue;
      const Eigen::Vector3d own = poses_[at(joint.child.link)].linear() * joint.child.frame.linear() * joint.axis;
      if (axis && own.cross(*axis).norm() > same_direction) continue;
      const double sense = axis && own.dot(*axis) < 0.0 ? -1.0 : 1.0;
      return {i, forward ? sense : -sense};
    }
    return {};
  }

  /// The angle of the child about the reference is -ratio times that of the parent.
  void add_gear(const SceneJoint& source) {
    const int reference = end_of(source, source.reference, true).link;
    const int first = end_of(source, source.parent, true).link, second = link_of(source.frame);
    if (reference == urdf::no_link || first == urdf::no_link || messages_.failed()) return;
    const auto axis_in_world = [&](const SceneAxis& axis) -> std::optional<Eigen::Vector3d> {
      if (!axis.given) return std::nullopt;
      return frames().pose(source.frame).linear() * direction(source, axis);
    };
    const Turning leader = pin_between(reference, first, axis_in_world(source.axis));
    const Turning follower =
        pin_between(reference, second, axis_in_world(source.second.given ? source.second : source.axis));
    if (leader.sign == 0.0 || follower.sign == 0.0 || leader.joint == follower.joint) {
      messages_.error(
          source.joint.spot, "bad-urdf",
          fmt::format("the gearbox '{}' needs two revolute joints along its axes, from '{}' to its parent and "
                      "to its child",
                      source.joint.name, source.reference.text));
      return;
    }
    Joint& tied = robot_.joints[follower.joint];
    if (tied.mimic) {
      messages_.error(source.joint.spot, "bad-urdf", fmt::format("joint '{}' follows another already", tied.name));
      return;
    }
    const Spot& spot = source.joint.spot;
    tied.mimic = urdf::Mimic{
        robot_.joints[leader.joint].name, -1, -source.ratio * leader.sign * follower.sign, 0.0, spot, spot, spot};
  }

  // --- tree --------------------------------------------------------------------------------------------------------

  /// Chooses the joints by which links hang on each other, turns those round that say it the other way, and lets float
  /// what hangs on nothing. The rest closes loops.
  void hang_links() {
    const std::size_t count = robot_.joints.size();
    DisjointSets connected(static_cast<int>(robot_.links.size()));
    std::vector<bool> chosen(count), has_parent(robot_.links.size());
    for (std::size_t i = 0; i < count; ++i) {
      const Joint& joint = robot_.joints[i];
      if (has_parent[at(joint.child.link)]) continue;
      if (connected.unite(joint.parent.link, joint.child.link)) chosen[i] = has_parent[at(joint.child.link)] = true;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Joint& joint = robot_.joints[i];
      if (!chosen[i] && connected.unite(joint.parent.link, joint.child.link)) chosen[i] = true;
    }
    std::vector<std::vector<std::size_t>> at_link(robot_.links.size());
    for (std::size_t i = 0; i < count; ++i) {
      robot_.joints[i].closes_loop = !chosen[i];
      if (!chosen[i]) continue;
      at_link[at(robot_.joints[i].parent.link)].push_back(i);
      at_link[at(robot_.joints[i].child.link)].push_back(i);
    }
    reached_.assign(robot_.links.size(), false);
    reach(0, at_link);
    for (const bool without_parent : {true, false}) {
      for (std::size_t i = 1; i < robot_.links.size(); ++i) {
        if (reached_[i] || (without_parent && has_parent[i])) continue;
        hang(0, static_cast<int>(i), JointType::floating);
        reach(static_cast<int>(i), at_link);
      }
    }
  }

  void reach(int first, const std::vector<std::vector<std::size_t>>& at_link) {
    std::vector<int> open{first};
    reached_[at(first)] = true;
    while (!open.empty()) {
      const int here = open.back();
      open.pop_back();
      for (const std::size_t i : at_link[at(here)]) {
        Joint& joint = robot_.joints[i];
        const int other = joint.parent.link == here ? joint.child.link : joint.parent.link;
        if (reached_[at(other)]) continue;
        if (joint.child.link == here) turn_round(joint);
        reached_[at(other)] = true;
        open.push_back(other);
      }
    }
  }

  Scene& scene_;
  Messages& messages_;
  urdf::Robot robot_;
  urdf::NamePool names_;
  int only_model_ = Frames::none;
  std::vector<Eigen::Isometry3d> poses_;  ///< of each link in the world
  std::vector<bool> stands_, reached_;    ///< of each link
  std::map<int, int> links_;              ///< by their frames
  std::map<int, std::size_t> indices_;    ///< of joints in the robot, by their frames
};

}  // namespace

urdf::Robot robot_of(Scene& scene, Messages& messages) { return RobotBuilder(scene, messages).build(); }

}  // namespace freeplay::sdf
