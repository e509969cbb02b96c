#include "assembly/element_rates.h"

#include "base/index.h"

namespace freeplay {

using Eigen::MatrixXd;

Eigen::Vector3d ElementRates::apart(const JointElement& element) const {
  const double* a = e_.markers[at(element.marker_a)].position;
  const double* b = e_.markers[at(element.marker_b)].position;
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

std::optional<Eigen::Vector3d> ElementRates::line(const JointElement& element) const {
  const Eigen::Vector3d between = apart(element);
  if (between.norm() < one_place) return std::nullopt;
  return between.normalized();
}

MatrixXd ElementRates::spread(const JointElement& element, const double* row) const {
  MatrixXd rate = MatrixXd::Zero(1, system_.layout().nv());
  const int width = system_.layout().body_velocities();
  const BodyId bodies[2] = {model_.markers[at(element.marker_a)].body, model_.markers[at(element.marker_b)].body};
  for (int k = 0; k < 2; ++k) {
    for (int c = 0; c < width && bodies[k] != ground; ++c) rate(0, width * bodies[k] + c) += row[width * k + c];
  }
  return rate;
}

MatrixXd ElementRates::of_ends(const JointElement& element, const Eigen::Vector3d& along, double turn_a,
                               double turn_b) const {
  double row[12] = {};
  for (int k = 0; k < 2; ++k) {
    const int marker = k == 0 ? element.marker_a : element.marker_b;
    if (model_.markers[at(marker)].body == ground) continue;
    const Eigen::Vector3d way = k == 0 ? -along : along;
    const double part[6] = {way[0], way[1], way[2], 0.0, 0.0, k == 0 ? turn_a : turn_b};
    system_.markers().row(marker, part, e_, row + at(k * system_.layout().body_velocities()));
  }
  return spread(element, row);
}

std::optional<MatrixXd> ElementRates::of(int joint) const {
  const JointElement& element = model_.joints[at(joint)];
  if (element.ideal_layout().coordinate == Coordinate::none) {
    const std::optional<Eigen::Vector3d> along = line(element);
    return along ? std::optional(of_ends(element, *along, 0.0, 0.0)) : std::nullopt;
  }
  double row[12] = {}, bias = 0.0;
  system_.joints().coordinate_row(joint, e_, row, bias);
  return spread(element, row);
}

}  // namespace freeplay
