#include "stage/matrix.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "stage/block_inverse.h"

namespace freeplay {
namespace {

constexpr MatrixEntry nowhere{-1, -1};
constexpr int left_out = 0;  // a number that is never read
constexpr int first_block = 1;
constexpr int largest_whole = 20;  // unknowns: taking some of them out costs more than it saves

}  // namespace

// Every entry that factor() fills, in its order, at its place in the whole system.
std::vector<MatrixEntry> StageMatrix::entries(std::span<const char> dependent) const {
  const int nv = system_.layout().nv(), nc = system_.layout().nc(), width = system_.layout().body_velocities();
  std::size_t of_rows = 0;
  for (const JacobianBlock& block : system_.jacobian().blocks()) of_rows += at(2 * width * block.rows);
  std::vector<MatrixEntry> all;
  all.reserve(at(nv + nc) + (forces_ ? at(4 * width * width) * system_.forces().pairs().size() + at(3 * nv) : 0) +
              of_rows);
  for (int i = 0; i < nv; ++i) all.push_back({i, i});
  for (int r = 0; r < nc; ++r) all.push_back(dependent[at(r)] ? MatrixEntry{nv + r, nv + r} : nowhere);
  if (forces_) add_force_entries(all);
  for (const JacobianBlock& block : system_.jacobian().blocks()) {
    for (int r = block.row; r < block.row + block.rows; ++r) {
      for (int c = width * block.body; c < width * (block.body + 1); ++c) {
        all.push_back(dependent[at(r)] ? nowhere : MatrixEntry{nv + r, c});
        all.push_back(dependent[at(r)] ? nowhere : MatrixEntry{c, nv + r});
      }
    }
  }
  return all;
}

// Of forces, in space of gyroscopic moments, too.
void StageMatrix::add_force_entries(std::vector<MatrixEntry>& all) const {
  const int nv = system_.layout().nv(), width = system_.layout().body_velocities();
  for (const BodyPair& pair : system_.forces().pairs()) {
    const BodyId bodies[2] = {pair.a, pair.b};
    for (int r = 0; r < 2 * width; ++r) {
      for (int c = 0; c < 2 * width; ++c) {
        const BodyId row = bodies[r / width], column = bodies[c / width];
        const bool inside = row != ground && column != ground;
        all.push_back(inside ? MatrixEntry{width * row + r % width, width * column + c % width} : nowhere);
      }
    }
  }
  for (int b = 0; width == 6 && b < nv / 6; ++b) {
    for (int r = 6 * b + 3; r < 6 * b + 6; ++r) {
      for (int c = 6 * b + 3; c < 6 * b + 6; ++c) all.push_back({r, c});
    }
  }
}

void StageMatrix::set_pattern(std::span<const char> dependent) {
  const std::vector<MatrixEntry> all = entries(dependent);
  const Division division = divide(all, dependent);
  std::vector<int> slots(all.size(), left_out);
  place_blocks(all, division, slots);
  place_couplings(all, division, slots);
  place_free(all, division, slots);
  share_out(slots);
  values_.assign(first_rest_ + rest_.values().size(), 0.0);
  rest_right_.assign(unknowns_.size(), 0.0);
  rest_update_.assign(unknowns_.size(), 0.0);
}

StageMatrix::Division StageMatrix::divide(std::span<const MatrixEntry> all, std::span<const char> dependent) {
  const int nv = system_.layout().nv(), size = nv + system_.layout().nc(), width = system_.layout().body_velocities();
  const bool tiny = size <= largest_whole;
  Division division{std::vector<int>(at(size), -1), std::vector<int>(at(size), -1),
                    std::vector<char>(at(size), tiny ? 1 : 0)};
  prescribed_.clear();
  for (const PrescribedBody& body :
       tiny ? std::vector<PrescribedBody>{} : prescribed_bodies(system_.jacobian(), dependent)) {
    const int index = static_cast<int>(prescribed_.size());
    for (int c = 0; c < width; ++c) {
      division.owner[at(width * body.body + c)] = division.owner[at(nv + body.rows[at(c)])] = index;
    }
    prescribed_.emplace_back().who = body;
  }
  for (const auto [row, column] : all) {
    if (row < 0 || row == column || !division.is_free(row) || !division.is_free(column)) continue;
    division.coupled[at(row)] = division.coupled[at(column)] = 1;
  }
  alone_.clear();
  unknowns_.clear();
  for (int i = 0; i < size; ++i) {
    if (!division.is_free(i)) continue;
    std::vector<int>& list = division.coupled[at(i)] ? unknowns_ : alone_;
    division.place[at(i)] = static_cast<int>(list.size());
    list.push_back(i);
  }
  return division;
}

// Phi_q of the rows of prescribed bodies in their own columns. The transposed blocks are left out.
void StageMatrix::place_blocks(std::span<const MatrixEntry> all, const Division& division, std::span<int> slots) const {
  const int nv = system_.layout().nv(), width = system_.layout().body_velocities();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [row, column] = all[i];
    if (row < nv || !division.is_block(row, column, nv)) continue;
    const int owner = division.owner[at(row)];
    const PrescribedBody& who = prescribed_[at(owner)].who;
    const auto r = std::ranges::find(who.rows, row - nv) - who.rows.begin();
    slots[i] = first_block + width * (width * owner + column - width * who.body) + static_cast<int>(r);
  }
}

