#include "analysis/inverse_dynamics.h"

#include <algorithm>

#include <Eigen/QR>

#include "base/error.h"
#include "base/index.h"
#include "linear/singular_values.h"
#include "model/gear_teeth.h"
#include "system/tooth_forces.h"

namespace freeplay {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double pivot_limit = 1e-10;  // of pivots, and of parts of the null space

/// Rows of the system, then of the inputs.
MatrixXd all_rows(const IdealMechanism& mechanism, const Evaluation& e) {
  const Model& model = mechanism.model();
  const System& system = mechanism.system();
  const int nc = system.layout().nc(), width = system.layout().body_velocities();
  const auto& inputs = mechanism.platform().inputs;
  MatrixXd rows = MatrixXd::Zero(nc + static_cast<Index>(inputs.size()), system.layout().nv());
  std::vector<SparseEntry> entries;
  system.jacobian().list(e.jacobian, entries);
  for (const SparseEntry& entry : entries) rows(entry.row(), entry.col()) += entry.value();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    double row[2 * spatial::velocities], bias = 0.0;
    system.joints().coordinate_row(inputs[i], e, row, bias);
    const JointElement& joint = model.joints[at(inputs[i])];
    const BodyId bodies[2] = {model.markers[at(joint.marker_a)].body, model.markers[at(joint.marker_b)].body};
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < width && bodies[k] != ground; ++c) {
        rows(nc + static_cast<Index>(i), width * bodies[k] + c) += row[width * k + c];
      }
    }
  }
  return rows;
}

/// Moves `lambda` along the columns of `null` to least norm of its rows from `first` on, `count` of them; returns the
/// directions that are left.
MatrixXd shift(VectorXd& lambda, const MatrixXd& null, Index first, Index count) {
  if (null.cols() == 0 || count == 0) return null;
  const SingularValues svd =
      singular_values(null.middleRows(first, count), SingularVectors::full, SingularVectors::full);
  Index rank = 0;
  while (rank < svd.sigma.size() && svd.sigma[rank] > pivot_limit) ++rank;
  const VectorXd wanted = -(svd.u.leftCols(rank).transpose() * lambda.segment(first, count));
  lambda += null * (svd.v.leftCols(rank) * wanted.cwiseQuotient(svd.sigma.head(rank)));
  return null * svd.v.rightCols(null.cols() - rank);
}

}  // namespace

InverseDynamics::Found InverseDynamics::solve(double t, const Posture& posture, const std::vector<double>& v,
                                              const std::vector<double>& a, double preload, Efforts& out) {
  const IdealMechanism& mechanism = solver_.mechanism();
  const System& system = mechanism.system();
  const Evaluation& e = solver_.evaluate_moving(t, posture, v, term_position | term_force);
  const int nc = system.layout().nc(), nv = system.layout().nv();
  const Index inputs = static_cast<Index>(mechanism.platform().inputs.size());
  const MatrixXd rows = all_rows(mechanism, e);
  VectorXd load(nv);
  for (int i = 0; i < nv; ++i) load[i] = e.force[at(i)] - system.inertia().mass()[at(i)] * a[at(i)];

  // rows P = Q R, so rows^T lambda = load becomes R^T (Q^T lambda) = P^T load.
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(pivot_limit);
  qr.compute(rows);
  const Index rank = qr.rank();
  if (rank < nv) return Found::unbalanced;
  const MatrixXd q = qr.householderQ();
  const VectorXd permuted = qr.colsPermutation().transpose() * load;
  const VectorXd y =
      qr.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().transpose().solve(permuted.head(rank));
  VectorXd lambda = q.leftCols(rank) * y;

  const Index first_driver = system.layout().first_driver_row(), drivers = rows.rows() - first_driver;
  const MatrixXd null = q.rightCols(rows.rows() - rank);
  MatrixXd left = shift(lambda, null, first_driver, drivers);
  if (preload != 0.0) {
    if (null.cols() == left.cols()) return Found::no_preload;
    if (null.cols() - left.cols() > 1) return Found::many_preloads;
    const SingularValues svd =
        singular_values(null.middleRows(first_driver, drivers), SingularVectors::none, SingularVectors::thin);
    VectorXd tension = null * svd.v.col(0) / svd.sigma[0];
    Index largest = 0;
    tension.tail(inputs).cwiseAbs().maxCoeff(&largest);
    // The effort is -lambda.
    if (tension.tail(inputs)[largest] > 0.0) tension = -tension;
    lambda += preload * tension;
  }
  shift(lambda, left, 0, first_driver);

  out.input.clear();
  for (Index i = 0; i < inputs; ++i) out.input.push_back(-lambda[nc + i]);
  out.wrench.clear();
  for (int j = 0; j < static_cast<int>(mechanism.model().joints.size()); ++j) {
    system.constraints().reaction(j, e, {lambda.data(), at(nc)}, out.wrench.emplace_back().data());
  }
  for (const Gear& gear : mechanism.model().gears) {
    if (!has_teeth(mechanism.model().joints[at(gear.joint)])) continue;
    for (const ToothWrench& one : tooth_wrenches(system, gear, e, {lambda.data(), at(nc)})) {
      one.add_to(out.wrench[at(one.joint)].data(), 5);
    }
  }
  return Found::yes;
}

}  // namespace freeplay
