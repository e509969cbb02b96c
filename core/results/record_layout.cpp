#include "results/record_layout.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "results/event_sink.h"

namespace freeplay {
namespace {

constexpr struct {
  const char *quantity, *phrase;
} phrases[] = {
    {"x", "position x"},
    {"y", "position y"},
    {"z", "position z"},
    {"angle", "angle"},
    {"position", "position"},
    {"speed", "speed"},
    {"qw", "orientation, scalar part of the quaternion"},
    {"qx", "orientation, x of the quaternion"},
    {"qy", "orientation, y of the quaternion"},
    {"qz", "orientation, z of the quaternion"},
    {"vx", "velocity x"},
    {"vy", "velocity y"},
    {"vz", "velocity z"},
    {"omega", "angular velocity"},
    {"wx", "angular velocity x"},
    {"wy", "angular velocity y"},
    {"wz", "angular velocity z"},
    {"fx", "force x"},
    {"fy", "force y"},
    {"fz", "force z"},
    {"torque", "torque"},
    {"force", "force"},
    {"tx", "torque x"},
    {"ty", "torque y"},
    {"tz", "torque z"},
    {"ex", "eccentricity x"},
    {"ey", "eccentricity y"},
    {"ez", "eccentricity z"},
    {"eangle", "error of the angle"},
    {"delta", "penetration"},
    {"fn", "normal force"},
    {"ft", "friction force"},
    {"vt", "slip speed"},
    {"power", "power"},
    {"contact", "contact, 1 or 0"},
    {"value", "prescribed or applied value"},
    {"kinetic", "kinetic energy"},
    {"potential", "potential energy"},
    {"dissipated", "energy lost to contact, friction and dampers"},
    {"work", "work of drivers and applied forces"},
    {"residual", "what the energy account does not close by"},
};

/// "normal force of joint leg1.B": a name is KIND.NAME.QUANTITY.
std::string long_name(const std::string& name) {
  const std::size_t first = name.find('.'), last = name.rfind('.');
  if (first == std::string::npos) return name;
  const std::string quantity = name.substr(last + 1);
  const auto found = std::ranges::find_if(phrases, [&](const auto& row) { return quantity == row.quantity; });
  const std::string phrase = found != std::end(phrases) ? found->phrase : quantity;
  if (first == last) return phrase + " of the mechanism";
  const std::string kind = name.substr(0, first), element = name.substr(first + 1, last - first - 1);
  return kind == "body" ? fmt::format("{} of the centre of mass of {}", phrase, element)
                        : fmt::format("{} of {} {}", phrase, kind, element);
}

/// Type and formula of a joint, then of each of its laws.
std::string source_of(const JointElement& joint) {
  std::string text = joint.component != nullptr ? joint.component->description.name : "gear";
  if (joint.component != nullptr && *joint.component->description.formula != '\0') {
    text += fmt::format(": {}", joint.component->description.formula);
  }
  if (joint.parameters == nullptr) return text;
  for (const auto& [key, value] : joint.parameters->values) {
    if (value.law == nullptr || value.law->component == nullptr) continue;
    const Description& law = value.law->component->description;
    text += fmt::format("; {} {}", key, law.name);
    if (*law.formula != '\0') text += fmt::format(": {}", law.formula);
  }
  return text;
}

/// Of each channel. Columns of one element are neighbours; its source is that of all of them.
std::vector<std::string> sources_of(const Model& model, const Channels& channels) {
  std::vector<std::string> sources(channels.all().size(), "equations of motion");
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::string_view name = channels.all()[i].name;
    if (name.starts_with("driver.")) sources[i] = "driver, equations of motion";
    if (name.starts_with("force.")) sources[i] = "applied force";
    if (name.starts_with("energy.")) sources[i] = "energy account";
    if (name == "time") sources[i] = "output grid and end of the run";
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointElement& joint = model.joints[j];
    const std::string prefix = fmt::format("{}.{}.", joint.is_force ? "force" : "joint", joint.name);
    const JointColumns& columns = channels.joints[j];
    const int first = columns.coordinate >= 0 ? std::min(columns.coordinate, columns.force) : columns.force;
    const std::string source = source_of(joint);
    for (std::size_t i = static_cast<std::size_t>(std::max(first, 0));
         i < sources.size() && channels.all()[i].name.starts_with(prefix); ++i) {
      sources[i] = source;
    }
  }
  return sources;
}

}  // namespace

RecordLayout record_layout(const Model& model, const Channels& channels, std::span<const std::size_t> picked,
                           bool described) {
  RecordLayout layout;
  layout.columns.reserve(picked.size());
  for (const std::size_t index : picked) {
    const ChannelInfo& channel = channels.all()[index];
    layout.columns.push_back({channel.name, std::string(channel.unit), "", ""});
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointElement& joint = model.joints[j];
    if (joint.has_play || channels.joints[j].normal_force >= 0) layout.bearings.push_back(joint.name);
  }
  add_event_columns(model, layout);
  if (!described) return layout;
  const std::vector<std::string> sources = sources_of(model, channels);
  for (std::size_t c = 0; c < picked.size(); ++c) {
    layout.columns[c].long_name = long_name(layout.columns[c].name);
    layout.columns[c].source = sources[picked[c]];
  }
  return layout;
}

}  // namespace freeplay
