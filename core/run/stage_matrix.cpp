#include "run/stage_matrix.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr MatrixEntry nowhere{-1, -1};
constexpr int left_out = 0;  // the number that nobody reads
constexpr int first_block = 1;
// Column by column, so that no comparison waits for all those before.
double largest_entry(const Eigen::Matrix3d& m) {
  const Eigen::Array3d a = m.col(0).array().abs(), b = m.col(1).array().abs(), c = m.col(2).array().abs();
  const auto greater = [](double x, double y) { return x > y ? x : y; };
  return greater(greater(greater(a[0], a[1]), greater(a[2], b[0])),
                 greater(greater(b[1], b[2]), greater(c[0], greater(c[1], c[2]))));
}

}  // namespace

// Every entry that factor() fills, in its order, at its place in the whole system.
std::vector<MatrixEntry> StageMatrix::entries(std::span<const char> dependent) const {
  const int nv = system_.layout().nv(), nc = system_.layout().nc();
  std::vector<MatrixEntry> all;
  for (int i = 0; i < nv; ++i) all.push_back({i, i});
  for (int r = 0; r < nc; ++r) all.push_back(dependent[at(r)] ? MatrixEntry{nv + r, nv + r} : nowhere);
  if (forces_) {
    for (const ForceBlock& block : system_.force_blocks()) {
      const BodyId bodies[2] = {block.a, block.b};
      for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) {
          const BodyId row = bodies[r / 3], column = bodies[c / 3];
          const bool inside = row != ground && column != ground;
          all.push_back(inside ? MatrixEntry{3 * row + r % 3, 3 * column + c % 3} : nowhere);
        }
      }
    }
  }
  for (const JacobianBlock& block : system_.jacobian_blocks()) {
    for (int r = block.row; r < block.row + block.rows; ++r) {
      for (int c = 3 * block.body; c < 3 * block.body + 3; ++c) {
        all.push_back(dependent[at(r)] ? nowhere : MatrixEntry{nv + r, c});
        all.push_back(dependent[at(r)] ? nowhere : MatrixEntry{c, nv + r});
      }
    }
  }
  return all;
}

void StageMatrix::set_pattern(std::span<const char> dependent) {
  const int nv = system_.layout().nv(), size = nv + system_.layout().nc();
  prescribed_.clear();
  std::vector<int> owner(at(size), -1);  // of a coordinate or row: its prescribed body
  for (const PrescribedBody& body : prescribed_bodies(system_, dependent)) {
    const int index = static_cast<int>(prescribed_.size());
    for (int c = 0; c < 3; ++c) owner[at(3 * body.body + c)] = owner[at(nv + body.rows[at(c)])] = index;
    prescribed_.emplace_back().who = body;
  }
  const std::vector<MatrixEntry> all = entries(dependent);
  std::vector<char> coupled(at(size), 0);  // shares a row or column with another free unknown
  for (const auto [row, column] : all) {
    if (row < 0 || row == column || owner[at(row)] >= 0 || owner[at(column)] >= 0) continue;
    coupled[at(row)] = coupled[at(column)] = 1;
  }
  alone_.clear();
  unknowns_.clear();
  std::vector<int> place(at(size), -1);  // in alone_ or in rest_
  for (int i = 0; i < size; ++i) {
    if (owner[at(i)] >= 0) continue;
    std::vector<int>& list = coupled[at(i)] ? unknowns_ : alone_;
    place[at(i)] = static_cast<int>(list.size());
    list.push_back(i);
  }

  std::vector<int> slots(all.size(), left_out);
  std::vector<MatrixEntry> factored;
  std::vector<std::size_t> factored_entry, alone_entry;
  // Couplings in the order in which they are used: by kind and body.
  struct Sorted {
    int kind, body;
    std::size_t entry;
  };
  std::vector<Sorted> sorted;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [row, column] = all[i];
    if (row < 0) continue;
    const int row_owner = owner[at(row)], column_owner = owner[at(column)];
    if (row_owner < 0 && column_owner < 0) {
      if (coupled[at(row)]) {
        factored.push_back({place[at(row)], place[at(column)]});
        factored_entry.push_back(i);
      } else {
        alone_entry.push_back(i);
      }
    } else if (row_owner == column_owner && (row < nv) != (column < nv)) {
      if (row < nv) continue;  // the transposed block
      const PrescribedBody& who = prescribed_[at(row_owner)].who;
      const auto r = std::ranges::find(who.rows, row - nv) - who.rows.begin();
      slots[i] = first_block + 9 * row_owner + 3 * (column - 3 * who.body) + static_cast<int>(r);
    } else if (row_owner < 0) {
      if (column < nv) sorted.push_back({2, 0, i});  // multipliers of prescribed bodies act on them alone
    } else {
      sorted.push_back({row < nv ? 1 : 0, row_owner, i});
    }
  }
  std::ranges::stable_sort(sorted, {}, [](const Sorted& s) { return std::pair(s.kind, s.body); });
  first_coupling_ = at(first_block) + 9 * prescribed_.size();
  couplings_.clear();
  for (const auto& [kind, body, entry] : sorted) {
    slots[entry] = static_cast<int>(first_coupling_ + couplings_.size());
    couplings_.push_back({all[entry].row, all[entry].column});
  }
  const auto first_of = [&](int kind, int body) {
    return static_cast<std::size_t>(
        std::ranges::lower_bound(sorted, std::pair(kind, body), {},
                                 [](const Sorted& s) { return std::pair(s.kind, s.body); }) -
        sorted.begin());
  };
  for (int p = 0; p < static_cast<int>(prescribed_.size()); ++p) {
    Prescribed& body = prescribed_[at(p)];
    body.first_row_part = first_of(0, p);
    body.end_row_part = first_of(0, p + 1);
    body.first_motion_part = first_of(1, p);
    body.end_motion_part = first_of(1, p + 1);
  }
  first_free_part_ = first_of(2, 0);
  first_alone_ = first_coupling_ + couplings_.size();
  for (const std::size_t i : alone_entry) slots[i] = static_cast<int>(first_alone_) + place[at(all[i].row)];
  first_rest_ = first_alone_ + alone_.size();
  const std::vector<int> found = rest_.set_pattern(static_cast<int>(unknowns_.size()), factored);
  for (std::size_t i = 0; i < found.size(); ++i) slots[factored_entry[i]] = static_cast<int>(first_rest_) + found[i];
  rest_right_.assign(unknowns_.size(), 0.0);
  rest_update_.assign(unknowns_.size(), 0.0);

  const auto first_forces = slots.begin() + size;
  const auto first_rows = first_forces + static_cast<std::ptrdiff_t>(forces_ ? 36 * system_.force_blocks().size() : 0);
  slots_ = {{slots.begin(), first_forces}, {first_forces, first_rows}, {first_rows, slots.end()}};
  constants_.assign(first_rest_ + rest_.values().size(), 0.0);
  values_ = constants_;
  for (int i = 0; i < size; ++i) {
    constants_[at(slots_.constant[at(i)])] += i < nv ? system_.mass()[at(i)] : 1.0;
  }
}

