#include "report/orbit.h"

#include <cmath>

#include "report/base64.h"
#include "report/courses.h"

namespace freeplay {

Orbit::Orbit(std::string joint, double clearance, bool in_space, std::size_t rows, std::size_t most)
    : joint_(std::move(joint)),
      clearance_(clearance),
      in_space_(in_space),
      all_(rows),
      parts_(rows > most ? most / 2 : 0) {
  if (parts_ > 0) next_ = bucket_begin(1, all_, parts_);
}

void Orbit::keep(std::size_t row, const Vector3& point) {
  rows_.push_back(static_cast<std::int32_t>(row));
  points_.push_back(static_cast<float>(point[0] / clearance_));
  points_.push_back(static_cast<float>(point[1] / clearance_));
  if (in_space_) radii_.push_back(static_cast<float>(std::hypot(point[0], point[1], point[2]) / clearance_));
}

void Orbit::add(const Vector3& point) {
  const std::size_t row = row_++;
  const double far = point[0] * point[0] + point[1] * point[1] + point[2] * point[2];
  if (std::isfinite(far)) {
    if (parts_ == 0 || !begun_) keep(row, point);
    if (!begun_ || far > far_) far_row_ = row, far_point_ = point, far_ = far;
    begun_ = true;
  }
  if (parts_ == 0 || row_ < next_) return;
  if (begun_ && rows_.back() != static_cast<std::int32_t>(far_row_)) keep(far_row_, far_point_);
  begun_ = false;
  next_ = bucket_begin(++part_ + 1, all_, parts_);
}

Json Orbit::json() const {
  Json json = {{"joint", joint_},
               {"clearance", clearance_},
               {"rows", base64_numbers<std::int32_t>(rows_)},
               {"points", base64_numbers<float>(points_)}};
  if (in_space_) json["radius"] = base64_numbers<float>(radii_);
  return json;
}

}  // namespace freeplay
