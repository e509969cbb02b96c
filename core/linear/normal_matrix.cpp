#include "linear/normal_matrix.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr std::size_t densest = 24;        // products for each number of G, beyond which S is too dense
constexpr std::size_t most_filled = 1000;  // operations for each number of G, beyond which its factors are

// Of a row: its place in an order that keeps the factors sparse.
std::vector<int> sparse_order(int rows, const std::vector<std::pair<int, int>>& places) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * places.size());
  for (const auto& [row, column] : places) {
    entries.emplace_back(row, column, 1.0);
    if (row != column) entries.emplace_back(column, row, 1.0);
  }
  Eigen::SparseMatrix<double> s(rows, rows);
  s.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic> order;
  Eigen::AMDOrdering<int>()(s, order);
  std::vector<int> out(at(rows));
  for (int place = 0; place < rows; ++place) out[at(order.indices()[place])] = place;
  return out;
}

// Of a call with the number of rows as a constant.
template <int width, class Call>
auto by_rows(int rows, Call&& call) {
  if constexpr (width == 6) {
    switch (rows) {
      case 3:
        return call.template operator()<3>();
      case 4:
        return call.template operator()<4>();
      case 5:
        return call.template operator()<5>();
      default:
        break;
    }
  }
  return rows == 1 ? call.template operator()<1>() : call.template operator()<2>();
}

}  // namespace

// Takes out the rows that hold one body alone, where they leave it a freedom; returns the rows that are left.
template <int width>
std::vector<int> NormalMatrix::find_anchored(int rows, std::span<const Piece> pieces) {
  std::vector<int> bodies_of_row(at(rows), 0), own_rows(inverse_mass_.size() / at(width), 0);
  for (const Piece& piece : pieces) ++bodies_of_row[at(piece.row)];
  for (const Piece& piece : pieces) own_rows[at(piece.body)] += bodies_of_row[at(piece.row)] == 1 ? 1 : 0;
  std::vector<AnchoredBody<width>>& bodies = anchored<width>(*this);
  bodies.clear();
  std::vector<int> index(own_rows.size(), -1);  // in `bodies`
  std::vector<char> taken(at(rows), 0);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const auto& [row, body] = pieces[p];
    if (bodies_of_row[at(row)] > 1 || own_rows[at(body)] > AnchoredBody<width>::most_rows) continue;
    if (index[at(body)] < 0) {
      index[at(body)] = static_cast<int>(bodies.size());
      bodies.emplace_back().body = body;
    }
    AnchoredBody<width>& own = bodies[at(index[at(body)])];
    own.row[at(own.rows)] = row;
    own.piece[at(own.rows++)] = static_cast<int>(p);
    taken[at(row)] = 1;
  }
  not_anchored_.clear();
  for (std::size_t b = 0; b < index.size(); ++b) {
    if (index[b] < 0) not_anchored_.push_back(width * b);
  }
  std::vector<int> left;
  for (int r = 0; r < rows; ++r) {
    if (!taken[at(r)]) left.push_back(r);
  }
  return left;
}

bool NormalMatrix::set_pattern(std::span<const double> mass, int width, int rows, std::span<const Piece> pieces) {
  width_ = width;
  return width == 3 ? set_pattern_in<3>(mass, rows, pieces) : set_pattern_in<6>(mass, rows, pieces);
}

template <int width>
bool NormalMatrix::set_pattern_in(std::span<const double> mass, int rows, std::span<const Piece> pieces) {
  inverse_mass_.clear();
  for (const double m : mass) inverse_mass_.push_back(1.0 / m);
  const std::vector<int> left = find_anchored<width>(rows, pieces);
  std::vector<int> number(at(rows), -1);
  for (std::size_t i = 0; i < left.size(); ++i) number[at(left[i])] = static_cast<int>(i);
  pieces_.clear();
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const int row = number[at(pieces[p].row)];
    if (row >= 0) pieces_.push_back({row, width * pieces[p].body, width * static_cast<int>(p)});
  }
  // Pieces of one body, one after another.
  std::vector<int> by_body(pieces_.size());
  std::iota(by_body.begin(), by_body.end(), 0);
  const auto body_of = [&](int i) { return pieces_[at(i)].column / width; };
  std::ranges::sort(by_body, {}, [&](int i) { return std::pair(body_of(i), i); });
  std::vector<std::pair<int, int>> pairs;  // of pieces
  for (std::size_t i = 0, first = 0; i < by_body.size(); ++i) {
    if (body_of(by_body[i]) != body_of(by_body[first])) first = i;
    for (std::size_t k = first; k <= i; ++k) pairs.emplace_back(by_body[i], by_body[k]);
    if (pairs.size() > densest * pieces_.size()) return false;
  }
  const auto places = [&] {
    std::vector<std::pair<int, int>> out;
    out.reserve(pairs.size());
    for (const auto& [a, b] : pairs) {
      const auto [low, high] = std::minmax({pieces_[at(a)].row, pieces_[at(b)].row});
      out.emplace_back(high, low);
    }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  };
  const int between = static_cast<int>(left.size());
  const std::vector<int> order = sparse_order(between, places());
  for (Other& piece : pieces_) piece.row = order[at(piece.row)];
  if (!factors_.set_pattern(between, places(), most_filled * pieces_.size())) return false;

  rows_.resize(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) rows_[at(order[i])] = left[i];
  products_.clear();
  products_.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    const auto [low, high] = std::minmax({pieces_[at(a)].row, pieces_[at(b)].row});
    products_.push_back({factors_.place(high, low), pieces_[at(a)].numbers, width * b});
  }
  others_.clear();
  for (AnchoredBody<width>& own : anchored<width>(*this)) {
    own.first_other = others_.size();
    others_.insert(others_.end(), std::ranges::lower_bound(by_body, own.body, {}, body_of),
                   std::ranges::upper_bound(by_body, own.body, {}, body_of));
    own.end_other = others_.size();
  }
  shares_.assign(at(AnchoredBody<width>::most_rows) * others_.size(), 0.0);
  weighted_.assign(at(width) * pieces_.size(), 0.0);
  diagonal_.assign(left.size(), 0.0);
  multipliers_.assign(left.size(), 0.0);
  return true;
}