// Couplings in the order in which they are used: by kind and body.
void StageMatrix::place_couplings(std::span<const MatrixEntry> all, const Division& division, std::span<int> slots) {
  enum Kind { of_rows, of_motion, of_free };
  struct Sorted {
    std::pair<int, int> when;  // kind and body
    std::size_t entry;
  };
  const int nv = system_.layout().nv(), width = system_.layout().body_velocities();
  std::vector<Sorted> sorted;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [row, column] = all[i];
    if (row < 0 || division.is_block(row, column, nv)) continue;
    if (!division.is_free(row)) {
      sorted.push_back({{row < nv ? of_motion : of_rows, division.owner[at(row)]}, i});
    } else if (!division.is_free(column) && column < nv) {  // multipliers of prescribed bodies act on them alone
      sorted.push_back({{of_free, 0}, i});
    }
  }
  std::ranges::stable_sort(sorted, {}, &Sorted::when);
  first_coupling_ = at(first_block) + at(width * width) * prescribed_.size();
  couplings_.clear();
  for (const auto& [when, entry] : sorted) {
    slots[entry] = static_cast<int>(first_coupling_ + couplings_.size());
    couplings_.push_back({all[entry].row, all[entry].column});
  }
  const auto first_of = [&](int kind, int body) {
    return static_cast<std::size_t>(std::ranges::lower_bound(sorted, std::pair(kind, body), {}, &Sorted::when) -
                                    sorted.begin());
  };
  for (int p = 0; p < static_cast<int>(prescribed_.size()); ++p) {
    Prescribed& body = prescribed_[at(p)];
    body.first_row_part = first_of(of_rows, p);
    body.end_row_part = first_of(of_rows, p + 1);
    body.first_motion_part = first_of(of_motion, p);
    body.end_motion_part = first_of(of_motion, p + 1);
  }
  first_free_part_ = first_of(of_free, 0);
}

// Entries of unknowns that are alone in their row and column, and of the others, which are factored.
void StageMatrix::place_free(std::span<const MatrixEntry> all, const Division& division, std::span<int> slots) {
  first_alone_ = first_coupling_ + couplings_.size();
  first_rest_ = first_alone_ + alone_.size();
  std::vector<MatrixEntry> factored;
  std::vector<std::size_t> factored_entry;
  factored.reserve(all.size());
  factored_entry.reserve(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [row, column] = all[i];
    if (row < 0 || !division.is_free(row) || !division.is_free(column)) continue;
    if (division.coupled[at(row)]) {
      factored.push_back({division.place[at(row)], division.place[at(column)]});
      factored_entry.push_back(i);
    } else {
      slots[i] = static_cast<int>(first_alone_) + division.place[at(row)];
    }
  }
  const std::vector<int> found = rest_.set_pattern(static_cast<int>(unknowns_.size()), factored);
  for (std::size_t i = 0; i < found.size(); ++i) slots[factored_entry[i]] = static_cast<int>(first_rest_) + found[i];
}

void StageMatrix::share_out(const std::vector<int>& slots) {
  const int nv = system_.layout().nv(), width = system_.layout().body_velocities();
  const auto first_forces = slots.begin() + nv + system_.layout().nc();
  const std::size_t of_forces = forces_ ? at(4 * width * width) * system_.forces().pairs().size() : 0;
  const auto first_turning = first_forces + static_cast<std::ptrdiff_t>(of_forces);
  const auto first_rows = first_turning + (forces_ && width == 6 ? 9 * (nv / 6) : 0);
  slots_ = {{slots.begin(), first_forces},
            {first_forces, first_turning},
            {first_turning, first_rows},
            {first_rows, slots.end()}};
}

