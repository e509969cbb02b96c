#include "run/peak_noise.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {

constexpr double first_difference = 0.01;  // of the play
constexpr double growth = 2.0;             // of differences in an impact
constexpr double same_peak = 0.01;         // of the value
constexpr std::size_t agreeing = 5;        // peaks that are the same: three are by chance in every twentieth run
constexpr double widening = 1.5;           // of the scale of the tail
constexpr double unknown = 0.3;            // of the value, where too little was seen
constexpr double same_speed = 1.05;        // an approach this much faster than the separation before is driven

}  // namespace

PeakNoise::PeakNoise(const Model& model, std::size_t values)
    : from_(model.settings.start + model.settings.discard),
      part_length_((model.settings.end - from_) / parts),
      part_end_(from_ + part_length_),
      contacts_(model.joints.size()) {
  for (const JointElement& joint : model.joints) {
    std::vector<EventKind>& kinds = kinds_.emplace_back();
    for (std::size_t i = 0; i < joint.layout.events.size; ++i) {
      const EventRole role = event_role(joint.layout, i);
      kinds.push_back({.begins = role == EventRole::contact_begin,
                       .ends = role == EventRole::contact_end,
                       .speed = field_index(joint.layout.events[i], "speed")});
      active_ = active_ || kinds.back().begins;
    }
  }
  if (active_) peaks_.resize(values);
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
  if (grows) impacts_ = std::max(impacts_, ++contact.growing);
}

void PeakNoise::add(double t, std::span<const double> values) {
  while (t > part_end_ && part_length_ > 0.0 && parts_over_ + 1 < parts) end_part();
  for (std::size_t i = 0; i < values.size(); ++i) {
    Peak& peak = peaks_[i];
    if (!(values[i] > peak.present)) continue;
    peak.present = values[i];
    if (!(values[i] > peak.all)) continue;
    peak.all = values[i];
    peak.impacts = impacts_;
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

double PeakNoise::of(std::size_t value) const {
  if (!active_) return 0.0;
  const Peak& peak = peaks_[value];
  const double grown = std::min(1.0, first_difference * (std::pow(growth, peak.impacts) - 1.0));
  if (!(grown > 0.0)) return 0.0;
  if (parts_over_ < 2) return grown * unknown * peak.all;
  std::array<double, kept + 1> x{};
  std::ranges::copy(peak.largest, x.begin());
  x.back() = peak.present;
  std::ranges::sort(x, std::greater<>());
  if (x[0] - x[agreeing - 1] <= same_peak * x[0]) return grown * (x[0] - x[agreeing - 1]);
  const std::size_t gaps = std::min(kept - 1, parts_over_);
  double scale = 0.0;
  for (std::size_t i = 1; i <= gaps; ++i) scale += static_cast<double>(i) * (x[i - 1] - x[i]);
  if (gaps > 0) scale /= static_cast<double>(gaps);
  return grown * std::max(widening * scale, x[0] - x[1]);
}

}  // namespace freeplay
