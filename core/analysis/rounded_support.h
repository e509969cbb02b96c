// RoundedSupport: the support function of a play without its kinks, for Newton's method.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "analysis/feasible_set.h"

namespace freeplay {

/// The support function of one generator of size 1, its kinks rounded, with its first two derivatives: of a norm |w|
/// hypot(|w|, r); of the corners p of a polytope, |p.mu| the most of them,
///
///   r log sum (e^(p.mu/r) + e^(-p.mu/r))
class RoundedSupport {
 public:
  explicit RoundedSupport(const Generator& generator)
      : columns_(generator.hull == nullptr ? generator.columns
                                           : Eigen::MatrixXd(generator.columns * generator.hull->vertices)),
        corners_(generator.hull != nullptr) {}
  /// Size of what `mu` makes of the columns.
  double scale(const Eigen::VectorXd& mu) const { return (columns_.transpose() * mu).norm(); }
  double value(const Eigen::VectorXd& mu, double round) const {
    const Eigen::VectorXd w = columns_.transpose() * mu;
    if (!corners_) return std::hypot(w.norm(), round);
    return round > 0.0 ? Shares(w, round).value : w.cwiseAbs().maxCoeff();
  }
  /// Adds `size` times the point of the generator where that is attained, in the rows of the columns.
  void add_point(const Eigen::VectorXd& mu, double round, double size, Eigen::VectorXd& point) const {
    const Eigen::VectorXd w = columns_.transpose() * mu;
    if (corners_) {
      if (round > 0.0) point += size * (columns_ * Shares(w, round).difference);
      return;
    }
    const double rounded = std::hypot(w.norm(), round);
    if (rounded > 0.0) point += size * (columns_ * w) / rounded;
  }
  /// Adds `size` times gradient and Hessian by t, mu = mu_0 + N t, reduced = N^T columns.
  void add(const Eigen::VectorXd& mu, double round, double size, const Eigen::MatrixXd& reduced,
           Eigen::VectorXd& gradient, Eigen::MatrixXd& hessian) const {
    const Eigen::VectorXd w = columns_.transpose() * mu;
    if (corners_) {
      const Shares shares(w, round);
      const Eigen::VectorXd direction = reduced * shares.difference;
      gradient += size * direction;
      hessian +=
          size / round * (reduced * shares.sum.asDiagonal() * reduced.transpose() - direction * direction.transpose());
      return;
    }
    const double s = std::hypot(w.norm(), round);
    const Eigen::VectorXd direction = reduced * w;
    gradient += size / s * direction;
    hessian += size / s * (reduced * reduced.transpose() - direction * direction.transpose() / (s * s));
  }
  const Eigen::MatrixXd& columns() const { return columns_; }

 private:
  /// Of each corner and its opposite: the sum and the difference of their shares of the sum of all.
  struct Shares {
    Shares(const Eigen::VectorXd& w, double round) {
      const double most = w.cwiseAbs().maxCoeff();
      const Eigen::VectorXd up = ((w.array() - most) / round).exp(), down = ((-w.array() - most) / round).exp();
      const double all = up.sum() + down.sum();
      sum = (up + down) / all;
      difference = (up - down) / all;
      value = most + round * std::log(all);
    }
    Eigen::VectorXd sum, difference;
    double value;
  };
  Eigen::MatrixXd columns_;
  bool corners_;
};

}  // namespace freeplay
