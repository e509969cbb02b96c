#include "stage/acceleration_matrix.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/LU>

#include "base/index.h"
#include "stage/block_inverse.h"

namespace freeplay {
namespace {

constexpr double measurable = 1e-10;     // pivot of the normal matrix that is not one of rounding
constexpr double regular_enough = 1e-7;  // pivot of the normal matrix below which the whole one is factored

}  // namespace

void AccelerationMatrix::set_pattern(std::span<const char> dependent) {
  const int nv = system_.layout().nv(), width = system_.layout().body_velocities();
  dependent_.assign(dependent.begin(), dependent.end());
  whole_.reset();
  by_normal_ = false;
  unit_ = 0.0;
  const Owners owners = find_prescribed();
  const std::vector<NormalMatrix::Piece> free_pieces = place_pieces(owners);
  sort_couplings(owners);

  // Prescribed bodies have no pieces there.
  std::vector<double> mass(system_.inertia().mass().begin(), system_.inertia().mass().end());
  for (const Prescribed& body : prescribed_) std::fill_n(&mass[at(width * body.who.body)], width, 1.0);
  has_normal_ = std::ranges::all_of(mass, [](double m) { return m > 0.0; }) &&
                normal_.set_pattern(mass, width, static_cast<int>(free_rows_.size()), free_pieces);
  multipliers_.assign(free_rows_.size(), 0.0);
  forces_.assign(at(width) * prescribed_.size(), 0.0);
  right_.assign(at(nv) + dependent.size(), 0.0);
  update_.assign(right_.size(), 0.0);
  all_free_ = free_rows_.size() == dependent.size();
}

AccelerationMatrix::Owners AccelerationMatrix::find_prescribed() {
  const int width = system_.layout().body_velocities();
  const std::size_t rows = dependent_.size();
  Owners owners{std::vector<int>(rows, -1), std::vector<int>(at(system_.layout().nv() / width), -1)};
  prescribed_.clear();
  for (const PrescribedBody& body : prescribed_bodies(system_.jacobian(), dependent_)) {
    const int index = static_cast<int>(prescribed_.size());
    owners.of_body[at(body.body)] = index;
    for (int c = 0; c < width; ++c) owners.of_row[at(body.rows[at(c)])] = index;
    prescribed_.emplace_back().who = body;
  }
  free_rows_.clear();
  for (int r = 0; r < static_cast<int>(rows); ++r) {
    if (!dependent_[at(r)] && owners.of_row[at(r)] < 0) free_rows_.push_back(r);
  }
  return owners;
}

std::vector<NormalMatrix::Piece> AccelerationMatrix::place_pieces(const Owners& owners) {
  const int width = system_.layout().body_velocities();
  const std::vector<Source> sources = sorted_sources(owners);
  offsets_.clear();
  additions_.clear();
  by_row_.clear();
  std::vector<NormalMatrix::Piece> free_pieces;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const Source& source = sources[i];
    if (i > 0 && source.same_piece(sources[i - 1])) {
      additions_.push_back({offsets_.size() - 1, source.offset});
      continue;
    }
    const std::size_t piece = offsets_.size();
    offsets_.push_back(source.offset);
    if (!source.held) {
      const auto place = std::ranges::lower_bound(free_rows_, source.row) - free_rows_.begin();
      free_pieces.push_back({static_cast<int>(place), source.body});
      continue;
    }
    Prescribed& body = prescribed_[at(owners.of_body[at(source.body)])];
    const auto own = std::find(body.who.rows.begin(), body.who.rows.begin() + width, source.row);
    if (own != body.who.rows.begin() + width) {
      body.pieces[static_cast<std::size_t>(own - body.who.rows.begin())] = piece;
    } else {
      by_row_.push_back({source.row, source.body, piece});
    }
  }
  numbers_.assign(at(width) * offsets_.size(), 0.0);
  return free_pieces;
}

