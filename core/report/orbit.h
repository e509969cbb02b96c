// Orbit: the journal's centre in its clearance circle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "model/model.h"

namespace freeplay {

/// Of each of some parts of the rows the first point and the one farthest from the centre, or all points where they are
/// few.
class Orbit {
 public:
  /// At most `most` points of `rows` rows.
  Orbit(std::string joint, double clearance, bool in_space, std::size_t rows, std::size_t most);

  /// The next row; a point with NaN is none. z: 0 in the plane.
  void add(const Vector3& point);
  /// `{joint, clearance, rows, points}` with x and y, in space also `radius`.
  Json json() const;

 private:
  void keep(std::size_t row, const Vector3& point);

  std::string joint_;
  double clearance_;
  bool in_space_;
  std::size_t all_, parts_, part_ = 0, next_ = 0, row_ = 0;  // parts_ 0: all points
  bool begun_ = false;
  std::size_t far_row_ = 0;
  Vector3 far_point_{};
  double far_ = -1.0;
  std::vector<std::int32_t> rows_;
  std::vector<float> points_, radii_;
};

}  // namespace freeplay
