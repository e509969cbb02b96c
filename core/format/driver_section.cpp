#include "format/driver_section.h"

#include <array>

#include "format/joint_section.h"
#include "format/kinematics_keys.h"
#include "format/motion_names.h"
#include "format/table_keys.h"
#include "model/leg.h"

namespace freeplay {
namespace {

const std::vector<std::string> kind_words = {"angle", "position", "velocity", "torque", "force"};

/// The kinds that fit a coordinate, for messages.
std::vector<std::string> kinds_for(Coordinate coordinate) {
  if (coordinate == Coordinate::angle) return {"angle", "velocity", "torque"};
  return {"position", "velocity", "force"};
}

bool fits(DriverKind kind, Coordinate coordinate) {
  switch (kind) {
    case DriverKind::angle:
    case DriverKind::torque:
      return coordinate == Coordinate::angle;
    case DriverKind::position:
    case DriverKind::force:
      return coordinate == Coordinate::position;
    case DriverKind::velocity:
      break;
  }
  return coordinate != Coordinate::none;
}

Dimension dimension_of(DriverKind kind, Coordinate coordinate) {
  switch (kind) {
    case DriverKind::angle:
      return dimension::angle;
    case DriverKind::position:
      return dimension::length;
    case DriverKind::torque:
      return dimension::torque;
    case DriverKind::force:
      return dimension::force;
    case DriverKind::velocity:
      break;
  }
  return coordinate == Coordinate::angle ? dimension::angular_velocity : dimension::velocity;
}

/// How many derivatives of its function a driver uses.
int derivatives_of(DriverKind kind) { return !prescribes(kind) ? 0 : kind == DriverKind::velocity ? 1 : 2; }

/// Reads one entry of `drivers`.
class DriverEntry {
 public:
  DriverEntry(Draft& draft, const Part& part, const CheckedValue& entry)
      : draft_(draft), part_(part), entry_(entry), map_(entry, "driver") {}

  void read() {
    if (!map_.good()) return;
    if (map_.has("inverse_kinematics")) {
      map_.conflict("joint", "inverse_kinematics");
      for (const char* key : {"joint", "kind", "value", "table", "input"}) map_.find(key);
      if (!map_.has("joint")) {
        for (const char* key : {"value", "table", "input"}) map_.conflict("inverse_kinematics", key);
      }
      read_kinematics(*map_.find("inverse_kinematics"));
    } else {
      map_.refuse("inverse_kinematics", "");
      read_driver();
    }
    map_.finish();
  }

 private:
  const JointElement& element(int joint) const { return draft_.model.joints[static_cast<std::size_t>(joint)]; }
  bool usable(int joint) const { return draft_.joint_usable[static_cast<std::size_t>(joint)]; }

  // --- on one joint ----------------------------------------------------------------------------------------------

  void read_driver() {
    const auto joint_value = map_.require("joint");
    const auto kind_value = map_.require("kind");
    const auto value = read_function_key();
    const std::optional<int> joint = joint_value ? draft_.joint(*joint_value, part_) : std::nullopt;
    const std::optional<int> word = kind_value ? kind_value->word(kind_words) : std::nullopt;
    add_name();
    if (joint && usable(*joint) && !may_be_driven(*joint, *joint_value, *joint_value)) return;
    if (word && value && (!joint || !usable(*joint))) return read_alone(*value, static_cast<DriverKind>(*word));
    if (!joint || !usable(*joint) || !word) return;
    const DriverKind kind = static_cast<DriverKind>(*word);
    const Coordinate coordinate = element(*joint).ideal_layout().coordinate;
    if (!fits(kind, coordinate)) {
      return kind_value->fail("wrong-type", "joint '" + element(*joint).name + "' is driven by " +
                                                either(kinds_for(coordinate)) + ", not by '" +
                                                kind_words[static_cast<std::size_t>(*word)] + "'");
    }
    Driver driver;
    driver.name = part_.full(entry_.key());
    driver.location = entry_.key_location();
    driver.joint = *joint;
    driver.kind = kind;
    if (prescribes(kind)) claim(*joint, entry_, driver.name);
    if (!value) return;
    const Dimension dimension = dimension_of(kind, coordinate);
    if (value->key() == "input") {
      driver.input = read_input(*value, dimension, kind);
      if (!driver.input) return;
    }
    if (value->key() == "table") {
      driver.table = read_table(draft_, *value, dimension, &driver.table_source);
      if (!driver.table) return;
    } else {
      if (!read_value(*value, dimension, driver)) return;
    }
    draft_.model.drivers.push_back(std::move(driver));
  }

