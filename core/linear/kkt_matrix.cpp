#include "linear/kkt_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>

#include <Eigen/Core>
#include <klu.h>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double smallest_growth = 1e-6;  // of pivots that are used again: digits that may be lost

// Loops of our own: with a dozen unknowns, Eigen spends most of its time on choosing its way through larger matrices.

/// a, by columns, becomes its inverse, by Gauss and Jordan, who take the rows in `order`, with a pivot chosen in every
/// row; `place` is room for `size` numbers. What is zero already costs a look. Returns the smallest pivot over the
/// largest, 0 for a singular matrix, of which nothing is left.
double invert(double* a, int size, const int* order, int* place) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  const auto column = [&](int c) { return a + c * size; };
  for (int step = 0; step < size; ++step) {
    const int k = order[step];
    int chosen = k;
    for (int later = step + 1; later < size; ++later) {
      if (std::abs(column(order[later])[k]) > std::abs(column(chosen)[k])) chosen = order[later];
    }
    place[step] = chosen;
    double* const own = column(k);
    if (chosen != k) std::swap_ranges(own, own + size, column(chosen));
    const double pivot = std::abs(own[k]);
    smallest = std::min(smallest, pivot);
    largest = std::max(largest, pivot);
    if (!(pivot > 0.0)) return 0.0;
    const double inverse = 1.0 / own[k];
    own[k] = 1.0;
    for (int r = 0; r < size; ++r) own[r] *= inverse;
    for (int c = 0; c < size; ++c) {
      double* const other = column(c);
      const double factor = other[k];
      if (c == k || factor == 0.0) continue;
      other[k] = 0.0;
      for (int r = 0; r < size; ++r) other[r] -= factor * own[r];
    }
  }
  // Columns that changed places are rows of the inverse.
  for (int step = size; step-- > 0;) {
    const int k = order[step], other = place[step];
    if (other == k) continue;
    for (int c = 0; c < size; ++c) std::swap(column(c)[k], column(c)[other]);
  }
  return std::isfinite(largest) ? smallest / largest : 0.0;
}

/// So many numbers of y = a x: they stay in registers while x is gone through.
template <int rows>
void multiply_rows(const double* a, int size, const double* x, double* y) {
  using Rows = Eigen::Matrix<double, rows, 1>;
  Rows sum = Rows::Zero();
  for (int c = 0; c < size; ++c, a += size) sum += Eigen::Map<const Rows>(a) * x[c];
  Eigen::Map<Rows> out(y);
  out = sum;
}

/// y = a x with a square matrix by columns.
void multiply(const double* a, int size, const double* x, double* y) {
  int r = 0;
  for (; r + 8 <= size; r += 8) multiply_rows<8>(a + r, size, x, y + r);
  if (size - r >= 4) {
    multiply_rows<4>(a + r, size, x, y + r);
    r += 4;
  }
  if (size - r >= 2) {
    multiply_rows<2>(a + r, size, x, y + r);
    r += 2;
  }
  if (r < size) multiply_rows<1>(a + r, size, x, y + r);
}

}  // namespace

struct KktMatrix::Impl {
  int size = 0;
  std::vector<int> starts, rows;  // columns one after the other
  std::vector<double> values, factored;
  double pivots = 0.0;  // smallest over largest of `factored`
  // Of small matrices: the inverse of the whole, by columns, and what it takes to find it.
  std::vector<double> inverse, scale;
  std::vector<int> order, place;
  bool has_factors = false;
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  std::vector<double> pivoted;  // values by which the pivots of `numeric` were chosen
  bool has_new_pivots = false;  // the last factors chose them

