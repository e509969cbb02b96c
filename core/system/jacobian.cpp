#include "system/jacobian.h"

#include <algorithm>
#include <numeric>

#include "base/index.h"
#include "system/planar_kinematics.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

template <int width>
void add_transposed_blocks(std::span<const JacobianBlock> blocks, std::span<const double> all,
                           std::span<const double> lambda, std::span<double> out) {
  for (const JacobianBlock& block : blocks) {
    const double* entries = &all[at(block.offset)];
    double* to = &out[at(width * block.body)];
    double sum[width];
    std::copy_n(to, width, sum);
    for (int r = 0; r < block.rows; ++r, entries += width) {
      const double l = lambda[at(block.row + r)];
      for (int c = 0; c < width; ++c) sum[c] += entries[c] * l;
    }
    std::copy_n(sum, width, to);
  }
}

template <int width>
void multiply_rows(const ConstraintJacobian& jacobian, std::span<const double> all, std::span<const double> v,
                   std::span<double> out) {
  for (std::size_t r = 0; r < out.size(); ++r) {
    double sum = 0.0;
    for (const ConstraintJacobian::RowPiece& piece : jacobian.row_pieces(r)) {
      const double *entries = &all[at(piece.offset)], *from = &v[at(piece.velocity)];
      for (int c = 0; c < width; ++c) sum += entries[c] * from[c];
    }
    out[r] = sum;
  }
}

}  // namespace

int ConstraintJacobian::add(BodyId place, int row, int rows) {
  if (place == ground || rows == 0) return -1;
  const int offset = static_cast<int>(size_), width = layout_.body_velocities();
  if (row < layout_.nc()) {
    if (layout_.unknown(place) != ground) blocks_.push_back({row, rows, place, offset});
    for (int r = 0; layout_.unknown(place) == ground && r < rows; ++r) {
      couplings_.push_back({row + r, offset + r * width, place - layout_.free_bodies()});
    }
  }
  size_ += at(rows * width);
  return offset;
}

void ConstraintJacobian::sort_rows() {
  starts_.assign(at(layout_.nc()) + 1, 0);
  for (const JacobianBlock& block : blocks_) {
    for (int r = block.row; r < block.row + block.rows; ++r) ++starts_[at(r) + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  pieces_.resize(starts_.back());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  const int width = layout_.body_velocities();
  for (const JacobianBlock& block : blocks_) {
    for (int r = 0; r < block.rows; ++r) {
      pieces_[next[at(block.row + r)]++] = {block.offset + r * width, width * block.body};
    }
  }
}

void ConstraintJacobian::add_transposed(std::span<const double> entries, std::span<const double> lambda,
                                        std::span<double> out) const {
  if (layout_.body_velocities() == planar::velocities) {
    add_transposed_blocks<planar::velocities>(blocks_, entries, lambda, out);
  } else {
    add_transposed_blocks<spatial::velocities>(blocks_, entries, lambda, out);
  }
}

void ConstraintJacobian::multiply(std::span<const double> entries, std::span<const double> v,
                                  std::span<double> out) const {
  if (layout_.body_velocities() == planar::velocities) {
    multiply_rows<planar::velocities>(*this, entries, v, out);
  } else {
    multiply_rows<spatial::velocities>(*this, entries, v, out);
  }
}

void ConstraintJacobian::list(std::span<const double> entries, std::vector<SparseEntry>& out) const {
  const int width = layout_.body_velocities();
  out.clear();
  for (const JacobianBlock& block : blocks_) {
    const double* entry = &entries[at(block.offset)];
    for (int r = block.row; r < block.row + block.rows; ++r) {
      for (int c = 0; c < width; ++c) out.emplace_back(r, width * block.body + c, *entry++);
    }
  }
}

void ConstraintJacobian::move_with_driven(std::span<const double> entries, std::span<const double> rate,
                                          std::span<double> right) const {
  for (const Coupling& c : couplings_) {
    const double *row = &entries[at(c.offset)], *of_body = &rate[at(3 * c.body)];
    right[at(c.row)] = right[at(c.row)] - row[0] * of_body[0] - row[1] * of_body[1] - row[2] * of_body[2];
  }
}

void ConstraintJacobian::take_from_driven(std::span<const double> entries, std::span<const double> lambda,
                                          std::span<double> force) const {
  for (const Coupling& c : couplings_) {
    double* const on = &force[at(3 * c.body)];
    for (int i = 0; i < 3; ++i) on[i] -= entries[at(c.offset + i)] * lambda[at(c.row)];
  }
}

double ConstraintJacobian::power_from_driven(std::span<const double> entries, std::span<const double> lambda,
                                             std::span<const double> rate) const {
  double power = 0.0;
  for (const Coupling& c : couplings_) {
    if (c.row >= layout_.first_driver_row()) continue;
    for (int i = 0; i < 3; ++i) power += lambda[at(c.row)] * entries[at(c.offset + i)] * rate[at(3 * c.body + i)];
  }
  return power;
}

}  // namespace freeplay
