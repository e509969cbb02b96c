// StackedRows: least squares of several ranks, each solved in what those before leave free.
#pragma once

#include <Eigen/Core>

namespace freeplay {

/// x that minimises |A_1 x - b_1|, among those |A_2 x - b_2|, and so on; of least norm where nothing is left to say.
/// Dense; for set-up.
class StackedRows {
 public:
  explicit StackedRows(Eigen::Index columns)
      : x_(Eigen::VectorXd::Zero(columns)), free_(Eigen::MatrixXd::Identity(columns, columns)) {}

  static constexpr double rounding = 1e-9;

  /// Directions in which earlier ranks leave less than the part `least` of the largest entry of A free count as none: a
  /// solution grows by 1/least at most.
  void add(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double least = rounding);
  const Eigen::VectorXd& solution() const { return x_; }
  /// Orthonormal columns: directions that no row says anything about.
  const Eigen::MatrixXd& free() const { return free_; }

 private:
  Eigen::VectorXd x_;
  Eigen::MatrixXd free_;
};

}  // namespace freeplay
