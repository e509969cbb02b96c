// AnchoredBody: the rows of a saddle-point system that hold one body and nothing else, eliminated with that body.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace freeplay {

/// A body that joints with the ground or with given motions hold, all but wholly. What other rows, g, still move of it
/// has the inverse mass  W' = W - W G^T S^-1 G W  with W = M^-1, its own rows G and S = G W G^T (see NormalMatrix).
/// Loops have a known length here.
template <int width>
struct AnchoredBody {
  /// Rows that leave a body of `width` freedoms at least one.
  static constexpr int most_rows = width - 1;

  int body = 0, rows = 0;
  std::array<int, most_rows> piece{}, row{};   // of each row: where its numbers and its multiplier are
  std::size_t first_other = 0, end_other = 0;  // the range of pieces of other rows that hold the body, too

  /// Factors L D L^T. Returns the smallest pivot in parts of its diagonal entry.
  template <int count>
  double factor(std::span<const double> numbers, std::span<const double> inverse_mass) {
    const double* const inverse = &inverse_mass[width * static_cast<std::size_t>(body)];
    double diagonal[count];
    for (int r = 0; r < count; ++r) {
      const double* const g = piece_of(numbers, r);
      for (int c = 0; c < width; ++c) weighted_[r][c] = g[c] * inverse[c];
      for (int k = 0; k <= r; ++k) {
        double sum = g[0] * weighted_[k][0];
        for (int c = 1; c < width; ++c) sum += g[c] * weighted_[k][c];
        s_[r][k] = sum;
      }
      diagonal[r] = s_[r][r];
    }
    double smallest = 1.0;
    for (int c = 0; c < count; ++c) {
      const double part = s_[c][c] / diagonal[c];
      if (part < smallest || std::isnan(part)) smallest = part;
      const double inverse_pivot = s_[c][c] = 1.0 / s_[c][c];
      for (int a = c + 1; a < count; ++a) {
        const double factor = s_[a][c] * inverse_pivot;
        for (int b = a; b < count; ++b) s_[b][a] -= factor * s_[b][c];
        s_[a][c] = factor;
      }
    }
    return smallest;
  }

  /// Of another row, with the numbers g: from W g^T to W' g^T, and in `shares` S^-1 G W g^T.
  template <int count>
  void reduce(const double* g, double* weighted, double* shares) const {
    for (int r = 0; r < count; ++r) {
      double sum = 0.0;
      for (int c = 0; c < width; ++c) sum += weighted_[r][c] * g[c];
      for (int k = 0; k < r; ++k) sum -= s_[r][k] * shares[k];
      shares[r] = sum;
    }
    back_substitute<count>(shares);
    for (int r = 0; r < count; ++r) {
      for (int c = 0; c < width; ++c) weighted[c] -= weighted_[r][c] * shares[r];
    }
  }

  /// From x = b and l = c to the multipliers l and x = W (b - G^T l); b holds the forces of all other rows.
  template <int count>
  void substitute(std::span<const double> numbers, std::span<const double> inverse_mass, std::span<double> x,
                  std::span<double> l) const {
    const std::size_t first = width * static_cast<std::size_t>(body);
    double b[width], multiplier[count];
    for (std::size_t c = 0; c < width; ++c) b[c] = x[first + c];
    for (int r = 0; r < count; ++r) {
      double sum = -l[static_cast<std::size_t>(row[static_cast<std::size_t>(r)])];
      for (int c = 0; c < width; ++c) sum += weighted_[r][c] * b[c];
      for (int k = 0; k < r; ++k) sum -= s_[r][k] * multiplier[k];
      multiplier[r] = sum;
    }
    back_substitute<count>(multiplier);
    for (int r = 0; r < count; ++r) {
      const double* const g = piece_of(numbers, r);
      for (int c = 0; c < width; ++c) b[c] -= g[c] * multiplier[r];
      l[static_cast<std::size_t>(row[static_cast<std::size_t>(r)])] = multiplier[r];
    }
    for (std::size_t c = 0; c < width; ++c) x[first + c] = b[c] * inverse_mass[first + c];
  }

 private:
  template <int count>
  void back_substitute(double* l) const {
    for (int r = count; r-- > 0;) {
      l[r] *= s_[r][r];
      for (int k = r + 1; k < count; ++k) l[r] -= s_[k][r] * l[k];
    }
  }
  const double* piece_of(std::span<const double> numbers, int r) const {
    return &numbers[width * static_cast<std::size_t>(piece[static_cast<std::size_t>(r)])];
  }
  double weighted_[most_rows][width] = {};  // G M^-1
  double s_[most_rows][most_rows] = {};     // L below the diagonal, which holds 1 / D
};

}  // namespace freeplay
