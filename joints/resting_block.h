// Where a block rests in its guide, in space.
#pragma once

#include <cmath>
#include <exception>

#include "wall_contacts.h"

namespace freeplay::play {

/// Shift of the block's origin [m] and rotation vector of the block, in the axes of the guide.
struct BlockStand {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
};

/// Static equilibrium of a block before flat walls, any number of them, under the force and the moment about its origin
/// that the walls exert on it together, in the axes of the guide; the force along x is not theirs. With the normals n,
/// the arms s from the origin and the forces F_N of the law,
///
///   sum F_N n = -force      sum F_N s x n = -moment
///
/// by Newton's method on the energy of the walls, which is convex, and that of a weak spring towards the middle, which
/// says where the block stands in directions that no load has. It begins strong and ends at `weakest` of what it would
/// carry all of the load with.
template <class Geometry>
class RestingBlock {
 public:
  RestingBlock(const Geometry& block, const ContactLawRef& law, const Eigen::Vector3d& force,
               const Eigen::Vector3d& moment)
      : block_(block), law_(law), lever_(block.levers()[0]) {
    load_ << force.y(), force.z(), moment;
    scale_ << 1.0, 1.0, lever_, lever_, lever_;
  }

  BlockStand stand() const {
    constexpr double weakest = 1e-10;
    constexpr int most_steps = 60;
    const double size = load_.cwiseQuotient(scale_).norm();
    BlockStand at;
    if (size < 1e-12) return at;
    for (double share = 1.0; share > 0.5 * weakest; share *= 0.1) {
      const double spring = share * size / block_.play;
      for (int i = 0; i < most_steps; ++i) {
        const Sum here = sum(at, spring);
        if (here.residual.cwiseQuotient(scale_).norm() <= 1e-13 * size) break;
        const Five step = -here.slope.ldlt().solve(here.residual);
        const double part = along(at, step, spring);
        at = moved(at, part * step);
        if ((part * step).cwiseProduct(scale_).norm() <= 1e-14 * block_.play) break;
      }
    }
    return at;
  }

 private:
  using Five = Eigen::Matrix<double, 5, 1>;  // y, z and a turn
  struct Sum {
    Five residual;
    Eigen::Matrix<double, 5, 5> slope;
  };

  Sum sum(const BlockStand& at, double spring) const {
    Sum out{load_, Eigen::Matrix<double, 5, 5>::Zero()};
    Five stand;
    stand << at.shift.y(), at.shift.z(), at.turn;
    out.residual += spring * scale_.cwiseAbs2().cwiseProduct(stand);
    out.slope.diagonal() = spring * scale_.cwiseAbs2();
    RelativeMotion<double> motion{};
    motion.d = {0.0, at.shift.y(), at.shift.z()};
    motion.r = {at.turn.x(), at.turn.y(), at.turn.z()};
    const TurnedMotion<double> turned(motion);
    for (std::size_t i = 0; i < Geometry::contacts; ++i) {
      const WallPlace<double> wall = block_.place(turned, i);
      if (!(wall.penetration > 0.0)) continue;
      const ContactForce f = law_.evaluate({wall.penetration, 0.0, 0.0});
      const Vec<double> moment = cross(wall.arm, wall.normal);
      Five by;
      by << wall.normal.y, wall.normal.z, moment.x, moment.y, moment.z;
      out.residual += share_of<Geometry>() * f.normal * by;
      out.slope += share_of<Geometry>() * f.d_penetration * by * by.transpose();
    }
    return out;
  }
  static BlockStand moved(const BlockStand& at, const Five& by) {
    const auto turned = [](const Eigen::Vector3d& v) {
      const double angle = v.norm();
      return Eigen::Quaterniond(
          Eigen::AngleAxisd(angle, angle > 0.0 ? Eigen::Vector3d(v / angle) : Eigen::Vector3d::UnitX()));
    };
    const Eigen::AngleAxisd turn(turned(by.template tail<3>()) * turned(at.turn));
    return {at.shift + Eigen::Vector3d(0.0, by[0], by[1]), turn.angle() * turn.axis()};
  }
  /// Share of a step at which the energy is least on it: where the slope along it is zero, or all of it.
  double along(const BlockStand& at, const Five& step, double spring) const {
    const auto rises = [&](double part) {
      try {
        return sum(moved(at, part * step), spring).residual.dot(step) > 0.0;
      } catch (const std::exception&) {
        return true;  // deeper than the law knows
      }
    };
    if (!rises(1.0)) return 1.0;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (rises(middle) ? high : low) = middle;
    }
    return low;
  }

  const Geometry& block_;
  const ContactLawRef& law_;
  double lever_;
  Five load_, scale_;
};

}  // namespace freeplay::play
