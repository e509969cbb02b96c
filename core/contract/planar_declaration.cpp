#include "contract/planar_declaration.h"

#include <cmath>

namespace freeplay {
namespace {

struct Relative {
  Relative(const MarkerKinematics& a, const MarkerKinematics& b)
      : h{a.rotation[0], a.rotation[3]},
        d{b.position[0] - a.position[0], b.position[1] - a.position[1]},
        rate{b.velocity[0] - a.velocity[0], b.velocity[1] - a.velocity[1]},
        w(a.angular_velocity[2]) {}
  std::array<double, 2> h, d, rate;
  double w;
};

double dot(const std::array<double, 2>& x, const std::array<double, 2>& y) { return x[0] * y[0] + x[1] * y[1]; }

// u.d for an axis u of marker a, with v = u turned by +90 degrees: (u.d)' = u.d' + w v.d and
// (u.d)'' = u.d'' + v.d alpha + 2 w v.d' - w^2 u.d.
DeclaredRow along(const Relative& r, const std::array<double, 2>& u) {
  const std::array<double, 2> v{-u[1], u[0]};
  DeclaredRow row;
  row.value = dot(u, r.d);
  for (std::size_t i = 0; i < 2; ++i) {
    row.jacobian[i] = -u[i];
    row.jacobian[6 + i] = u[i];
  }
  row.jacobian[5] = dot(v, r.d);
  row.gamma = -(2.0 * r.w * dot(v, r.rate) - r.w * r.w * dot(u, r.d));
  return row;
}

DeclaredRow turn(const MarkerKinematics& a, const MarkerKinematics& b) {
  DeclaredRow row;
  row.value = std::atan2(a.rotation[0] * b.rotation[3] - a.rotation[3] * b.rotation[0],
                         a.rotation[0] * b.rotation[0] + a.rotation[3] * b.rotation[3]);
  row.jacobian[5] = -1.0;
  row.jacobian[11] = 1.0;
  row.is_angle = true;
  return row;
}

}  // namespace

std::vector<DeclaredRow> declared_rows(Span<const PlanarRow> rows, const MarkerKinematics& a,
                                       const MarkerKinematics& b) {
  const Relative r(a, b);
  std::vector<DeclaredRow> out;
  for (const PlanarRow kind : rows) {
    if (kind == PlanarRow::across) out.push_back(along(r, {-r.h[1], r.h[0]}));
    if (kind == PlanarRow::turn) out.push_back(turn(a, b));
    for (std::size_t i = 0; kind == PlanarRow::origins && i < 2; ++i) {
      DeclaredRow row;
      row.value = r.d[i];
      row.jacobian[i] = -1.0;
      row.jacobian[6 + i] = 1.0;
      out.push_back(row);
    }
  }
  return out;
}

DeclaredRow declared_coordinate(Coordinate kind, const MarkerKinematics& a, const MarkerKinematics& b) {
  const Relative r(a, b);
  return kind == Coordinate::angle ? turn(a, b) : along(r, r.h);
}

}  // namespace freeplay
