#include "run/peak_noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {

constexpr double first_difference = 0.01;  // of the play
constexpr double growth = 2.0;             // of differences in an impact
constexpr double same_peak = 0.01;         // of the value
constexpr double never_by_chance = 1e-4;   // of the value, to which peaks agree
constexpr std::size_t agreeing = 5;        // peaks that are the same: three are by chance in every twentieth run
constexpr double widening = 1.5;           // of the scale of the tail
constexpr double unknown = 0.3;            // of the value, where too little was seen
constexpr double same_speed = 1.05;        // an approach this much faster than the separation before is driven

/// What impacts make of a small difference, of all that chance can do.
double grown_by(int impacts) { return std::min(1.0, first_difference * (std::pow(growth, impacts) - 1.0)); }

/// Bodies that joints, gears and springs hold together, as groups: a number each, from 0 on.
class Groups {
 public:
  explicit Groups(const Model& model) : model_(model), of_(model.bodies.size()) {
    std::iota(of_.begin(), of_.end(), 0);
    for (const JointElement& joint : model.joints) {
      if (joint.gear < 0) unite(body(joint.marker_a), body(joint.marker_b));
    }
    for (const Gear& gear : model.gears) unite(moved(gear.first), moved(gear.second));
  }
  int of_body(BodyId body) const { return body == ground ? of_nothing : of_[at(body)]; }
  int of_marker(int marker) const { return of_body(body(marker)); }
  int of_joint(int joint) const { return of_body(moved(joint)); }

  static constexpr int of_nothing = -1;

 private:
  BodyId body(int marker) const { return model_.markers[at(marker)].body; }
  BodyId moved(int joint) const {
    const JointElement& element = model_.joints[at(joint)];
    if (element.gear >= 0) return moved(model_.gears[at(element.gear)].first);
    return body(element.marker_b) == ground ? body(element.marker_a) : body(element.marker_b);
  }
  void unite(BodyId a, BodyId b) {
    if (a == ground || b == ground) return;
    std::ranges::replace(of_, int{of_[at(b)]}, int{of_[at(a)]});
  }

  const Model& model_;
  std::vector<int> of_;
};

/// The group that each value hangs on; of_nothing for loads that the model gives.
std::vector<int> groups_of_values(const Model& model, const PeakValues& places, const Groups& groups) {
  std::vector<int> of(places.size(), Groups::of_nothing);
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
    : from_(model.settings.start + model.settings.discard),
      part_length_((model.settings.end - from_) / parts),
      part_end_(from_ + part_length_),
      impacts_(model.bodies.size()),
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
  if (!active_) return;
  groups_ = groups_of_values(model, places, Groups(model));
  peaks_.resize(places.size());
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
  if (group >= 0) impacts_[at(group)] = std::max(impacts_[at(group)], contact.growing);
}

void PeakNoise::add(double t, std::span<const double> values) {
  while (t > part_end_ && part_length_ > 0.0 && parts_over_ + 1 < parts) end_part();
  for (std::size_t i = 0; i < values.size(); ++i) {
    Peak& peak = peaks_[i];
    if (!(values[i] > peak.present)) continue;
    peak.present = values[i];
    if (!(values[i] > peak.all)) continue;
    peak.all = values[i];
    if (groups_[i] >= 0) peak.impacts = impacts_[at(groups_[i])];
  }
}

void PeakNoise::end_part() {
  part_end_ = from_ + static_cast<double>(++parts_over_ + 1) * part_length_;
  for (Peak& peak : peaks_) {
    const auto place = std::ranges::find_if(peak.largest, [&](double value) { return value < peak.present; });
    if (place != peak.largest.end()) {
      std::shift_right(place, peak.largest.end(), 1);
      *place = peak.present;
    }
    peak.present = 0.0;
  }
}

int PeakNoise::growing_impacts() const { return impacts_.empty() ? 0 : *std::ranges::max_element(impacts_); }

std::array<double, PeakNoise::kept + 1> PeakNoise::in_order(const Peak& peak) const {
  std::array<double, kept + 1> x{};
  std::ranges::copy(peak.largest, x.begin());
  x.back() = peak.present;
  std::ranges::sort(x, std::greater<>());
  return x;
}

bool PeakNoise::repeats(int group) const {
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    if (groups_[forces_[j]] != group || !std::ranges::any_of(kinds_[j], &EventKind::begins)) continue;
    const auto x = in_order(peaks_[forces_[j]]);
    if (x[0] - x[agreeing - 1] > same_peak * x[0]) return false;
  }
  return true;
}

double PeakNoise::grown(std::size_t value) const {
  return active_ && groups_[value] >= 0 ? grown_by(impacts_[at(groups_[value])]) : 0.0;
}

double PeakNoise::of(std::size_t value) const {
  if (!active_) return 0.0;
  const Peak& peak = peaks_[value];
  const double grown = grown_by(peak.impacts);
  if (!(grown > 0.0)) return 0.0;
  if (parts_over_ < 2) return grown * unknown * peak.all;
  const auto x = in_order(peak);
  const double apart = x[0] - x[agreeing - 1];
  if (apart <= never_by_chance * x[0] || (apart <= same_peak * x[0] && repeats(groups_[value]))) {
    return grown * same_peak * x[0];
  }
  const std::size_t gaps = std::min(kept - 1, parts_over_);
  double scale = 0.0;
  for (std::size_t i = 1; i <= gaps; ++i) scale += static_cast<double>(i) * (x[i - 1] - x[i]);
  if (gaps > 0) scale /= static_cast<double>(gaps);
  return grown * std::max(widening * scale, x[0] - x[1]);
}

}  // namespace freeplay
