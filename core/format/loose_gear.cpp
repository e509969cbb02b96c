#include "format/loose_gear.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/index.h"
#include "format/draft.h"
#include "format/gear.h"
#include "format/joint_section.h"

namespace freeplay {
namespace {

constexpr double same_length = 1e-6;  // by itself

/// A wheel on the body that carries both: its marker, that of its axis there, and the sense of the joint's coordinate.
struct Wheel {
  int marker, axis;
  double sense;
};

std::array<Wheel, 2> ways_to_see(const JointElement& joint) {
  return {{{joint.marker_b, joint.marker_a, 1.0}, {joint.marker_a, joint.marker_b, -1.0}}};
}

class LooseGear {
 public:
  LooseGear(Draft& draft, const Gear& gear, const CheckedValue& entry) : draft_(draft), gear_(gear), entry_(entry) {}

  void loosen(const CheckedParameters& parameters) {
    if (!find_wheels()) return;
    ParameterBlock block = *parameters.block;
    const double ratio = gear_.ratio * first_.sense * second_.sense;
    for (const char* own : {"clearance.first_radius", "clearance.middle"}) {
      const auto written = parameters.places.find(own);
      if (written == parameters.places.end()) continue;
      return written->second.fail_at_key("conflicting-keys", "'" + written->second.path() + "' follows from the gear");
    }
    const auto set = [&](const char* name, double value) {
      block.values[name].given = true;
      block.values[name].number = value;
    };
    set("clearance.first_radius", -ratio * block.values["clearance.pitch_radius"].number);
    set("clearance.middle", std::numeric_limits<double>::quiet_NaN());
    if (!meets(block, parameters, ratio)) return;
    CheckedParameters made{std::move(block), parameters.places, parameters.fields};
    JointRef joint;
    JointLayout layout;
    JointElement& element = draft_.model.joints[at(gear_.joint)];
    if (!make_joint(draft_, made, entry_, joint, layout)) return;
    element.parameters = std::make_shared<const ParameterBlock>(*made.block);
    if (is_made_ideal(draft_, element.name)) {
      draft_.model.ideal.push_back(element.name);
      return;
    }
    element.twin = std::make_shared<const IdealTwin>(IdealTwin{element.component, element.joint, element.layout});
    element.component = made.block->component;
    element.joint = joint;
    element.layout = layout;
    element.marker_a = first_.marker;
    element.marker_b = second_.marker;
    element.has_play = true;
  }

 private:
  const Marker& marker(int index) const { return draft_.model.markers[at(index)]; }
  const JointElement& joint(int index) const { return draft_.model.joints[at(index)]; }

  bool find_wheels() {
    for (const int j : {gear_.first, gear_.second}) {
      if (joint(j).ideal_layout().coordinate == Coordinate::angle) continue;
      return refuse(fmt::format("'{}' slides: teeth with play join two wheels that turn", joint(j).name),
                    "leave the play out, or couple two joints that turn");
    }
    for (const Wheel& one : ways_to_see(joint(gear_.first))) {
      for (const Wheel& other : ways_to_see(joint(gear_.second))) {
        if (marker(one.axis).body != marker(other.axis).body) continue;
        if (marker(one.marker).body == marker(other.marker).body) continue;
        first_ = one;
        second_ = other;
        return true;
      }
    }
    return refuse(fmt::format("'{}' and '{}' do not hold two wheels on one body: teeth meet where one body carries "
                              "both axes",
                              joint(gear_.first).name, joint(gear_.second).name),
                  "couple joints between the wheels and the frame or the arm that carries them");
  }

  /// The pitch circles touch where the frames of the joints put the axes.
  bool meets(const ParameterBlock& block, const CheckedParameters& parameters, double ratio) const {
    const auto found = block.values.find("clearance.pitch_radius");
    if (found == block.values.end()) return true;
    const Vector3 &a = marker(first_.axis).position, &b = marker(second_.axis).position;
    const double apart = std::hypot(b[0] - a[0], b[1] - a[1]);
    const double wanted = found->second.number * std::abs(1.0 - ratio);
    if (std::abs(apart - wanted) <= same_length * wanted) return true;
    const std::string reason = fmt::format(
        "the axes of '{}' and '{}' are {:.6g} m apart, but with this pitch radius and ratio the pitch "
        "circles touch at {:.6g} m",
        joint(gear_.first).name, joint(gear_.second).name, apart, wanted);
    const std::string remedy =
        ratio == 1.0 || apart == 0.0
            ? ""
            : fmt::format("the pitch radius of the second wheel is {:.9g} m", apart / std::abs(1.0 - ratio));
    const auto place = parameters.places.find(found->first);
    (place == parameters.places.end() ? entry_ : place->second).fail("out-of-range", reason, {}, remedy);
    return false;
  }

  bool refuse(const std::string& reason, const std::string& remedy) const {
    entry_.fail_at_key("wrong-type", reason, {}, remedy);
    return false;
  }

  Draft& draft_;
  const Gear& gear_;
  const CheckedValue& entry_;
  Wheel first_{}, second_{};
};

}  // namespace

const Component* loose_gear(const Draft& draft, const MapReader& map) {
  for (const RegisteredComponent& one : draft.registry.components()) {
    const Description& twin = one.component->description;
    if (one.component->kind != ComponentKind::joint || twin.ideal == nullptr || twin.block == nullptr) continue;
    if (std::string_view(twin.ideal) != gear_word || !map.has(twin.block)) continue;
    if (serves(twin.space, draft.model.space)) return one.component;
  }
  return nullptr;
}

void loosen(Draft& draft, const Gear& gear, const CheckedParameters& parameters, const CheckedValue& entry) {
  LooseGear(draft, gear, entry).loosen(parameters);
}

}  // namespace freeplay
