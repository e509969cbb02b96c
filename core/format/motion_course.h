// MotionCourse: what a function of time does during a run.
#pragma once

#include "base/expression.h"
#include "model/model.h"

namespace freeplay {

/// Speeds that no drive has, whatever their unit: a rifle's bullet, a million turns a minute.
namespace fastest_motion {
inline constexpr double slide = 1e3;  ///< [m/s]
inline constexpr double turn = 1e5;   ///< [rad/s]
/// Of a body at its radius of gyration [m/s]: rings of steel burst at 400, flywheels of carbon fibre reach 1000.
inline constexpr double rim = 1e3;
}  // namespace fastest_motion

/// What a prescribed motion does during the run.
struct Course {
  bool known = false;
  double begin = 0.0, low = 0.0, high = 0.0, fastest = 0.0;
  bool returns = false;  ///< it turns back, or comes to rest at the end
};

/// Of a formula, in a time of `spans` runs.
Course course_of(const Expression& motion, const Settings& settings, double spans = 1.0);

/// Of the coordinate that a driver prescribes, by formula or table; a speed is summed up from zero.
Course course_of(const Driver& driver, const Settings& settings);

/// Largest speed of a motion: a short move lies between samples, towards the half of a span with the larger change.
double peak_speed(const Expression& motion, const Settings& settings);

}  // namespace freeplay
