#include "analysis/velocity_map.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr double rank_limit = 1e-10;     // of pivots, relative to the largest
constexpr double folded_limit = 1e-7;    // of both at a fold, which is known to the root of the rounding
constexpr double nothing = 1e-9;         // of rows, relative to null vectors of length 1
constexpr double regular_inputs = 1e-9;  // pivots of B of a part that can be told apart by inputs

}  // namespace

VelocityMapper::VelocityMapper(const IdealMechanism& mechanism, const Components& kept)
    : mechanism_(mechanism), system_(mechanism.system()), column_(mechanism.model().bodies.size(), -1) {
  for (std::size_t i = 0; i < 3; ++i) place_[i] = kept[i] ? kept_++ : -1 - eliminated_++;
  const int parts = static_cast<int>(mechanism.parts().size());
  std::vector<int> all;
  for (int p = 0; p < parts; ++p) {
    if (eliminated_ == 0) make_group({p});
    all.push_back(p);
  }
  if (eliminated_ > 0) make_group(all);
}

void VelocityMapper::make_group(std::vector<int> parts) {
  Group& group = groups_.emplace_back();
  std::vector<int> local(at(system_.layout().nc()), -1);
  for (const int p : parts) {
    const Limb& part = mechanism_.parts()[at(p)];
    for (const BodyId b : part.bodies) {
      column_[at(b)] = group.columns;
      group.columns += 3;
    }
    for (const int row : part.rows) local[at(row)] = group.rows++;
    group.inputs.insert(group.inputs.end(), part.inputs.begin(), part.inputs.end());
    group.plays.insert(group.plays.end(), part.plays.begin(), part.plays.end());
  }
  group.columns += eliminated_;
  for (int k = 0; k < static_cast<int>(system_.jacobian_blocks().size()); ++k) {
    const JacobianBlock& block = system_.jacobian_blocks()[at(k)];
    if (block.rows > 0 && local[at(block.row)] >= 0) {
      group.fills.push_back({k, 0, block.rows, local[at(block.row)], block.body});
    }
  }
  for (const int p : group.plays) {
    group.play_rows.push_back(local[at(system_.layout().rows(mechanism_.plays()[at(p)].joint).offset)]);
  }
  group.rows += static_cast<int>(group.inputs.size());
  group.parts = std::move(parts);
  group.passive.resize(group.rows, group.columns);
  group.right.resize(group.rows, kept_ + static_cast<Index>(group.inputs.size() + 2 * group.plays.size()));
  group.work.resize(group.right.cols());
}

// Three entries of a row in the columns of a body; those of the platform become columns of its frame:
// r = X - s, so g r' = g X' - (g . E s) angle'.
void VelocityMapper::put(Group& group, int row, int body, const double* g, const Evaluation& e) {
  if (body != mechanism_.platform_body()) {
    for (int c = 0; c < 3; ++c) group.passive(row, column_[at(body)] + c) += g[c];
    return;
  }
  const planar::Arm& arm = e.arms[at(mechanism_.platform().marker)];
  const double frame[3] = {g[0], g[1], g[2] + g[0] * arm.y - g[1] * arm.x};
  for (std::size_t c = 0; c < 3; ++c) {
    if (place_[c] >= 0) {
      group.right(row, place_[c]) += frame[c];
    } else {
      group.passive(row, group.columns - eliminated_ - 1 - place_[c]) += frame[c];
    }
  }
}

