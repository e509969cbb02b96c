#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "sdf/scene.h"
#include "urdf/reference.h"
#include "urdf/text_value.h"

namespace freeplay::sdf {
namespace {

using urdf::JointType;
using Kind = SceneJoint::Kind;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Files before 1.7 write it where a joint has no limit, and stops that have one end only get it for the other.
constexpr double no_limit = 1e16;

struct TypeWord {
  const char* word;
  JointType type;
  Kind kind;
};
constexpr TypeWord types[] = {
    {"revolute", JointType::revolute, Kind::plain},
    {"continuous", JointType::revolute, Kind::plain},
    {"prismatic", JointType::prismatic, Kind::plain},
    {"ball", JointType::spherical, Kind::plain},
    {"fixed", JointType::fixed, Kind::plain},
    {"universal", JointType::universal, Kind::universal},
    {"revolute2", JointType::universal, Kind::universal},
    {"screw", JointType::screw, Kind::screw},
    {"gearbox", JointType::fixed, Kind::gear},
};

class JointReader {
 public:
  JointReader(XmlElement& xml, Scene& scene, Messages& messages)
      : xml_(xml), scene_(scene), messages_(messages), element_(xml, owner_of(xml), messages, false) {}

  void read(int scope) {
    Frame frame;
    frame.kind = Frame::Kind::joint;
    frame.scope = scope;
    read_head(frame);
    read_pose(element_, frame, true, scene_, messages_);
    out_.parent = read_word(element_, "parent", true, messages_);
    out_.child = read_word(element_, "child", true, messages_);
    if (out_.child.text == "world") {
      messages_.error(out_.child.spot, "bad-urdf", fmt::format("the world cannot be the child of {}", element_.owner()),
                      {}, "swap parent and child");
    }
    frame.attached_to = out_.child;
    read_axes();
    read_screw();
    read_gear();
    for (const char* other : {"physics", "sensor"}) element_.pass_over(other);
    element_.finish();
    out_.frame = scene_.frames.add(std::move(frame), scene_.names_frames());
    scene_.joints.push_back(std::move(out_));
  }

 private:
  static std::string owner_of(const XmlElement& xml) {
    const char* name = xml.Attribute("name");
    return name == nullptr ? "a joint" : fmt::format("joint '{}'", name);
  }

  void read_head(Frame& frame) {
    urdf::Joint& joint = out_.joint;
    const Frame::Name name = read_name(element_, messages_);
    frame.name = joint.name = name.text;
    frame.spot = joint.spot = joint.type_spot = name.spot;
    joint.element = joint.axis_spot = element_.begin_spot();
    joint.axis_given = true;
    const XmlAttribute* type = element_.require("type");
    if (type == nullptr) return;
    joint.type_spot = urdf::spot_of(xml_, *type);
    const auto* known =
        std::ranges::find_if(types, [&](const TypeWord& one) { return type->Value() == std::string(one.word); });
    if (known != std::end(types)) {
      joint.type = known->type;
      out_.kind = known->kind;
      endless_ = type->Value() == std::string("continuous");
      return;
    }
    std::vector<std::string> words;
    for (const TypeWord& one : types) words.emplace_back(one.word);
    messages_.error(joint.type_spot, "bad-urdf",
                    fmt::format("the type '{}' of {} has no counterpart here", type->Value(), element_.owner()),
                    messages_.suggest(type->Value(), words), fmt::format("types: {}", fmt::join(words, ", ")));
  }

  // --- axes --------------------------------------------------------------------------------------------------------

  void read_axes() {
    const bool needs_axis = out_.joint.type != JointType::fixed && out_.joint.type != JointType::spherical;
    const bool two = out_.kind == Kind::universal;
    XmlElement* first = needs_axis ? element_.required_child("axis") : element_.child("axis");
    XmlElement* second = two ? element_.required_child("axis2") : element_.child("axis2");
    if (first != nullptr) read_axis(*first, out_.axis);
    if (second != nullptr) read_axis(*second, out_.second);
    if (out_.joint.type == JointType::prismatic && out_.joint.reach == 0.0) out_.joint.reach = urdf::endless_reach;
  }

