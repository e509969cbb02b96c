#include "contract/joint_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "freeplay/eigen.h"

namespace freeplay {
namespace {

std::string of_end(const char* const (&names)[6], std::size_t component, const char* joining) {
  return std::string(names[component % 6]) + joining + (component % 12 < 6 ? "a" : "b");
}

}  // namespace

std::string words_of(const JointMoment& moment) {
  const Eigen::Vector3d arm = vector3(moment.markers.b.position) - vector3(moment.markers.a.position);
  const Eigen::Matrix3d relative = rotation(moment.markers.a).transpose() * rotation(moment.markers.b);
  const double cosine = std::clamp(0.5 * (relative.trace() - 1.0), -1.0, 1.0);
  std::string words = fmt::format("at t = {:.4g} s with b at ({:.4g}, {:.4g}, {:.4g}) m from a, turned by {:.4g} rad",
                                  moment.t, arm[0], arm[1], arm[2], std::acos(cosine));
  const Eigen::Vector3d v = vector3(moment.markers.b.velocity) - vector3(moment.markers.a.velocity),
                        wa = vector3(moment.markers.a.angular_velocity),
                        wb = vector3(moment.markers.b.angular_velocity);
  if (!v.isZero(0.0)) words += fmt::format(", moving with ({:.4g}, {:.4g}, {:.4g}) m/s", v[0], v[1], v[2]);
  if (!wa.isZero(0.0) || !wb.isZero(0.0)) {
    const auto turning = [](const Eigen::Vector3d& w) {
      return w[0] == 0.0 && w[1] == 0.0 ? fmt::format("{:.4g}", w[2])
                                        : fmt::format("({:.4g}, {:.4g}, {:.4g})", w[0], w[1], w[2]);
    };
    words += fmt::format(", a turning with {} rad/s and b with {} rad/s", turning(wa), turning(wb));
  }
  if (moment.per_contact > 0.0) words += fmt::format(", per_contact = {:g}", moment.per_contact);
  if (!moment.z.empty()) words += fmt::format(", z0 = {:.4g}", moment.z[0]);
  return words;
}

std::string twist_word(std::size_t component) {
  return of_end({"vx", "vy", "vz", "wx", "wy", "wz"}, component, " of ");
}

std::string force_word(std::size_t row) {
  if (row >= 12) return fmt::format("rate of z{}", row - 12);
  return of_end({"Fx", "Fy", "Fz", "Mx", "My", "Mz"}, row, " on ");
}

std::string input_word(std::size_t column) {
  if (column >= 24) return fmt::format("z{}", column - 24);
  if (column >= 12) return twist_word(column - 12);
  return of_end({"x", "y", "z", "turn x", "turn y", "turn z"}, column, " of ");
}

}  // namespace freeplay
