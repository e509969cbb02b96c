#include "system/motion.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

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
      starts_(model.drivers.size(), 0.0) {
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const Driver& driver = model.drivers[d];
    if (driver.kind == DriverKind::velocity) {
      antiderivatives_[d] = Antiderivative(driver.value, model.settings.start, model.settings.end, driver.location);
    }
    if (driver.kinematics < 0) continue;
    const InverseKinematics& kinematics = model.kinematics[static_cast<std::size_t>(driver.kinematics)];
    for (const auto& component : kinematics.path) {
      if (!component) {
        throw Error(Error::Category::input, "ik-underdetermined",
                    "the path of '" + kinematics.name + "' must give x, y and angle of its frame",
                    kinematics.path_location);
      }
    }
    const auto leg = find_leg(model, driver.joint, kinematics.marker);
    if (!leg) {
      throw Error(Error::Category::input, "ik-underdetermined",
                  "joint '" + driver.name + "' is not the ground pin of a crank and a coupler that carry the frame",
                  driver.location, "other driven chains are not in this release");
    }
    legs_[d] = *leg;
    legs_[d].elbow = driver.elbow;
  }
}

void Motions::set_start(int driver, double coordinate) { starts_[static_cast<std::size_t>(driver)] = coordinate; }

bool Motions::modulo_turns(int driver) const {
  return model_.drivers[static_cast<std::size_t>(driver)].kinematics >= 0;
}

bool Motions::path(int kinematics, double t, PathPose& pose, MotionFault& fault) const noexcept {
  const InverseKinematics& entry = model_.kinematics[static_cast<std::size_t>(kinematics)];
  for (std::size_t i = 0; i < pose.size(); ++i) {
    EvaluationFailure failure;
    if (!entry.path[i]->evaluate(t, pose[i], failure)) {
      fault.kinematics = kinematics;
      fail(fault, failure.id, failure.reason);
      return false;
    }
  }
  return true;
}

bool Motions::leg_pose(int driver, double t, LegPose& pose, MotionFault& fault) const noexcept {
  const int kinematics = model_.drivers[static_cast<std::size_t>(driver)].kinematics;
  PathPose frame;
  if (!path(kinematics, t, frame, fault)) return false;
  const double turn =
      model_.markers[static_cast<std::size_t>(model_.kinematics[static_cast<std::size_t>(kinematics)].marker)].angle;
  const Leg& leg = legs_[static_cast<std::size_t>(driver)];
  pose = solve_leg(leg, frame[0], frame[1], frame[2] - Jet::constant(turn));
  if (pose.reachable) return true;
  fault.driver = driver;
  fault.kinematics = kinematics;
  fault.id = "ik-unreachable";
  const auto end =
      fmt::format_to_n(fault.text, sizeof fault.text - 1,
                       "leg of '{}' cannot reach the path at t = {} s: its pins are {:.6g} m apart, the leg "
                       "reaches from {:.6g} m to {:.6g} m",
                       leg.name, t, pose.distance, std::abs(leg.crank - leg.coupler), leg.crank + leg.coupler);
  *end.out = '\0';
  return false;
}

bool Motions::evaluate(double t, Span<TimeValue> out, MotionFault& fault) const noexcept {
  for (std::size_t d = 0; d < model_.drivers.size(); ++d) {
    const Driver& driver = model_.drivers[d];
    if (driver.kinematics >= 0) {
      LegPose pose;
      if (!leg_pose(static_cast<int>(d), t, pose, fault)) return false;
      out[d] = {pose.crank.value + legs_[d].coordinate_offset, pose.crank.rate, pose.crank.acceleration};
      continue;
    }
    Jet value;
    EvaluationFailure failure;
    bool good = driver.value.evaluate(t, value, failure);
    out[d] = {value.value, value.rate, value.acceleration};
    if (good && driver.kind == DriverKind::velocity) {
      double integral = 0.0;
      good = antiderivatives_[d].evaluate(t, integral, failure);
      out[d] = {starts_[d] + integral, value.value, value.rate};
    }
    if (!good) {
      fault.driver = static_cast<int>(d);
      fail(fault, failure.id, failure.reason);
      return false;
    }
  }
  return true;
}

}  // namespace freeplay
