#include "analysis/play_samples.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/SVD>

namespace freeplay {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Numbers that do not depend on the standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * M_PI * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

/// A disc (2 numbers) or an interval (1) of size 1 among the plays.
struct Room {
  Index place, size;
};

class Sampler {
 public:
  Sampler(const MatrixXd& a, const MatrixXd& inverse, const std::vector<Generator>& generators, std::uint64_t seed)
      : random_(seed) {
    Index width = 0;
    for (const Generator& generator : generators) {
      if (generator.size <= 0.0) continue;
      rooms_.push_back({width, generator.columns.cols()});
      width += generator.columns.cols();
    }
    MatrixXd all(a.rows(), width);
    std::size_t room = 0;
    for (const Generator& generator : generators) {
      if (generator.size <= 0.0) continue;
      all.middleCols(rooms_[room].place, rooms_[room].size) = generator.size * generator.columns;
      ++room;
    }
    image_ = inverse * all;
    plays_ = VectorXd::Zero(width);
    if (width == 0 || a.rows() == 3) return;
    const Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeFullU);
    const MatrixXd closure = svd.matrixU().rightCols(a.rows() - 3).transpose() * all;
    const Eigen::JacobiSVD<MatrixXd> free(closure, Eigen::ComputeFullV);
    const double limit = 1e-12 * std::max(1e-300, all.cwiseAbs().maxCoeff());
    Index rank = 0;
    while (rank < free.singularValues().size() && free.singularValues()[rank] > limit) ++rank;
    if (rank > 0) directions_ = free.matrixV().rightCols(width - rank);
    walks_ = rank > 0;
    for (Index i = 0; walks_ && i < 20 * width; ++i) walk();
  }

  Eigen::Vector3d draw() {
    if (walks_) {
      walk();
    } else {
      fill();
    }
    return image_ * plays_;
  }

 private:
  void fill() {
    for (const Room& room : rooms_) {
      if (room.size == 1) {
        plays_[room.place] = 2.0 * random_.uniform() - 1.0;
        continue;
      }
      const double radius = std::sqrt(random_.uniform()), angle = 2.0 * M_PI * random_.uniform();
      plays_[room.place] = radius * std::cos(angle);
      plays_[room.place + 1] = radius * std::sin(angle);
    }
  }

  // To a random point of the chord in a random direction.
  void walk() {
    if (directions_.cols() == 0) return;
    VectorXd mixture(directions_.cols());
    for (Index i = 0; i < mixture.size(); ++i) mixture[i] = random_.normal();
    const VectorXd direction = directions_ * mixture;
    double least = -std::numeric_limits<double>::infinity(), most = -least;
    for (const Room& room : rooms_) {
      const VectorXd u = direction.segment(room.place, room.size), y = plays_.segment(room.place, room.size);
      const double a = u.squaredNorm(), b = u.dot(y), c = y.squaredNorm() - 1.0;
      if (!(a > 0.0)) continue;
      const double root = std::sqrt(std::max(0.0, b * b - a * c));
      least = std::max(least, (-b - root) / a);
      most = std::min(most, (-b + root) / a);
    }
    if (!(most > least)) return;
    plays_ += (least + (most - least) * random_.uniform()) * direction;
  }

  Random random_;
  std::vector<Room> rooms_;
  MatrixXd image_, directions_;
  VectorXd plays_;
  bool walks_ = false;
};

}  // namespace

std::optional<PlayStatistics> sample_play(const IdealMechanism& mechanism, const VelocityMap& map, long count,
                                          std::uint64_t seed) {
  const std::optional<MatrixXd> inverse = pseudo_inverse(map.a, mechanism.length());
  if (!inverse) return std::nullopt;
  Sampler sampler(map.a, *inverse, generators_of(mechanism, map), seed);
  PlayStatistics out;
  for (long i = 0; i < count; ++i) {
    const Eigen::Vector3d x = sampler.draw();
    const double squared = x.head<2>().squaredNorm();
    out.rms_position += squared;
    out.rms_dangle += x[2] * x[2];
    out.max_position = std::max(out.max_position, squared);
    out.max_dangle = std::max(out.max_dangle, std::abs(x[2]));
  }
  out.rms_position = std::sqrt(out.rms_position / static_cast<double>(count));
  out.rms_dangle = std::sqrt(out.rms_dangle / static_cast<double>(count));
  out.max_position = std::sqrt(out.max_position);
  return out;
}

std::optional<PlayStatistics> least_squares_play(const IdealMechanism& mechanism, const VelocityMap& map) {
  const std::optional<MatrixXd> inverse = pseudo_inverse(map.a, mechanism.length());
  if (!inverse) return std::nullopt;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Generator& generator : generators_of(mechanism, map)) {
    const MatrixXd image = generator.size * (*inverse * generator.columns);
    covariance += image * image.transpose() / (image.cols() == 2 ? 4.0 : 3.0);
  }
  PlayStatistics out;
  out.rms_position = std::sqrt(covariance(0, 0) + covariance(1, 1));
  out.rms_dangle = std::sqrt(covariance(2, 2));
  return out;
}

}  // namespace freeplay
