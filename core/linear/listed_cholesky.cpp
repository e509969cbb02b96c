#include "linear/listed_cholesky.h"

#include <algorithm>

#include "base/index.h"

namespace freeplay {

bool ListedCholesky::set_pattern(int size, const std::vector<std::pair<int, int>>& entries, std::size_t most) {
  std::vector<std::vector<int>> below(at(size));  // rows of each column of L
  for (const auto& [row, column] : entries) {
    if (row != column) below[at(column)].push_back(row);
  }
  // What a column has below its first row goes into the column of that row.
  std::size_t operations = 0, count = 0;
  for (int c = 0; c < size; ++c) {
    std::vector<int>& own = below[at(c)];
    std::ranges::sort(own);
    own.erase(std::unique(own.begin(), own.end()), own.end());
    count += own.size() + 1;
    operations += own.size() * (own.size() + 1) / 2;
    if (operations > most) return false;
    if (own.size() < 2) continue;
    std::vector<int>& parent = below[at(own.front())];
    parent.insert(parent.end(), own.begin() + 1, own.end());
  }
  starts_.assign(1, 0);
  rows_.clear();
  rows_.reserve(count);
  for (int c = 0; c < size; ++c) {
    rows_.push_back(c);
    rows_.insert(rows_.end(), below[at(c)].begin(), below[at(c)].end());
    starts_.push_back(static_cast<int>(rows_.size()));
    below[at(c)] = {};
  }
  targets_.clear();
  targets_.reserve(operations);
  for (int c = 0; c < size; ++c) {
    for (int a = starts_[at(c)] + 1; a < starts_[at(c) + 1]; ++a) {
      for (int b = a; b < starts_[at(c) + 1]; ++b) targets_.push_back(place(rows_[at(b)], rows_[at(a)]));
    }
  }
  values_.assign(rows_.size(), 0.0);
  inverse_.assign(at(size), 0.0);
  return true;
}

int ListedCholesky::place(int row, int column) const {
  const auto begin = rows_.begin() + starts_[at(column)], end = rows_.begin() + starts_[at(column) + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - rows_.begin());
}

void ListedCholesky::factor() {
  double* const v = values_.data();
  const int* target = targets_.data();
  for (std::size_t c = 0; c < inverse_.size(); ++c) {
    const int end = starts_[c + 1];
    const double inverse = inverse_[c] = 1.0 / v[starts_[c]];
    for (int a = starts_[c] + 1; a < end; ++a) {
      const double factor = v[a] * inverse;
      for (int b = a; b < end; ++b) v[*target++] -= factor * v[b];
      v[a] = factor;
    }
  }
}

void ListedCholesky::solve(std::span<double> x) const {
  const std::size_t size = inverse_.size();
  const double* const v = values_.data();
  for (std::size_t c = 0; c < size; ++c) {
    for (int i = starts_[c] + 1; i < starts_[c + 1]; ++i) x[at(rows_[at(i)])] -= v[i] * x[c];
  }
  for (std::size_t c = size; c-- > 0;) {
    double sum = x[c] * inverse_[c];
    for (int i = starts_[c] + 1; i < starts_[c + 1]; ++i) sum -= v[i] * x[at(rows_[at(i)])];
    x[c] = sum;
  }
}

}  // namespace freeplay
