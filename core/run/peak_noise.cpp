#include "run/peak_noise.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "component/joint_roles.h"
#include "run/body_groups.h"

namespace freeplay {
namespace {

constexpr double first_difference = 0.005;  // of the play
constexpr double growth = 2.7;              // of differences in an impact
constexpr double same_peak = 0.01;          // of the value
constexpr double never_by_chance = 1e-4;    // of the value, to which peaks agree
constexpr std::size_t agreeing = 5;         // peaks that are the same: three are by chance in every twentieth run
constexpr std::size_t gaps = 5;             // between bursts, that give the scale of the tail
constexpr double widening = 3.0;            // of that scale
constexpr std::size_t gaps_of_parts = 8;    // between parts,
constexpr double widening_of_parts = 5.0;   // and of their scale
constexpr double unknown = 0.5;             // of the value, where one burst alone was seen
constexpr double chaotic = 0.3;             // of what chance can do: from there on bursts are draws
constexpr int steps_at_rest = 50;           // for which a contact is on before it rests
constexpr double same_speed = 1.05;         // an approach this much faster than the separation before is driven

/// What impacts make of a small difference, of all that chance can do.
double grown_by(int impacts) { return std::min(1.0, first_difference * (std::pow(growth, impacts) - 1.0)); }

/// Of values: the largest, by how much it is above the next, and the scale of an exponential tail.
struct Tail {
  double largest, first = 0.0, scale = 0.0;
};
Tail tail(std::span<double> values, std::size_t most_gaps) {
  std::ranges::sort(values, std::greater<>());
  Tail out{values[0]};
  const std::size_t used = std::min(most_gaps, values.size() - 1);
  for (std::size_t i = 1; i <= used; ++i) out.scale += static_cast<double>(i) * (values[i - 1] - values[i]);
  if (used > 0) out.first = values[0] - values[1], out.scale /= static_cast<double>(used);
  return out;
}

/// The group that each value hangs on; of_nothing for loads that the model gives.
std::vector<int> groups_of_values(const Model& model, const PeakValues& places, const BodyGroups& groups) {
  std::vector<int> of(places.size(), BodyGroups::of_nothing);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) of[places.speed(b)] = groups.of_body(b);
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    for (const std::size_t place :
         {places.force(j), places.torque(j), places.normal_force(j), places.penetration(j), places.eccentricity(j)}) {
      of[place] = groups.of_joint(j);
    }
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const Driver& driver = model.drivers[at(d)];
    if (prescribes(driver.kind)) of[places.effort(d)] = groups.of_joint(driver.joint);
  }
  for (int p = 0; p < static_cast<int>(model.kinematics.size()); ++p) {
    of[places.position_error(p)] = of[places.angle_error(p)] = groups.of_marker(model.kinematics[at(p)].marker);
  }
  for (int f = 0; f < static_cast<int>(model.force_elements.size()); ++f) {
    const int joint = model.force_elements[at(f)].joint;
    if (joint >= 0) of[places.applied_force(f)] = of[places.applied_torque(f)] = groups.of_joint(joint);
  }
  return of;
}

}  // namespace

PeakNoise::PeakNoise(const Model& model, const PeakValues& places)
    : accuracy_(model.settings.adaptive ? model.settings.accuracy : 0.0),
      from_(model.settings.start + model.settings.discard),
      part_length_((model.settings.end - from_) / parts),
      part_end_(from_ + part_length_),
      impacts_(model.bodies.size()),
      grown_(model.bodies.size()),
      contacts_(model.joints.size()) {
  for (const JointElement& joint : model.joints) {
    forces_.push_back(places.force(static_cast<int>(kinds_.size())));
    std::vector<EventKind>& kinds = kinds_.emplace_back();
    for (std::size_t i = 0; i < joint.layout.events.size; ++i) {
      const EventRole role = event_role(joint.layout, i);
      kinds.push_back({.begins = role == EventRole::contact_begin,
                       .ends = role == EventRole::contact_end,
                       .speed = field_index(joint.layout.events[i], "speed")});
      active_ = active_ || kinds.back().begins;
    }
  }
  groups_ = groups_of_values(model, places, BodyGroups(model));
  values_.resize(places.size());
  if (!active_ || accuracy_ == 0.0) return;
  ringing_.resize(places.size());
  rests_.resize(model.bodies.size());
  for (int j = 0; j < static_cast<int>(kinds_.size()); ++j) {
    const std::size_t depth = places.penetration(j);
    if (std::ranges::any_of(kinds_[at(j)], &EventKind::begins) && groups_[depth] >= 0) shallow_.push_back({depth});
  }
}

void PeakNoise::event(int joint, int event, std::span<const double> fields) {
  const EventKind& kind = kinds_[at(joint)][at(event)];
  if (!kind.begins && !kind.ends) return;
  const double given = kind.speed >= 0 ? fields[at(kind.speed)] : 0.0, speed = std::isnan(given) ? 0.0 : given;
  Contact& contact = contacts_[at(joint)];
  if (kind.ends) {
    contact.separation = speed;
    return;
  }
  // The first contact only says where the motion begins; an end without a speed counts as one at rest.
  const bool grows = contact.separation >= 0.0 && speed >= same_speed * contact.separation;
  contact.separation = 0.0;
  if (!grows) return;
  const int group = groups_[forces_[at(joint)]];
  ++contact.growing;
  if (group < 0 || contact.growing <= impacts_[at(group)]) return;
  impacts_[at(group)] = contact.growing;
  grown_[at(group)] = grown_by(contact.growing);
}