std::vector<AccelerationMatrix::Source> AccelerationMatrix::sorted_sources(const Owners& owners) const {
  const int width = system_.layout().body_velocities();
  std::vector<Source> sources;
  for (const JacobianBlock& block : system_.jacobian().blocks()) {
    for (int r = 0; r < block.rows; ++r) {
      if (dependent_[at(block.row + r)]) continue;
      sources.push_back({owners.of_body[at(block.body)] >= 0, block.row + r, block.body, block.offset + r * width});
    }
  }
  std::ranges::sort(sources, {}, [](const Source& s) { return std::tuple(s.held, s.row, s.body, s.offset); });
  return sources;
}

void AccelerationMatrix::sort_couplings(const Owners& owners) {
  const int count = static_cast<int>(prescribed_.size());
  const auto of_row = [&](const Coupling& c) {
    const int owner = owners.of_row[at(c.row)];
    return owner < 0 ? count : owner;
  };
  const auto of_body = [&](const Coupling& c) { return owners.of_body[at(c.body)]; };
  by_body_ = by_row_;
  std::ranges::sort(by_row_, {}, [&](const Coupling& c) { return std::tuple(of_row(c), c.row, c.body); });
  std::ranges::sort(by_body_, {}, [&](const Coupling& c) { return std::tuple(of_body(c), c.row, c.body); });
  const auto first_of = [](const std::vector<Coupling>& list, int owner, const auto& owner_of) {
    return static_cast<std::size_t>(std::ranges::lower_bound(list, owner, {}, owner_of) - list.begin());
  };
  for (int p = 0; p < count; ++p) {
    prescribed_[at(p)].first_row_part = first_of(by_row_, p, of_row);
    prescribed_[at(p)].end_row_part = first_of(by_row_, p + 1, of_row);
    prescribed_[at(p)].first_motion_part = first_of(by_body_, p, of_body);
    prescribed_[at(p)].end_motion_part = first_of(by_body_, p + 1, of_body);
  }
  first_free_part_ = first_of(by_row_, count, of_row);
}

template <int width>
void AccelerationMatrix::gather(std::span<const double> jacobian) {
  double* to = numbers_.data();
  for (const int offset : offsets_) {
    const double* from = &jacobian[at(offset)];
    for (int c = 0; c < width; ++c) to[c] = from[c];
    to += width;
  }
  for (const Addition& addition : additions_) {
    for (std::size_t c = 0; c < width; ++c) numbers_[width * addition.piece + c] += jacobian[at(addition.offset) + c];
  }
}

double AccelerationMatrix::factor(Evaluation& e) {
  const bool planar = system_.layout().body_velocities() == 3;
  planar ? gather<3>(e.jacobian) : gather<6>(e.jacobian);
  const double normal = has_normal_ ? normal_.factor(numbers_) : 0.0;
  by_normal_ = normal > regular_enough;
  if (!by_normal_) return factor_whole(e, normal);
  return smallest_ = std::min(normal, planar ? invert_blocks<3>() : invert_blocks<6>());
}

void AccelerationMatrix::make_whole() {
  whole_ = std::make_unique<StageMatrix>(system_, false);
  whole_->set_pattern(dependent_);
}

// Close to a singular position the pivots of both matrices fall with the square of the distance from it.
double AccelerationMatrix::factor_whole(Evaluation& e, double normal) {
  if (whole_ == nullptr) make_whole();
  const double whole = whole_->factor(e, 0.0, 0.0, 0.0);
  if (normal > measurable) {
    unit_ = whole / normal;
    return whole > 0.0 ? normal : 0.0;
  }
  return unit_ > 0.0 ? whole / unit_ : whole;
}

void AccelerationMatrix::save(ArchiveWriter& archive) const {
  archive(numbers_, by_normal_, smallest_, unit_, whole_ != nullptr);
  if (whole_ != nullptr) archive(*whole_);
}

