#include "analysis/velocity_map.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "linear/singular_values.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double rank_limit = 1e-10;     // of pivots, relative to the largest
constexpr double folded_limit = 1e-7;    // of both at a fold, which is known to the root of the rounding
constexpr double nothing = 1e-9;         // of rows, relative to null vectors of length 1
constexpr double regular_inputs = 1e-9;  // pivots of B of a part that inputs can distinguish

}  // namespace

MatrixXd VelocityMap::scaled_outputs(double length) const {
  MatrixXd out = a;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    if (turns[k]) out.col(static_cast<Index>(k)) /= length;
  }
  return out;
}

VelocityMapper::VelocityMapper(const IdealMechanism& mechanism, const Components& kept)
    : mechanism_(mechanism),
      system_(mechanism.system()),
      frame_(system_, mechanism.platform().marker),
      column_(mechanism.model().bodies.size(), -1) {
  const PoseForm& form = frame_.form();
  all_shifts_ = true;
  for (std::size_t i = 0; i < form.size(); ++i) {
    place_[i] = kept[i] ? kept_++ : -1 - eliminated_++;
    if (kept[i]) turns_.push_back(form.is_turn(i) ? 1 : 0);
    all_shifts_ = all_shifts_ && (kept[i] || form.is_turn(i));
  }
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
      group.columns += system_.layout().body_velocities();
    }
    for (const int row : part.rows) local[at(row)] = group.rows++;
    group.inputs.insert(group.inputs.end(), part.inputs.begin(), part.inputs.end());
    group.plays.insert(group.plays.end(), part.plays.begin(), part.plays.end());
  }
  group.columns += eliminated_;
  for (int k = 0; k < static_cast<int>(system_.jacobian().blocks().size()); ++k) {
    const JacobianBlock& block = system_.jacobian().blocks()[at(k)];
    if (block.rows > 0 && local[at(block.row)] >= 0) {
      group.fills.push_back({k, 0, block.rows, local[at(block.row)], block.body});
    }
  }
  for (const int p : group.plays) {
    const Play& play = mechanism_.plays()[at(p)];
    group.play_rows.push_back(local[at(system_.layout().rows(play.joint).offset)]);
    group.play_columns.push_back(group.play_numbers);
    group.play_numbers += play.size;
  }
  group.rows += static_cast<int>(group.inputs.size());
  group.parts = std::move(parts);
  group.passive.resize(group.rows, group.columns);
  group.right.resize(group.rows, kept_ + static_cast<Index>(group.inputs.size()) + group.play_numbers);
  group.work.resize(group.right.cols());
}

// Entries of a row in the columns of a body; those of the platform become columns of its frame.
void VelocityMapper::put(Group& group, int row, int body, const double* g, const Evaluation& e) {
  if (body != mechanism_.platform_body()) {
    for (int c = 0; c < system_.layout().body_velocities(); ++c) group.passive(row, column_[at(body)] + c) += g[c];
    return;
  }
  double frame[most_components];
  frame_.frame_row(g, e, frame);
  for (std::size_t c = 0; c < frame_.form().size(); ++c) {
    if (place_[c] >= 0) {
      group.right(row, place_[c]) += frame[c];
    } else {
      group.passive(row, group.columns - eliminated_ - 1 - place_[c]) += frame[c];
    }
  }
}

void VelocityMapper::eliminate(Group& group, const Evaluation& e) {
  const Model& model = mechanism_.model();
  const int width = system_.layout().body_velocities();
  group.passive.setZero();
  group.right.setZero();
  for (const Fill& fill : group.fills) {
    const double* entries = &e.jacobian[at(system_.jacobian().blocks()[at(fill.block)].offset)];
    for (int r = 0; r < fill.rows; ++r) put(group, fill.row + r, fill.body, entries + width * r, e);
  }
  const int first_input = group.rows - static_cast<int>(group.inputs.size());
  for (int i = 0; i < static_cast<int>(group.inputs.size()); ++i) {
    const int j = mechanism_.platform().inputs[at(group.inputs[at(i)])];
    double row[2 * spatial::velocities], bias = 0.0;
    system_.joints().coordinate_row(j, e, row, bias);
    const JointElement& joint = model.joints[at(j)];
    const BodyId bodies[2] = {model.markers[at(joint.marker_a)].body, model.markers[at(joint.marker_b)].body};
    for (int k = 0; k < 2; ++k) {
      if (bodies[k] != ground) put(group, first_input + i, bodies[k], row + width * k, e);
    }
    group.right(first_input + i, kept_ + i) = 1.0;
  }
  for (std::size_t p = 0; p < group.plays.size(); ++p) put_play(group, p, e);
  if (group.columns == 0) return;
  group.qr.setThreshold(rank_limit_);
  group.qr.compute(group.passive);
  group.right.applyOnTheLeft(group.qr.householderQ().adjoint());
}

