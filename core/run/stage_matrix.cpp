#include "run/stage_matrix.h"

#include <algorithm>
#include <iterator>

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr MatrixEntry left_out{-1, -1};

}  // namespace

void StageMatrix::set_pattern(std::span<const char> dependent) {
  const int nv = system_.layout().nv(), nc = system_.layout().nc();
  std::vector<MatrixEntry> entries;
  for (int i = 0; i < nv; ++i) entries.push_back({i, i});
  for (int r = 0; r < nc; ++r) entries.push_back(dependent[at(r)] ? MatrixEntry{nv + r, nv + r} : left_out);
  if (forces_) {
    for (const ForceBlock& block : system_.force_blocks()) {
      const BodyId bodies[2] = {block.a, block.b};
      for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) {
          const BodyId row = bodies[r / 3], column = bodies[c / 3];
          const bool inside = row != ground && column != ground;
          entries.push_back(inside ? MatrixEntry{3 * row + r % 3, 3 * column + c % 3} : left_out);
        }
      }
    }
  }
  for (const JacobianBlock& block : system_.jacobian_blocks()) {
    for (int r = block.row; r < block.row + block.rows; ++r) {
      for (int c = 3 * block.body; c < 3 * block.body + 3; ++c) {
        entries.push_back(dependent[at(r)] ? left_out : MatrixEntry{nv + r, c});
        entries.push_back(dependent[at(r)] ? left_out : MatrixEntry{c, nv + r});
      }
    }
  }
  std::vector<MatrixEntry> inside;
  std::ranges::copy_if(entries, std::back_inserter(inside), [](const MatrixEntry& e) { return e.row >= 0; });
  const std::vector<int> found = matrix_.set_pattern(nv + nc, inside);
  slots_.assign(entries.size(), -1);
  for (std::size_t i = 0, next = 0; i < entries.size(); ++i) {
    if (entries[i].row >= 0) slots_[i] = found[next++];
  }
}

void StageMatrix::add_forces(const Evaluation& e, double beta_q, double beta_v, const int*& slot,
                             std::span<double> values) const {
  if (!internal_.empty()) {
    internal_.add_to_matrix([&](std::size_t block, int r, int c, double value) {
      const int place = slot[36 * block + at(6 * r + c)];
      if (place >= 0) values[at(place)] += value;
    });
  }
  for (std::size_t i = 0; i < 36 * system_.force_blocks().size(); ++i) {
    const int place = *slot++;
    if (place >= 0) values[at(place)] -= beta_v * e.force_v[i] + beta_q * e.force_q[i];
  }
}

double StageMatrix::factor(Evaluation& e, double beta_q, double beta_v, double beta_z) {
  const std::span<double> values = matrix_.values();
  const int* slot = slots_.data();
  std::ranges::fill(values, 0.0);
  for (const double mass : system_.mass()) values[at(*slot++)] += mass;
  for (int r = 0; r < system_.layout().nc(); ++r) {
    if (*slot >= 0) values[at(*slot)] = 1.0;
    ++slot;
  }
  if (forces_) {
    if (!internal_.empty()) internal_.prepare(e, beta_q, beta_v, beta_z);
    add_forces(e, beta_q, beta_v, slot, values);
  }
  for (const double entry : e.jacobian) {
    if (*slot >= 0) {
      values[at(slot[0])] += entry;
      values[at(slot[1])] += entry;
    }
    slot += 2;
  }
  return matrix_.factor();
}

}  // namespace freeplay