  void read_axis(XmlElement& xml, SceneAxis& axis) {
    Element element(xml, fmt::format("the {} of {}", xml.Name(), element_.owner()), messages_, false);
    axis.given = true;
    axis.spot = element.name_spot();
    if (XmlElement* xyz = element.required_child("xyz")) read_direction(*xyz, element.owner(), axis);
    // Up to 1.4 axes are those of the model, and up to 1.6 a flag may say so.
    const bool in_model = read_flag(element, "use_parent_model_frame", scene_.minor < 5, messages_);
    if (in_model && !scene_.names_frames()) axis.expressed_in = {"__model__", axis.spot};
    read_dynamics(element);
    read_limit(element);
    read_mimic(element);
    if (read_value(element, "initial_position", 0.0, messages_) != 0.0) {
      messages_.warning(
          urdf::name_spot(*xml.FirstChildElement("initial_position")), "urdf-ignored",
          fmt::format("{} begins where the file draws it, not at its initial_position", element_.owner()));
    }
    element.finish();
  }

  void read_direction(XmlElement& xml, const std::string& owner, SceneAxis& axis) {
    Element xyz(xml, "the xyz of " + owner, messages_, false);
    axis.spot = urdf::whole_text_spot(xml);
    const XmlAttribute* frame = xyz.find("expressed_in");
    if (frame != nullptr) axis.expressed_in = {frame->Value(), urdf::spot_of(xml, *frame)};
    xyz.finish(true);
    const std::vector<double> numbers = urdf::text_numbers(xml, 3, messages_);
    if (numbers.empty()) return;
    axis.xyz = urdf::unit_axis({numbers[0], numbers[1], numbers[2]}, axis.spot, owner, messages_);
  }

  // --- values ------------------------------------------------------------------------------------------------------

  double not_negative(Element& element, const char* name, Spot& spot) {
    const double value = read_value(element, name, 0.0, messages_, &spot);
    if (value >= 0.0) return value;
    messages_.error(spot, "bad-urdf", fmt::format("{} in {} must not be negative: {}", name, element.owner(), value));
    return 0.0;
  }

  void read_dynamics(Element& axis) {
    XmlElement* xml = axis.child("dynamics");
    if (xml == nullptr) return;
    urdf::Joint& joint = out_.joint;
    Element dynamics(*xml, "the dynamics of " + element_.owner(), messages_, false);
    const double damping = not_negative(dynamics, "damping", joint.damping_spot);
    const double friction = not_negative(dynamics, "friction", joint.friction_spot);
    const double stiffness = not_negative(dynamics, "spring_stiffness", joint.stiffness_spot);
    const double slack_at = read_value(dynamics, "spring_reference", 0.0, messages_);
    dynamics.finish();
    if (joint.has_coordinate()) {
      joint.damping = damping;
      joint.friction = friction;
      joint.stiffness = stiffness;
      joint.slack_at = slack_at;
      return;
    }
    if (damping > 0.0) messages_.ignore("damping of joint", joint.name);
    if (friction > 0.0) messages_.ignore("friction of joint", joint.name);
    if (stiffness > 0.0) messages_.ignore("spring of joint", joint.name);
  }

  void read_limit(Element& axis) {
    XmlElement* xml = axis.child("limit");
    if (xml == nullptr) return;
    urdf::Joint& joint = out_.joint;
    Element limit(*xml, "the limit of " + element_.owner(), messages_, false);
    const double lower = read_value(limit, "lower", -infinity, messages_);
    const double upper = read_value(limit, "upper", infinity, messages_);
    const double effort = read_value(limit, "effort", infinity, messages_);
    const double stiffness = read_value(limit, "stiffness", infinity, messages_);
    read_value(limit, "velocity", infinity, messages_);
    read_value(limit, "dissipation", infinity, messages_);
    limit.finish();
    const bool has_lower = lower > -no_limit, has_upper = upper < no_limit;
    if (lower > upper) {
      messages_.error(urdf::name_spot(*xml), "bad-urdf",
                      fmt::format("{}: lower {} is above upper {}", limit.owner(), lower, upper));
      return;
    }
    if (!has_lower && !has_upper) return;
    if (!joint.has_coordinate() || endless_) {
      messages_.ignore("limits of joint", joint.name);
      return;
    }
    if (joint.turns()) doubt_degrees(lower, upper, *xml);
    if (has_lower && has_upper) joint.reach = std::max(std::abs(lower), std::abs(upper));
    joint.limits = urdf::Limits{std::max(lower, -no_limit), std::min(upper, no_limit),
                                std::isfinite(effort) ? std::max(effort, 0.0) : 0.0, urdf::name_spot(*xml),
                                std::isfinite(stiffness) ? std::max(stiffness, 0.0) : 0.0};
  }

