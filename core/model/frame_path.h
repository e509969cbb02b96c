// FramePath: where a frame shall be over time.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "base/expression.h"
#include "model/time_table.h"

namespace freeplay {

struct PathPose;

/// Numbers of a pose, at most: x, y [m] and angle [rad] in the plane; x, y, z [m] and roll, pitch, yaw [rad] in space.
inline constexpr std::size_t most_path_numbers = 6;

/// A function or a table for each number that is given; the others follow from the mechanism. Tables in space give the
/// orientation whole, by four splines q_i(t) through the parts w, x, y, z of quaternions whose signs were chosen so
/// that neighbours lie on one side, q_k . q_(k+1) >= 0. The orientation is that of q/|q|, which is C2 as the q_i are.
struct FramePath {
  std::array<std::optional<Expression>, most_path_numbers> functions;
  std::array<std::string, most_path_numbers> text;                             ///< of each function, as written
  std::array<std::shared_ptr<const TimeTable>, most_path_numbers + 1> tables;  ///< of x, y, z, w, x, y, z
  TableSource source;                                                          ///< of the tables
  std::string angle_unit;                                                      ///< of their angle; empty: rad

  bool gives(std::size_t number) const { return functions[number].has_value() || tables[number] != nullptr; }
  bool gives_any() const;
  /// The first `count` numbers.
  bool gives_all(std::size_t count) const;
  /// Roll, pitch and yaw.
  bool gives_turning() const { return gives(3) && gives(4) && gives(5); }
  /// Writes the numbers that are given; turning, too, where gives_turning().
  bool evaluate(double t, PathPose& pose, EvaluationFailure& failure) const noexcept;
};

}  // namespace freeplay