// A play moves the second marker against the second body: what its rows feel of that displacement of the body, or of
// the opposite one of the first.
void VelocityMapper::put_play(Group& group, std::size_t p, const Evaluation& e) {
  const Play& play = mechanism_.plays()[at(group.plays[p])];
  const Model& model = mechanism_.model();
  const JointElement& joint = model.joints[at(play.joint)];
  const Slice rows = system_.layout().rows(play.joint);
  const bool second = model.markers[at(joint.marker_b)].body != ground;
  const int marker = second ? joint.marker_b : joint.marker_a;
  const Index first = kept_ + static_cast<Index>(group.inputs.size()) + group.play_columns[p];
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> axes(e.markers[at(joint.marker_a)].rotation);
  const bool slide = joint.ideal_layout().coordinate == Coordinate::position;
  const Eigen::Vector3d lever = Eigen::Map<const Eigen::Vector3d>(e.markers[at(joint.marker_a)].position) -
                                Eigen::Map<const Eigen::Vector3d>(e.markers[at(joint.marker_b)].position);
  for (const JacobianBlock& block : system_.jacobian().blocks()) {
    if (block.row != rows.offset || block.body != model.markers[at(marker)].body || block.rows != rows.size) continue;
    for (int r = 0; r < rows.size; ++r) {
      double row[6];
      system_.markers().twist_row(marker, &e.jacobian[at(block.offset + system_.layout().body_velocities() * r)], e,
                                  row);
      for (int k = 0; k < play.size; ++k) {
        const Eigen::Map<const Eigen::Vector3d> turn(play.twist[at(k)].data() + 3);
        Eigen::Vector3d shift = Eigen::Map<const Eigen::Vector3d>(play.twist[at(k)].data());
        // The turn is about the second marker, which stands elsewhere than the first on a slide.
        if (slide && !second) shift += turn.cross(axes.transpose() * lever);
        const Eigen::Map<const Eigen::Vector3d> force(row), moment(row + 3);
        const double felt =
            play.own_axes ? force.dot(axes * shift) + moment.dot(axes * turn) : force.dot(shift) + moment.dot(turn);
        group.right(group.play_rows[p] + r, first + k) = second ? felt : -felt;
      }
    }
  }
}

double VelocityMapper::towards_platform(const Group& group, const Evaluation& e, const Eigen::Vector3d& shift) const {
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
        return shift.dot(spatial::vector(tip) - spatial::vector(base)) < 0.0 ? -1.0 : 1.0;
      }
    }
  }
  return 1.0;
}

// Part of a row in the shifts; those that are not kept are 0.
Eigen::Vector3d VelocityMapper::shift_of(const Eigen::Ref<const Eigen::RowVectorXd>& row) const {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < frame_.form().lengths; ++i) {
    if (place_[i] >= 0) shift[static_cast<Index>(i)] = row[place_[i]];
  }
  return shift;
}

// Divides the columns of turns by L.
void VelocityMapper::scale_turns(Eigen::Ref<MatrixXd> outputs) const {
  for (Index k = 0; k < kept_; ++k) {
    if (turns_[static_cast<std::size_t>(k)]) outputs.col(k) /= mechanism_.length();
  }
}

// Length that a row of several outputs is scaled to 1 in.
double VelocityMapper::output_size(const Eigen::Ref<const Eigen::RowVectorXd>& row) const {
  const double shift = shift_of(row).norm();
  double turn = 0.0;
  for (Index k = 0; k < kept_; ++k) {
    if (turns_[static_cast<std::size_t>(k)]) turn = std::hypot(turn, row[k] / mechanism_.length());
  }
  if (!all_shifts_) return std::hypot(shift, turn);
  return shift > nothing * turn ? shift : turn;
}

