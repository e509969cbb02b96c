#include "model/channel.h"

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/name_pattern.h"
#include "base/program_lock.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {

struct Units {
  static inline std::set<std::string>& texts =
      *new std::set<std::string>;  // for threads that outlive the program's end
};

/// The same text for the life of the program: units of columns are views.
const char* kept_unit(const std::string& unit) {
  const std::lock_guard lock(ProgramLock<Units>::get());
  return Units::texts.insert(unit).first->c_str();
}

}  // namespace

Channels::Channels(const Model& model, bool all) : planar_(model.space == Space::planar) {
  struct Column {
    const char *name, *unit;
  };
  constexpr Column in_plane[] = {{".x", "m"},    {".y", "m"},    {".angle", "rad"},
                                 {".vx", "m/s"}, {".vy", "m/s"}, {".omega", "rad/s"}};
  constexpr Column in_space[] = {{".x", "m"},      {".y", "m"},      {".z", "m"},     {".qw", "1"},   {".qx", "1"},
                                 {".qy", "1"},     {".qz", "1"},     {".vx", "m/s"},  {".vy", "m/s"}, {".vz", "m/s"},
                                 {".wx", "rad/s"}, {".wy", "rad/s"}, {".wz", "rad/s"}};
  time = add("time", "s");
  const auto pose = [&](const std::string& prefix) {
    const int first = static_cast<int>(all_.size());
    for (const Column& column : planar_ ? std::span<const Column>(in_plane) : in_space) {
      add(prefix + column.name, column.unit);
    }
    return first;
  };
  for (const Body& body : model.bodies) bodies.push_back(pose("body." + body.name));
  joints.resize(model.joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!model.joints[j].is_force) joints[j] = add_joint(model.joints[j], "joint." + model.joints[j].name);
  }
  add_drivers(model);
  forces.resize(model.forces.size());
  for (const ForceElement& element : model.force_elements) {
    if (element.joint >= 0) {
      const std::size_t j = static_cast<std::size_t>(element.joint);
      joints[j] = add_joint(model.joints[j], "force." + model.joints[j].name);
      continue;
    }
    const std::size_t f = static_cast<std::size_t>(element.applied);
    const std::string prefix = "force." + model.forces[f].name;
    forces[f].force = add_wrench(prefix);
    forces[f].power = add(prefix + ".power", "W");
  }
  for (const int frame : model.settings.frames) {
    frames.push_back(pose("frame." + model.markers[static_cast<std::size_t>(frame)].name));
  }
  energy.kinetic = add("energy.kinetic", "J");
  energy.potential = add("energy.potential", "J");
  energy.dissipated = add("energy.dissipated", "J");
  energy.work = add("energy.work", "J");
  energy.residual = add("energy.residual", "J");
  add_asked(model, all);
  if (!all) add_formulas(model);
  all_.shrink_to_fit();
}

namespace {

/// Names and patterns of columns that a model asks for, by what stands after the last dot.
class Asked {
 public:
  Asked(const Settings& settings, bool all) : all_(all) {
    for (const std::string& pattern : settings.channels) note(pattern);
    for (const StopCondition& stop : settings.stop) note(stop.channel);
    for (const OutputColumn& column : settings.columns) {
      for (const std::string& channel : column.channels) note(channel);
    }
  }
  /// Whether any column of this quantity is asked for, and whether this one is.
  bool any(std::string_view quantity) const { return all_ || by_quantity_.contains(quantity); }
  bool has(const std::string& prefix, std::string_view quantity) const {
    if (all_) return true;
    const auto patterns = by_quantity_.find(quantity);
    if (patterns == by_quantity_.end()) return false;
    const std::string name = prefix + "." + std::string(quantity);
    if (names_.contains(name)) return true;
    return std::ranges::any_of(patterns->second, [&](std::string_view pattern) { return matches(pattern, name); });
  }

 private:
  void note(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos) return;
    std::vector<std::string_view>& patterns = by_quantity_[name.substr(dot + 1)];
    if (is_pattern(name)) {
      patterns.push_back(name);
    } else {
      names_.insert(name);
    }
  }
  bool all_;
  std::unordered_set<std::string_view> names_;
  std::map<std::string_view, std::vector<std::string_view>, std::less<>> by_quantity_;
};

}  // namespace

