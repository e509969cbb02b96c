// State: the mechanism at one instant and what integrators and joints remember of it, in one block of numbers.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "base/archive.h"
#include "freeplay/integrator.h"
#include "system/guard_marks.h"
#include "system/layout.h"

namespace freeplay {

/// [t | q | v | a | lambda | z | h | integrator memory]. Copying it is the only rollback. q, v and a are those of the
/// unknowns; lambda has the loads of driven bodies after theirs.
class State {
 public:
  State() : block_(guard::marks) {}
  /// `flows`: integrals that the integrator carries along after the internal variables of the joints.
  State(const Layout& layout, int memory, int flows = 0)
      : nq_(size(layout.nq())),
        nv_(size(layout.nv())),
        nc_(size(layout.nc())),
        rows_(size(layout.all_rows())),
        nz_(size(layout.nz() + flows)),
        nh_(size(layout.nh())),
        memory_(size(memory)),
        block_(1 + nq_ + 2 * nv_ + rows_ + nz_ + nh_ + memory_ + guard::marks, 0.0) {
    guard::set(end());
  }

  /// Copies a state of the same layout without allocating; the memory of the integrator may differ in size.
  void assign(const State& other) {
    const std::size_t common = std::min(block().size(), other.block().size());
    std::copy_n(other.block_.begin(), common, block_.begin());
  }
  /// The same where the flows differ in number, too; flows and memory are left as they are.
  void assign_motion(const State& other) {
    t() = other.t();
    std::ranges::copy(other.q(), q().begin());
    std::ranges::copy(other.v(), v().begin());
    std::ranges::copy(other.a(), a().begin());
    std::ranges::copy(other.lambda(), lambda().begin());
    std::copy_n(other.z().begin(), std::min(nz_, other.nz_), z().begin());
    std::ranges::copy(other.h(), h().begin());
  }

  double& t() { return block_[0]; }
  double t() const { return block_[0]; }
  std::span<double> q() { return part(1, nq_); }
  std::span<double> v() { return part(1 + nq_, nv_); }
  std::span<double> a() { return part(1 + nq_ + nv_, nv_); }
  std::span<double> lambda() { return part(1 + nq_ + 2 * nv_, rows_); }
  std::span<double> z() { return part(1 + nq_ + 2 * nv_ + rows_, nz_); }
  std::span<double> h() { return part(1 + nq_ + 2 * nv_ + rows_ + nz_, nh_); }
  std::span<double> memory() { return part(1 + nq_ + 2 * nv_ + rows_ + nz_ + nh_, memory_); }
  std::span<const double> q() const { return part(1, nq_); }
  std::span<const double> v() const { return part(1 + nq_, nv_); }
  std::span<const double> a() const { return part(1 + nq_ + nv_, nv_); }
  std::span<const double> lambda() const { return part(1 + nq_ + 2 * nv_, rows_); }
  std::span<const double> z() const { return part(1 + nq_ + 2 * nv_ + rows_, nz_); }
  std::span<const double> h() const { return part(1 + nq_ + 2 * nv_ + rows_ + nz_, nh_); }
  /// t, q, v, a, lambda and z.
  std::span<const double> before_history() const { return part(0, 1 + nq_ + 2 * nv_ + rows_ + nz_); }
  /// For checkpoints and hashes.
  std::span<const double> block() const { return std::span(block_).first(block_.size() - guard::marks); }
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.block_);
  }
  /// False when something was written past the end of the block.
  bool intact() const { return guard::intact(block_.data() + block().size()); }
  StateView view() {
    return {&block_[0],
            Span<double>(q()),
            Span<double>(v()),
            Span<double>(a()),
            Span<double>(lambda().first(nc_)),
            Span<double>(z()),
            Span<double>(memory())};
  }

 private:
  double* end() { return block_.data() + block().size(); }
  static std::size_t size(int n) { return static_cast<std::size_t>(n); }
  std::span<double> part(std::size_t offset, std::size_t count) { return {block_.data() + offset, count}; }
  std::span<const double> part(std::size_t offset, std::size_t count) const { return {block_.data() + offset, count}; }
  std::size_t nq_ = 0, nv_ = 0, nc_ = 0, rows_ = 0, nz_ = 0, nh_ = 0, memory_ = 0;
  std::vector<double> block_;
};

}  // namespace freeplay
