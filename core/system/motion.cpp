#include "system/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/format_into.h"
#include "system/leg_edges.h"
#include "system/path_place.h"

namespace freeplay {
namespace {

void fail(MotionFault& fault, const char* id, const char* text) {
  fault.id = id;
  abi::copy_text(fault.text, sizeof fault.text, text);
}

}  // namespace

Motions::Motions(const Model& model)
    : model_(model),
      legs_(model.drivers.size()),
      antiderivatives_(model.drivers.size()),
      starts_(model.drivers.size(), 0.0),
      table_starts_(model.drivers.size(), 0.0) {
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const Driver& driver = model.drivers[d];
    legs_[d] = closed_form_leg(model, static_cast<int>(d));
    if (driver.kind != DriverKind::velocity) continue;
    if (!driver.table) {
      antiderivatives_[d] = Antiderivative(driver.value, model.settings.start, model.settings.end, driver.location);
      continue;
    }
    EvaluationFailure failure;
    if (!driver.table->integral(model.settings.start, table_starts_[d], failure)) {
      throw Error(Error::Category::input, failure.id, failure.reason, driver.location);
    }
  }
}

bool Motions::follows(int driver) const {
  const std::size_t d = static_cast<std::size_t>(driver);
  return model_.drivers[d].kinematics >= 0 && !legs_[d];
}

bool Motions::entry_follows(int kinematics) const {
  const InverseKinematics& entry = model_.kinematics[static_cast<std::size_t>(kinematics)];
  for (int d = entry.first_driver; d < entry.first_driver + entry.driver_count; ++d) {
    if (follows(d)) return true;
  }
  return false;
}

const Leg* Motions::leg(int driver) const {
  const std::optional<Leg>& leg = legs_[static_cast<std::size_t>(driver)];
  return leg ? &*leg : nullptr;
}

std::vector<PathEdge> Motions::edges(double until) const {
  std::vector<PathEdge> found;
  for (std::size_t d = 0; d < legs_.size(); ++d) {
    if (!legs_[d]) continue;
    const std::vector<PathEdge> of_leg =
        leg_edges(model_, static_cast<int>(d), *legs_[d], model_.settings.start, until);
    found.insert(found.end(), of_leg.begin(), of_leg.end());
  }
  if (followed_) found.insert(found.end(), followed_->edges().begin(), followed_->edges().end());
  return found;
}

void Motions::set_start(int driver, double coordinate) { starts_[static_cast<std::size_t>(driver)] = coordinate; }

bool Motions::modulo_turns(int driver) const {
  const Driver& driven = model_.drivers[static_cast<std::size_t>(driver)];
  return driven.kinematics >= 0 && driven.kind == DriverKind::angle;
}

FollowedMotion::Work& Motions::own_part(MotionWork& work) const {
  if (!work.followed) work.followed = followed_->make_work();
  return *work.followed;
}

bool Motions::path(int kinematics, double t, PathPose& pose, MotionWork& work, MotionFault& fault) const noexcept {
  const InverseKinematics& entry = model_.kinematics[static_cast<std::size_t>(kinematics)];
  if (!entry.path.gives_all(path_numbers(model_.space))) {
    pose = {};
    if (followed_ && !followed_->frame(kinematics, t, pose, own_part(work), fault)) return false;
  }
  EvaluationFailure failure;
  if (entry.path.evaluate(t, pose, failure)) return true;
  fault.kinematics = kinematics;
  fail(fault, failure.id, failure.reason);
  return false;
}

Jet Motions::platform_angle(int driver, const PathPose& frame) const {
  const int kinematics = model_.drivers[static_cast<std::size_t>(driver)].kinematics;
  const int marker = model_.kinematics[static_cast<std::size_t>(kinematics)].marker;
  return frame[2] - Jet::constant(model_.markers[static_cast<std::size_t>(marker)].angle);
}