void Channels::add_asked(const Model& model, bool all) {
  const Asked asked(model.settings, all);
  struct Quantity {
    const char *name, *unit;
    int component;
  };
  constexpr Quantity in_plane[] = {{"ax", "m/s^2", 0}, {"ay", "m/s^2", 1}, {"alpha", "rad/s^2", 5}};
  constexpr Quantity in_space[] = {{"ax", "m/s^2", 0},       {"ay", "m/s^2", 1},       {"az", "m/s^2", 2},
                                   {"alphax", "rad/s^2", 3}, {"alphay", "rad/s^2", 4}, {"alphaz", "rad/s^2", 5}};
  const auto quantities = planar_ ? std::span<const Quantity>(in_plane) : std::span<const Quantity>(in_space);
  const auto add_if = [&](const std::string& prefix, int element, const Quantity& q, std::vector<AskedColumn>& to) {
    if (asked.has(prefix, q.name)) to.push_back({add(prefix + "." + q.name, q.unit), element, q.component});
  };
  const auto accelerations = [&](const std::string& prefix, std::size_t element, std::vector<AskedColumn>& to) {
    for (const Quantity& q : quantities) add_if(prefix, static_cast<int>(element), q, to);
  };
  if (std::ranges::any_of(quantities, [&](const Quantity& q) { return asked.any(q.name); })) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      accelerations("body." + model.bodies[b].name, b, body_accelerations);
    }
    for (std::size_t f = 0; f < model.settings.frames.size(); ++f) {
      const int marker = model.settings.frames[f];
      accelerations("frame." + model.markers[static_cast<std::size_t>(marker)].name, f, frame_accelerations);
    }
  }
  constexpr Quantity work{"work", "J", 0}, loss{"loss", "J", 0};
  for (std::size_t d = 0; asked.any(work.name) && d < model.drivers.size(); ++d) {
    add_if("driver." + model.drivers[d].name, static_cast<int>(d), work, driver_work);
  }
  for (std::size_t i = 0; asked.any(work.name) && i < model.force_elements.size(); ++i) {
    const ForceElement& element = model.force_elements[i];
    const std::string& name = element.joint >= 0 ? model.joints[static_cast<std::size_t>(element.joint)].name
                                                 : model.forces[static_cast<std::size_t>(element.applied)].name;
    add_if("force." + name, static_cast<int>(i), work, force_work);
  }
  for (std::size_t j = 0; asked.any(loss.name) && j < model.joints.size(); ++j) {
    const JointElement& joint = model.joints[j];
    if (joint.layout.forces == 0) continue;
    add_if((joint.is_force ? "force." : "joint.") + joint.name, static_cast<int>(j), loss, joint_loss);
  }
}

/// In the order of the file as columns, and as formulas each after those that it names.
void Channels::add_formulas(const Model& model) {
  const std::vector<OutputColumn>& columns = model.settings.columns;
  if (columns.empty()) return;
  const std::size_t before = all_.size();
  for (const OutputColumn& column : columns) add(column.name, kept_unit(column.unit));
  std::unordered_map<std::string_view, std::size_t> places;
  for (std::size_t i = 0; i < all_.size(); ++i) places.emplace(all_[i].name, i);
  std::vector<char> added(columns.size(), 0);
  const auto add_formula = [&](std::size_t i, const auto& again) -> void {
    if (std::exchange(added[i], 1) != 0) return;
    std::vector<int> named;
    for (const std::string& channel : columns[i].channels) {
      const auto found = places.find(channel);
      const std::size_t place = found == places.end() ? 0 : found->second;
      if (place >= before) again(place - before, again);
      named.push_back(static_cast<int>(place));
    }
    formulas.push_back({static_cast<int>(before + i), columns[i].formula});
    formulas.back().formula.renumber(named);
  };
  for (std::size_t i = 0; i < columns.size(); ++i) add_formula(i, add_formula);
}

void Channels::fill_formulas(std::span<double> row) const {
  for (const FormulaColumn& column : formulas) {
    row[static_cast<std::size_t>(column.column)] = column.formula.value(row[static_cast<std::size_t>(time)], row);
  }
}

