#include "run/internal_elimination.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

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

InternalElimination::InternalElimination(const System& system)
    : system_(system), residual_(at(system.layout().nz()), 0.0) {
  std::size_t total = 0, widest = 0;
  for (std::size_t f = 0; f < system.force_blocks().size(); ++f) {
    const ForceBlock& block = system.force_blocks()[f];
    if (block.internal == 0) continue;
    const std::size_t nz = at(block.internal);
    blocks_.push_back({f,
                       block.internal,
                       system.layout().internal(block.joint).offset,
                       {block.a, block.b},
                       total,
                       total + nz * nz,
                       total + nz * nz + 6 * nz});
    total += nz * nz + 12 * nz;
    widest = std::max(widest, nz * nz + nz * (nz + 6));
  }
  numbers_.resize(total + widest);  // work space of prepare() at the end
}

void InternalElimination::prepare(Evaluation& e, double beta_q, double beta_v, double beta_z) {
  for (const Block& block : blocks_) {
    const InternalDerivatives d(system_.force_blocks()[block.force_block], e.internal_derivatives);
    const int nz = block.size;
    const std::size_t square = at(nz * nz), columns = at(nz + 6);
    double* matrix = &numbers_[numbers_.size() - square - at(nz) * columns];
    double* right = matrix + square;
    for (int r = 0; r < nz; ++r) {
      for (int c = 0; c < nz; ++c) {
        matrix[r * nz + c] = (r == c ? 1.0 : 0.0) - beta_z * d.rate_z[at(r * nz + c)];
        right[at(r) * columns + at(c)] = r == c ? 1.0 : 0.0;
      }
      for (int c = 0; c < 6; ++c) {
        right[at(r) * columns + at(nz + c)] = beta_q * d.rate_q[at(6 * r + c)] + beta_v * d.rate_v[at(6 * r + c)];
      }
    }
    solve_small(matrix, nz, right, nz + 6);
    for (int r = 0; r < nz; ++r) {
      for (int c = 0; c < nz; ++c) numbers_[block.inverse + at(r * nz + c)] = right[at(r) * columns + at(c)];
      for (int c = 0; c < 6; ++c) numbers_[block.slope + at(6 * r + c)] = right[at(r) * columns + at(nz + c)];
    }
    for (std::size_t i = 0; i < at(6 * nz); ++i) numbers_[block.force + i] = beta_z * d.force_z[i];
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
    for (int r = 0; r < 6; ++r) {
      const int body = block.bodies[r / 3];
      if (body == ground) continue;
      for (int z = 0; z < block.size; ++z) {
        right[at(3 * body + r % 3)] += force(block, r, z) * residual_[at(block.offset + z)];
      }
    }
  }
}

double InternalElimination::advance(std::span<const double> change, double beta_z, std::span<const double> z,
                                    std::span<double> z_rate) const {
  double largest = 0.0;
  for (const Block& block : blocks_) {
    for (int i = 0; i < block.size; ++i) {
      const std::size_t index = at(block.offset + i);
      double sum = residual_[index];
      for (int c = 0; c < 6; ++c) {
        const int body = block.bodies[c / 3];
        if (body != ground) sum += slope(block, i, c) * change[at(3 * body + c % 3)];
      }
      z_rate[index] += sum;
      const double size = std::max(std::abs(z[index]), beta_z * std::abs(z_rate[index]));
      if (sum != 0.0) largest = std::max(largest, beta_z * std::abs(sum) / size);
    }
  }
  return largest;
}

}  // namespace freeplay
