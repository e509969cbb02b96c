#include "format/gear_teeth.h"

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/index.h"
#include "format/doubtful_number.h"
#include "model/gear_teeth.h"

namespace freeplay {
namespace {

constexpr double largest_pressure_angle = M_PI / 4.0;  // [rad]
constexpr double farthest_axles = 100.0;               // by the radii of gyration of both wheels

std::optional<double> pressure_angle_of(const CheckedValue& written) {
  const std::optional<double> angle = written.quantity(dimension::angle);
  if (!angle || (*angle > 0.0 && *angle <= largest_pressure_angle)) return angle;
  const double in_degrees = *angle * M_PI / 180.0;
  const bool unit_forgotten = !names_a_unit(written) && in_degrees > 0.0 && in_degrees <= largest_pressure_angle;
  written.fail("out-of-range", "'" + written.path() + "' must be above 0 and not above 45 deg", {},
               unit_forgotten ? fmt::format("a number without a unit is in rad; write '{:g} deg'", *angle)
                              : "usual are 14.5 deg, 20 deg and 25 deg");
  return std::nullopt;
}

/// Why the two joints of a gear cannot have teeth between them; "" where they can.
class TeethFault {
 public:
  TeethFault(const Model& model, const Gear& gear)
      : model_(model), gear_(gear), first_(joint(gear.first)), second_(joint(gear.second)) {}

  std::string words() const {
    if (model_.space != Space::planar) return "works in planar models only";
    if (!turns(first_) && !turns(second_)) return "needs a wheel: both joints slide";
    for (const JointElement* one : {&first_, &second_}) {
      const char* const needed = turns(*one) ? "a wheel whose axle is held" : "a rack that does not turn";
      if (one->ideal_layout().constraint_rows != 2) return needs(needed, *one);
      if (one->has_play) return needs("bearings without play", *one);
    }
    const std::optional<BodyId> carrier = carrier_of(model_, gear_);
    if (!carrier) return "needs '" + first_.name + "' and '" + second_.name + "' on one body that carries both wheels";
    if (!turns(first_) || !turns(second_)) return "";
    return words_of_wheels(*carrier);
  }
  /// Wheels that do not reach each other; "" where they may.
  std::string doubt() const {
    double gyration = 0.0;
    for (const int marker : {first_.marker_a, first_.marker_b, second_.marker_a, second_.marker_b}) {
      const BodyId body = model_.markers[at(marker)].body;
      if (body == ground || body == carrier_of(model_, gear_)) continue;
      gyration += std::sqrt(model_.bodies[at(body)].inertia[8] / model_.bodies[at(body)].mass);
    }
    const double apart = distance();
    if (!turns(first_) || !turns(second_) || apart <= farthest_axles * gyration || !(gyration > 0.0)) return "";
    return fmt::format(
        "the axles of '{}' and '{}' are {:.4g} m apart, but the radii of gyration of their wheels come to {:.3g} m: "
        "check the places of the axles, their units and the inertias",
        first_.name, second_.name, apart, gyration);
  }
  /// What may be written instead.
  std::string remedy() const {
    const bool loose = first_.has_play || second_.has_play;
    return loose && model_.space == Space::planar ? "give the gear play, too, by a block 'clearance'" : "";
  }

 private:
  static bool turns(const JointElement& one) { return one.ideal_layout().coordinate == Coordinate::angle; }
  static std::string needs(const std::string& what, const JointElement& joint) {
    return "needs " + what + ", but '" + joint.name + (joint.has_play ? "' has play" : "' leaves it free");
  }
  const JointElement& joint(int index) const { return model_.joints[at(index)]; }
  bool is_on(BodyId body, int marker) const { return model_.markers[at(marker)].body == body; }

  /// Of two axles on one body [m].
  double distance() const {
    const BodyId carrier = carrier_of(model_, gear_).value_or(ground);
    const auto axle = [&](const JointElement& one) -> const Vector3& {
      return model_.markers[at(is_on(carrier, one.marker_a) ? one.marker_a : one.marker_b)].position;
    };
    const Vector3 &a = axle(first_), &b = axle(second_);
    return std::hypot(b[0] - a[0], b[1] - a[1]);
  }

  std::string words_of_wheels(BodyId carrier) const {
    const auto is_first = [&](const JointElement& one) { return is_on(carrier, one.marker_a); };
    if (distance() == 0.0) {
      return "needs two axles at a distance, of which pitch radii follow; both are at the same point";
    }
    const double sense = is_first(first_) == is_first(second_) ? 1.0 : -1.0;
    return sense * gear_.ratio == 1.0 ? "needs wheels that do not turn equally fast the same way" : "";
  }

  const Model& model_;
  const Gear& gear_;
  const JointElement &first_, &second_;
};

}  // namespace

void give_teeth(Draft& draft, const CheckedValue& written, const Gear& gear) {
  const std::optional<double> angle = pressure_angle_of(written);
  if (!angle) return;
  const TeethFault fault(draft.model, gear);
  if (const std::string words = fault.words(); !words.empty()) {
    written.fail("conflicting-keys", "'pressure_angle' " + words, {}, fault.remedy());
    return;
  }
  if (const std::string words = fault.doubt(); !words.empty()) written.warn("doubtful-length", words);
  JointElement& element = draft.model.joints[at(gear.joint)];
  auto block = std::make_shared<ParameterBlock>();
  block->component = element.component;
  ParameterValue& value = block->values[pressure_angle_word];
  value.given = true;
  value.number = *angle;
  element.parameters = std::move(block);
}

}  // namespace freeplay