int* JointColumns::of(ChannelRole role) {
  switch (role) {
    case ChannelRole::penetration:
      return &penetration;
    case ChannelRole::normal_force:
      return &normal_force;
    case ChannelRole::friction_force:
      return &friction_force;
    case ChannelRole::slip_speed:
      return &slip;
    case ChannelRole::eccentricity_x:
      return &eccentricity_x;
    case ChannelRole::eccentricity_y:
      return &eccentricity_y;
    case ChannelRole::eccentricity_z:
      return &eccentricity_z;
    case ChannelRole::in_contact:
      return &contact;
    case ChannelRole::none:
      break;
  }
  return nullptr;
}

JointColumns Channels::add_joint(const JointElement& joint, const std::string& prefix) {
  JointColumns columns;
  const auto add_coordinate = [&] {
    if (joint.layout.coordinate == Coordinate::none) return;
    const bool angle = joint.layout.coordinate == Coordinate::angle;
    columns.coordinate = add(prefix + (angle ? ".angle" : ".position"), angle ? "rad" : "m");
    if (!joint.is_force) columns.speed = add(prefix + ".speed", angle ? "rad/s" : "m/s");
  };
  if (!joint.is_force) add_coordinate();
  columns.force = add_wrench(prefix);
  if (joint.is_force) {
    columns.power = add(prefix + ".power", "W");
    add_coordinate();
  }
  columns.own = static_cast<int>(all_.size());
  for (std::size_t i = 0; i < joint.layout.channels.size; ++i) {
    const Channel& channel = joint.layout.channels[i];
    const int index = add(prefix + "." + channel.name, channel.unit);
    if (int* column = columns.of(channel_role(joint.layout, i))) *column = index;
  }
  return columns;
}

int Channels::add_wrench(const std::string& prefix) {
  const int first = add(prefix + ".fx", "N");
  add(prefix + ".fy", "N");
  if (planar_) {
    add(prefix + ".torque", "N*m");
    return first;
  }
  add(prefix + ".fz", "N");
  for (const char* moment : {".tx", ".ty", ".tz"}) add(prefix + moment, "N*m");
  return first;
}

void Channels::add_drivers(const Model& model) {
  for (const Driver& driver : model.drivers) {
    const std::string prefix = "driver." + driver.name;
    const bool angle = model.joints[static_cast<std::size_t>(driver.joint)].layout.coordinate == Coordinate::angle;
    const bool effort = !prescribes(driver.kind);
    DriverColumns columns;
    const bool speed = driver.kind == DriverKind::velocity;
    const char* prescribed = speed ? (angle ? "rad/s" : "m/s") : (angle ? "rad" : "m");
    columns.value = add(prefix + ".value", effort ? (angle ? "N*m" : "N") : prescribed);
    columns.effort = add(prefix + (angle ? ".torque" : ".force"), angle ? "N*m" : "N");
    columns.power = add(prefix + ".power", "W");
    drivers.push_back(columns);
    if (driver.kinematics < 0) continue;
    const InverseKinematics& entry = model.kinematics[static_cast<std::size_t>(driver.kinematics)];
    const std::size_t index = static_cast<std::size_t>(driver.kinematics);
    if (&driver != &model.drivers[static_cast<std::size_t>(entry.first_driver + entry.driver_count - 1)]) continue;
    if (paths.size() <= index) paths.resize(index + 1);
    const std::string path = "driver." + entry.name;
    PathColumns& errors = paths[index];
    errors.error_x = add(path + ".ex", "m");
    errors.error_y = add(path + ".ey", "m");
    if (!planar_) errors.error_z = add(path + ".ez", "m");
    errors.error_angle = add(path + ".eangle", "rad");
  }
}

int Channels::add(std::string name, const char* unit) {
  all_.push_back({std::move(name), unit});
  return static_cast<int>(all_.size()) - 1;
}

int Channels::find(std::string_view name) const {
  const auto found = std::ranges::find(all_, name, &ChannelInfo::name);
  return found == all_.end() ? -1 : static_cast<int>(found - all_.begin());
}

}  // namespace freeplay
