#include "assembly/play_bypass.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assembly/row_space.h"
#include "base/index.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr double no_lever = 1e-8;        // by the size of the model
constexpr double within_its_play = 2.0;  // clearances

class Bypasses {
 public:
  Bypasses(const System& closed, const Evaluation& shut) : model_(closed.model()), closed_(closed), shut_(shut) {
    for (const JacobianBlock& block : closed.jacobian().blocks()) blocks_.emplace(block.row, &block);
    root_.resize(model_.bodies.size() + 1);  // the last is ground
    std::iota(root_.begin(), root_.end(), 0);
    while (merge()) {
    }
  }

  std::vector<PlayBypass> find() const {
    std::vector<PlayBypass> found;
    for (int j = 0; j < joints(); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (!joint.has_play || joint.gear >= 0 || closed_.layout().rows(j).size == 0) continue;
      PlayBypass one = of(j);
      if (one.by.empty()) continue;
      const auto ends = bodies_of(j);
      one.direct = std::ranges::all_of(one.by, [&](int k) { return bodies_of(k) == ends; });
      found.push_back(std::move(one));
    }
    return found;
  }

 private:
  int joints() const { return static_cast<int>(model_.joints.size()); }
  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }
  int group_of(int marker) const {
    const BodyId body = body_of(marker);
    return body == ground ? root_.back() : root_[at(body)];
  }
  std::pair<BodyId, BodyId> bodies_of(int j) const {
    const JointElement& joint = model_.joints[at(j)];
    return std::minmax({body_of(joint.marker_a), body_of(joint.marker_b)});
  }
  bool is_ideal(int j) const {
    const JointElement& joint = model_.joints[at(j)];
    return !joint.has_play && joint.gear < 0 && closed_.layout().rows(j).size > 0;
  }

  /// Makes one of groups that the ideal joints between them fix to each other; true where it found such.
  bool merge() {
    std::map<std::pair<int, int>, MatrixXd> between;
    for (int j = 0; j < joints(); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      const auto groups = std::minmax({group_of(joint.marker_a), group_of(joint.marker_b)});
      if (!is_ideal(j) || groups.first == groups.second) continue;
      const int marker = group_of(joint.marker_a) == groups.first ? joint.marker_a : joint.marker_b;
      MatrixXd& rows = between[groups];
      rows = stacked(rows, rows_of(j, marker, Vector3d::Zero(), 0.0));
    }
    bool merged = false;
    for (const auto& [groups, rows] : between) {
      if (rank_of(rows) < (model_.space == Space::planar ? 3 : 6)) continue;
      std::ranges::replace(root_, groups.first, groups.second);  // ground, the last, stays one
      merged = true;
    }
    return merged;
  }

  /// Rows of a joint as of the twist of its part with `marker`, taken at `place`, while the other part stands still. Of
  /// ground the other part turns back. What misses the place by less than `near` is there: a journal may start beside
  /// the centre of its bearing.
  MatrixXd rows_of(int j, int marker, const Vector3d& place, double near) const {
    const Slice slice = closed_.layout().rows(j);
    const int width = closed_.layout().body_velocities();
    const double sign = body_of(marker) == ground ? -1.0 : 1.0;
    if (sign < 0.0)
      marker = marker == model_.joints[at(j)].marker_a ? model_.joints[at(j)].marker_b : model_.joints[at(j)].marker_a;
    const Vector3d lever = Eigen::Map<const Vector3d>(shut_.markers[at(marker)].position) - place;
    MatrixXd rows = MatrixXd::Zero(slice.size, 6);
    for (auto [found, end] = blocks_.equal_range(slice.offset); found != end; ++found) {
      const JacobianBlock& block = *found->second;
      if (block.body != body_of(marker)) continue;
      for (int r = 0; r < block.rows; ++r) {
        double twist[6] = {};
        closed_.markers().twist_row(marker, &shut_.jacobian[at(block.offset + r * width)], shut_, twist);
        const Vector3d along = Eigen::Map<const Vector3d>(twist);
        Vector3d about = Eigen::Map<const Vector3d>(twist + 3) + lever.cross(along);
        about = (about.array().abs() > near * along.norm()).select(about, 0.0);
        rows.row(r) << sign * along.transpose(), sign * about.transpose();
      }
    }
    return rows;
  }

  bool is_between(int k, int a, int b) const {
    const JointElement& joint = model_.joints[at(k)];
    const int first = joint.marker_a, second = joint.marker_b;
    return (has_point_of(a, k, first) && has_point_of(b, k, second)) ||
           (has_point_of(b, k, first) && has_point_of(a, k, second));
  }

  /// Whether what joint k holds with a marker is of this group: a rod holds also the body that is pinned where it ends.
  bool has_point_of(int group, int k, int marker) const {
    if (group_of(marker) == group) return true;
    const Vector3d place(shut_.markers[at(marker)].position);
    const double near = no_lever * closed_.size();
    if (rank_of(rows_of(k, marker, place, near).rightCols(3)) > 0) return false;  // it holds more than a point
    for (int pin = 0; pin < joints(); ++pin) {
      const JointElement& joint = model_.joints[at(pin)];
      if (pin == k || !is_ideal(pin)) continue;
      const bool first = group_of(joint.marker_a) == group && group_of(joint.marker_b) == group_of(marker);
      const bool second = group_of(joint.marker_b) == group && group_of(joint.marker_a) == group_of(marker);
      if (!first && !second) continue;
      const int own = first ? joint.marker_b : joint.marker_a;
      const Vector3d at_pin(shut_.markers[at(own)].position);
      if ((at_pin - place).norm() >= near) continue;
      if (rank_of(rows_of(pin, own, place, near).leftCols(3)) == (model_.space == Space::planar ? 2 : 3)) return true;
    }
    return false;
  }

  PlayBypass of(int j) const {
    const JointElement& loose = model_.joints[at(j)];
    const int a = group_of(loose.marker_a), b = group_of(loose.marker_b);
    PlayBypass found{j, {}, true, false, 0};
    if (a == b) {
      for (int k = 0; k < joints(); ++k) {
        if (is_ideal(k) && group_of(model_.joints[at(k)].marker_a) == a && group_of(model_.joints[at(k)].marker_b) == a)
          found.by.push_back(k);
      }
      keep_direct(found.by, bodies_of(j));
      return found;
    }
    const int side = b == root_.back() ? a : b;
    const Vector3d place(shut_.markers[at(loose.marker_b)].position);
    const double near = no_lever * closed_.size() + within_its_play * loose.layout.clearance;
    const auto rows_at_place = [&](int k) {
      const JointElement& joint = model_.joints[at(k)];
      return rows_of(k, has_point_of(side, k, joint.marker_b) ? joint.marker_b : joint.marker_a, place, near);
    };
    const MatrixXd held = rows_at_place(j), play = directions_of(held);
    MatrixXd all(0, 6);
    std::vector<int> beside;
    int most = 0, alone = -1;
    for (int k = 0; k < joints(); ++k) {
      if (!is_ideal(k)) continue;
      if (!is_between(k, a, b)) continue;
      const MatrixXd rows = rows_at_place(k);
      const int taken = taken_by(rows, play, loose);
      if (taken > most) alone = k;
      most = std::max(most, taken);
      all = stacked(all, rows);
      beside.push_back(k);
    }
    found.directions = beside.empty() ? 0 : taken_by(all, play, loose);
    if (found.directions == 0 || (found.directions == 1 && most == 1 && is_second_bearing(alone, place, near)))
      return found;
    found.whole = rank_of(stacked(all, held)) == rank_of(all);
    found.by = most == found.directions ? std::vector{alone} : beside;
    return found;
  }

  /// Whether a joint in space holds a point of the body elsewhere: then it holds the journal along the line between
  /// both, as a bearing that locates a shaft does.
  bool is_second_bearing(int k, const Vector3d& place, double near) const {
    if (model_.space == Space::planar) return false;
    const JointElement& joint = model_.joints[at(k)];
    const int marker = body_of(joint.marker_a) == ground ? joint.marker_b : joint.marker_a;
    const Vector3d own(shut_.markers[at(marker)].position);
    return (own - place).norm() > near && rank_of(directions_of(rows_of(k, marker, own, near))) == 3;
  }

  /// Joints between just these two bodies, if there are any.
  void keep_direct(std::vector<int>& joints, const std::pair<BodyId, BodyId>& bodies) const {
    const auto direct = [&](int k) { return bodies_of(k) == bodies; };
    if (std::ranges::any_of(joints, direct)) std::erase_if(joints, [&](int k) { return !direct(k); });
  }

  /// Rows of the directions in which the parts of a joint with play can be apart.
  MatrixXd directions_of(const MatrixXd& held) const {
    if (model_.space == Space::planar) return held;
    // In space those that hold the journal where no turn moves it.
    const MatrixXd still = null_space(held.rightCols(3).transpose());
    return still.transpose() * held;
  }

  /// How many directions of the play the rows hold.
  int taken_by(const MatrixXd& rows, const MatrixXd& play, const JointElement& loose) const {
    const int own = rank_of(rows), shared = own + rank_of(play) - rank_of(stacked(rows, play));
    if (shared == 0 || model_.space == Space::planar || loose.ideal_layout().coordinate != Coordinate::angle)
      return shared;
    const double* r = shut_.markers[at(loose.marker_a)].rotation;
    MatrixXd axis = MatrixXd::Zero(1, 6);
    axis << r[2], r[5], r[8], 0.0, 0.0, 0.0;
    const bool along = rank_of(stacked(rows, axis)) == own && rank_of(stacked(play, axis)) == rank_of(play);
    return along ? shared - 1 : shared;
  }

  const Model& model_;
  const System& closed_;
  const Evaluation& shut_;
  std::multimap<int, const JacobianBlock*> blocks_;  // by their first row
  std::vector<int> root_;                            // of each body: one to which it is fixed without play
};

}  // namespace

std::vector<PlayBypass> play_bypasses(const System& closed, const Evaluation& at_start) {
  return Bypasses(closed, at_start).find();
}

}  // namespace freeplay
