#include "format/motion_names.h"

#include <algorithm>
#include <array>
#include <span>

namespace freeplay {
namespace {

using Of = MotionChannel::Of;

struct MarkerQuantity {
  const char* name;
  Of of;
  int component;
  bool plane, space;
};
constexpr MarkerQuantity marker_quantities[] = {
    {"x", Of::position, 0, true, true},           {"y", Of::position, 1, true, true},
    {"z", Of::position, 2, false, true},          {"angle", Of::angle, 2, true, false},
    {"vx", Of::velocity, 0, true, true},          {"vy", Of::velocity, 1, true, true},
    {"vz", Of::velocity, 2, false, true},         {"omega", Of::angular_velocity, 2, true, false},
    {"wx", Of::angular_velocity, 0, false, true}, {"wy", Of::angular_velocity, 1, false, true},
    {"wz", Of::angular_velocity, 2, false, true}};

constexpr std::array accelerations_in_plane{"ax", "ay", "alpha"};
constexpr std::array accelerations_in_space{"ax", "ay", "az", "alphax", "alphay", "alphaz"};
constexpr std::array loads{"fx", "fy", "fz", "torque", "tx", "ty", "tz", "power", "work", "loss"};
constexpr std::array energies{"kinetic", "potential", "dissipated", "work", "residual"};

bool holds(std::span<const char* const> words, std::string_view word) {
  return std::ranges::any_of(words, [&](std::string_view own) { return own == word; });
}

/// Of a quantity that forces make.
bool is_unit_of_load(std::string_view unit) { return unit == "N" || unit == "N*m" || unit == "W" || unit == "J"; }

Dimension dimension_of(const MotionChannel& channel, bool turns) {
  switch (channel.of) {
    case Of::position:
      return dimension::length;
    case Of::angle:
      return dimension::angle;
    case Of::velocity:
      return dimension::velocity;
    case Of::angular_velocity:
      return dimension::angular_velocity;
    case Of::coordinate:
      return turns ? dimension::angle : dimension::length;
    case Of::speed:
      break;
  }
  return turns ? dimension::angular_velocity : dimension::velocity;
}

}  // namespace

std::optional<MotionNames::Name> MotionNames::split(std::string_view name) {
  const std::size_t first = name.find('.'), last = name.rfind('.');
  if (first == std::string_view::npos || first == last) return std::nullopt;
  return Name{std::string(name.substr(0, first)), std::string(name.substr(first + 1, last - first - 1)),
              std::string(name.substr(last + 1))};
}

std::optional<FormulaVariable> MotionNames::find(std::string_view name) const {
  const std::optional<Name> parts = split(name);
  if (!parts) return std::nullopt;
  std::string full;
  const std::optional<MotionChannel> found = channel(*parts, full);
  if (!found) {
    excused_ = excused_ || draft_.excused(parts->element);
    return std::nullopt;
  }
  const std::pair written(std::string(name), parts->kind + "." + full + "." + parts->quantity);
  if (std::ranges::find(found_, written) == found_.end()) found_.push_back(written);
  auto place = std::ranges::find(channels_, *found);
  if (place == channels_.end()) place = channels_.insert(place, *found);
  const bool turns =
      found->is_of_joint() &&
      draft_.model.joints[static_cast<std::size_t>(found->element)].layout.coordinate == Coordinate::angle;
  return FormulaVariable{static_cast<int>(place - channels_.begin()), DimensionKind::dimensioned,
                         dimension_of(*found, turns)};
}

std::optional<MotionChannel> MotionNames::channel(const Name& name, std::string& full) const {
  if (name.kind == "body") {
    const std::optional<BodyId> body = draft_.find_body(name.element, part_);
    if (!body || *body == ground) return std::nullopt;
    full = draft_.body_name(*body);
    return of_marker(full + "/com", name.quantity);
  }
  if (name.kind == "frame") {
    const std::optional<std::string> found = frame(name.element);
    if (!found) return std::nullopt;
    full = *found;
    return of_marker(full, name.quantity);
  }
  const std::optional<int> joint = name.kind == "joint" ? draft_.find_joint(name.element, part_) : std::nullopt;
  if (!joint) return std::nullopt;
  full = draft_.joints.names()[static_cast<std::size_t>(*joint)];
  return of_joint(*joint, name.quantity);
}

std::optional<MotionChannel> MotionNames::of_marker(const std::string& marker, const std::string& quantity) const {
  const bool plane = draft_.model.space == Space::planar;
  for (const MarkerQuantity& known : marker_quantities) {
    if (quantity == known.name && (plane ? known.plane : known.space)) {
      return MotionChannel{known.of, draft_.marker(marker), known.component};
    }
  }
  return std::nullopt;
}

std::optional<MotionChannel> MotionNames::of_joint(int joint, const std::string& quantity) const {
  if (!draft_.joint_usable[static_cast<std::size_t>(joint)]) {
    excused_ = true;
    return std::nullopt;
  }
  const JointElement& element = draft_.model.joints[static_cast<std::size_t>(joint)];
  const Coordinate coordinate = element.layout.coordinate;
  if (coordinate == Coordinate::none || element.gear >= 0) return std::nullopt;
  if (quantity == (coordinate == Coordinate::angle ? "angle" : "position")) return MotionChannel{Of::coordinate, joint};
  if (quantity == "speed") return MotionChannel{Of::speed, joint};
  return std::nullopt;
}

/// BODY/FRAME in full; the body may be left out where one frame alone has the name.
std::optional<std::string> MotionNames::frame(const std::string& reference) const {
  const std::size_t slash = reference.find('/');
  if (slash == std::string::npos) {
    const std::string* only = draft_.lone_frame(part_.full(reference));
    if (only == nullptr) only = draft_.lone_frame(reference);
    if (only != nullptr) return *only;
    const std::optional<BodyId> body = draft_.find_body(reference, part_);
    return body ? std::optional(draft_.body_name(*body) + "/origin") : std::nullopt;
  }
  const std::optional<BodyId> body = draft_.find_body(reference.substr(0, slash), part_);
  if (!body) return std::nullopt;
  const std::string stem = draft_.body_name(*body) + "/", own = reference.substr(slash + 1);
  for (const std::string& name : {stem + part_.full(own), stem + own}) {
    if (draft_.frames.contains(name)) return name;
  }
  return std::nullopt;
}

std::optional<MotionNames::Refusal> MotionNames::refusal(std::string_view written) const {
  const std::string words(written);
  const std::size_t first = words.find('.');
  const bool of_output = words.starts_with("output."), of_energy = words.starts_with("energy.");
  const bool plain_result = of_output || (of_energy && holds(energies, std::string_view(words).substr(first + 1)));
  const std::optional<Name> name = split(written);
  if (name && is_acceleration(*name)) {
    return Refusal{"algebraic-loop",
                   "'" + words +
                       "' is an acceleration: a force that depends on the acceleration it makes is defined "
                       "by itself",
                   "write it by positions and speeds; what resists an acceleration in proportion is mass: add it to "
                   "a body"};
  }
  if (name && follows_from_forces(*name)) {
    return Refusal{"algebraic-loop",
                   "'" + words + "' follows from the forces: one that depends on it is defined by itself",
                   "write by positions and speeds what it is made of"};
  }
  if (!plain_result && !(name && is_result(*name))) return std::nullopt;
  return Refusal{"state-not-allowed", "'" + words + "' is a result, on which no force can depend", known()};
}

bool MotionNames::is_acceleration(const Name& name) const {
  const bool plane = draft_.model.space == Space::planar;
  const auto quantities = plane ? std::span<const char* const>(accelerations_in_plane) : accelerations_in_space;
  if (!holds(quantities, name.quantity)) return false;
  const std::optional<BodyId> body = name.kind == "body" ? draft_.find_body(name.element, part_) : std::nullopt;
  return (body && *body != ground) || (name.kind == "frame" && frame(name.element));
}

/// Elements that are not read yet are believed.
bool MotionNames::follows_from_forces(const Name& name) const {
  if (name.kind == "force") return holds(loads, name.quantity);
  if (name.kind == "driver") return holds(loads, name.quantity) || name.quantity == "force";
  const std::optional<int> joint = name.kind == "joint" ? draft_.find_joint(name.element, part_) : std::nullopt;
  if (!joint) return false;
  if (holds(loads, name.quantity)) return true;
  const Span<const Channel> channels = draft_.model.joints[static_cast<std::size_t>(*joint)].layout.channels;
  return std::any_of(channels.begin(), channels.end(), [&](const Channel& channel) {
    return name.quantity == channel.name && is_unit_of_load(channel.unit);
  });
}

bool MotionNames::is_result(const Name& name) const {
  if (name.kind == "force" || name.kind == "driver") return true;
  const std::optional<int> joint = name.kind == "joint" ? draft_.find_joint(name.element, part_) : std::nullopt;
  if (!joint) return false;
  const Span<const Channel> channels = draft_.model.joints[static_cast<std::size_t>(*joint)].layout.channels;
  return std::any_of(channels.begin(), channels.end(),
                     [&](const Channel& channel) { return name.quantity == channel.name; });
}

std::vector<std::string> MotionNames::quantities(const Name& name) const {
  std::vector<std::string> all;
  if (name.kind == "joint") {
    for (const char* quantity : {"angle", "position", "speed"}) all.emplace_back(quantity);
    return all;
  }
  const bool plane = draft_.model.space == Space::planar;
  for (const MarkerQuantity& known : marker_quantities) {
    if (plane ? known.plane : known.space) all.emplace_back(known.name);
  }
  return all;
}

std::string MotionNames::nearest(std::string_view name) const {
  std::optional<Name> parts = split(name);
  if (!parts) return {};
  const std::vector<std::string> kinds{"body", "joint", "frame"};
  if (const std::string kind = freeplay::nearest(parts->kind, kinds); !kind.empty()) parts->kind = kind;
  std::vector<std::string> candidates;
  const auto add = [&](const std::string& kind, const std::string& element) {
    for (const std::string& quantity : quantities({kind, element, {}})) {
      if (candidates.size() > most_candidates) return;
      std::string full;
      if (channel({kind, element, quantity}, full)) candidates.push_back(kind + "." + element + "." + quantity);
    }
  };
  const auto add_all = [&](const std::string& kind, const std::vector<std::string>& elements) {
    for (const std::string& element : elements) {
      if (!part_.prefix.empty() && element.starts_with(part_.prefix)) add(kind, element.substr(part_.prefix.size()));
      add(kind, element);
    }
  };
  const bool short_frame = parts->kind == "frame" && parts->element.find('/') == std::string::npos;
  if (parts->kind != "joint" && parts->kind != "frame") add_all("body", draft_.bodies.names());
  if (parts->kind != "body" && parts->kind != "frame") add_all("joint", draft_.joints.names());
  if (parts->kind == "frame") {
    const std::vector<std::string> frames = frames_in_order();
    if (short_frame) {
      add_all("frame", draft_.bodies.names());
      for (const std::string& frame : frames) add("frame", frame.substr(frame.find('/') + 1));
    }
    add_all("frame", frames);
  }
  if (short_frame && !frame(parts->element)) {
    if (std::string first = first_frame(*parts); !first.empty()) return first;
  }
  return freeplay::nearest(parts->kind + "." + parts->element + "." + parts->quantity, candidates);
}

std::vector<std::string> MotionNames::frames_in_order() const {
  std::vector<std::string> frames;
  for (const auto& [frame, unused] : draft_.frames) frames.push_back(frame);
  std::ranges::sort(frames);
  return frames;
}

/// A frame is meant that several bodies have: that of the first.
std::string MotionNames::first_frame(const Name& name) const {
  std::string quantity = freeplay::nearest(name.quantity, quantities(name));
  if (quantity.empty()) quantity = "x";
  for (const std::string& frame : frames_in_order()) {
    if (frame.ends_with("/" + name.element)) return "frame." + frame + "." + quantity;
  }
  return {};
}

}  // namespace freeplay
