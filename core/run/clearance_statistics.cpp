#include "run/clearance_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"
#include "base/index.h"

namespace freeplay {
namespace {
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
}  // namespace

double BearingTable::angle(std::size_t sector) {
  return (static_cast<double>(sector) + 0.5) * (whole_turn / static_cast<double>(sectors));
}

ClearanceStatistics::ClearanceStatistics(const Model& model, const Joints& joints, const Channels& channels)
    : channels_(channels),
      from_(model.settings.start + model.settings.discard),
      index_(model.joints.size(), -1),
      sum_noise_(from_, from_, 0) {
  for (int j = 0; j < static_cast<int>(index_.size()); ++j) {
    const JointColumns& columns = channels.joints[at(j)];
    if (columns.normal_force < 0) continue;
    const JointLayout& layout = joints.layout(j);
    // In space a bearing has an axis, about which the joint turns. A socket has none: its angle is that about z of its
    // own axes, and its load may rise from their plane.
    const bool planar = model.space == Space::planar;
    const bool is_bearing =
        columns.eccentricity_x >= 0 && columns.eccentricity_y >= 0 && (planar || columns.eccentricity_z >= 0);
    index_[at(j)] = static_cast<int>(joints_.size());
    OfJoint& joint = joints_.emplace_back();
    joint.joint = j;
    joint.marker = model.joints[at(j)].marker_a;
    joint.is_bearing = is_bearing;
    joint.is_socket = is_bearing && !planar && layout.coordinate != Coordinate::angle;
    joint.area = 2.0 * (layout.smaller_radius + layout.clearance) * layout.contact_length;
  }
  sum_noise_ = MeanNoise(from_, model.settings.end, 2 * joints_.size());
}

ClearanceStatistics::Rates ClearanceStatistics::rates(const OfJoint& joint, std::span<const double> row,
                                                      const Evaluation& e) const {
  const JointColumns& columns = channels_.joints[at(joint.joint)];
  const auto value = [&](int column) { return column < 0 ? 0.0 : row[at(column)]; };
  Rates out;
  out.normal = value(columns.normal_force);
  out.contact = columns.contact < 0 ? (out.normal != 0.0 ? 1.0 : 0.0) : value(columns.contact);
  if (out.contact == 0.0 && out.normal == 0.0) return out;
  const double slip = std::abs(value(columns.slip));
  out.slip = slip * out.contact;
  out.rub = out.normal * slip;
  if (!joint.is_bearing) return out;
  const double* axes = e.markers[at(joint.marker)].rotation;
  const double ex = value(columns.eccentricity_x), ey = value(columns.eccentricity_y),
               ez = value(columns.eccentricity_z);
  const double x = axes[0] * ex + axes[3] * ey + axes[6] * ez, y = axes[1] * ex + axes[4] * ey + axes[7] * ez,
               z = axes[2] * ex + axes[5] * ey + axes[8] * ez;
  const double angle = std::atan2(y, x), turned = angle < 0.0 ? angle + whole_turn : angle;
  const double sectors = static_cast<double>(BearingTable::sectors);
  out.sector = std::min(static_cast<int>(turned / whole_turn * sectors), static_cast<int>(BearingTable::sectors) - 1);
  const double length = std::sqrt(x * x + y * y);
  out.cosine = length > 0.0 ? x / length : 1.0;
  out.sine = length > 0.0 ? y / length : 0.0;
  if (const double distance = std::hypot(length, z); joint.is_socket && distance > 0.0) {
    out.flat = length / distance;
    out.rise = z / distance;
  }
  return out;
}

void ClearanceStatistics::add_half(OfJoint& joint, const Rates& rates, double half) {
  joint.contact_time += half * rates.contact;
  if (rates.contact == 0.0 && rates.normal == 0.0) return;
  joint.impulse += half * rates.normal;
  joint.sliding += half * rates.slip;
  joint.work += half * rates.rub;
  if (rates.sector < 0) return;
  joint.load_x += half * rates.normal * rates.cosine;
  joint.load_y += half * rates.normal * rates.sine;
  joint.across_x += half * rates.normal * rates.flat * rates.cosine;
  joint.across_y += half * rates.normal * rates.flat * rates.sine;
  joint.along_z += half * rates.normal * rates.rise;
  const std::size_t k = at(rates.sector);
  joint.table.contact_time[k] += half * rates.contact;
  joint.table.impulse[k] += half * rates.normal;
  joint.table.sliding[k] += half * rates.slip;
  joint.table.work[k] += half * rates.rub;
}

// What was lost before the first instant, less what contacts lost that had ended: the rest is of those that were on.
void ClearanceStatistics::add(std::span<const double> row, const Evaluation& e, std::span<const double> joint_loss) {
  const double t = row[at(channels_.time)], half = seen_ ? 0.5 * (t - time_) : 0.0;
  for (OfJoint& joint : joints_) {
    if (!seen_) joint.carried_in += joint_loss[at(joint.joint)];
    const Rates now = rates(joint, row, e);
    add_half(joint, joint.last, half);
    add_half(joint, now, half);
    joint.largest_rub = std::max(joint.largest_rub, now.rub);
    if (now.sector >= 0) joint.table.pv_max[at(now.sector)] = std::max(joint.table.pv_max[at(now.sector)], now.rub);
    joint.last = now;
  }
  duration_ += 2.0 * half;
  time_ = t;
  seen_ = true;
  if (!sum_noise_.is_due(t)) return;
  double* to = sum_noise_.note(t).data();
  for (const OfJoint& joint : joints_) *to++ = joint.sliding, *to++ = joint.work;
}

ClearanceStatistics::SumNoise ClearanceStatistics::sum_noise(int joint, double contacts) const {
  const auto index = static_cast<std::size_t>(index_[at(joint)]);
  const OfJoint& sums = joints_[index];
  return {sum_noise_.of(2 * index, time_, sums.sliding, contacts),
          sum_noise_.of(2 * index + 1, time_, sums.work, contacts)};
}

void ClearanceStatistics::add_contact(int joint, double end, const ContactRecord& contact) {
  if (!has(joint)) return;
  OfJoint& sums = joints_[at(index_[at(joint)])];
  sums.fastest = std::fmax(sums.fastest, contact.approach_speed);
  sums.hardest = std::fmax(sums.hardest, contact.impulse);
  if (!(contact.impact > 0.0)) return;
  ++sums.impacts;
  sums.impact_time += end - std::max(from_, contact.begin);
}

void ClearanceStatistics::add_contact_before(int joint, const ContactRecord& contact) {
  if (has(joint)) joints_[at(index_[at(joint)])].carried_in -= contact.energy_lost;
}

void ClearanceStatistics::add_open_contact(int joint, const ContactRecord& contact) {
  if (has(joint)) joints_[at(index_[at(joint)])].carried_out += contact.energy_lost;
}

PlayFigures ClearanceStatistics::figures(int joint) const {
  const OfJoint& sums = of(joint);
  const bool any = duration_ > 0.0, slides = channels_.joints[at(joint)].slip >= 0;
  const double time = any ? duration_ : not_known, load = std::hypot(sums.load_x, sums.load_y);
  // Sums of the same time that are taken step by step differ in their last digits: no part is below zero.
  const double flight = any ? std::max(0.0, 1.0 - sums.contact_time / time) : not_known;
  const double impact = any ? std::min(sums.impact_time / time, 1.0 - flight) : not_known;
  const bool loaded = any && sums.is_bearing && sums.impulse > 0.0;
  return {.flight = flight,
          .impact = impact,
          .lasting = 1.0 - flight - impact,
          .impacts = sums.impacts,
          .max_approach_speed = sums.fastest < 0.0 ? not_known : sums.fastest,
          .max_impulse = sums.hardest < 0.0 ? not_known : sums.hardest,
          .mean_normal_force = sums.impulse / time,
          .load_angle = loaded ? std::atan2(sums.load_y, sums.load_x) : not_known,
          .load_concentration = loaded ? load / sums.impulse : not_known,
          .load_elevation =
              loaded && sums.is_socket ? std::atan2(sums.along_z, std::hypot(sums.across_x, sums.across_y)) : not_known,
          .sliding = slides && any ? sums.sliding : not_known,
          .work = slides && any ? sums.work : not_known,
          .pv_mean = slides ? sums.work / sums.area / time : not_known,
          .pv_max = slides && any ? sums.largest_rub / sums.area : not_known,
          .carried_in = any ? sums.carried_in : not_known,
          .carried_out = any ? sums.carried_out : not_known};
}

BearingTable ClearanceStatistics::table(int joint) const {
  const OfJoint& sums = of(joint);
  BearingTable out = sums.table;
  for (std::size_t k = 0; k < BearingTable::sectors; ++k) {
    out.pv_mean[k] = out.work[k] / sums.area / duration_;
    out.pv_max[k] /= sums.area;
  }
  return out;
}

}  // namespace freeplay