  /// An effort may depend on the motion.
  bool read_value(const CheckedValue& value, const Dimension& dimension, Driver& driver) const {
    const MotionNames names(draft_, part_, driver.by_motion.channels);
    std::optional<Expression> expression =
        value.time_function(dimension, derivatives_of(driver.kind), prescribes(driver.kind) ? nullptr : &names);
    if (!expression) return false;
    driver.text = value.node().text;
    if (expression->depends_on_variables()) {
      driver.in_time = expression->time_parts();
      driver.by_motion.formulas.emplace_back(*expression);
    } else {
      driver.value = std::move(*expression);
    }
    return true;
  }

  /// Whether it is what an effort begins with that the caller of a run sets.
  static bool read_input(const CheckedValue& value, const Dimension& dimension, DriverKind kind) {
    if (!prescribes(kind)) return value.quantity(dimension).has_value();
    value.fail_at_key("wrong-type",
                      "'" + value.path() + "' is for a torque or a force: '" +
                          kind_words[static_cast<std::size_t>(kind)] + "' is prescribed by 'value' or 'table'",
                      {}, "not in this release");
    return false;
  }

  /// For the mistakes in it, when the joint is not known.
  void read_alone(const CheckedValue& value, DriverKind kind) const {
    if (value.key() == "input") {
      read_input(value, dimension_of(kind, Coordinate::none), kind);
      return;
    }
    if (kind == DriverKind::velocity) return;  // its dimension is that of the joint
    const Dimension dimension = dimension_of(kind, Coordinate::none);
    if (value.key() == "table") {
      read_table(draft_, value, dimension);
    } else {
      value.time_function(dimension, derivatives_of(kind));
    }
  }

  /// `value`, `table` or `input`, by the key.
  std::optional<CheckedValue> read_function_key() {
    const auto value = map_.find("value"), table = map_.find("table"), input = map_.find("input");
    if (map_.conflict("value", "table") || map_.conflict("value", "input") || map_.conflict("table", "input")) {
      return std::nullopt;
    }
    if (!value && !table && !input) map_.report_missing("value");
    return value ? value : table ? table : input;
  }

  void add_name() {
    const std::string name = part_.full(entry_.key());
    if (draft_.drivers.add(name)) return;
    entry_.fail_at_key("duplicate-name", "there is a driver '" + name + "' already");
  }

  /// What to drive in place of a joint without a coordinate.
  std::string remedy_of(int joint) const {
    for (const Gear& gear : draft_.model.gears)
      if (gear.joint == joint)
        return "drive '" + element(gear.first).name + "' or '" + element(gear.second).name + "', which it ties";
    return coordinate_hint(*element(joint).ideal_component());
  }

  /// Has the joint a coordinate of its own? Reports at `clearance_place` or `place` when not.
  bool may_be_driven(int joint, const CheckedValue& place, const CheckedValue& clearance_place) const {
    if (element(joint).ideal_layout().coordinate == Coordinate::none) {
      place.fail("wrong-type", "joint '" + element(joint).name + "' has no coordinate that could be driven", {},
                 remedy_of(joint));
      return false;
    }
    if (!element(joint).has_play || element(joint).layout.coordinate != Coordinate::none) return true;
    if (!usable(joint)) return false;  // what is wrong in it was said
    clearance_place.fail("driver-on-clearance",
                         "joint '" + element(joint).name + "' has clearance, which leaves no coordinate to drive", {},
                         "--ideal closes it");
    return false;
  }

  /// At most one prescribing driver a joint.
  bool claim(int joint, const CheckedValue& place, const std::string& name) {
    const auto [owner, fresh] = draft_.prescribed.emplace(joint, name);
    if (fresh) return true;
    place.fail_at_key("duplicate-driver",
                      "joint '" + element(joint).name + "' is driven by '" + owner->second + "' already");
    return false;
  }

  // --- by inverse kinematics -------------------------------------------------------------------------------------

