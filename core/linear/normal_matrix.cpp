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

}  // namespace

bool NormalMatrix::set_pattern(std::span<const double> mass, int width, int rows, std::span<const Piece> pieces) {
  // Pieces of one body, behind each other.
  std::vector<int> by_body(pieces.size());
  std::iota(by_body.begin(), by_body.end(), 0);
  std::ranges::sort(by_body, {}, [&](int i) { return std::pair(pieces[at(i)].body, i); });
  std::vector<std::pair<int, int>> pairs;  // of pieces
  for (std::size_t i = 0, first = 0; i < by_body.size(); ++i) {
    if (pieces[at(by_body[i])].body != pieces[at(by_body[first])].body) first = i;
    for (std::size_t k = first; k <= i; ++k) pairs.emplace_back(by_body[i], by_body[k]);
    if (pairs.size() > densest * pieces.size()) return false;
  }
  const auto places = [&](const auto& row_of) {
    std::vector<std::pair<int, int>> out;
    out.reserve(pairs.size());
    for (const auto& [a, b] : pairs) {
      const auto [low, high] = std::minmax({row_of(a), row_of(b)});
      out.emplace_back(high, low);
    }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  };
  order_ = sparse_order(rows, places([&](int i) { return pieces[at(i)].row; }));
  const auto place_of = [&](int i) { return order_[at(pieces[at(i)].row)]; };
  if (!factors_.set_pattern(rows, places(place_of), most_filled * pieces.size())) return false;

  width_ = width;
  inverse_mass_.clear();
  for (const double m : mass) inverse_mass_.push_back(1.0 / m);
  pieces_.assign(pieces.begin(), pieces.end());
  for (Piece& piece : pieces_) piece.row = order_[at(piece.row)];
  products_.clear();
  products_.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    const auto [low, high] = std::minmax({place_of(a), place_of(b)});
    products_.push_back({factors_.place(high, low), a, b});
  }
  weighted_.assign(at(width) * pieces.size(), 0.0);
  diagonal_.assign(at(rows), 0.0);
  multipliers_.assign(at(rows), 0.0);
  return true;
}

template <int width>
void NormalMatrix::multiply(std::span<const double> numbers) {
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const double* inverse = &inverse_mass_[width * at(pieces_[p].body)];
    for (std::size_t c = 0; c < width; ++c) weighted_[width * p + c] = numbers[width * p + c] * inverse[c];
  }
  double* const s = factors_.values().data();
  for (const Product& product : products_) {
    const double *a = &numbers[width * at(product.a)], *b = &weighted_[width * at(product.b)];
    double sum = a[0] * b[0];
    for (int c = 1; c < width; ++c) sum += a[c] * b[c];
    s[product.target] += sum;
  }
}

double NormalMatrix::factor(std::span<const double> numbers) {
  const std::span<double> s = factors_.values();
  std::ranges::fill(s, 0.0);
  width_ == 3 ? multiply<3>(numbers) : multiply<6>(numbers);
  for (std::size_t r = 0; r < diagonal_.size(); ++r) diagonal_[r] = s[at(factors_.diagonal(static_cast<int>(r)))];
  factors_.factor();
  double smallest = 1.0;
  for (std::size_t r = 0; r < diagonal_.size(); ++r) {
    const double part = s[at(factors_.diagonal(static_cast<int>(r)))] / diagonal_[r];
    if (!(part >= smallest)) smallest = part;  // keeps a NaN
  }
  return smallest > 0.0 ? smallest : 0.0;
}

template <int width>
void NormalMatrix::substitute(std::span<const double> numbers, std::span<double> x, std::span<double> l) const {
  for (std::size_t r = 0; r < order_.size(); ++r) multipliers_[at(order_[r])] = l[r];
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const double *g = &weighted_[width * p], *b = &x[width * at(pieces_[p].body)];
    double sum = g[0] * b[0];
    for (int c = 1; c < width; ++c) sum += g[c] * b[c];
    multipliers_[at(pieces_[p].row)] += sum;
  }
  factors_.solve(multipliers_);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const double* g = &numbers[width * p];
    const double multiplier = multipliers_[at(pieces_[p].row)];
    double* b = &x[width * at(pieces_[p].body)];
    for (int c = 0; c < width; ++c) b[c] -= g[c] * multiplier;
  }
  for (std::size_t i = 0; i < inverse_mass_.size(); ++i) x[i] *= inverse_mass_[i];
  for (std::size_t r = 0; r < order_.size(); ++r) l[r] = multipliers_[at(order_[r])];
}

void NormalMatrix::solve(std::span<const double> numbers, std::span<double> x, std::span<double> l) const {
  width_ == 3 ? substitute<3>(numbers, x, l) : substitute<6>(numbers, x, l);
}

}  // namespace freeplay