// One row for the whole group.
void VelocityMapper::scale_single(const Group& group, const Evaluation& e, Eigen::Ref<MatrixXd> row) const {
  const Eigen::Vector3d shift = shift_of(row.row(0));
  double size = 0.0;
  if (kept_ == 1) {
    size = std::abs(row(0, 0)) / (turns_[0] ? mechanism_.length() : 1.0);
    for (std::size_t i = 0; i < group.inputs.size(); ++i) {
      size = std::hypot(size, row(0, kept_ + static_cast<Index>(i)) / mechanism_.crank_length(group.inputs[i]));
    }
  } else {
    size = output_size(row.row(0));
  }
  if (size < nothing) return;
  row *= towards_platform(group, e, shift) / size;
}

void VelocityMapper::scale_several(const Group& group, Eigen::Ref<MatrixXd> rows) const {
  const Index inputs = static_cast<Index>(group.inputs.size());
  if (rows.rows() == inputs) {
    const Eigen::FullPivLU<MatrixXd> b(rows.middleCols(kept_, inputs));
    if (b.matrixLU().diagonal().cwiseAbs().minCoeff() > regular_inputs) {
      rows = b.solve(MatrixXd(rows)).eval();
      for (Index r = 0; r < rows.rows(); ++r) {
        const double size = output_size(rows.row(r));
        if (size > 0.0) rows.row(r) /= size;
      }
      return;
    }
  }
  MatrixXd a = rows.leftCols(kept_);
  scale_turns(a);
  const SingularValues svd = singular_values(a, SingularVectors::full);
  rows.applyOnTheLeft(svd.u.transpose());
  for (Index r = 0; r < svd.sigma.size(); ++r) {
    if (svd.sigma[r] > nothing) rows.row(r) /= svd.sigma[r];
  }
}

// Rows that only play can violate go after the others, which are reported; of a single output these become orthonormal.
Index VelocityMapper::separate(const Group& group, Eigen::Ref<MatrixXd> rows) const {
  const Index inputs = static_cast<Index>(group.inputs.size());
  MatrixXd scaled = rows.leftCols(kept_ + inputs);
  scale_turns(scaled);
  for (Index i = 0; i < inputs; ++i) {
    scaled.col(kept_ + i) /= mechanism_.crank_length(group.inputs[static_cast<std::size_t>(i)]);
  }
  const SingularValues svd = singular_values(scaled, SingularVectors::full);
  Index moving = 0;
  while (moving < svd.sigma.size() && svd.sigma[moving] > row_limit_) ++moving;
  if (moving == rows.rows() && kept_ > 1) return moving;
  rows.applyOnTheLeft(svd.u.transpose());
  rows.bottomRows(rows.rows() - moving).leftCols(kept_ + inputs).setZero();
  for (Index r = 0; r < moving && kept_ == 1; ++r) rows.row(r) /= svd.sigma[r];
  return moving;
}

double VelocityMapper::smallest_input(const Group& group, const Eigen::Ref<const MatrixXd>& rows) const {
  if (group.inputs.empty()) return std::numeric_limits<double>::infinity();
  MatrixXd b = rows.middleCols(kept_, static_cast<Index>(group.inputs.size()));
  for (Index i = 0; i < b.cols(); ++i) b.col(i) /= mechanism_.crank_length(group.inputs[static_cast<std::size_t>(i)]);
  if (b.rows() == 1 && b.cols() == 1) return std::abs(b(0, 0));
  if (b.rows() < b.cols()) return 0.0;
  return singular_values(b).sigma.minCoeff();
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
    const Play& play = mechanism_.plays()[static_cast<std::size_t>(group.plays[p])];
    out.c.block(first, play.place, count, play.size) =
        rows.middleCols(kept_ + inputs + group.play_columns[p], play.size);
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
  out.c.setZero(rows, mechanism_.play_numbers());
  out.part.clear();
  out.turns = turns_;
  out.inverse_min = std::numeric_limits<double>::infinity();
  Index first = 0;
  for (Group& group : groups_) first += take(group, e, first, out);
}

}  // namespace freeplay
