#include "linear/normal_matrix.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/OrderingMethods>

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr std::size_t densest = 24;  // products for each entry of G, beyond which S is too dense

bool same_column(const NormalMatrix::Entry& a, const NormalMatrix::Entry& b) { return a.column == b.column; }

}  // namespace

bool NormalMatrix::set_pattern(std::span<const double> mass, int rows, std::vector<Entry> entries) {
  const auto sort = [&] { std::ranges::sort(entries, {}, [](const Entry& e) { return std::pair(e.column, e.row); }); };
  sort();
  std::size_t count = 0;
  for (std::size_t i = 0, first = 0; i < entries.size(); ++i) {
    if (!same_column(entries[i], entries[first])) first = i;
    count += i - first + 1;
  }
  if (count > densest * entries.size()) return false;

  // Column and row of the upper part, each once, in order; smaller than triplets.
  const auto fill = [&] {
    std::vector<std::pair<int, int>> places;
    places.reserve(count);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      for (std::size_t k = i + 1; k-- > 0 && same_column(entries[k], entries[i]);) {
        places.emplace_back(entries[i].row, entries[k].row);
      }
    }
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    s_.resize(rows, rows);
    s_.resizeNonZeros(static_cast<Eigen::Index>(places.size()));
    std::fill_n(s_.outerIndexPtr(), rows + 1, 0);
    for (std::size_t i = 0; i < places.size(); ++i) {
      ++s_.outerIndexPtr()[places[i].first + 1];
      s_.innerIndexPtr()[i] = places[i].second;
      s_.valuePtr()[i] = 1.0;
    }
    std::partial_sum(s_.outerIndexPtr(), s_.outerIndexPtr() + rows + 1, s_.outerIndexPtr());
  };
  fill();
  Eigen::PermutationMatrix<Eigen::Dynamic> order;
  Eigen::AMDOrdering<int>()(Sparse(s_.selfadjointView<Eigen::Upper>()), order);
  order_.assign(at(rows), 0);
  for (int place = 0; place < rows; ++place) order_[at(order.indices()[place])] = place;
  for (Entry& entry : entries) entry.row = order_[at(entry.row)];
  sort();
  fill();

  inverse_mass_.clear();
  for (const double m : mass) inverse_mass_.push_back(1.0 / m);
  entries_ = std::move(entries);
  numbers_.assign(entries_.size(), 0.0);
  weighted_ = numbers_;
  multipliers_.resize(rows);
  const auto place_of = [&](int row, int column) {
    const int *begin = s_.innerIndexPtr() + s_.outerIndexPtr()[column],
              *end = s_.innerIndexPtr() + s_.outerIndexPtr()[column + 1];
    return static_cast<int>(std::lower_bound(begin, end, row) - s_.innerIndexPtr());
  };
  products_.clear();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    for (std::size_t k = i + 1; k-- > 0 && same_column(entries_[k], entries_[i]);) {
      products_.push_back({place_of(entries_[k].row, entries_[i].row), static_cast<int>(i), static_cast<int>(k)});
    }
  }
  diagonal_.clear();
  for (int r = 0; r < rows; ++r) diagonal_.push_back(place_of(r, r));
  factors_.analyzePattern(s_);
  return true;
}

double NormalMatrix::factor(std::span<const double> values) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    numbers_[i] = values[entries_[i].value];
    weighted_[i] = numbers_[i] * inverse_mass_[at(entries_[i].column)];
  }
  double* s = s_.valuePtr();
  std::fill_n(s, s_.nonZeros(), 0.0);
  for (const Product& p : products_) s[p.target] += numbers_[at(p.a)] * weighted_[at(p.b)];
  factors_.refactor(s_);
  if (factors_.info() != Eigen::Success) return 0.0;
  double smallest = 1.0;
  const auto& pivots = factors_.pivots();
  for (Eigen::Index r = 0; r < pivots.size(); ++r) {
    const double part = pivots[r] / s[diagonal_[static_cast<std::size_t>(r)]];
    if (!(part >= smallest)) smallest = part;  // keeps a NaN
  }
  return smallest > 0.0 ? smallest : 0.0;
}

void NormalMatrix::solve(std::span<const double> right, std::span<double> update) const {
  const std::size_t bodies = inverse_mass_.size();
  for (std::size_t r = 0; r < order_.size(); ++r) multipliers_[order_[r]] = -right[bodies + r];
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    multipliers_[entries_[i].row] += weighted_[i] * right[at(entries_[i].column)];
  }
  factors_.matrixL().solveInPlace(multipliers_);
  multipliers_.array() /= factors_.pivots().array();
  factors_.matrixU().solveInPlace(multipliers_);
  std::copy_n(right.begin(), bodies, update.begin());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    update[at(entries_[i].column)] -= numbers_[i] * multipliers_[entries_[i].row];
  }
  for (std::size_t i = 0; i < bodies; ++i) update[i] *= inverse_mass_[i];
  for (std::size_t r = 0; r < order_.size(); ++r) update[bodies + r] = multipliers_[order_[r]];
}

}  // namespace freeplay
