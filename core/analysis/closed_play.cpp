#include "analysis/closed_play.h"

#include <algorithm>
#include <limits>

#include <Eigen/QR>

namespace freeplay {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rim_step = 0.6;     // standard deviation of a step on rims [rad]
constexpr int rim_steps = 3;         // from one sample to the next
constexpr double closed = 1e-13;     // gap that counts as none; plays have size 1
constexpr double same_place = 1e-8;  // distance of places that are one
constexpr int most_corrections = 30, most_starts = 1000;

}  // namespace

ClosedPlay::ClosedPlay(const MatrixXd& across, MatrixXd along, std::vector<PlayRoom> rooms, const PlayLaw& law,
                       RandomDraws& random)
    : closure_(across.transpose()), along_(std::move(along)), rooms_(std::move(rooms)), law_(law), random_(random) {
  plays_ = VectorXd::Zero(closure_.cols());
  if (law_.kind == PlayLaw::Kind::rim) exists_ = find_rims();
  for (Index i = 0; exists_ && i < 20 * plays_.size(); ++i) next();
}

const VectorXd& ClosedPlay::next() {
  if (law_.kind != PlayLaw::Kind::rim) {
    const Index steps = law_.kind == PlayLaw::Kind::normal ? plays_.size() : 1;
    for (Index i = 0; i < steps; ++i) walk_over_discs();
    return plays_;
  }
  for (int i = 0; i < rim_steps; ++i) walk_on_rims();
  plays_ = plays_at(rim_.place);
  // What closes, closes the other way round, too; no small step may lead there.
  if (random_.uniform() < 0.5) plays_ = -plays_;
  return plays_;
}

// To a random point of the chord in a random direction.
void ClosedPlay::walk_over_discs() {
  if (along_.cols() == 0) return;
  VectorXd mixture(along_.cols());
  for (Index i = 0; i < mixture.size(); ++i) mixture[i] = random_.normal();
  const VectorXd direction = along_ * mixture;
  double least = -std::numeric_limits<double>::infinity(), most = -least;
  for (const PlayRoom& room : rooms_) {
    const VectorXd u = direction.segment(room.place, room.size), y = plays_.segment(room.place, room.size);
    if (room.hull != nullptr) {
      const VectorXd rise = room.hull->facets * u, at = room.hull->facets * y;
      for (Index i = 0; i < rise.size(); ++i) {
        if (rise[i] == 0.0) continue;
        least = std::max(least, std::min(0.0, -(at[i] + std::copysign(1.0, rise[i])) / rise[i]));
        most = std::min(most, std::max(0.0, (std::copysign(1.0, rise[i]) - at[i]) / rise[i]));
      }
      continue;
    }
    const double a = u.squaredNorm(), b = u.dot(y), c = y.squaredNorm() - 1.0;
    if (!(a > 0.0)) continue;
    const double root = std::sqrt(std::max(0.0, b * b - a * c));
    least = std::max(least, (-b - root) / a);
    most = std::min(most, (-b + root) / a);
  }
  if (law_.kind == PlayLaw::Kind::normal) {
    // The part of the chord where the law is denser than a random share of what it is here.
    const double length = direction.norm(), centre = -direction.dot(plays_) / (length * length);
    const double depth = -2.0 * law_.sigma * law_.sigma * std::log(1.0 - random_.uniform());
    const double half = std::sqrt(centre * centre + depth / (length * length));
    least = std::max(least, centre - half);
    most = std::min(most, centre + half);
  }
  if (!(most > least)) return;
  plays_ += (least + (most - least) * random_.uniform()) * direction;
}

VectorXd ClosedPlay::plays_at(const VectorXd& place) const {
  VectorXd plays(closure_.cols());
  for (std::size_t r = 0; r < rooms_.size(); ++r) {
    const double value = place[static_cast<Index>(r)];
    plays[rooms_[r].place] = rooms_[r].size == 2 ? std::cos(value) : value;
    if (rooms_[r].size == 2) plays[rooms_[r].place + 1] = std::sin(value);
  }
  return plays;
}

MatrixXd ClosedPlay::normal_at(const VectorXd& place) const {
  MatrixXd normal(place.size(), closure_.rows());
  for (std::size_t r = 0; r < rooms_.size(); ++r) {
    const Index k = static_cast<Index>(r), c = rooms_[r].place;
    normal.row(k) = closure_.col(c).transpose();
    if (rooms_[r].size == 2) {
      normal.row(k) = (std::cos(place[k]) * closure_.col(c + 1) - std::sin(place[k]) * closure_.col(c)).transpose();
    }
  }
  return normal;
}

bool ClosedPlay::inside(const VectorXd& place) const {
  for (std::size_t r = 0; r < rooms_.size(); ++r) {
    if (rooms_[r].size == 1 && std::abs(place[static_cast<Index>(r)]) > 1.0) return false;
  }
  return true;
}

bool ClosedPlay::look(Rim& rim) const {
  rim.normal = normal_at(rim.place);
  if (rim.normal.rows() < rim.normal.cols()) return false;
  const Eigen::HouseholderQR<MatrixXd> qr(rim.normal);
  rim.basis = qr.householderQ() * MatrixXd::Identity(rim.normal.rows(), rim.normal.cols());
  rim.volume = std::abs(qr.matrixQR().diagonal().prod());
  return rim.volume > 0.0;
}

// Newton's method along the columns of `normal`; along those of each place where it is null.
bool ClosedPlay::put_back(const MatrixXd* normal, VectorXd& place) const {
  for (int i = 0; i < most_corrections; ++i) {
    const VectorXd gap = closure_ * plays_at(place);
    if (gap.lpNorm<Eigen::Infinity>() <= closed) return true;
    const MatrixXd here = normal_at(place);
    const MatrixXd& columns = normal != nullptr ? *normal : here;
    place -= columns * (here.transpose() * columns).colPivHouseholderQr().solve(gap);
    if (!place.allFinite()) return false;
  }
  return false;
}

bool ClosedPlay::find_rims() {
  for (int i = 0; i < most_starts; ++i) {
    rim_.place.resize(static_cast<Index>(rooms_.size()));
    for (std::size_t r = 0; r < rooms_.size(); ++r) {
      const double share = 2.0 * random_.uniform() - 1.0;
      rim_.place[static_cast<Index>(r)] = rooms_[r].size == 2 ? M_PI * share : share;
    }
    if (put_back(nullptr, rim_.place) && inside(rim_.place) && look(rim_)) return true;
  }
  return false;
}

void ClosedPlay::walk_on_rims() {
  VectorXd step(rim_.place.size());
  for (Index i = 0; i < step.size(); ++i) step[i] = rim_step * random_.normal();
  const double threshold = random_.uniform();
  step -= rim_.basis * (rim_.basis.transpose() * step);
  Rim there;
  there.place = rim_.place + step;
  if (!put_back(&rim_.normal, there.place) || !inside(there.place) || !look(there)) return;
  VectorXd back = rim_.place - there.place;
  back -= there.basis * (there.basis.transpose() * back);
  // Given that plays close, places are the likelier the slower the closure changes there.
  const double ratio =
      rim_.volume / there.volume * std::exp(0.5 * (step.squaredNorm() - back.squaredNorm()) / (rim_step * rim_step));
  if (threshold >= ratio) return;
  VectorXd returned = there.place + back;
  if (!put_back(&there.normal, returned) || (returned - rim_.place).norm() > same_place) return;
  rim_ = std::move(there);
}

}  // namespace freeplay
