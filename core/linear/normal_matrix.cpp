#include "linear/normal_matrix.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
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

// Takes out the bodies that have all their rows for themselves; returns the rows that are left.
std::vector<int> NormalMatrix::find_anchored(int width, int rows, std::span<const Piece> pieces) {
  std::vector<int> bodies_of_row(at(rows), 0), rows_of_body(inverse_mass_.size() / at(width), 0);
  for (const Piece& piece : pieces) {
    ++bodies_of_row[at(piece.row)];
    ++rows_of_body[at(piece.body)];
  }
  for (const Piece& piece : pieces) {
    int& count = rows_of_body[at(piece.body)];
    if (bodies_of_row[at(piece.row)] > 1 || count > AnchoredBody::most_rows(width)) count = 0;  // not anchored
  }
  anchored_.clear();
  std::vector<int> index(rows_of_body.size(), -1);  // in anchored_
  std::vector<char> taken(at(rows), 0);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const auto& [row, body] = pieces[p];
    if (rows_of_body[at(body)] == 0) continue;
    if (index[at(body)] < 0) {
      index[at(body)] = static_cast<int>(anchored_.size());
      anchored_.emplace_back().body = body;
    }
    AnchoredBody& own = anchored_[at(index[at(body)])];
    own.row[at(own.rows)] = row;
    own.piece[at(own.rows++)] = static_cast<int>(p);
    taken[at(row)] = 1;
  }
  std::vector<int> left;
  for (int r = 0; r < rows; ++r) {
    if (!taken[at(r)]) left.push_back(r);
  }
  return left;
}

bool NormalMatrix::set_pattern(std::span<const double> mass, int width, int rows, std::span<const Piece> pieces) {
  inverse_mass_.clear();
  for (const double m : mass) inverse_mass_.push_back(1.0 / m);
  const std::vector<int> left = find_anchored(width, rows, pieces);
  std::vector<int> number(at(rows), -1);
  for (std::size_t i = 0; i < left.size(); ++i) number[at(left[i])] = static_cast<int>(i);
  pieces_.clear();
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const int row = number[at(pieces[p].row)];
    if (row >= 0) pieces_.push_back({{row, pieces[p].body}, static_cast<int>(p)});
  }
  // Pieces of one body, behind each other.
  std::vector<int> by_body(pieces_.size());
  std::iota(by_body.begin(), by_body.end(), 0);
  const auto body_of = [&](int i) { return pieces_[at(i)].where.body; };
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
      const auto [low, high] = std::minmax({pieces_[at(a)].where.row, pieces_[at(b)].where.row});
      out.emplace_back(high, low);
    }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  };
  const int between = static_cast<int>(left.size());
  const std::vector<int> order = sparse_order(between, places());
  for (Numbered& piece : pieces_) piece.where.row = order[at(piece.where.row)];
  if (!factors_.set_pattern(between, places(), most_filled * pieces_.size())) return false;

  width_ = width;
  rows_.resize(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) rows_[at(order[i])] = left[i];
  products_.clear();
  products_.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    const auto [low, high] = std::minmax({pieces_[at(a)].where.row, pieces_[at(b)].where.row});
    products_.push_back({factors_.place(high, low), pieces_[at(a)].piece, b});
  }
  weighted_.assign(at(width) * pieces_.size(), 0.0);
  diagonal_.assign(left.size(), 0.0);
  multipliers_.assign(left.size(), 0.0);
  return true;
}

template <int width>
void NormalMatrix::multiply(std::span<const double> numbers) {
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const double* inverse = &inverse_mass_[width * at(pieces_[p].where.body)];
    const double* g = &numbers[width * at(pieces_[p].piece)];
    for (std::size_t c = 0; c < width; ++c) weighted_[width * p + c] = g[c] * inverse[c];
  }
  double* const s = factors_.values().data();
  for (const Product& product : products_) {
    const double *a = &numbers[width * at(product.a)], *b = &weighted_[width * at(product.b)];
    double sum = a[0] * b[0];
    for (int c = 1; c < width; ++c) sum += a[c] * b[c];
    s[product.target] += sum;
  }
}

template <int width>
double NormalMatrix::factor_anchored(std::span<const double> numbers) {
  double smallest = 1.0;
  for (AnchoredBody& own : anchored_) {
    const double part =
        by_rows<width>(own.rows, [&]<int count>() { return own.factor<width, count>(numbers, inverse_mass_); });
    if (!(part >= smallest)) smallest = part;  // keeps a NaN
  }
  return smallest;
}

double NormalMatrix::factor(std::span<const double> numbers) {
  double smallest = width_ == 3 ? factor_anchored<3>(numbers) : factor_anchored<6>(numbers);
  const std::span<double> s = factors_.values();
  std::ranges::fill(s, 0.0);
  width_ == 3 ? multiply<3>(numbers) : multiply<6>(numbers);
  for (std::size_t r = 0; r < diagonal_.size(); ++r) diagonal_[r] = s[at(factors_.diagonal(static_cast<int>(r)))];
  factors_.factor();
  for (std::size_t r = 0; r < diagonal_.size(); ++r) {
    const double part = s[at(factors_.diagonal(static_cast<int>(r)))] / diagonal_[r];
    if (!(part >= smallest)) smallest = part;
  }
  return smallest > 0.0 ? smallest : 0.0;
}

template <int width>
void NormalMatrix::substitute(std::span<const double> numbers, std::span<double> x, std::span<double> l) const {
  for (const AnchoredBody& own : anchored_) {
    by_rows<width>(own.rows, [&]<int count>() { own.substitute<width, count>(numbers, x, l); });
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) multipliers_[r] = l[at(rows_[r])];
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const double *g = &weighted_[width * p], *b = &x[width * at(pieces_[p].where.body)];
    double sum = g[0] * b[0];
    for (int c = 1; c < width; ++c) sum += g[c] * b[c];
    multipliers_[at(pieces_[p].where.row)] += sum;
  }
  factors_.solve(multipliers_);
  for (const Numbered& piece : pieces_) {
    const double* g = &numbers[width * at(piece.piece)];
    const double multiplier = multipliers_[at(piece.where.row)];
    double* b = &x[width * at(piece.where.body)];
    for (int c = 0; c < width; ++c) b[c] -= g[c] * multiplier;
  }
  for (std::size_t i = 0; i < inverse_mass_.size(); ++i) x[i] *= inverse_mass_[i];
  for (std::size_t r = 0; r < rows_.size(); ++r) l[at(rows_[r])] = multipliers_[r];
}

void NormalMatrix::solve(std::span<const double> numbers, std::span<double> x, std::span<double> l) const {
  width_ == 3 ? substitute<3>(numbers, x, l) : substitute<6>(numbers, x, l);
}

}  // namespace freeplay
