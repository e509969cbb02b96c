#include "analysis/feasible_set.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "analysis/rounded_support.h"
#include "linear/singular_values.h"

namespace freeplay {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double certainty = 1e-10;  // of the farthest point in the plane, relative
constexpr double certainty_in_space = 1e-7;
constexpr double regular = 1e-12;         // determinant of three rows of length 1
constexpr double on_boundary = 1e-11;     // of D, relative
constexpr double smallest_round = 1e-11;  // of corners, when h is minimised

/// Half widths D of all rows when every generator acts on one row alone: the right sides then fill a box.
std::optional<VectorXd> box_of(Index rows, const std::vector<Generator>& generators) {
  VectorXd widths = VectorXd::Zero(rows);
  for (const Generator& generator : generators) {
    const double largest = generator.columns.cwiseAbs().maxCoeff();
    Index own = -1;
    for (Index r = 0; r < rows; ++r) {
      if (generator.columns.row(r).cwiseAbs().maxCoeff() <= 1e-14 * largest) continue;
      if (own >= 0) return std::nullopt;
      own = r;
    }
    if (own < 0) continue;
    const VectorXd row = generator.columns.row(own).transpose();
    widths[own] += generator.size * (generator.hull == nullptr ? row.norm() : generator.hull->support(row));
  }
  return widths;
}

std::vector<Generator> generators_of(const VectorXd& widths) {
  std::vector<Generator> out;
  for (Index r = 0; r < widths.size(); ++r) {
    Generator generator{MatrixXd::Zero(widths.size(), 1), widths[r]};
    generator.columns(r, 0) = 1.0;
    out.push_back(std::move(generator));
  }
  return out;
}

/// dX of N numbers, 3 or 6.
template <int N>
using Change = Eigen::Matrix<double, N, 1>;
template <int N>
constexpr int lengths = N == 3 ? 2 : 3;
template <int N>
using Shift = Eigen::Matrix<double, lengths<N>, 1>;

/// h(n) = sum size |columns^T image^T n|, of polytopes the most of their corners, and the dX where it is attained.
template <int N>
class LinearImage {
  using Columns = Eigen::Matrix<double, N, lengths<N>>;

 public:
  LinearImage(const MatrixXd& image, const std::vector<Generator>& generators) {
    for (const Generator& generator : generators) {
      if (generator.hull != nullptr) {
        corners_.push_back(generator.size * (image * generator.columns * generator.hull->vertices));
        continue;
      }
      Columns columns = Columns::Zero();
      columns.leftCols(generator.columns.cols()) = generator.size * (image * generator.columns);
      columns_.push_back(columns);
    }
  }
  double support(const Change<N>& n, Change<N>& at) const {
    double value = 0.0;
    at.setZero();
    for (const Columns& columns : columns_) {
      const Shift<N> w = columns.transpose() * n;
      const double size = w.norm();
      value += size;
      if (size > 0.0) at += columns * (w / size);
    }
    for (const auto& corners : corners_) {
      Index farthest = 0;
      const VectorXd w = corners.transpose() * n;
      value += w.cwiseAbs().maxCoeff(&farthest);
      at += std::copysign(1.0, w[farthest]) * corners.col(farthest);
    }
    return value;
  }