template <int width>
void NormalMatrix::weigh(std::span<const double> numbers) {
  std::ranges::fill(diagonal_, 0.0);
  double* weighted = weighted_.data();
  for (const Other& piece : pieces_) {
    const double *inverse = &inverse_mass_[at(piece.column)], *g = &numbers[at(piece.numbers)];
    double sum = 0.0;
    for (int c = 0; c < width; ++c) {
      weighted[c] = g[c] * inverse[c];
      sum += g[c] * weighted[c];
    }
    diagonal_[at(piece.row)] += sum;
    weighted += width;
  }
}

template <int width>
double NormalMatrix::eliminate_anchored(std::span<const double> numbers) {
  double smallest = 1.0;
  for (AnchoredBody<width>& own : anchored<width>(*this)) {
    const double part = by_rows<width>(own.rows, [&]<int count>() {
      const double pivot = own.template factor<count>(numbers, inverse_mass_);
      for (std::size_t i = own.first_other; i < own.end_other; ++i) {
        const std::size_t p = at(others_[i]);
        own.template reduce<count>(&numbers[at(pieces_[p].numbers)], &weighted_[width * p],
                                   &shares_[AnchoredBody<width>::most_rows * i]);
      }
      return pivot;
    });
    if (part < smallest || std::isnan(part)) smallest = part;
  }
  return smallest;
}

template <int width>
void NormalMatrix::multiply(std::span<const double> numbers) {
  double* const s = factors_.values().data();
  std::ranges::fill(factors_.values(), 0.0);
  for (const Product& product : products_) {
    const double *a = &numbers[at(product.a)], *b = &weighted_[at(product.b)];
    double sum = a[0] * b[0];
    for (int c = 1; c < width; ++c) sum += a[c] * b[c];
    s[product.target] += sum;
  }
}

template <int width>
double NormalMatrix::factor_in(std::span<const double> numbers) {
  weigh<width>(numbers);
  double smallest = eliminate_anchored<width>(numbers);
  multiply<width>(numbers);
  factors_.factor();
  const std::span<const double> s = factors_.values();
  for (std::size_t r = 0; r < diagonal_.size(); ++r) {
    const double pivot = s[at(factors_.diagonal(static_cast<int>(r)))];
    if (pivot < smallest * diagonal_[r] || std::isnan(pivot)) smallest = pivot / diagonal_[r];
  }
  return smallest > 0.0 ? smallest : 0.0;
}

double NormalMatrix::factor(std::span<const double> numbers) {
  return width_ == 3 ? factor_in<3>(numbers) : factor_in<6>(numbers);
}

template <int width>
void NormalMatrix::substitute(std::span<const double> numbers, std::span<double> x, std::span<double> l) {
  if (!rows_.empty()) solve_others<width>(numbers, x, l);
  for (const AnchoredBody<width>& own : anchored<width>(*this)) {
    by_rows<width>(own.rows, [&]<int count>() { own.template substitute<count>(numbers, inverse_mass_, x, l); });
  }
  for (const std::size_t first : not_anchored_) {
    for (std::size_t c = first; c < first + width; ++c) x[c] *= inverse_mass_[c];
  }
}

// The multipliers of the rows in S, and from x = b to b - G^T l with these alone.
template <int width>
void NormalMatrix::solve_others(std::span<const double> numbers, std::span<double> x, std::span<double> l) {
  double* const multipliers = multipliers_.data();
  for (std::size_t r = 0; r < rows_.size(); ++r) multipliers[r] = -l[at(rows_[r])];
  const double* weighted = weighted_.data();
  for (const Other& piece : pieces_) {
    const double* b = &x[at(piece.column)];
    double sum = weighted[0] * b[0];
    for (int c = 1; c < width; ++c) sum += weighted[c] * b[c];
    multipliers[piece.row] += sum;
    weighted += width;
  }
  for (const AnchoredBody<width>& own : anchored<width>(*this)) {
    for (std::size_t i = own.first_other; i < own.end_other; ++i) {
      const double* shares = &shares_[AnchoredBody<width>::most_rows * i];
      double& multiplier = multipliers[pieces_[at(others_[i])].row];
      for (int r = 0; r < own.rows; ++r) multiplier += shares[r] * l[at(own.row[at(r)])];
    }
  }
  factors_.solve(multipliers_);
  for (const Other& piece : pieces_) {
    const double* g = &numbers[at(piece.numbers)];
    const double multiplier = multipliers[piece.row];
    double* b = &x[at(piece.column)];
    for (int c = 0; c < width; ++c) b[c] -= g[c] * multiplier;
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) l[at(rows_[r])] = multipliers[r];
}

void NormalMatrix::solve(std::span<const double> numbers, std::span<double> x, std::span<double> l) {
  width_ == 3 ? substitute<3>(numbers, x, l) : substitute<6>(numbers, x, l);
}

}  // namespace freeplay
