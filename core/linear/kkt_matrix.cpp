#include "linear/kkt_matrix.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/LU>
#include <klu.h>

namespace freeplay {
namespace {

constexpr double smallest_growth = 1e-6;  // of pivots that are used again: digits that may be lost
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

struct KktMatrix::Impl {
  int size = 0;
  std::vector<int> starts, rows;  // columns one after the other
  std::vector<double> values, factored;
  double pivots = 0.0;  // smallest over largest of `factored`
  // Of small matrices: rows in parts of their largest entry, factors, and the inverse of the whole.
  // Their largest size is told, so that nothing is allocated.
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, largest_dense, largest_dense>;
  Small dense, inverse;
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, largest_dense, 1> scale;
  Eigen::PartialPivLU<Small> lu;
  bool has_factors = false;
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;

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
    if (numeric != nullptr && common.status == KLU_OK) return true;
    klu_free_numeric(&numeric, &common);
    return false;
  }
};

double KktMatrix::Impl::invert() {
  dense.setZero();
  scale.setZero();
  for (int c = 0; c < size; ++c) {
    for (int i = starts[at(c)]; i < starts[at(c) + 1]; ++i) {
      dense(rows[at(i)], c) = values[at(i)];
      scale[rows[at(i)]] = std::max(scale[rows[at(i)]], std::abs(values[at(i)]));
    }
  }
  if (!(scale.minCoeff() > 0.0)) return 0.0;
  scale = scale.cwiseInverse();
  for (int c = 0; c < size; ++c) dense.col(c).array() *= scale.array();
  lu.compute(dense);
  const auto diagonal = lu.matrixLU().diagonal().cwiseAbs();
  const double smallest = diagonal.minCoeff(), largest = diagonal.maxCoeff();
  if (!(smallest > 0.0) || !std::isfinite(largest)) return 0.0;
  inverse.setIdentity();
  inverse.applyOnTheLeft(lu.permutationP());
  lu.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(inverse);
  lu.matrixLU().triangularView<Eigen::Upper>().solveInPlace(inverse);
  for (int c = 0; c < size; ++c) inverse.col(c) *= scale[c];
  return smallest / largest;
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
  std::partial_sum(m.starts.begin(), m.starts.end(), m.starts.begin());
  m.values.assign(m.rows.size(), 0.0);
  m.factored.assign(m.rows.size(), 0.0);
  m.has_factors = false;
  if (m.is_dense()) {
    m.dense = m.inverse = Impl::Small::Zero(size, size);
    m.scale.setZero(size);
    m.lu = Eigen::PartialPivLU<Impl::Small>(size);
  }
  return slots;
}

std::span<double> KktMatrix::values() { return impl_->values; }

double KktMatrix::factor() {
  Impl& m = *impl_;
  if (m.size == 0) return 1.0;
  // What does not change, as the masses of bodies without rows, costs a look.
  if (m.has_factors && m.values == m.factored) return m.pivots;
  m.has_factors = false;
  if (m.is_dense()) {
    m.pivots = m.invert();
    m.has_factors = m.pivots > 0.0;
    std::ranges::copy(m.values, m.factored.begin());
    return m.pivots;
  }
  if (!m.symbolic) m.symbolic = klu_analyze(m.size, m.starts.data(), m.rows.data(), &m.common);
  if (!m.symbolic || !(m.reuse_pivots() || m.choose_pivots())) return 0.0;
  std::ranges::copy(m.values, m.factored.begin());
  m.has_factors = true;
  m.pivots = klu_rcond(m.symbolic, m.numeric, &m.common) != 0 ? m.common.rcond : 0.0;
  return m.pivots;
}

void KktMatrix::solve(std::span<const double> b, std::span<double> x) const {
  Impl& m = *impl_;
  if (m.is_dense()) {
    Eigen::Map<Eigen::VectorXd>(x.data(), m.size).noalias() =
        m.inverse * Eigen::Map<const Eigen::VectorXd>(b.data(), m.size);
    return;
  }
  std::ranges::copy(b, x.begin());
  if (m.size > 0) klu_solve(m.symbolic, m.numeric, m.size, 1, x.data(), &m.common);
}

}  // namespace freeplay