  void read_kinematics(const CheckedValue& value) {
    MapReader map(value, "inverse_kinematics");
    const auto frame = map.require("frame");
    const auto path = map.require("path");
    const auto joints = map.require("joints");
    auto elbow = map.find("elbow");
    map.finish();
    if (elbow && elbow->in_space()) {
      elbow->fail_at_key("type-space", "working modes work in planar models only", {},
                         "a 'pose' of the bodies chooses the branch");
      elbow.reset();
    }
    InverseKinematics kinematics;
    const std::optional<int> marker = frame ? draft_.marker(*frame, part_) : std::nullopt;
    const auto components = path ? read_path(draft_, *path, true) : std::nullopt;
    const auto driven = joints ? draft_.joint_list(*joints, part_) : std::nullopt;
    const std::size_t count = driven ? driven->size() : 0;
    const auto modes = elbow && driven ? read_elbow(*elbow, count) : std::vector<int>(count, 1);
    const bool claimed = driven && claim_all(*driven, *joints);
    if (!marker || !components || !claimed || !modes) return;
    kinematics.name = part_.full(entry_.key());
    kinematics.location = entry_.key_location();
    kinematics.frame_location = frame->location();
    kinematics.path_location = path->location();
    kinematics.marker = *marker;
    kinematics.path = *components;
    kinematics.first_driver = static_cast<int>(draft_.model.drivers.size());
    kinematics.driver_count = static_cast<int>(count);
    for (std::size_t i = 0; i < count; ++i) expand((*driven)[i], (*modes)[i], elbow.has_value(), joints->location());
    if (elbow) draft_.elbows.emplace_back(static_cast<int>(draft_.model.kinematics.size()), *elbow);
    draft_.model.kinematics.push_back(std::move(kinematics));
  }

  bool claim_all(const std::vector<int>& driven, const CheckedValue& joints) {
    bool good = true;
    if (driven.empty()) {
      joints.fail("wrong-length", "at least one joint must be driven");
      return false;
    }
    for (const int joint : driven) {
      if (!usable(joint)) {
        good = false;
        continue;
      }
      const std::string& name = element(joint).name;
      if (!may_be_driven(joint, joints, joints) || !claim(joint, joints, part_.full(entry_.key()))) return false;
      if (draft_.drivers.add(name)) continue;
      joints.fail("duplicate-name", "there is a driver '" + name + "' already");
      good = false;
    }
    return good;
  }

  void expand(int joint, int mode, bool mode_given, const Location& place) {
    Driver driver;
    driver.name = element(joint).name;
    driver.location = place;
    driver.joint = joint;
    driver.kind =
        element(joint).ideal_layout().coordinate == Coordinate::angle ? DriverKind::angle : DriverKind::position;
    driver.kinematics = static_cast<int>(draft_.model.kinematics.size());
    driver.elbow = mode;
    driver.elbow_given = mode_given;
    draft_.model.drivers.push_back(std::move(driver));
  }

  Draft& draft_;
  const Part& part_;
  const CheckedValue& entry_;
  MapReader map_;
};

}  // namespace

void add_drivers(Draft& draft, const Part& part) {
  const auto section = part.section("drivers");
  if (!section) return;
  for (const CheckedValue& entry : entries_of(*section)) {
    Draft::check_name(entry);
    const int errors = draft.diagnostics.errors();
    const std::size_t drivers = draft.model.drivers.size();
    DriverEntry(draft, part, entry).read();
    if (draft.diagnostics.errors() == errors && draft.model.drivers.size() > drivers) continue;
    // Drivers of inverse kinematics are named by their joints.
    const bool one = entry.node().is_map() && entry.node().find("joint") != nullptr;
    draft.unsure_columns.push_back(one ? "driver." + part.full(entry.key()) + "." : "driver.");
  }
}

void warn_ignored_elbows(const Draft& draft) {
  const Model& model = draft.model;
  for (const auto& [index, place] : draft.elbows) {
    const InverseKinematics& entry = model.kinematics[static_cast<std::size_t>(index)];
    for (int d = entry.first_driver; d < entry.first_driver + entry.driver_count; ++d) {
      if (find_leg_chain(model, model.drivers[static_cast<std::size_t>(d)].joint, entry.marker)) continue;
      place.warn_at_key("elbow-ignored", "joint '" + model.drivers[static_cast<std::size_t>(d)].name +
                                             "' does not move a crank and a coupler that carry the frame; it follows "
                                             "the start, not 'elbow'");
    }
  }
}

}  // namespace freeplay