bool Motions::reaches(int driver, double t, const CrankPose& pose, MotionFault& fault) const noexcept {
  if (pose.reachable) return true;
  const Leg& leg = *legs_[static_cast<std::size_t>(driver)];
  fault.driver = driver;
  fault.kinematics = model_.drivers[static_cast<std::size_t>(driver)].kinematics;
  fault.id = "ik-unreachable";
  char* const end = fault.text + sizeof fault.text - 1;
  char* to = format_into(fault.text, end, "leg of '{}' cannot reach the path at t = {:.9g} s", leg.name, t);
  to = write_place_on_path(model_, fault.kinematics, t, to, end);
  to = format_into(to, end, ": its pins are {:.6g} m apart, the leg reaches from {:.6g} m to {:.6g} m", pose.distance,
                   std::abs(leg.crank - leg.coupler), leg.crank + leg.coupler);
  *to = '\0';
  return false;
}

bool Motions::leg_pose(int driver, double t, LegPose& pose, MotionFault& fault) const noexcept {
  PathPose frame;
  if (!path(model_.drivers[static_cast<std::size_t>(driver)].kinematics, t, frame, fault)) return false;
  pose = solve_leg(*legs_[static_cast<std::size_t>(driver)], frame[0], frame[1], platform_angle(driver, frame));
  return reaches(driver, t, pose, fault);
}

bool Motions::function(std::size_t d, double t, TimeValue& out, EvaluationFailure& failure) const noexcept {
  const Driver& driver = model_.drivers[d];
  Jet value;
  if (!(driver.table ? driver.table->evaluate(t, value, failure) : driver.value.evaluate(t, value, failure))) {
    return false;
  }
  out = {value.value, value.rate, value.acceleration};
  if (driver.kind != DriverKind::velocity) return true;
  const bool steady = !driver.table && !driver.value.depends_on_time();
  double integral = steady ? value.value * (t - model_.settings.start) : 0.0;
  if (!steady && !(driver.table ? driver.table->integral(t, integral, failure)
                                : antiderivatives_[d].evaluate(t, integral, failure))) {
    return false;
  }
  out = {starts_[d] + (integral - table_starts_[d]), value.value, value.rate};
  return true;
}

bool Motions::follow_paths(double t, Span<TimeValue> out, MotionWork& work, MotionFault& fault) const noexcept {
  PathPose frame;
  PlatformTurn platform;
  int framed = -1;  // the entry that both are of
  for (std::size_t d = 0; d < model_.drivers.size(); ++d) {
    const int kinematics = model_.drivers[d].kinematics;
    if (kinematics < 0) continue;
    out[d] = {};
    if (!legs_[d]) continue;
    if (framed != kinematics) {
      if (!path(kinematics, t, frame, work, fault)) return false;
      platform = platform_angle(static_cast<int>(d), frame);
    }
    framed = kinematics;
    const CrankPose pose = solve_crank(*legs_[d], frame[0], frame[1], platform);
    if (!reaches(static_cast<int>(d), t, pose, fault)) return false;
    out[d] = {pose.crank.value + legs_[d]->coordinate_offset, pose.crank.rate, pose.crank.acceleration};
  }
  return true;
}

bool Motions::evaluate(double t, Span<TimeValue> out, MotionWork& work, MotionFault& fault) const noexcept {
  if (!model_.kinematics.empty() && !follow_paths(t, out, work, fault)) return false;
  for (std::size_t d = 0; d < model_.drivers.size(); ++d) {
    if (model_.drivers[d].kinematics >= 0) continue;
    EvaluationFailure failure;
    if (function(d, t, out[d], failure)) continue;
    fault.driver = static_cast<int>(d);
    fail(fault, failure.id, failure.reason);
    return false;
  }
  return !followed_ || followed_->evaluate(t, out, own_part(work), fault);
}

bool Motions::evaluate(double t, Span<TimeValue> out, MotionFault& fault) const noexcept {
  MotionWork work;
  return evaluate(t, out, work, fault);
}

bool Motions::path(int kinematics, double t, PathPose& pose, MotionFault& fault) const noexcept {
  MotionWork work;
  return path(kinematics, t, pose, work, fault);
}

}  // namespace freeplay