 private:
  std::vector<Columns> columns_;
  std::vector<Eigen::Matrix<double, N, Eigen::Dynamic>> corners_;  // of polytopes
};

/// The direction n in the shifts (`first` 0) or in the turns.
template <int N>
Change<N> embedded(const Shift<N>& n, int first) {
  Change<N> out = Change<N>::Zero();
  out.template segment<lengths<N>>(first) = n;
  return out;
}

template <int N, class Support>
WorstCase worst_of(const Support& support) {
  WorstCase out;
  Change<N> at;
  for (int i = 0; i < N; ++i) out.change[static_cast<std::size_t>(i)] = support(Change<N>::Unit(i), at);
  const auto largest = [&](int first, Shift<N>& direction) {
    return farthest(
        [&](const Shift<N>& n, Shift<N>& p) {
          const double value = support(embedded<N>(n, first), at);
          p = at.template segment<lengths<N>>(first);
          return value;
        },
        direction);
  };
  Shift<N> direction;
  out.dangle = out.change[2];
  if constexpr (N == 6) out.dangle = largest(3, direction);
  out.position = largest(0, direction);
  support(embedded<N>(direction, 0), at);
  out.worst = at;
  return out;
}

/// Vertices of |A_i dX| <= D_i: three rows at their ends, the others within.
WorstCase worst_vertex(const MatrixXd& a, const VectorXd& widths) {
  WorstCase out;
  out.worst = Vector3d::Zero();
  const Index rows = a.rows();
  out.multipliers = VectorXd::Zero(rows);
  const double slack = on_boundary * widths.maxCoeff();
  Index active[3] = {};
  for (Index i = 0; i < rows; ++i) {
    for (Index j = i + 1; j < rows; ++j) {
      for (Index k = j + 1; k < rows; ++k) {
        Eigen::Matrix3d three;
        three << a.row(i), a.row(j), a.row(k);
        const Eigen::PartialPivLU<Eigen::Matrix3d> lu(three);
        const double scale = three.row(0).norm() * three.row(1).norm() * three.row(2).norm();
        if (!(std::abs(lu.determinant()) > regular * scale)) continue;
        const Eigen::Matrix3d inverse = lu.inverse();
        for (int signs = 0; signs < 4; ++signs) {
          const Vector3d d(widths[i], (signs & 1) ? -widths[j] : widths[j], (signs & 2) ? -widths[k] : widths[k]);
          const Vector3d x = inverse * d;
          bool inside = true;
          for (Index r = 0; r < rows && inside; ++r) {
            inside = r == i || r == j || r == k || std::abs(a.row(r).dot(x)) <= widths[r] + slack;
          }
          if (!inside) continue;
          for (int c = 0; c < 3; ++c) {
            double& most = out.change[static_cast<std::size_t>(c)];
            most = std::max(most, std::abs(x[c]));
          }
          if (const double position = std::hypot(x[0], x[1]); position > out.position) {
            out.position = position;
            out.worst = x;
            active[0] = i, active[1] = j, active[2] = k;
          }
        }
      }
    }
  }
  out.dangle = out.change[2];
  if (!(out.position > 0.0)) return out;
  Eigen::Matrix3d three;
  three << a.row(active[0]), a.row(active[1]), a.row(active[2]);
  const Vector3d n(out.worst[0] / out.position, out.worst[1] / out.position, 0.0);
  const Vector3d mu = three.transpose().partialPivLu().solve(n);
  for (int i = 0; i < 3; ++i) out.multipliers[active[i]] = mu[i];
  return out;
}

/// min over t of the sum of all supports at mu_0 + N t, N spanning the null space of A^T.
class Dual {
 public:
  Dual(const MatrixXd& a, const std::vector<Generator>& generators) : generators_(generators) {
    const SingularValues svd = singular_values(a, SingularVectors::full, SingularVectors::full);
    image_ = svd.v * svd.sigma.cwiseInverse().asDiagonal() * svd.u.leftCols(a.cols()).transpose();
    null_ = svd.u.rightCols(a.rows() - a.cols());
    for (const Generator& generator : generators) {
      supports_.emplace_back(generator);
      reduced_.push_back(null_.transpose() * supports_.back().columns());
    }
  }

  template <int N>
  double support(const Change<N>& n, Change<N>& at) const {
    const VectorXd start = image_.transpose() * n;
    VectorXd t = VectorXd::Zero(null_.cols());
    double scale = 0.0;
    for (const RoundedSupport& support : supports_) scale = std::max(scale, support.scale(start));
    // The kinks are rounded, less and less; those of corners in small steps, as each step may cross but few of them.
    const bool corners = std::ranges::any_of(generators_, [](const Generator& g) { return g.hull != nullptr; });
    const double less = corners ? 0.5 : 0.1;
    const int most = corners ? 200 : 30;
    for (double round = 0.1; round >= smallest_round; round *= less) {
      for (int i = 0; i < most && improve(start, round * scale, t); ++i) {
      }
    }
    multipliers_ = start + null_ * t;
    double value = 0.0;
    VectorXd right = VectorXd::Zero(start.size());
    for (std::size_t k = 0; k < generators_.size(); ++k) {
      value += generators_[k].size * supports_[k].value(multipliers_, 0.0);
      supports_[k].add_point(multipliers_, smallest_round * scale, generators_[k].size, right);
    }
    at = image_ * right;
    return value;
  }
  const VectorXd& multipliers() const { return multipliers_; }

 private:
  double rounded(const VectorXd& start, double round, const VectorXd& t) const {
    double value = 0.0;
    const VectorXd mu = start + null_ * t;
    for (std::size_t k = 0; k < generators_.size(); ++k) value += generators_[k].size * supports_[k].value(mu, round);
    return value;
  }