  void doubt_degrees(double lower, double upper, const XmlElement& xml) {
    for (const double angle : {lower, upper}) {
      if (!urdf::looks_like_degrees(angle)) continue;
      messages_.warning(urdf::name_spot(xml), "doubtful-angle",
                        fmt::format("a limit of {} is {:.6g} rad, {:.3g} turns: robot files are in radians, not in "
                                    "degrees",
                                    element_.owner(), angle, std::abs(angle) / (2.0 * std::numbers::pi)));
      return;
    }
  }

  void read_mimic(Element& axis) {
    XmlElement* xml = axis.child("mimic");
    if (xml == nullptr) return;
    Element mimic(*xml, "the mimic of " + element_.owner(), messages_, false);
    const XmlAttribute* leader = mimic.require("joint");
    const XmlAttribute* which = mimic.find("axis");
    urdf::Mimic made;
    made.spot = urdf::spot_of(*xml, "joint");
    made.multiplier_spot = made.offset_spot = mimic.name_spot();
    made.multiplier = read_value(mimic, "multiplier", 1.0, messages_, &made.multiplier_spot);
    made.offset = read_value(mimic, "offset", 0.0, messages_, &made.offset_spot);
    made.offset -= made.multiplier * read_value(mimic, "reference", 0.0, messages_);
    mimic.finish();
    if (which != nullptr && which->Value() != std::string("axis")) {
      messages_.error(urdf::spot_of(*xml, *which), "bad-urdf",
                      fmt::format("{} can follow a first axis only, not '{}'", element_.owner(), which->Value()));
    }
    if (made.multiplier == 0.0) {
      messages_.error(made.multiplier_spot, "bad-urdf",
                      fmt::format("the multiplier of {} must not be 0", mimic.owner()));
    }
    if (leader == nullptr) return;
    made.joint = leader->Value();
    out_.joint.mimic = made;
  }

  // --- types with values of their own ------------------------------------------------------------------------------

  /// `thread_pitch` is an older word for the same: the turn per metre, of a left-handed thread where it is positive.
  void read_screw() {
    Spot spot, old_spot;
    const double lead = read_value(element_, "screw_thread_pitch", 0.0, messages_, &spot);
    const double pitch = read_value(element_, "thread_pitch", 0.0, messages_, &old_spot);
    if (out_.kind != Kind::screw) return;
    const bool is_new = xml_.FirstChildElement("screw_thread_pitch") != nullptr;
    out_.joint.lead = is_new ? lead : pitch == 0.0 ? 0.0 : -2.0 * std::numbers::pi / pitch;
    if (out_.joint.lead != 0.0) return;
    messages_.error(
        element_.begin_spot(), "bad-urdf",
        fmt::format("{} needs a screw_thread_pitch that is not 0: the way per turn in m", element_.owner()));
  }

  void read_gear() {
    const bool gear = out_.kind == Kind::gear;
    Spot spot;
    out_.ratio = read_value(element_, "gearbox_ratio", 1.0, messages_, &spot);
    out_.reference = read_word(element_, "gearbox_reference_body", gear, messages_);
    if (gear && out_.ratio == 0.0) {
      messages_.error(spot, "bad-urdf", fmt::format("the gearbox_ratio of {} must not be 0", element_.owner()));
    }
  }

  XmlElement& xml_;
  Scene& scene_;
  Messages& messages_;
  Element element_;
  SceneJoint out_;
  bool endless_ = false;
};

}  // namespace

void read_joint(XmlElement& xml, int scope, Scene& scene, Messages& messages) {
  JointReader(xml, scene, messages).read(scope);
}

}  // namespace freeplay::sdf
