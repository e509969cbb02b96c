// How long a driver takes until its motion comes again.
#pragma once

#include <optional>

#include "model/model.h"

namespace freeplay {

/// Period of what a driver prescribes [s]: of a table that is repeated, of a steady turn 2 pi/omega, of another formula
/// the least time after which its rate (of an effort its value) comes again, to a millionth, at many instants. Looked
/// for from `from` on, up to `longest` seconds. Empty where there is none, as of a motion from point to point.
std::optional<double> motion_period(const Model& model, const Driver& driver, double from, double longest);

/// The same of a load, by its value.
std::optional<double> load_period(const AppliedForce& force, double from, double longest);

/// That of a driver of a steady turn alone.
std::optional<double> turn_period(const Model& model, const Driver& driver, double from, double longest);

}  // namespace freeplay
