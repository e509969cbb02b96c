// DoubtfulNumber: single numbers of the model file that look like those of another unit, or of no material.
#pragma once

#include "component/parameter_block.h"
#include "format/checked_value.h"
#include "format/parameter_check.h"

namespace freeplay {

/// A number without a unit is doubted beyond these, as it may be meant in another unit: degrees, rpm, mm/s^2, ms, mm.
/// Sources: 1000 rad/s are 9549 rpm, beyond what linkages turn at; 50 m/s^2 are five times the earth's gravity.
namespace bare_limit {
inline constexpr double angle = 6.2831853071795864769;   ///< one turn [rad]
inline constexpr double direction = 3.1415926535897932;  ///< half a turn [rad]
inline constexpr double angular_speed = 1000.0;          ///< [rad/s]
inline constexpr double pin_speed = 50.0;                ///< of a joint on a driven link [m/s]; in fast engines 40
inline constexpr double gravity = 50.0;                  ///< [m/s^2]
inline constexpr double step = 5e-3;                     ///< and a fiftieth of the run [s]
inline constexpr double long_step = 0.1;                 ///< in whatever run [s]
inline constexpr double length = 100.0;                  ///< in terms of the lengths around it
inline constexpr double start = 50.0;                    ///< likewise: of a slide at its start
inline constexpr double bearing = 20.0;                  ///< likewise: radii, lengths and plays of bearings
inline constexpr double lead = 2.0;                      ///< likewise: the way along a thread in a turn
inline constexpr double slide_speed = 50.0;              ///< [m/s]
inline constexpr double rows = 1e7;                      ///< of a result
}  // namespace bare_limit

/// What stands in the brackets of functions such as sin and smooth, which says nothing of the unit of a value.
enum class Arguments { passed_over, read };

/// True if a unit stands in the text of the value or in that of a parameter that it refers to. Such a value is
/// never doubted for its unit.
bool names_a_unit(const CheckedValue& written, Arguments arguments = Arguments::passed_over);
/// The same for any text within a list or a map.
bool says_unit(const CheckedValue& value, Arguments arguments = Arguments::passed_over);
/// True if a unit of time stands somewhere in the text, in brackets of functions, too: that of 5 m/s is none.
bool says_time(const CheckedValue& value);

/// `doubtful-angle`: beyond a turn, without a unit, and no multiple of pi. True after a message.
bool doubt_angle(const CheckedValue& written, double radians);
/// The same of a direction, where more than half a turn is doubted, too, if it is a round number.
bool doubt_direction(const CheckedValue& written, double radians);
/// `doubtful-speed`.
void doubt_angular_speed(const CheckedValue& written, double speed);
/// The same of a speed along a slide.
void doubt_slide_speed(const CheckedValue& written, double speed);
/// `doubtful-length`: a start of a slide where the lengths of the mechanism are about `scale` [m], 0 when unknown.
void doubt_start_length(const CheckedValue& written, double value, double scale);
/// `doubtful-value`.
void doubt_gravity(const CheckedValue& written, const Vector3& gravity);
/// `doubtful-time`: of fixed steps, or the first one, in a run of length `span` [s].
void doubt_step(const CheckedValue& written, double step, double span);
/// `doubtful-time`: of rows that are farther apart than half the run, or so close that they fill a disk.
void doubt_interval(const CheckedValue& written, double interval, double span);

/// Doubts the numbers of one component by the units of its table: angles and speeds as above, `doubtful-value` for
/// moduli, stiffnesses and coefficients of friction that no material and no spring has. `scale` [m]: of the mechanism's
/// lengths, 0 when unknown; a length without a unit that is `most_lengths` times as long is `doubtful-length`.
void doubt_parameters(const ParameterBlock& block, const std::map<std::string, CheckedValue>& places, double scale,
                      double most_lengths = bare_limit::length);

/// `doubtful-angle`: degrees in a sine, cosine or tangent of a formula that stands in the value, without their unit.
void doubt_degrees(const CheckedValue& written, std::string_view text);

/// `doubtful-value`: the stiffness that a contact law of the entry is given, as of no material.
void doubt_contact_stiffness(const CheckedValue& entry, const ParameterBlock& block, const JointLayout& layout,
                             double scale);

}  // namespace freeplay