  // One damped Newton step; false when it no longer pays.
  bool improve(const VectorXd& start, double round, VectorXd& t) const {
    const VectorXd mu = start + null_ * t;
    VectorXd gradient = VectorXd::Zero(t.size());
    MatrixXd hessian = MatrixXd::Zero(t.size(), t.size());
    double now = 0.0;
    for (std::size_t k = 0; k < generators_.size(); ++k) {
      const double value = supports_[k].value(mu, round);
      if (!(value > 0.0)) continue;
      now += generators_[k].size * value;
      supports_[k].add(mu, round, generators_[k].size, reduced_[k], gradient, hessian);
    }
    hessian.diagonal().array() += 1e-14 * hessian.trace() + 1e-300;
    const VectorXd step = -hessian.ldlt().solve(gradient);
    const double slope = gradient.dot(step);
    if (!(slope < -1e-15 * now)) return false;
    for (double length = 1.0; length > 1e-9; length *= 0.5) {
      const VectorXd trial = t + length * step;
      if (rounded(start, round, trial) > now + 1e-4 * length * slope) continue;
      t = trial;
      return true;
    }
    return false;
  }

  const std::vector<Generator>& generators_;
  MatrixXd image_, null_;
  std::vector<RoundedSupport> supports_;  // by generator
  std::vector<MatrixXd> reduced_;
  mutable VectorXd multipliers_;
};

/// The largest value of a support function h that was met, and its direction.
template <int N>
class Ascent {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Support = std::function<double(const Vector&, Vector&)>;
  Ascent(const Support& support, Vector& direction) : support_(support), direction_(direction) {
    direction_ = Vector::UnitX();
  }

  /// h(n), and from there to where the farthest point lies, again and again: that never makes h smaller.
  double look(const Vector& n) {
    Vector p, m = n;
    const double value = support_(n, p);
    if (value > best_) best_ = value, direction_ = n;
    for (int i = 0; i < 60 && p.norm() > 0.0; ++i) {
      const Vector next = p.normalized();
      const double reached = support_(next, p);
      if (!(reached > best_)) break;
      best_ = reached;
      direction_ = next;
      if ((next - m).squaredNorm() < 1e-30) break;
      m = next;
    }
    return value;
  }
  double best() const { return best_; }

 private:
  const Support& support_;
  Vector& direction_;
  double best_ = 0.0;
};

}  // namespace

double farthest(const std::function<double(const Vector2d&, Vector2d&)>& support, Vector2d& direction) {
  constexpr int first_directions = 8;
  constexpr long most = 400'000;
  struct Piece {
    double bound, left, right, at_left, at_right;
    bool operator<(const Piece& other) const { return bound < other.bound; }
  };
  Ascent<2> found(support, direction);
  const auto towards = [](double angle) { return Vector2d(std::cos(angle), std::sin(angle)); };
  // Between two directions h is at most the sinusoid through its values there.
  const auto piece = [](double left, double right, double a, double b) {
    const double width = right - left, c = std::cos(width), s = std::sin(width);
    const bool inside = b > a * c && a > b * c;
    // Distance of the two support lines' intersection, free of cancellation in narrow pieces.
    const double half = std::sin(0.5 * width);
    const double bound = inside ? std::sqrt((a - b) * (a - b) + 4.0 * a * b * half * half) / s : std::max(a, b);
    return Piece{bound, left, right, a, b};
  };
  std::priority_queue<Piece> pieces;
  double values[first_directions + 1];
  for (int i = 0; i < first_directions; ++i) values[i] = found.look(towards(M_PI * i / first_directions));
  values[first_directions] = values[0];
  for (int i = 0; i < first_directions; ++i) {
    pieces.push(piece(M_PI * i / first_directions, M_PI * (i + 1) / first_directions, values[i], values[i + 1]));
  }
  for (long i = 0; i < most && !pieces.empty() && pieces.top().bound > found.best() * (1.0 + certainty); ++i) {
    const Piece top = pieces.top();
    pieces.pop();
    const double middle = 0.5 * (top.left + top.right), value = found.look(towards(middle));
    pieces.push(piece(top.left, middle, top.at_left, value));
    pieces.push(piece(middle, top.right, value, top.at_right));
  }
  return found.best();
}

