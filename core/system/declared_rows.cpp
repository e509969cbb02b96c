#include "system/declared_rows.h"

#include <cmath>

#include "base/angle.h"
#include "base/index.h"
#include "system/system.h"

namespace freeplay::planar {
namespace {}  // namespace

/// The line of a slide: h the x axis of marker a, n = h turned by +90 degrees, d = P_b - P_a, and their rates.
///
///   (n.d)' = n.d' - w h.d,  (n.d)'' = n.d'' - h.d alpha - 2 w h.d' - w^2 n.d
///   (h.d)' = h.d' + w n.d,  (h.d)'' = h.d'' + n.d alpha + 2 w n.d' - w^2 h.d
struct DeclaredRows::Slide {
  Slide(const DeclaredRows::Ends& ends, std::span<const Mount> mounts, const Evaluation& e)
      : a(e.arms[at(ends.marker_a)]), b(e.arms[at(ends.marker_b)]) {
    const Mount& mount = mounts[at(ends.marker_a)];
    const planar::Turn still, &turn = ends.body_a == ground ? still : e.turns[at(ends.body_a)];
    h_x = turn.cosine * mount.cosine - turn.sine * mount.sine;
    h_y = turn.sine * mount.cosine + turn.cosine * mount.sine;
    d_x = b.at_x - a.at_x;
    d_y = b.at_y - a.at_y;
    const auto speed = [&](BodyId body, std::size_t i) { return body == ground ? 0.0 : e.v[3 * at(body) + i]; };
    rate_x = (speed(ends.body_b, 0) - b.y * b.w) - (speed(ends.body_a, 0) - a.y * a.w);
    rate_y = (speed(ends.body_b, 1) + b.x * b.w) - (speed(ends.body_a, 1) + a.x * a.w);
  }
  double along() const { return h_x * d_x + h_y * d_y; }
  double across() const { return h_x * d_y - h_y * d_x; }
  double rate_along() const { return h_x * rate_x + h_y * rate_y; }
  double rate_across() const { return h_x * rate_y - h_y * rate_x; }

