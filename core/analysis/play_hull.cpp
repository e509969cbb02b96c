#include "analysis/play_hull.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "linear/singular_values.h"

namespace freeplay {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index numbers_each = 7;           // of a bound
constexpr double dependent_bounds = 1e-10;  // singular value against the largest, and pivot of chosen bounds
constexpr double bounds_rounding = 1e-9, same_corner = 1e-7;  // of a bound, of a vertex

/// Directions that the bounds hold, as columns: coordinates of shift and turn where these are independent.
MatrixXd held_directions(const MatrixXd& bounds) {
  std::vector<Index> used;
  for (Index c = 0; c < bounds.cols(); ++c) {
    if (bounds.col(c).cwiseAbs().maxCoeff() > 0.0) used.push_back(c);
  }
  MatrixXd scaled = bounds(Eigen::all, used);
  const VectorXd size = scaled.colwise().norm();
  scaled = scaled * size.cwiseInverse().asDiagonal();
  const SingularValues svd = singular_values(scaled, SingularVectors::none, SingularVectors::full);
  Index rank = 0;
  while (rank < svd.sigma.size() && svd.sigma[rank] > dependent_bounds * svd.sigma[0]) ++rank;
  const auto width = static_cast<Index>(used.size());
  const MatrixXd own = rank == width ? MatrixXd(MatrixXd::Identity(width, width))
                                     : MatrixXd(size.cwiseInverse().asDiagonal() * svd.v.leftCols(rank));
  MatrixXd out = MatrixXd::Zero(bounds.cols(), rank);
  for (Index k = 0; k < width; ++k) out.row(used[static_cast<std::size_t>(k)]) = own.row(k);
  return out;
}

/// Vertices of |facets y| <= 1: as many bounds as numbers at their ends, the others within.
class Vertices {
 public:
  explicit Vertices(const MatrixXd& facets) : facets_(facets) { choose(0); }
  MatrixXd found() const {
    MatrixXd out(facets_.cols(), static_cast<Index>(found_.size()));
    for (std::size_t i = 0; i < found_.size(); ++i) out.col(static_cast<Index>(i)) = found_[i];
    return out;
  }

 private:
  void choose(Index from) {
    if (static_cast<Index>(chosen_.size()) == facets_.cols()) return solve();
    for (Index i = from; i < facets_.rows(); ++i) {
      chosen_.push_back(i);
      choose(i + 1);
      chosen_.pop_back();
    }
  }
  void solve() {
    const MatrixXd rows = facets_(chosen_, Eigen::all);
    Eigen::FullPivLU<MatrixXd> lu(rows);
    lu.setThreshold(dependent_bounds);
    if (!lu.isInvertible()) return;
    const std::size_t count = chosen_.size();
    // The first sign is +: opposites are not kept.
    for (unsigned signs = 0; signs < 1U << (count - 1); ++signs) {
      VectorXd ends = VectorXd::Ones(static_cast<Index>(count));
      for (std::size_t k = 1; k < count; ++k) {
        if ((signs >> (k - 1) & 1U) != 0) ends[static_cast<Index>(k)] = -1.0;
      }
      const VectorXd y = lu.solve(ends);
      if ((facets_ * y).cwiseAbs().maxCoeff() > 1.0 + bounds_rounding) continue;
      const double near = same_corner * y.norm();
      const auto is_same = [&](const VectorXd& other) {
        return (y - other).norm() < near || (y + other).norm() < near;
      };
      if (std::ranges::none_of(found_, is_same)) found_.push_back(y);
    }
  }
  const MatrixXd& facets_;
  std::vector<Index> chosen_;
  std::vector<VectorXd> found_;
};

}  // namespace

BoundedPlay bounded_play(Span<const double> play_bounds, double size) {
  const auto count = static_cast<Index>(play_bounds.size) / numbers_each;
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> given(
      play_bounds.data, count, numbers_each);
  const MatrixXd bounds = size * given.col(0).cwiseInverse().asDiagonal() * given.rightCols(6);
  MatrixXd directions = held_directions(bounds);
  PlayHull hull;
  hull.facets = bounds * directions;
  hull.vertices = Vertices(hull.facets).found();
  const VectorXd extent = hull.vertices.cwiseAbs().rowwise().maxCoeff();
  directions = directions * extent.asDiagonal();
  hull.facets = hull.facets * extent.asDiagonal();
  hull.vertices = extent.cwiseInverse().asDiagonal() * hull.vertices;
  BoundedPlay out;
  for (Index k = 0; k < directions.cols(); ++k) {
    std::array<double, 6>& twist = out.twist.emplace_back();
    for (Index i = 0; i < 6; ++i) twist[static_cast<std::size_t>(i)] = directions(i, k);
  }
  out.hull = std::move(hull);
  return out;
}

}  // namespace freeplay