  Impl() {
    klu_defaults(&common);
    // In passes over the matrix: without a limit the search for a diagonal takes the square of the size.
    common.maxwork = 10;
  }
  ~Impl() { forget(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void forget() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }

  bool reuse_pivots() {
    has_new_pivots = false;
    return numeric != nullptr &&
           klu_refactor(starts.data(), rows.data(), values.data(), symbolic, numeric, &common) != 0 &&
           common.status == KLU_OK &&
           klu_rgrowth(starts.data(), rows.data(), values.data(), symbolic, numeric, &common) != 0 &&
           common.rgrowth > smallest_growth;
  }

  bool is_dense() const { return size <= largest_dense; }
  double invert();

  bool choose_pivots() {
    klu_free_numeric(&numeric, &common);
    numeric = klu_factor(starts.data(), rows.data(), values.data(), symbolic, &common);
    if (numeric != nullptr && common.status == KLU_OK) {
      std::ranges::copy(values, pivoted.begin());
      return has_new_pivots = true;
    }
    klu_free_numeric(&numeric, &common);
    return false;
  }
};

// Rows in parts of their largest entry.
double KktMatrix::Impl::invert() {
  std::ranges::fill(inverse, 0.0);
  std::ranges::fill(scale, 0.0);
  for (std::size_t i = 0; i < rows.size(); ++i) scale[at(rows[i])] = std::max(scale[at(rows[i])], std::abs(values[i]));
  for (double& size_of_row : scale) {
    if (!(size_of_row > 0.0)) return 0.0;
    size_of_row = 1.0 / size_of_row;
  }
  for (int c = 0; c < size; ++c) {
    for (int i = starts[at(c)]; i < starts[at(c) + 1]; ++i) {
      inverse[at(c * size + rows[at(i)])] = values[at(i)] * scale[at(rows[at(i)])];
    }
  }
  const double regularity = freeplay::invert(inverse.data(), size, order.data(), place.data());
  for (int c = 0; c < size; ++c) {
    for (int r = 0; r < size; ++r) inverse[at(c * size + r)] *= scale[at(c)];
  }
  return regularity;
}

KktMatrix::KktMatrix() : impl_(std::make_unique<Impl>()) {}
KktMatrix::KktMatrix(KktMatrix&&) noexcept = default;
KktMatrix& KktMatrix::operator=(KktMatrix&&) noexcept = default;
KktMatrix::~KktMatrix() = default;

std::vector<int> KktMatrix::set_pattern(int size, std::span<const MatrixEntry> entries) {
  Impl& m = *impl_;
  m.forget();
  m.size = size;
  std::vector<int> order(entries.size());
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](int i) { return std::pair(entries[at(i)].column, entries[at(i)].row); };
  std::ranges::sort(order, [&](int a, int b) { return place(a) < place(b); });
  std::vector<int> slots(entries.size());
  m.rows.clear();
  m.starts.assign(at(size) + 1, 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto [column, row] = place(order[i]);
    if (i == 0 || place(order[i - 1]) != std::pair(column, row)) {
      m.rows.push_back(row);
      ++m.starts[at(column) + 1];
    }
    slots[at(order[i])] = static_cast<int>(m.rows.size()) - 1;
  }
  m.rows.shrink_to_fit();
  std::partial_sum(m.starts.begin(), m.starts.end(), m.starts.begin());
  m.values.assign(m.rows.size(), 0.0);
  m.factored.assign(m.is_dense() ? m.rows.size() : 0, 0.0);
  m.pivoted.assign(m.is_dense() ? 0 : m.rows.size(), 0.0);
  m.has_factors = false;
  if (m.is_dense()) {
    m.inverse.assign(at(size * size), 0.0);
    m.scale.assign(at(size), 0.0);
    m.place.assign(at(size), 0);
    m.order.resize(at(size));
    std::iota(m.order.begin(), m.order.end(), 0);
    // Unknowns that many others share come last, so that little fills in.
    std::ranges::stable_sort(m.order, {}, [&](int c) { return m.starts[at(c) + 1] - m.starts[at(c)]; });
  }
  return slots;
}

std::span<double> KktMatrix::values() { return impl_->values; }

double KktMatrix::factor() {
  Impl& m = *impl_;
  if (m.size == 0) return 1.0;
  // What does not change, as the masses of bodies without rows, costs a look; of large matrices a copy would cost more.
  if (m.has_factors && m.is_dense() && m.values == m.factored) return m.pivots;
  m.has_factors = false;
  if (m.is_dense()) {
    m.pivots = m.invert();
    m.has_factors = m.pivots > 0.0;
    std::ranges::copy(m.values, m.factored.begin());
    return m.pivots;
  }
  if (!m.symbolic) m.symbolic = klu_analyze(m.size, m.starts.data(), m.rows.data(), &m.common);
  if (!m.symbolic || !(m.reuse_pivots() || m.choose_pivots())) {
    if (m.common.status == KLU_OUT_OF_MEMORY) throw std::bad_alloc();  // which is no singular matrix
    return 0.0;
  }
  m.pivots = klu_rcond(m.symbolic, m.numeric, &m.common) != 0 ? m.common.rcond : 0.0;
  return m.pivots;
}

void KktMatrix::save(ArchiveWriter& archive) const {
  const Impl& m = *impl_;
  archive(m.values, m.has_factors, m.numeric != nullptr, m.has_new_pivots, m.pivoted);
}

// Factors by old pivots depend on two matrices: the present one, and that by which the pivots were chosen.
void KktMatrix::restore(ArchiveReader& archive) {
  Impl& m = *impl_;
  bool has_inverse = false, has_pivots = false;
  archive(m.values, has_inverse, has_pivots, m.has_new_pivots, m.pivoted);
  if (has_inverse) factor();
  if (!has_pivots) return;
  const std::vector<double> present = m.values;
  const bool new_pivots = m.has_new_pivots;
  std::ranges::copy(m.pivoted, m.values.begin());
  if (!m.symbolic) m.symbolic = klu_analyze(m.size, m.starts.data(), m.rows.data(), &m.common);
  ArchiveReader::require(m.symbolic != nullptr && m.choose_pivots());
  m.values = present;
  if (!new_pivots) ArchiveReader::require(m.reuse_pivots());
}

void KktMatrix::solve(std::span<const double> b, std::span<double> x) const {
  Impl& m = *impl_;
  if (m.is_dense()) {
    return multiply(m.inverse.data(), m.size, b.data(), x.data());
  }
  std::ranges::copy(b, x.begin());
  if (m.size > 0) klu_solve(m.symbolic, m.numeric, m.size, 1, x.data(), &m.common);
}

}  // namespace freeplay