namespace {

/// Bound of h over a triangle of directions: of all n in its cone h(n) is at most g.n, the linear function with h's
/// values at the corners (rows).
double triangle_bound(const Eigen::Matrix3d& corners, const Vector3d& values) {
  const Eigen::PartialPivLU<Eigen::Matrix3d> lu(corners);
  const Vector3d g = lu.solve(values), share = lu.transpose().solve(g);
  if (share.minCoeff() >= 0.0) return g.norm();
  // Then g.n is largest on an edge.
  double most = values.maxCoeff();
  for (int i = 0; i < 3; ++i) {
    const Vector3d a = corners.row(i), b = corners.row((i + 1) % 3);
    const double u = values[i], v = values[(i + 1) % 3], c = a.dot(b), s = a.cross(b).norm();
    if (u > v * c && v > u * c) most = std::max(most, std::sqrt((u - v) * (u - v) + u * v * (a - b).squaredNorm()) / s);
  }
  return most;
}

}  // namespace

double farthest(const std::function<double(const Vector3d&, Vector3d&)>& support, Vector3d& direction) {
  constexpr long most = 50'000;
  struct Triangle {
    double bound;
    Eigen::Matrix3d corners;
    Vector3d values;
    bool operator<(const Triangle& other) const { return bound < other.bound; }
  };
  Ascent<3> found(support, direction);
  std::priority_queue<Triangle> triangles;
  const auto push = [&](const Eigen::Matrix3d& corners, const Vector3d& values) {
    triangles.push({triangle_bound(corners, values), corners, values});
  };
  // Half of an octahedron; the set is symmetric.
  const Vector3d axes(found.look(Vector3d::UnitX()), found.look(Vector3d::UnitY()), found.look(Vector3d::UnitZ()));
  for (const double x : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) push(Vector3d(x, y, 1.0).asDiagonal(), axes);
  }
  for (long cut = 0; triangles.top().bound > found.best() * (1.0 + certainty_in_space); ++cut) {
    const Triangle top = triangles.top();
    if (cut == most) return top.bound;
    triangles.pop();
    int from = 0;
    double length = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double side = (top.corners.row(i) - top.corners.row((i + 1) % 3)).squaredNorm();
      if (side > length) length = side, from = i;
    }
    const int to = (from + 1) % 3;
    const Vector3d middle = (top.corners.row(from) + top.corners.row(to)).transpose().normalized();
    const double value = found.look(middle);
    for (const int replaced : {from, to}) {
      Eigen::Matrix3d corners = top.corners;
      Vector3d values = top.values;
      corners.row(replaced) = middle.transpose();
      values[replaced] = value;
      push(corners, values);
    }
  }
  return found.best();
}

namespace {

template <int N>
WorstCase least_squares(const MatrixXd& pseudo_inverse, const std::vector<Generator>& generators) {
  const std::optional<VectorXd> box = box_of(pseudo_inverse.cols(), generators);
  const LinearImage<N> image(pseudo_inverse, box ? generators_of(*box) : generators);
  WorstCase out = worst_of<N>([&](const Change<N>& n, Change<N>& at) { return image.support(n, at); });
  out.multipliers = VectorXd::Zero(pseudo_inverse.cols());
  if (out.position > 0.0) {
    const Shift<N> shift = out.worst.head<lengths<N>>();
    out.multipliers = pseudo_inverse.transpose() * embedded<N>(shift.normalized(), 0);
  }
  return out;
}

template <int N>
WorstCase dual_worst_case(const MatrixXd& a, const std::vector<Generator>& generators) {
  const Dual dual(a, generators);
  WorstCase out = worst_of<N>([&](const Change<N>& n, Change<N>& at) { return dual.support<N>(n, at); });
  Shift<N> direction = Shift<N>::UnitX();
  if (out.position > 0.0) direction = out.worst.head<lengths<N>>().normalized();
  Change<N> at;
  dual.support<N>(embedded<N>(direction, 0), at);
  out.multipliers = dual.multipliers();
  return out;
}

}  // namespace

WorstCase least_squares_worst_case(const MatrixXd& pseudo_inverse, const std::vector<Generator>& generators) {
  return pseudo_inverse.rows() == 3 ? least_squares<3>(pseudo_inverse, generators)
                                    : least_squares<6>(pseudo_inverse, generators);
}

WorstCase exact_worst_case(const MatrixXd& a, const std::vector<Generator>& generators) {
  if (a.rows() == a.cols()) return least_squares_worst_case(a.inverse(), generators);
  if (a.cols() != 3) return dual_worst_case<6>(a, generators);
  if (const std::optional<VectorXd> box = box_of(a.rows(), generators)) return worst_vertex(a, *box);
  return dual_worst_case<3>(a, generators);
}

}  // namespace freeplay