void PeakNoise::add(double t, std::span<const double> values) {
  while (t > part_end_ && part_length_ > 0.0 && parts_over_ + 1 < parts) {
    part_end_ = from_ + static_cast<double>(++parts_over_ + 1) * part_length_;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    Part& part = values_[i].part[parts_over_];
    if (!(values[i] > part.largest)) continue;
    part.largest = values[i];
    if (groups_[i] >= 0) part.grown = grown_[at(groups_[i])];
  }
  if (!shallow_.empty()) follow_ringing(values);
}

void PeakNoise::follow_ringing(std::span<const double> values) {
  int longest = 0;
  for (ShallowContact& contact : shallow_) {
    if (contact.steps < 0) continue;
    const double depth = values[contact.depth];
    if (depth >= accuracy_) {
      // Where one contact goes deeper the others' forces are little of all that there is.
      for (ShallowContact& other : shallow_) {
        if (groups_[other.depth] == groups_[contact.depth]) other.steps = -1;
      }
      continue;
    }
    contact.steps = depth > 0.0 ? std::min(contact.steps + 1, steps_at_rest + 1) : 0;
    longest = std::max(longest, contact.steps);
  }
  if (longest < steps_at_rest) return;
  std::ranges::fill(rests_, 0);
  for (const ShallowContact& contact : shallow_) {
    int& rests = rests_[at(groups_[contact.depth])];
    rests = std::max(rests, contact.steps);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int rests = groups_[i] >= 0 ? rests_[at(groups_[i])] : 0;
    if (rests > steps_at_rest) {
      ringing_[i].see(values[i]);
    } else if (rests == steps_at_rest) {
      ringing_[i].restart(values[i]);
    }
  }
}

int PeakNoise::growing_impacts() const { return impacts_.empty() ? 0 : *std::ranges::max_element(impacts_); }

double PeakNoise::apart(std::size_t value) const {
  std::array<double, parts> x{};
  std::ranges::transform(seen(value), x.begin(), &Part::largest);
  std::ranges::nth_element(x, x.begin() + (agreeing - 1), std::greater<>());
  return *std::max_element(x.begin(), x.begin() + agreeing) - x[agreeing - 1];
}

bool PeakNoise::repeats(int group) const {
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    if (groups_[forces_[j]] != group || !std::ranges::any_of(kinds_[j], &EventKind::begins)) continue;
    if (apart(forces_[j]) > same_peak * largest_seen(forces_[j])) return false;
  }
  return true;
}

double PeakNoise::grown(std::size_t value) const { return groups_[value] >= 0 ? grown_[at(groups_[value])] : 0.0; }

PeakNoise::Bursts PeakNoise::bursts(std::span<const Part> seen, const std::function<bool(const Part&)>& chosen) {
  std::array<double, parts> of_bursts{}, of_parts{};
  std::size_t count = 0, all = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (!chosen(seen[k])) continue;
    const double here = of_parts[all++] = seen[k].largest;
    if ((k > 0 && here <= seen[k - 1].largest) || (k + 1 < seen.size() && here < seen[k + 1].largest)) continue;
    of_bursts[count++] = here;
  }
  if (count == 0) return {};
  const Tail blows = tail({of_bursts.data(), count}, gaps), even = tail({of_parts.data(), all}, gaps_of_parts);
  const double by_bursts = count > 1 ? std::max(widening * blows.scale, blows.first) : unknown * blows.largest;
  // What swells and falls without blows differs little from part to part.
  const double most = all > 1 ? std::max(widening_of_parts * even.scale, even.first) : by_bursts;
  return {blows.largest, std::min(by_bursts, most)};
}

double PeakNoise::of(std::size_t value) const {
  if (groups_[value] < 0) return 0.0;
  return std::max(by_chance(value), std::min(by_ringing(value), largest_seen(value)));
}

double PeakNoise::largest_seen(std::size_t value) const {
  return std::ranges::max(seen(value), {}, &Part::largest).largest;
}

double PeakNoise::by_ringing(std::size_t value) const {
  const auto deep = [&](const ShallowContact& contact) {
    return groups_[contact.depth] == groups_[value] && contact.steps < 0;
  };
  return ringing_.empty() || std::ranges::any_of(shallow_, deep) ? 0.0 : ringing_[value].largest();
}

double PeakNoise::by_chance(std::size_t value) const {
  const Part peak = std::ranges::max(seen(value), {}, &Part::largest);
  const double most = peak.largest, grown = peak.grown;
  const Bursts later =
      bursts(seen(value), [&](const Part& part) { return part.grown > grown && part.grown > chaotic; });
  // A peak of chance itself is one of the draws.
  const double past = grown < 1.0 ? later.largest + later.beyond - most : 0.0;
  if (!(grown > 0.0)) return std::clamp(past, 0.0, most);
  const double same = apart(value);
  const bool again = parts_over_ >= agreeing &&
                     (same <= never_by_chance * most || (same <= same_peak * most && repeats(groups_[value])));
  const double own = again ? same_peak * most : bursts(seen(value), [](const Part&) { return true; }).beyond;
  return std::min(std::max(grown * own, past), most);
}

}  // namespace freeplay
