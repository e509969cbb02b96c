#include "system/declared_rows.h"

#include "base/angle.h"
#include "base/index.h"
#include "system/constraints.h"
#include "system/slide_line.h"

namespace freeplay::planar {

void DeclaredRows::add(Span<const PlanarRow> rows, const JointEnds& ends, int row, int offset_a, int offset_b) {
  for (const PlanarRow kind : rows) {
    if (kind == PlanarRow::origins) {
      origins_.push_back({ends.marker_a, ends.marker_b, row, offset_a, offset_b});
    } else {
      (kind == PlanarRow::across ? across_ : turns_).push_back({ends, row, offset_a, offset_b});
    }
    const int count = kind == PlanarRow::origins ? 2 : 1;
    row += count;
    if (offset_a >= 0) offset_a += velocities * count;
    if (offset_b >= 0) offset_b += velocities * count;
  }
}

void DeclaredRows::write_constants(ConstraintValues& rows) const {
  const auto write = [&](int offset, double x, double y, double turn) {
    if (offset < 0) return;
    double* row = &rows.jacobian[at(offset)];
    row[0] = x;
    row[1] = y;
    row[2] = turn;
  };
  const auto next = [](int offset) { return offset < 0 ? offset : offset + velocities; };
  for (const RowPair& pair : origins_) {
    write(pair.offset_a, -1.0, 0.0, 0.0);
    write(next(pair.offset_a), 0.0, -1.0, 0.0);
    write(pair.offset_b, 1.0, 0.0, 0.0);
    write(next(pair.offset_b), 0.0, 1.0, 0.0);
  }
  for (const Row& row : turns_) {
    write(row.offset_a, 0.0, 0.0, -1.0);
    write(row.offset_b, 0.0, 0.0, 1.0);
  }
}

void DeclaredRows::fill(const RowPair& pair, const MarkerValues& bodies, ConstraintValues& rows) {
  double* const jacobian = rows.jacobian.data();
  if (pair.offset_a >= 0) {
    const Arm& a = bodies.arms[at(pair.marker_a)];
    jacobian[pair.offset_a + 2] = a.y;
    jacobian[pair.offset_a + 5] = -a.x;
  }
  if (pair.offset_b >= 0) {
    const Arm& b = bodies.arms[at(pair.marker_b)];
    jacobian[pair.offset_b + 2] = -b.y;
    jacobian[pair.offset_b + 5] = b.x;
  }
}

void DeclaredRows::fill(const Row& row, const SlideLine& s, ConstraintValues& rows) {
  double* const jacobian = rows.jacobian.data();
  if (row.offset_a >= 0) {
    jacobian[row.offset_a] = s.h_y;
    jacobian[row.offset_a + 1] = -s.h_x;
    jacobian[row.offset_a + 2] = -s.along() - (s.h_x * s.a.x + s.h_y * s.a.y);
  }
  if (row.offset_b >= 0) {
    jacobian[row.offset_b] = -s.h_y;
    jacobian[row.offset_b + 1] = s.h_x;
    jacobian[row.offset_b + 2] = s.h_x * s.b.x + s.h_y * s.b.y;
  }
}

void DeclaredRows::fill_jacobian(std::span<const Mount> mounts, const MarkerValues& bodies,
                                 ConstraintValues& rows) const {
  for (const RowPair& pair : origins_) fill(pair, bodies, rows);
  for (const Row& row : across_) fill(row, SlideLine(row.ends, mounts, bodies), rows);
}

void DeclaredRows::fill(std::span<const Mount> mounts, const MarkerValues& bodies, ConstraintValues& rows) const {
  double* const phi = rows.phi.data();
  for (const RowPair& pair : origins_) {
    const Arm &a = bodies.arms[at(pair.marker_a)], &b = bodies.arms[at(pair.marker_b)];
    phi[pair.row] = b.at_x - a.at_x;
    phi[pair.row + 1] = b.at_y - a.at_y;
    fill(pair, bodies, rows);
  }
  for (const Row& row : across_) {
    const SlideLine s(row.ends, mounts, bodies);
    phi[row.row] = s.across();
    fill(row, s, rows);
  }
  for (const Row& row : turns_) phi[row.row] = without_turns(angle_between(row.ends, mounts, bodies));
}

void DeclaredRows::fill_nu(ConstraintValues& rows) const {
  double* const nu = rows.nu.data();
  for (const RowPair& pair : origins_) nu[pair.row] = nu[pair.row + 1] = 0.0;
  for (const Row& row : across_) nu[row.row] = 0.0;
  for (const Row& row : turns_) nu[row.row] = 0.0;
}

void DeclaredRows::fill_gamma(std::span<const Mount> mounts, const MarkerValues& bodies, ConstraintValues& rows) const {
  double* const gamma = rows.gamma.data();
  for (const RowPair& pair : origins_) {
    const Arm &a = bodies.arms[at(pair.marker_a)], &b = bodies.arms[at(pair.marker_b)];
    gamma[pair.row] = b.x * b.w * b.w - a.x * a.w * a.w;
    gamma[pair.row + 1] = b.y * b.w * b.w - a.y * a.w * a.w;
  }
  for (const Row& row : across_) {
    const SlideLine s(row.ends, mounts, bodies);
    // Arms turn with their bodies: d'' has -arm w^2 besides the accelerations of the bodies.
    const double bias =
        (s.h_x * s.b.y - s.h_y * s.b.x) * s.b.w * s.b.w - (s.h_x * s.a.y - s.h_y * s.a.x) * s.a.w * s.a.w;
    gamma[row.row] = 2.0 * s.a.w * s.rate_along() + s.a.w * s.a.w * s.across() + bias;
  }
  for (const Row& row : turns_) gamma[row.row] = 0.0;
}

}  // namespace freeplay::planar
