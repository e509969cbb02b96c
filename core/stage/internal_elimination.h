// InternalElimination: internal variables of joints, taken out of a stage's equations joint by joint.
//
// With z = z_known + beta_z z' and r_z = g(q, v, z) - z', one Newton step is
//   dz' = W (r_z + B da),   W = (1 - beta_z g_z)^-1,   B = beta_q g_q + beta_v g_v
// and leaves in the equations of motion  -beta_z f_z W B  on the left and  beta_z f_z W r_z  on the right.
#pragma once

#include <span>
#include <vector>

#include "system/system.h"

namespace freeplay {

/// Blocks of one factored matrix. Sized once; joints without internal variables cost nothing.
class InternalElimination {
 public:
  InternalElimination(const Layout& layout, const Forces& forces);
  bool empty() const { return blocks_.empty(); }

  /// Takes W, B and beta_z f_z W from the derivatives of `e`.
  void prepare(Evaluation& e, double beta_q, double beta_v, double beta_z);
  /// `add(row, column, value)` for every entry that the left side gains, in velocities of the bodies.
  template <class Add>
  void add_to_matrix(Add&& add) const {
    for (const Block& block : blocks_) {
      for (int r = 0; r < columns_; ++r) {
        for (int c = 0; c < columns_; ++c) {
          double value = 0.0;
          for (int z = 0; z < block.size; ++z) value -= force(block, r, z) * slope(block, z, c);
          add(block.force_block, r, c, value);
        }
      }
    }
  }
  /// right += beta_z f_z W r_z; keeps W r_z for advance().
  void add_to_right(std::span<const double> internal_rate, std::span<const double> z_rate, std::span<double> right);
  /// z' += W (r_z + B da). Returns the largest change of z relative to its size (z itself or what it gains
  /// in a stage, and at least a small part of that of the joint's largest variable). `largest_rate` has the largest
  /// amounts of z' in this stage, 0 at its start: a z' within their rounding is set to 0.
  double advance(std::span<const double> change, double beta_z, std::span<const double> z, std::span<double> z_rate,
                 std::span<double> largest_rate) const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.numbers_);
  }

 private:
  struct Block {
    std::size_t force_block = 0;
    int size = 0, offset = 0;  // of z
    int bodies[2] = {ground, ground};
    std::size_t inverse = 0, slope = 0, force = 0;  // offsets into numbers_: W, W B, beta_z f_z
  };
  double force(const Block& b, int row, int z) const {
    return numbers_[b.force + static_cast<std::size_t>(row * b.size + z)];
  }
  double slope(const Block& b, int z, int c) const {
    return numbers_[b.slope + static_cast<std::size_t>(z * columns_ + c)];
  }

  const Layout& layout_;
  const Forces& forces_;
  int columns_;  // velocities of two bodies
  std::vector<Block> blocks_;
  std::vector<double> numbers_, residual_;
};

}  // namespace freeplay
