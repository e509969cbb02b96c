// The rule of roles: channels mean what the joint declares of them.
#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "component/joint_roles.h"
#include "contract/joint_contract.h"
#include "contract/joint_words.h"

namespace freeplay {
namespace {

struct RoleWords {
  const char *name, *unit;
};
RoleWords words_of_role(ChannelRole role) {
  constexpr RoleWords words[] = {{"no role", ""},         {"penetration", "m"},    {"normal_force", "N"},
                                 {"friction_force", "N"}, {"slip_speed", "m/s"},   {"eccentricity_x", "m"},
                                 {"eccentricity_y", "m"}, {"eccentricity_z", "m"}, {"in_contact", "1"}};
  return words[static_cast<std::size_t>(role)];
}

/// Whether a channel of this role may have this value there.
bool may_be(ChannelRole role, double value, const JointMoment& moment) {
  if (role == ChannelRole::normal_force) return value >= 0.0;
  if (role == ChannelRole::in_contact) return value == 0.0 || value == 1.0;
  const bool eccentricity = role >= ChannelRole::eccentricity_x && role <= ChannelRole::eccentricity_z;
  if (!eccentricity) return true;
  const auto axis = static_cast<std::size_t>(role) - static_cast<std::size_t>(ChannelRole::eccentricity_x);
  const double a = moment.markers.a.position[axis], b = moment.markers.b.position[axis];
  return std::abs(value - (b - a)) <= 1e-12 * (std::abs(a) + std::abs(b));
}

}  // namespace

void check_roles(const JointProbe& probe, const std::vector<JointMoment>& moments, Findings& findings) {
  const JointLayout& layout = probe.layout();
  if (!layout.event_roles.empty()) {
    const auto begins = std::ranges::count(layout.event_roles, EventRole::contact_begin),
               ends = std::ranges::count(layout.event_roles, EventRole::contact_end);
    findings.expect("roles", begins == ends,
                    [&] { return fmt::format("{} events begin a contact and {} end one", begins, ends); });
  }
  if (layout.channel_roles.empty()) return;
  for (std::size_t i = 0; i < layout.channels.size; ++i) {
    const RoleWords role = words_of_role(layout.channel_roles[i]);
    findings.expect("roles", *role.unit == '\0' || std::string_view(role.unit) == layout.channels[i].unit, [&] {
      return fmt::format("'{}' has the role {}, which is in {}, and the unit {}", layout.channels[i].name, role.name,
                         role.unit, layout.channels[i].unit);
    });
  }
  for (const JointMoment& moment : moments) {
    const std::vector<double> values = probe.observe(moment);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const ChannelRole role = layout.channel_roles[i];
      findings.expect("roles", may_be(role, values[i], moment), [&] {
        return fmt::format("'{}' has the role {} and is {:.6g} {}", layout.channels[i].name, words_of_role(role).name,
                           values[i], words_of(moment));
      });
    }
  }
}

}  // namespace freeplay