void VelocityMapper::eliminate(Group& group, const Evaluation& e) {
  const Model& model = mechanism_.model();
  group.passive.setZero();
  group.right.setZero();
  for (const Fill& fill : group.fills) {
    const double* entries = &e.jacobian[at(system_.jacobian_blocks()[at(fill.block)].offset)];
    for (int r = 0; r < fill.rows; ++r) put(group, fill.row + r, fill.body, entries + 3 * r, e);
  }
  const int first_input = group.rows - static_cast<int>(group.inputs.size());
  for (int i = 0; i < static_cast<int>(group.inputs.size()); ++i) {
    const int j = mechanism_.platform().inputs[at(group.inputs[at(i)])];
    double row[6], bias = 0.0;
    system_.coordinate_row(j, e, row, bias);
    const JointElement& joint = model.joints[at(j)];
    const BodyId bodies[2] = {model.markers[at(joint.marker_a)].body, model.markers[at(joint.marker_b)].body};
    for (int k = 0; k < 2; ++k) {
      if (bodies[k] != ground) put(group, first_input + i, bodies[k], row + 3 * k, e);
    }
    group.right(first_input + i, kept_ + i) = 1.0;
  }
  // A play moves the second marker against the second body: what its rows feel of a shift of that body, or of the
  // opposite shift of the first.
  for (std::size_t p = 0; p < group.plays.size(); ++p) {
    const int j = mechanism_.plays()[at(group.plays[p])].joint;
    const Slice rows = system_.layout().rows(j);
    const BodyId second = model.markers[at(model.joints[at(j)].marker_b)].body;
    const BodyId moved = second != ground ? second : model.markers[at(model.joints[at(j)].marker_a)].body;
    const double sign = second != ground ? 1.0 : -1.0;
    for (const JacobianBlock& block : system_.jacobian_blocks()) {
      if (block.row != rows.offset || block.body != moved || block.rows != rows.size) continue;
      for (int r = 0; r < rows.size; ++r) {
        for (int c = 0; c < 2; ++c) {
          group.right(group.play_rows[p] + r, kept_ + static_cast<Index>(group.inputs.size() + 2 * p) + c) =
              sign * e.jacobian[at(block.offset + 3 * r + c)];
        }
      }
    }
  }
  if (group.columns == 0) return;
  group.qr.setThreshold(rank_limit_);
  group.qr.compute(group.passive);
  group.right.applyOnTheLeft(group.qr.householderQ().adjoint());
}

double VelocityMapper::towards_platform(const Group& group, const Evaluation& e, double x, double y) const {
  if (group.inputs.empty()) return 1.0;
  const Model& model = mechanism_.model();
  const JointElement& input = model.joints[at(mechanism_.platform().inputs[at(group.inputs[0])])];
  const double* base = e.markers[at(input.marker_a)].position;
  for (const int p : group.parts) {
    for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
      const JointElement& joint = model.joints[at(j)];
      const Slice rows = system_.layout().rows(j);
      if (rows.size == 0 ||
          std::ranges::find(mechanism_.parts()[at(p)].rows, rows.offset) == mechanism_.parts()[at(p)].rows.end()) {
        continue;
      }
      for (const int m : {joint.marker_a, joint.marker_b}) {
        if (model.markers[at(m)].body != mechanism_.platform_body()) continue;
        const double* tip = e.markers[at(m)].position;
        return x * (tip[0] - base[0]) + y * (tip[1] - base[1]) < 0.0 ? -1.0 : 1.0;
      }
    }
  }
  return 1.0;
}

// Length that a row of several outputs is scaled to 1 in; `turn`: its angle over L.
double VelocityMapper::output_size(double x, double y, double turn) const {
  if (place_[0] < 0 || place_[1] < 0) return std::hypot(x, y, turn);
  const double flat = std::hypot(x, y);
  return flat > nothing * std::abs(turn) ? flat : std::abs(turn);
}

// One row for the whole group.
void VelocityMapper::scale_single(const Group& group, const Evaluation& e, Eigen::Ref<MatrixXd> row) const {
  const double x = place_[0] >= 0 ? row(0, place_[0]) : 0.0, y = place_[1] >= 0 ? row(0, place_[1]) : 0.0;
  const double turn = place_[2] >= 0 ? row(0, place_[2]) / mechanism_.length() : 0.0;
  double size = std::hypot(x, y);
  if (kept_ == 1) {
    for (std::size_t i = 0; i < group.inputs.size(); ++i) {
      size = std::hypot(size, turn, row(0, kept_ + static_cast<Index>(i)) / mechanism_.crank_length(group.inputs[i]));
    }
  } else {
    size = output_size(x, y, turn);
  }
  if (size < nothing) return;
  row *= towards_platform(group, e, x, y) / size;
}

void VelocityMapper::scale_several(const Group& group, Eigen::Ref<MatrixXd> rows) const {
  const Index inputs = static_cast<Index>(group.inputs.size());
  if (rows.rows() == inputs) {
    const Eigen::FullPivLU<MatrixXd> b(rows.middleCols(kept_, inputs));
    if (b.matrixLU().diagonal().cwiseAbs().minCoeff() > regular_inputs) {
      rows = b.solve(MatrixXd(rows)).eval();
      for (Index r = 0; r < rows.rows(); ++r) {
        const double x = place_[0] >= 0 ? rows(r, place_[0]) : 0.0, y = place_[1] >= 0 ? rows(r, place_[1]) : 0.0;
        const double turn = place_[2] >= 0 ? rows(r, place_[2]) / mechanism_.length() : 0.0;
        const double size = output_size(x, y, turn);
        if (size > 0.0) rows.row(r) /= size;
      }
      return;
    }
  }
  MatrixXd a = rows.leftCols(kept_);
  if (place_[2] >= 0) a.col(place_[2]) /= mechanism_.length();
  const Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeFullU);
  rows.applyOnTheLeft(svd.matrixU().transpose());
  for (Index r = 0; r < svd.singularValues().size(); ++r) {
    if (svd.singularValues()[r] > nothing) rows.row(r) /= svd.singularValues()[r];
  }
}

