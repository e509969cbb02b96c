#include "stage/internal_elimination.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double vanishing_part = 1e-4;  // of the largest variable of a joint
constexpr double left_over = 1e-15;      // of the largest rate that the iteration came by: its rounding

// Gauss-Jordan with partial pivoting, in place on a small row-major matrix and its right sides.
void solve_small(double* matrix, int size, double* right, int columns) {
  for (int pivot = 0; pivot < size; ++pivot) {
    int best = pivot;
    for (int r = pivot + 1; r < size; ++r) {
      if (std::abs(matrix[r * size + pivot]) > std::abs(matrix[best * size + pivot])) best = r;
    }
    if (best != pivot) {
      std::swap_ranges(matrix + best * size, matrix + (best + 1) * size, matrix + pivot * size);
      std::swap_ranges(right + best * columns, right + (best + 1) * columns, right + pivot * columns);
    }
    const double inverse = 1.0 / matrix[pivot * size + pivot];
    for (int c = 0; c < size; ++c) matrix[pivot * size + c] *= inverse;
    for (int c = 0; c < columns; ++c) right[pivot * columns + c] *= inverse;
    for (int r = 0; r < size; ++r) {
      const double factor = r == pivot ? 0.0 : matrix[r * size + pivot];
      if (factor == 0.0) continue;
      for (int c = 0; c < size; ++c) matrix[r * size + c] -= factor * matrix[pivot * size + c];
      for (int c = 0; c < columns; ++c) right[r * columns + c] -= factor * right[pivot * columns + c];
    }
  }
}

}  // namespace

InternalElimination::InternalElimination(const Layout& layout, const Forces& forces)
    : layout_(layout), forces_(forces), columns_(2 * layout.body_velocities()), residual_(at(layout.nz()), 0.0) {
  std::size_t total = 0, widest = 0;
  for (std::size_t f = 0; f < forces.blocks().size(); ++f) {
    const ForceBlock& block = forces.blocks()[f];
    if (block.internal == 0) continue;
    const std::size_t nz = at(block.internal);
    blocks_.push_back({f,
                       block.internal,
                       layout.internal(block.joint).offset,
                       {block.a, block.b},
                       total,
                       total + nz * nz,
                       total + nz * nz + at(columns_) * nz});
    total += nz * nz + 2 * at(columns_) * nz;
    widest = std::max(widest, nz * nz + nz * (nz + at(columns_)));
  }
  numbers_.resize(total + widest);  // work space of prepare() at the end
}

void InternalElimination::prepare(Evaluation& e, double beta_q, double beta_v, double beta_z) {
  for (const Block& block : blocks_) {
    const InternalDerivatives d =
        internal_derivatives(forces_.blocks()[block.force_block], layout_.body_velocities(), e.internal_derivatives);
    const int nz = block.size;
    const std::size_t square = at(nz * nz), columns = at(nz + columns_);
    double* matrix = &numbers_[numbers_.size() - square - at(nz) * columns];
    double* right = matrix + square;
    for (int r = 0; r < nz; ++r) {
      for (int c = 0; c < nz; ++c) {
        matrix[r * nz + c] = (r == c ? 1.0 : 0.0) - beta_z * d.rate_z[at(r * nz + c)];
        right[at(r) * columns + at(c)] = r == c ? 1.0 : 0.0;
      }
      for (int c = 0; c < columns_; ++c) {
        const std::size_t i = at(columns_ * r + c);
        right[at(r) * columns + at(nz + c)] = beta_q * d.rate_q[i] + beta_v * d.rate_v[i];
      }
    }
    solve_small(matrix, nz, right, nz + columns_);
    for (int r = 0; r < nz; ++r) {
      for (int c = 0; c < nz; ++c) numbers_[block.inverse + at(r * nz + c)] = right[at(r) * columns + at(c)];
      for (int c = 0; c < columns_; ++c)
        numbers_[block.slope + at(columns_ * r + c)] = right[at(r) * columns + at(nz + c)];
    }
    for (std::size_t i = 0; i < at(columns_ * nz); ++i) numbers_[block.force + i] = beta_z * d.force_z[i];
  }
}

void InternalElimination::add_to_right(std::span<const double> internal_rate, std::span<const double> z_rate,
                                       std::span<double> right) {
  for (const Block& block : blocks_) {
    for (int z = 0; z < block.size; ++z) {
      double sum = 0.0;
      for (int k = 0; k < block.size; ++k) {
        const std::size_t i = at(block.offset + k);
        sum += numbers_[block.inverse + at(z * block.size + k)] * (internal_rate[i] - z_rate[i]);
      }
      residual_[at(block.offset + z)] = sum;
    }
    const int width = columns_ / 2;
    for (int r = 0; r < columns_; ++r) {
      const int body = block.bodies[r / width];
      if (body == ground) continue;
      for (int z = 0; z < block.size; ++z) {
        right[at(width * body + r % width)] += force(block, r, z) * residual_[at(block.offset + z)];
      }
    }
  }
}

double InternalElimination::advance(std::span<const double> change, double beta_z, std::span<const double> z,
                                    std::span<double> z_rate, std::span<double> largest_rate) const {
  double largest = 0.0;
  for (const Block& block : blocks_) {
    // Components of a vector that vanish but for rounding never settle by their own measure.
    double vanishing = 0.0;
    for (std::size_t i = at(block.offset); i < at(block.offset + block.size); ++i) {
      vanishing = std::max({vanishing, vanishing_part * std::abs(z[i]), vanishing_part * beta_z * std::abs(z_rate[i])});
    }
    for (int i = 0; i < block.size; ++i) {
      const std::size_t index = at(block.offset + i);
      double sum = residual_[index];
      const int width = columns_ / 2;
      for (int c = 0; c < columns_; ++c) {
        const int body = block.bodies[c / width];
        if (body != ground) sum += slope(block, i, c) * change[at(width * body + c % width)];
      }
      z_rate[index] += sum;
      // A rate that converges to zero, as in a clutch that is free from its first step on, ends at its rounding.
      largest_rate[index] = std::max(largest_rate[index], std::abs(z_rate[index]));
      if (std::abs(z_rate[index]) <= left_over * largest_rate[index]) z_rate[index] = 0.0;
      const double size = std::max({std::abs(z[index]), beta_z * std::abs(z_rate[index]), vanishing});
      if (sum != 0.0) largest = std::max(largest, beta_z * std::abs(sum) / size);
    }
  }
  return largest;
}

}  // namespace freeplay