// The whole matrix keeps its pivots while the other one serves.
void AccelerationMatrix::restore(ArchiveReader& archive) {
  bool has_whole = false;
  archive(numbers_, by_normal_, smallest_, unit_, has_whole);
  if (has_whole) {
    make_whole();
    archive(*whole_);
  }
  if (!by_normal_) return;
  normal_.factor(numbers_);
  system_.layout().body_velocities() == 3 ? invert_blocks<3>() : invert_blocks<6>();
}

template <int width>
double AccelerationMatrix::invert_blocks() {
  double smallest = 1.0;
  for (Prescribed& body : prescribed_) {
    Eigen::Matrix<double, width, width> block;
    for (int r = 0; r < width; ++r) {
      for (int c = 0; c < width; ++c) block(r, c) = numbers_[width * body.pieces[at(r)] + at(c)];
    }
    smallest = std::min(smallest, invert_block<width>(block, body.inverse));
  }
  return smallest;
}

// Forwards and backwards in one function, as both halves share nearly all that they name.
template <int width>
void AccelerationMatrix::substitute(std::span<double> x, std::span<double> l) {
  using Square = Eigen::Matrix<double, width, width>;
  using Vector = Eigen::Matrix<double, width, 1>;
  double* const a = x.data();
  double* const lambda = l.data();  // gamma, until it is solved for
  const auto move_rows = [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const Coupling& c = by_row_[i];
      const double *g = &numbers_[width * c.piece], *rate = a + width * c.body;
      for (int k = 0; k < width; ++k) lambda[c.row] -= g[k] * rate[k];
    }
  };
  double* force = forces_.data();
  for (const Prescribed& body : prescribed_) {
    move_rows(body.first_row_part, body.end_row_part);
    Vector b;
    for (int r = 0; r < width; ++r) b[r] = lambda[body.who.rows[at(r)]];
    const Eigen::Map<Vector> own(a + width * body.who.body);
    Eigen::Map<Vector>{force} = own;
    Eigen::Map<Vector>{a + width* body.who.body} = Eigen::Map<const Square>(body.inverse) * b;
    force += width;
  }
  move_rows(first_free_part_, by_row_.size());
  for (std::size_t r = 0; r < free_rows_.size(); ++r) multipliers_[r] = lambda[free_rows_[r]];
  normal_.solve(numbers_, x, multipliers_);
  for (std::size_t r = 0; r < free_rows_.size(); ++r) lambda[free_rows_[r]] = multipliers_[r];
  for (std::size_t p = prescribed_.size(); p-- > 0;) {
    const Prescribed& body = prescribed_[p];
    const std::size_t first = width * at(body.who.body);
    Vector left = Eigen::Map<const Vector>(&forces_[width * p]);
    for (std::size_t c = 0; c < width; ++c)
      left[static_cast<int>(c)] -= system_.inertia().mass()[first + c] * a[first + c];
    for (std::size_t i = body.first_motion_part; i < body.end_motion_part; ++i) {
      const double* g = &numbers_[width * by_body_[i].piece];
      for (int k = 0; k < width; ++k) left[k] -= g[k] * lambda[by_body_[i].row];
    }
    const Vector multipliers = Eigen::Map<const Square>(body.inverse).transpose() * left;
    for (int r = 0; r < width; ++r) lambda[body.who.rows[at(r)]] = multipliers[r];
  }
}

void AccelerationMatrix::solve_whole(std::span<double> x, std::span<double> l) {
  std::ranges::copy(x, right_.begin());
  std::copy(l.begin(), l.end(), right_.begin() + static_cast<std::ptrdiff_t>(x.size()));
  whole_->solve(right_, update_);
  std::copy_n(update_.begin(), x.size(), x.begin());
  std::copy_n(update_.begin() + static_cast<std::ptrdiff_t>(x.size()), l.size(), l.begin());
}

void AccelerationMatrix::solve(std::span<double> x, std::span<double> l) {
  if (!by_normal_) return solve_whole(x, l);
  if (all_free_) return normal_.solve(numbers_, x, l);
  system_.layout().body_velocities() == 3 ? substitute<3>(x, l) : substitute<6>(x, l);
}

}  // namespace freeplay