double StageMatrix::factor(Evaluation& e, double beta_q, double beta_v, double beta_z) {
  std::ranges::copy(constants_, values_.begin());
  if (forces_) {
    const int* slot = slots_.forces.data();
    if (!internal_.empty()) {
      internal_.prepare(e, beta_q, beta_v, beta_z);
      internal_.add_to_matrix([&](std::size_t block, int r, int c, double value) {
        values_[at(slot[36 * block + at(6 * r + c)])] += value;
      });
    }
    for (std::size_t i = 0; i < e.force_v.size(); ++i) {
      values_[at(*slot++)] -= beta_v * e.force_v[i] + beta_q * e.force_q[i];
    }
  }
  const int* slot = slots_.rows.data();
  for (const double entry : e.jacobian) {
    values_[at(*slot++)] += entry;
    values_[at(*slot++)] += entry;
  }
  std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(first_rest_), rest_.values().size(),
              rest_.values().begin());
  double smallest = rest_.factor();
  for (std::size_t i = first_alone_; i < first_rest_; ++i) {
    if (values_[i] == 0.0 || !std::isfinite(values_[i])) smallest = 0.0;
  }
  const double* numbers = &values_[at(first_block)];
  for (Prescribed& body : prescribed_) {
    const Eigen::Map<const Eigen::Matrix3d> block(numbers);
    numbers += 9;
    body.inverse = block.inverse();
    const double size = largest_entry(block) * largest_entry(body.inverse);
    smallest = std::min(smallest, size > 0.0 && std::isfinite(size) ? 1.0 / size : 0.0);
  }
  return smallest;
}

void StageMatrix::subtract(std::size_t first, std::size_t end, std::span<const double> update,
                           std::span<double> right) const {
  const double* value = values_.data() + first_coupling_;
  for (std::size_t i = first; i < end; ++i) {
    const Coupling& c = couplings_[i];
    right[at(c.row)] -= value[i] * update[at(c.column)];
  }
}

void StageMatrix::solve(std::span<double> right, std::span<double> update) const {
  const Profile::Timer timer(system_.profile(), Phase::solution);
  using Vector = Eigen::Vector3d;
  const int nv = system_.layout().nv();
  for (const Prescribed& body : prescribed_) {
    subtract(body.first_row_part, body.end_row_part, update, right);
    const auto& rows = body.who.rows;
    const Vector b(right[at(nv + rows[0])], right[at(nv + rows[1])], right[at(nv + rows[2])]);
    const Vector change = body.inverse * b;
    std::copy_n(change.data(), 3, update.begin() + 3 * body.who.body);
  }
  subtract(first_free_part_, couplings_.size(), update, right);
  const double* value = values_.data() + first_alone_;
  for (std::size_t i = 0; i < alone_.size(); ++i) update[at(alone_[i])] = right[at(alone_[i])] / value[i];
  if (!unknowns_.empty()) {
    for (std::size_t i = 0; i < unknowns_.size(); ++i) rest_right_[i] = right[at(unknowns_[i])];
    rest_.solve(rest_right_, rest_update_);
    for (std::size_t i = 0; i < unknowns_.size(); ++i) update[at(unknowns_[i])] = rest_update_[i];
  }
  for (std::size_t p = prescribed_.size(); p-- > 0;) {
    const Prescribed& body = prescribed_[p];
    subtract(body.first_motion_part, body.end_motion_part, update, right);
    const Vector multipliers = body.inverse.transpose() * Eigen::Map<const Vector>(&right[at(3 * body.who.body)]);
    for (int r = 0; r < 3; ++r) update[at(nv + body.who.rows[at(r)])] = multipliers[r];
  }
}

}  // namespace freeplay
