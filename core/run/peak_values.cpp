#include "run/peak_values.h"

#include <cmath>

namespace freeplay {

PeakValues::PeakValues(const Model& model, const Channels& channels)
    : channels_(channels),
      planar_(model.space == Space::planar),
      joints_(channels.bodies.size()),
      drivers_(joints_ + 5 * channels.joints.size()),
      paths_(drivers_ + channels.drivers.size()),
      forces_(paths_ + 2 * channels.paths.size()) {
  for (const ForceElement& element : model.force_elements) {
    force_columns_.push_back(element.joint >= 0 ? channels.joints[at(element.joint)].force
                                                : channels.forces[at(element.applied)].force);
  }
}

namespace {
// Quicker than std::hypot, whose care for numbers beyond 1e150 no row needs.
double length_of(double x, double y, double z = 0.0) { return std::sqrt(x * x + y * y + z * z); }
}  // namespace

double PeakValues::length(std::span<const double> row, int column) const {
  return length_of(row[at(column)], row[at(column + 1)], planar_ ? 0.0 : row[at(column + 2)]);
}

double PeakValues::moment(std::span<const double> row, int wrench) const {
  return planar_ ? std::abs(row[at(wrench + 2)]) : length(row, wrench + 3);
}

void PeakValues::of(std::span<const double> row, std::span<double> out) const {
  const auto value = [&](int column) { return column < 0 ? 0.0 : row[at(column)]; };
  double* to = out.data();
  for (const int body : channels_.bodies) *to++ = length(row, body + (planar_ ? 3 : 7));
  for (const JointColumns& joint : channels_.joints) {
    *to++ = length(row, joint.force);
    *to++ = value(joint.normal_force);
    *to++ = value(joint.penetration);
    const bool eccentric = joint.contact >= 0 && joint.eccentricity_x >= 0;
    *to++ = eccentric ? length_of(value(joint.eccentricity_x), value(joint.eccentricity_y), value(joint.eccentricity_z))
                      : 0.0;
    *to++ = moment(row, joint.force);
  }
  for (const DriverColumns& driver : channels_.drivers) *to++ = std::abs(value(driver.effort));
  for (const PathColumns& path : channels_.paths) {
    *to++ = length_of(value(path.error_x), value(path.error_y), value(path.error_z));
    *to++ = std::abs(value(path.error_angle));
  }
  for (const int column : force_columns_) {
    *to++ = length(row, column);
    *to++ = moment(row, column);
  }
}

}  // namespace freeplay