  const Arm &a, &b;
  double h_x, h_y, d_x, d_y, rate_x, rate_y;
};

void DeclaredRows::add_rows(Span<const PlanarRow> rows, const Ends& ends, int row, int block_a, int block_b) {
  for (const PlanarRow kind : rows) {
    if (kind == PlanarRow::origins) {
      origins_.push_back({ends.marker_a, ends.marker_b, row, block_a, block_b});
    } else {
      (kind == PlanarRow::across ? across_ : turns_).push_back({ends, row, block_a, block_b});
    }
    const int count = kind == PlanarRow::origins ? 2 : 1;
    row += count;
    if (block_a >= 0) block_a += velocities * count;
    if (block_b >= 0) block_b += velocities * count;
  }
}

void DeclaredRows::add_coordinate(Coordinate kind, const Ends& ends, int joint, unsigned terms, int turn) {
  (kind == Coordinate::angle ? angles_ : positions_).push_back({ends, joint, turn, terms});
  terms_ |= terms;
}

void DeclaredRows::write_constants(Evaluation& e) const {
  const auto write = [&](int block, double x, double y, double turn) {
    if (block < 0) return;
    double* row = &e.jacobian[at(block)];
    row[0] = x;
    row[1] = y;
    row[2] = turn;
  };
  const auto next = [](int block) { return block < 0 ? block : block + velocities; };
  for (const RowPair& pair : origins_) {
    write(pair.block_a, -1.0, 0.0, 0.0);
    write(next(pair.block_a), 0.0, -1.0, 0.0);
    write(pair.block_b, 1.0, 0.0, 0.0);
    write(next(pair.block_b), 0.0, 1.0, 0.0);
  }
  for (const Row& row : turns_) {
    write(row.block_a, 0.0, 0.0, -1.0);
    write(row.block_b, 0.0, 0.0, 1.0);
  }
  for (const JointCoordinate& angle : angles_) {
    e.coordinate_rows[at(angle.joint)].jacobian[5] = -1.0;
    e.coordinate_rows[at(angle.joint)].jacobian[11] = 1.0;
  }
}

// The part of Phi_q that motions change.
void DeclaredRows::fill(const RowPair& pair, Evaluation& e) {
  double* const jacobian = e.jacobian.data();
  if (pair.block_a >= 0) {
    const Arm& a = e.arms[at(pair.marker_a)];
    jacobian[pair.block_a + 2] = a.y;
    jacobian[pair.block_a + 5] = -a.x;
  }
  if (pair.block_b >= 0) {
    const Arm& b = e.arms[at(pair.marker_b)];
    jacobian[pair.block_b + 2] = -b.y;
    jacobian[pair.block_b + 5] = b.x;
  }
}

void DeclaredRows::fill(const Row& row, const Slide& s, Evaluation& e) {
  double* const jacobian = e.jacobian.data();
  if (row.block_a >= 0) {
    jacobian[row.block_a] = s.h_y;
    jacobian[row.block_a + 1] = -s.h_x;
    jacobian[row.block_a + 2] = -s.along() - (s.h_x * s.a.x + s.h_y * s.a.y);
  }
  if (row.block_b >= 0) {
    jacobian[row.block_b] = -s.h_y;
    jacobian[row.block_b + 1] = s.h_x;
    jacobian[row.block_b + 2] = s.h_x * s.b.x + s.h_y * s.b.y;
  }
}

void DeclaredRows::fill_jacobian(std::span<const Mount> mounts, Evaluation& e) const {
  for (const RowPair& pair : origins_) fill(pair, e);
  for (const Row& row : across_) fill(row, Slide(row.ends, mounts, e), e);
}

void DeclaredRows::fill_rows(std::span<const Mount> mounts, Evaluation& e) const {
  double* const phi = e.phi.data();
  for (const RowPair& pair : origins_) {
    const Arm &a = e.arms[at(pair.marker_a)], &b = e.arms[at(pair.marker_b)];
    phi[pair.row] = b.at_x - a.at_x;
    phi[pair.row + 1] = b.at_y - a.at_y;
    fill(pair, e);
  }
  for (const Row& row : across_) {
    const Slide s(row.ends, mounts, e);
    phi[row.row] = s.across();
    fill(row, s, e);
  }
  for (const Row& row : turns_) {
    const auto angle = [&](BodyId body, int marker) {
      return (body == ground ? 0.0 : e.q[3 * at(body) + 2]) + mounts[at(marker)].angle;
    };
    const double apart = angle(row.ends.body_b, row.ends.marker_b) - angle(row.ends.body_a, row.ends.marker_a);
    phi[row.row] = without_turns(apart);
  }
}

void DeclaredRows::fill_nu(Evaluation& e) const {
  double* const nu = e.nu.data();
  for (const RowPair& pair : origins_) nu[pair.row] = nu[pair.row + 1] = 0.0;
  for (const Row& row : across_) nu[row.row] = 0.0;
  for (const Row& row : turns_) nu[row.row] = 0.0;
}

void DeclaredRows::fill_gamma(std::span<const Mount> mounts, Evaluation& e) const {
  double* const gamma = e.gamma.data();
  for (const RowPair& pair : origins_) {
    const Arm &a = e.arms[at(pair.marker_a)], &b = e.arms[at(pair.marker_b)];
    gamma[pair.row] = b.x * b.w * b.w - a.x * a.w * a.w;
    gamma[pair.row + 1] = b.y * b.w * b.w - a.y * a.w * a.w;
  }
  for (const Row& row : across_) {
    const Slide s(row.ends, mounts, e);
    // Arms turn with their bodies: d'' has -arm w^2 besides the accelerations of the bodies.
    const double bias =
        (s.h_x * s.b.y - s.h_y * s.b.x) * s.b.w * s.b.w - (s.h_x * s.a.y - s.h_y * s.a.x) * s.a.w * s.a.w;
    gamma[row.row] = 2.0 * s.a.w * s.rate_along() + s.a.w * s.a.w * s.across() + bias;
  }
  for (const Row& row : turns_) gamma[row.row] = 0.0;
}

void DeclaredRows::fill_coordinates(const Point& point, std::span<const Mount> mounts, unsigned terms,
                                    Evaluation& e) const {
  if ((terms_ & terms) == 0) return;
  for (const JointCoordinate& angle : angles_) {
    if ((angle.terms & terms) == 0) continue;
    const Arm &a = e.arms[at(angle.ends.marker_a)], &b = e.arms[at(angle.ends.marker_b)];
    const auto turned = [&](BodyId body, int marker) {
      return (body == ground ? 0.0 : e.q[3 * at(body) + 2]) + mounts[at(marker)].angle;
    };
    double value = turned(angle.ends.body_b, angle.ends.marker_b) - turned(angle.ends.body_a, angle.ends.marker_a);
    // The turn nearest to the last accepted angle: a step never turns a joint by more than half a revolution.
    const double off = (angle.turn < 0 ? 0.0 : point.h[at(angle.turn)]) - value;
    if (std::abs(off) > M_PI) value += whole_turn * std::round(off / whole_turn);
    e.coordinate[at(angle.joint)] = e.coordinate_rows[at(angle.joint)].value = value;
    e.coordinate_rate[at(angle.joint)] = b.w - a.w;
  }
  for (const JointCoordinate& position : positions_) {
    if ((position.terms & terms) == 0) continue;
    const Slide s(position.ends, mounts, e);
    CoordinateRow& row = e.coordinate_rows[at(position.joint)];
    e.coordinate[at(position.joint)] = row.value = s.along();
    e.coordinate_rate[at(position.joint)] = s.rate_along() + s.a.w * s.across();
    row.bias = 2.0 * s.a.w * s.rate_across() - s.a.w * s.a.w * s.along();
    row.jacobian[0] = -s.h_x;
    row.jacobian[1] = -s.h_y;
    row.jacobian[5] = s.across();
    row.jacobian[6] = s.h_x;
    row.jacobian[7] = s.h_y;
  }
}

}  // namespace freeplay::planar
