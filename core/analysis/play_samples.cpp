#include "analysis/play_samples.h"

#include <algorithm>
#include <cmath>

#include "analysis/closed_play.h"
#include "base/error.h"
#include "linear/singular_values.h"

namespace freeplay {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class Sampler {
 public:
  Sampler(const MatrixXd& a, const MatrixXd& inverse, const std::vector<Generator>& generators, const PlayLaw& law,
          std::uint64_t seed)
      : law_(law), random_(seed) {
    Index width = 0;
    for (const Generator& generator : generators) {
      if (generator.size <= 0.0) continue;
      rooms_.push_back({width, generator.columns.cols(), generator.hull});
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
    if (width == 0 || a.rows() == a.cols()) return;
    const SingularValues svd = singular_values(a, SingularVectors::full);
    const MatrixXd closure = svd.u.rightCols(a.rows() - a.cols()).transpose() * all;
    const SingularValues free = singular_values(closure, SingularVectors::none, SingularVectors::full);
    const double limit = 1e-12 * std::max(1e-300, all.cwiseAbs().maxCoeff());
    Index rank = 0;
    while (rank < free.sigma.size() && free.sigma[rank] > limit) ++rank;
    if (rank == 0) return;
    const bool balls =
        std::ranges::any_of(rooms_, [](const PlayRoom& one) { return one.size == 3 || one.hull != nullptr; });
    if (law_.kind == PlayLaw::Kind::rim && balls) {
      throw Error(Error::Category::usage, "bad-value",
                  "play of balls that touch their sockets, and of sliders that touch the walls of their guides in "
                  "space, can be drawn only in mechanisms without redundancy");
    }
    const MatrixXd& v = free.v;
    closed_.emplace(v.leftCols(rank), v.rightCols(width - rank), rooms_, law_, random_);
  }
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;

  bool has_samples() const { return !closed_ || closed_->exists(); }

  VectorXd draw() {
    if (closed_) return image_ * closed_->next();
    for (const PlayRoom& room : rooms_) {
      const std::span<double> own(&plays_[room.place], static_cast<std::size_t>(room.size));
      if (room.hull != nullptr) {
        freeplay::draw(law_, random_, *room.hull, own);
      } else {
        freeplay::draw(law_, random_, own);
      }
    }
    return image_ * plays_;
  }

 private:
  PlayLaw law_;
  RandomDraws random_;
  std::vector<PlayRoom> rooms_;
  MatrixXd image_;
  VectorXd plays_;
  std::optional<ClosedPlay> closed_;
};

}  // namespace

std::optional<PlayStatistics> sample_play(const IdealMechanism& mechanism, const VelocityMap& map, long count,
                                          std::uint64_t seed, const PlayLaw& law, const Tick& tick) {
  const std::optional<MatrixXd> inverse = pseudo_inverse(map, mechanism.length());
  if (!inverse) return std::nullopt;
  Sampler sampler(map.a, *inverse, generators_of(mechanism, map), law, seed);
  if (!sampler.has_samples()) return std::nullopt;
  const auto lengths = static_cast<Index>(mechanism.form().lengths);
  PlayStatistics out;
  for (long i = 0; i < count; ++i) {
    if (tick && i % 1024 == 0) tick(0);
    const VectorXd x = sampler.draw();
    const double shift = x.head(lengths).squaredNorm(), turn = x.tail(x.size() - lengths).squaredNorm();
    out.rms_position += shift;
    out.rms_dangle += turn;
    out.max_position = std::max(out.max_position, shift);
    out.max_dangle = std::max(out.max_dangle, turn);
  }
  out.rms_position = std::sqrt(out.rms_position / static_cast<double>(count));
  out.rms_dangle = std::sqrt(out.rms_dangle / static_cast<double>(count));
  out.max_position = std::sqrt(out.max_position);
  out.max_dangle = std::sqrt(out.max_dangle);
  return out;
}

std::optional<PlayStatistics> least_squares_play(const IdealMechanism& mechanism, const VelocityMap& map,
                                                 const PlayLaw& law) {
  const std::optional<MatrixXd> inverse = pseudo_inverse(map, mechanism.length());
  if (!inverse) return std::nullopt;
  MatrixXd covariance = MatrixXd::Zero(inverse->rows(), inverse->rows());
  for (const Generator& generator : generators_of(mechanism, map)) {
    if (generator.hull != nullptr) return std::nullopt;
    const MatrixXd image = generator.size * (*inverse * generator.columns);
    covariance += image * image.transpose() * variance(law, static_cast<int>(image.cols()));
  }
  PlayStatistics out;
  const auto lengths = static_cast<Index>(mechanism.form().lengths);
  out.rms_position = std::sqrt(covariance.diagonal().head(lengths).sum());
  out.rms_dangle = std::sqrt(covariance.diagonal().tail(covariance.rows() - lengths).sum());
  return out;
}

}  // namespace freeplay
