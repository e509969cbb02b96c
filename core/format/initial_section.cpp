#include "format/initial_section.h"

#include <algorithm>

#include "format/doubtful_number.h"
#include "format/joint_section.h"

namespace freeplay {
namespace {

enum class StartKind { coordinate, speed };

/// Does a driver already say what `initial` would?
bool is_prescribed(const Draft& draft, int joint, StartKind what) {
  for (const Driver& driver : draft.model.drivers) {
    if (driver.joint != joint || !prescribes(driver.kind)) continue;
    // The integral of a speed starts at a value that must be chosen.
    if (what == StartKind::speed || driver.kind != DriverKind::velocity) return true;
  }
  return false;
}

Dimension dimension_of(Coordinate coordinate, StartKind what) {
  const bool angle = coordinate == Coordinate::angle;
  if (what == StartKind::coordinate) return angle ? dimension::angle : dimension::length;
  return angle ? dimension::angular_velocity : dimension::velocity;
}

void read_start_value(Draft& draft, const CheckedValue& value, StartKind what) {
  const std::string name = value.key();
  const std::optional<int> joint = draft.find_joint(name, draft.parts.front());
  if (!joint) return draft.unknown_joint(value, name, draft.parts.front(), true);
  const std::size_t index = static_cast<std::size_t>(*joint);
  if (!draft.joint_usable[index]) return;
  JointElement& element = draft.model.joints[index];
  const Coordinate coordinate = element.ideal_layout().coordinate;
  if (coordinate == Coordinate::none) {
    return value.fail_at_key("wrong-type", "joint '" + name + "' has no coordinate that could have a start value", {},
                             coordinate_hint(*element.ideal_component()));
  }
  const std::optional<double> number = value.quantity(dimension_of(coordinate, what));
  if (is_prescribed(draft, *joint, what)) {
    return value.fail_at_key("conflicting-keys",
                             "a driver moves joint '" + name + "'; it has no start value of its own");
  }
  if (!number) return;
  if (what == StartKind::speed) {
    coordinate == Coordinate::angle ? doubt_angular_speed(value, *number) : doubt_slide_speed(value, *number);
  } else if (coordinate == Coordinate::angle) {
    doubt_angle(value, *number);
  } else {
    doubt_start_length(value, *number, draft.length_scale);
  }
  (what == StartKind::coordinate ? element.start_coordinate : element.start_speed) =
      StartValue{*number, value.key_location()};
}

/// A number for angles and lengths alike.
std::optional<double> read_tolerance(const CheckedValue& value) {
  const std::optional<Quantity> quantity = value.any_quantity();
  if (!quantity) return std::nullopt;
  // A length is as good as a plain number here.
  return fits(*quantity, dimension::length) ? value.quantity(dimension::length, positive)
                                            : value.quantity(dimension::angle, positive);
}

void read_assembly(Draft& draft, const CheckedValue& value) {
  MapReader map(value, "assembly");
  const auto tolerance = map.find("tolerance");
  const auto iterations = map.find("max_iterations");
  Settings& settings = draft.model.settings;
  if (tolerance) {
    settings.assembly_tolerance = read_tolerance(*tolerance).value_or(settings.assembly_tolerance);
  }
  if (iterations) {
    settings.assembly_iterations = static_cast<int>(iterations->integer(1, 1'000'000).value_or(50));
  }
  map.finish();
}

}  // namespace

void read_initial(Draft& draft, const CheckedValue& section) {
  MapReader map(section, "initial");
  if (const auto joints = map.find("joints")) {
    for (const CheckedValue& value : entries_of(*joints, MapNames::references))
      read_start_value(draft, value, StartKind::coordinate);
  }
  if (const auto speeds = map.find("speeds")) {
    for (const CheckedValue& value : entries_of(*speeds, MapNames::references))
      read_start_value(draft, value, StartKind::speed);
  }
  if (const auto assembly = map.find("assembly")) read_assembly(draft, *assembly);
  map.finish();
}

}  // namespace freeplay