double StageMatrix::factor(Evaluation& e, double beta_q, double beta_v, double beta_z) {
  std::ranges::fill(values_, 0.0);
  const std::span<const double> mass = system_.inertia().mass();
  for (std::size_t i = 0; i < slots_.constant.size(); ++i) {
    values_[at(slots_.constant[i])] += i < mass.size() ? mass[i] : 1.0;
  }
  if (forces_) fill_forces(e, beta_q, beta_v, beta_z);
  const int* slot = slots_.rows.data();
  for (const JacobianBlock& block : system_.jacobian().blocks()) {
    const double* entry = &e.jacobian[at(block.offset)];
    for (int i = 0; i < block.rows * system_.layout().body_velocities(); ++i, ++entry) {
      values_[at(*slot++)] += *entry;
      values_[at(*slot++)] += *entry;
    }
  }
  std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(first_rest_), rest_.values().size(),
              rest_.values().begin());
  double smallest = rest_.factor();
  for (std::size_t i = first_alone_; i < first_rest_; ++i) {
    if (values_[i] == 0.0 || !std::isfinite(values_[i])) smallest = 0.0;
  }
  return std::min(smallest, system_.layout().body_velocities() == 3 ? invert_blocks<3>() : invert_blocks<6>());
}

void StageMatrix::fill_forces(Evaluation& e, double beta_q, double beta_v, double beta_z) {
  const int* slot = slots_.forces.data();
  if (!internal_.empty()) {
    internal_.prepare(e, beta_q, beta_v, beta_z);
    const std::size_t columns = at(2 * system_.layout().body_velocities());
    internal_.add_to_matrix([&](std::size_t block, int r, int c, double value) {
      values_[at(slot[columns * (columns * block + at(r)) + at(c)])] += value;
    });
  }
  for (std::size_t i = 0; i < e.force_v.size(); ++i) {
    values_[at(*slot++)] -= beta_v * e.force_v[i] + beta_q * e.force_q[i];
  }
  for (std::size_t i = 0; i < slots_.turning.size(); ++i) {
    values_[at(slots_.turning[i])] -= beta_v * e.gyroscopic_v[i];
  }
}

template <int width>
double StageMatrix::invert_blocks() {
  using Square = Eigen::Matrix<double, width, width>;
  double smallest = 1.0;
  const double* numbers = values_.data() + first_block;
  for (Prescribed& body : prescribed_) {
    const Square block = Eigen::Map<const Square>(numbers);
    numbers += width * width;
    smallest = std::min(smallest, invert_block<width>(block, body.inverse));
  }
  return smallest;
}

void StageMatrix::restore(ArchiveReader& archive) {
  archive(values_, internal_, rest_);
  system_.layout().body_velocities() == 3 ? invert_blocks<3>() : invert_blocks<6>();
}

void StageMatrix::subtract(std::size_t first, std::size_t end, std::span<const double> update,
                           std::span<double> right) const {
  const double* value = values_.data() + first_coupling_;
  for (std::size_t i = first; i < end; ++i) {
    const Coupling& c = couplings_[i];
    right[at(c.row)] -= value[i] * update[at(c.column)];
  }
}

void StageMatrix::solve(std::span<double> right, std::span<double> update) {
  system_.layout().body_velocities() == 3 ? substitute<3>(right, update) : substitute<6>(right, update);
}

template <int width>
void StageMatrix::substitute(std::span<double> right, std::span<double> update) {
  using Square = Eigen::Matrix<double, width, width>;
  using Vector = Eigen::Matrix<double, width, 1>;
  const int nv = system_.layout().nv();
  if (unknowns_.size() == update.size()) return rest_.solve(right, update);
  for (const Prescribed& body : prescribed_) {
    subtract(body.first_row_part, body.end_row_part, update, right);
    Vector b;
    for (int r = 0; r < width; ++r) b[r] = right[at(nv + body.who.rows[at(r)])];
    const Vector change = Eigen::Map<const Square>(body.inverse) * b;
    std::copy_n(change.data(), width, &update[at(width * body.who.body)]);
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
    const Vector multipliers = Eigen::Map<const Square>(body.inverse).transpose() *
                               Eigen::Map<const Vector>(&right[at(width * body.who.body)]);
    for (int r = 0; r < width; ++r) update[at(nv + body.who.rows[at(r)])] = multipliers[r];
  }
}

}  // namespace freeplay