// Rows that only play can violate get behind the others, which are told; of a single output these become orthonormal.
Index VelocityMapper::separate(const Group& group, Eigen::Ref<MatrixXd> rows) const {
  const Index inputs = static_cast<Index>(group.inputs.size());
  MatrixXd scaled = rows.leftCols(kept_ + inputs);
  if (place_[2] >= 0) scaled.col(place_[2]) /= mechanism_.length();
  for (Index i = 0; i < inputs; ++i) {
    scaled.col(kept_ + i) /= mechanism_.crank_length(group.inputs[static_cast<std::size_t>(i)]);
  }
  const Eigen::JacobiSVD<MatrixXd> svd(scaled, Eigen::ComputeFullU);
  Index moving = 0;
  while (moving < svd.singularValues().size() && svd.singularValues()[moving] > row_limit_) ++moving;
  if (moving == rows.rows() && kept_ > 1) return moving;
  rows.applyOnTheLeft(svd.matrixU().transpose());
  rows.bottomRows(rows.rows() - moving).leftCols(kept_ + inputs).setZero();
  for (Index r = 0; r < moving && kept_ == 1; ++r) rows.row(r) /= svd.singularValues()[r];
  return moving;
}

double VelocityMapper::smallest_input(const Group& group, const Eigen::Ref<const MatrixXd>& rows) const {
  if (group.inputs.empty()) return std::numeric_limits<double>::infinity();
  MatrixXd b = rows.middleCols(kept_, static_cast<Index>(group.inputs.size()));
  for (Index i = 0; i < b.cols(); ++i) b.col(i) /= mechanism_.crank_length(group.inputs[static_cast<std::size_t>(i)]);
  if (b.rows() == 1 && b.cols() == 1) return std::abs(b(0, 0));
  if (b.rows() < b.cols()) return 0.0;
  return Eigen::JacobiSVD<MatrixXd>(b).singularValues().minCoeff();
}

Eigen::Index VelocityMapper::take(Group& group, const Evaluation& e, Index first, VelocityMap& out) {
  const Index rank = group.columns == 0 ? 0 : group.qr.rank();
  const Index count = group.rows - rank;
  if (count == 0) return 0;
  auto rows = group.right.bottomRows(count);
  const Index moving = count == 1 ? 1 : separate(group, rows);
  if (moving == 1) {
    scale_single(group, e, rows.topRows(1));
  } else if (moving > 1 && kept_ > 1) {
    scale_several(group, rows.topRows(moving));
  }
  out.inverse_min = std::min(out.inverse_min, smallest_input(group, rows.topRows(moving)));
  const Index inputs = static_cast<Index>(group.inputs.size());
  out.a.middleRows(first, count) = rows.leftCols(kept_);
  for (Index i = 0; i < inputs; ++i) {
    out.b.block(first, group.inputs[static_cast<std::size_t>(i)], count, 1) = rows.col(kept_ + i);
  }
  for (std::size_t p = 0; p < group.plays.size(); ++p) {
    out.c.block(first, 2 * group.plays[p], count, 2) = rows.middleCols(kept_ + inputs + 2 * static_cast<Index>(p), 2);
  }
  for (Index r = 0; r < count; ++r) out.part.push_back(group.parts.size() == 1 ? group.parts[0] : -1);
  return count;
}

void VelocityMapper::map(const Evaluation& e, VelocityMap& out, bool folded) {
  // Columns of angles have entries of the model's size.
  rank_limit_ = folded ? folded_limit * std::min(1.0, system_.size()) : rank_limit;
  row_limit_ = folded ? folded_limit : nothing;
  Index rows = 0;
  for (Group& group : groups_) {
    eliminate(group, e);
    rows += group.rows - (group.columns == 0 ? 0 : group.qr.rank());
  }
  out.a.setZero(rows, kept_);
  out.b.setZero(rows, static_cast<Index>(mechanism_.platform().inputs.size()));
  out.c.setZero(rows, 2 * static_cast<Index>(mechanism_.plays().size()));
  out.part.clear();
  out.inverse_min = std::numeric_limits<double>::infinity();
  Index first = 0;
  for (Group& group : groups_) first += take(group, e, first, out);
}

}  // namespace freeplay
