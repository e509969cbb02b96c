#include "results/twin_comparison.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double same_instant_of_rows = 1e-9;  // of the interval

std::size_t pose_size(const Model& model) { return model.space == Space::planar ? 3 : 7; }

/// Of the turn from one unit quaternion w, x, y, z to another.
double angle_between(std::span<const double> a, std::span<const double> b) {
  const double w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const double x = a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2];
  const double y = a[0] * b[2] + a[1] * b[3] - a[2] * b[0] - a[3] * b[1];
  const double z = a[0] * b[3] - a[1] * b[2] + a[2] * b[1] - a[3] * b[0];
  return 2.0 * std::atan2(std::sqrt(x * x + y * y + z * z), std::abs(w));
}

}  // namespace

TwinNumbers::TwinNumbers(const Model& model, const Channels& channels) {
  columns_.push_back(at(channels.time));
  for (const int body : channels.bodies) {
    for (std::size_t i = 0; i < pose_size(model); ++i) columns_.push_back(at(body) + i);
  }
  for (const DriverColumns& driver : channels.drivers) columns_.push_back(at(driver.effort));
}

void TwinNumbers::pick(std::span<const double> row, std::span<double> numbers) const {
  for (std::size_t i = 0; i < columns_.size(); ++i) numbers[i] = row[columns_[i]];
}

TwinComparison::TwinComparison(const Model& model)
    : model_(model),
      from_(model.settings.start + model.settings.discard - same_instant_of_rows * model.settings.interval),
      bodies_(model.bodies.size()),
      drivers_(model.drivers.size()) {}

void TwinComparison::Sum::add(double value) {
  largest = std::fmax(largest, std::abs(value));
  square += value * value;
}

double TwinComparison::rms(const Sum& sum) const { return std::sqrt(sum.square / count_); }

void TwinComparison::add(std::span<const double> numbers, std::span<const double> twin) {
  if (numbers.front() < from_) return;
  count_ += 1.0;
  std::size_t next = 1;
  const bool planar = model_.space == Space::planar;
  for (OfBody& body : bodies_) {
    const std::span a = numbers.subspan(next, pose_size(model_)), b = twin.subspan(next, pose_size(model_));
    next += a.size();
    body.distance.add(planar ? std::hypot(a[0] - b[0], a[1] - b[1])
                             : std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    body.angle.add(planar ? a[2] - b[2] : angle_between(a.subspan(3), b.subspan(3)));
  }
  for (OfDriver& driver : drivers_) {
    driver.difference.add(numbers[next] - twin[next]);
    driver.twin.add(twin[next]);
    ++next;
  }
}

Json TwinComparison::json() const {
  if (count_ == 0.0) return nullptr;
  Json bodies = Json::object(), drivers = Json::object();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const OfBody& body = bodies_[i];
    append(bodies, model_.bodies[i].name,
           {{"max_position", json_number(body.distance.largest)},
            {"rms_position", json_number(rms(body.distance))},
            {"max_angle", json_number(body.angle.largest)},
            {"rms_angle", json_number(rms(body.angle))}});
  }
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    const OfDriver& driver = drivers_[i];
    append(drivers, model_.drivers[i].name,
           {{"max", json_number(driver.difference.largest)},
            {"rms", json_number(rms(driver.difference))},
            {"ripple", json_number(rms(driver.difference) / rms(driver.twin))}});
  }
  return {{"bodies", std::move(bodies)}, {"drivers", std::move(drivers)}};
}

}  // namespace freeplay
