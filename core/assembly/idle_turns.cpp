#include "assembly/idle_turns.h"

#include <algorithm>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <fmt/format.h>

#include "assembly/row_space.h"
#include "base/index.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;

constexpr double at_one_place = 1e-6;  // by the size of the model
constexpr int width = 6;

class IdleTurns {
 public:
  IdleTurns(const System& closed, const Evaluation& shut)
      : model_(closed.model()), closed_(closed), shut_(shut), rows_(constraint_matrix(closed.jacobian(), shut)) {}

  /// The joints of a body that can turn about them and moves nothing, or none.
  std::vector<int> around(BodyId body) const {
    std::vector<int> joints;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (joint.gear >= 0 || (body_of(joint.marker_a) != body && body_of(joint.marker_b) != body)) continue;
      if (is_force_element(joint) || is_geared(j)) return {};
      joints.push_back(j);
    }
    if (joints.size() < 2 || is_loaded(body)) return {};
    const int first = marker_of(joints[0], body);
    MatrixXd turned(0, 3);
    for (const int j : joints) {
      if ((place(marker_of(j, body)) - place(first)).norm() > at_one_place * closed_.size()) return {};
      const Slice own = closed_.layout().rows(j);
      const MatrixXd moved = rows_.block(own.offset, width * body, own.size, width) * twists(first);
      // What lets the place slide, as a curve does, may be moved by a turn all the same.
      if (own.size < 3 || rank_of(moved.leftCols(3)) < 3) return {};
      turned = stacked(turned, moved.rightCols(3));
    }
    const MatrixXd free = twists(first).rightCols(3) * null_space(turned);
    const bool swings = free.cols() > 0 && free.topRows(3).norm() > at_one_place * closed_.size();
    return swings ? joints : std::vector<int>{};
  }

  /// The body that a driver only spins about a line on which all that ties it to other moving bodies lies, or ground.
  BodyId spun_by(const Driver& driver) const {
    const JointElement& driven = model_.joints[at(driver.joint)];
    for (const BodyId body : {body_of(driven.marker_a), body_of(driven.marker_b)}) {
      if (body == ground || !is_tied_to_another(body, driver.joint)) continue;
      const MatrixXd own = rows_.topRows(closed_.layout().first_driver_row()).middleCols(width * body, width);
      if (null_space(own).cols() > 0) return body;
    }
    return ground;
  }

  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }
  int marker_of(int joint, BodyId body) const {
    const JointElement& element = model_.joints[at(joint)];
    return body_of(element.marker_a) == body ? element.marker_a : element.marker_b;
  }

 private:
  bool is_geared(int joint) const {
    return std::ranges::any_of(model_.gears,
                               [&](const Gear& gear) { return gear.first == joint || gear.second == joint; });
  }
  /// To a moving body beside the joint, by joints alone.
  bool is_tied_to_another(BodyId body, int beside) const {
    bool tied = false;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      const BodyId a = body_of(joint.marker_a), b = body_of(joint.marker_b);
      if (j == beside || joint.gear >= 0 || (a != body && b != body)) continue;
      if (is_force_element(joint) || is_geared(j)) return false;
      tied = tied || (a != ground && b != ground);
    }
    return tied && !is_geared(beside) && !is_loaded(body);
  }
  bool is_loaded(BodyId body) const {
    return std::ranges::any_of(model_.forces, [&](const AppliedForce& force) { return body_of(force.marker) == body; });
  }
  Eigen::Map<const Eigen::Vector3d> place(int marker) const {
    return Eigen::Map<const Eigen::Vector3d>(shut_.markers[at(marker)].position);
  }

  /// Velocities of the body of a marker by unit twists of that marker, world axes.
  MatrixXd twists(int marker) const {
    MatrixXd rows(width, width);
    for (int k = 0; k < width; ++k) {
      double unit[width] = {}, row[width];
      unit[k] = 1.0;
      closed_.markers().row(marker, unit, shut_, row);
      rows.row(k) = Eigen::Map<const Eigen::RowVectorXd>(row, width);
    }
    return rows.inverse();
  }

  const Model& model_;
  const System& closed_;
  const Evaluation& shut_;
  const MatrixXd rows_;
};

}  // namespace

void doubt_idle_turns(
    const System& closed, const Evaluation& shut,
    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt) {
  const Model& model = closed.model();
  if (model.space == Space::planar) return;
  const IdleTurns turns(closed, shut);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[at(b)];
    if (body.location.file != model.file) continue;
    const std::vector<int> joints = turns.around(b);
    if (joints.empty()) continue;
    const JointElement& second = model.joints[at(joints[1])];
    doubt("same-frame",
          fmt::format("joints '{}' and '{}' hold '{}' at one place, '{}', so that its turning moves nothing: is one of "
                      "them meant at another frame, or about another axis",
                      model.joints[at(joints[0])].name, second.name, body.name,
                      model.markers[at(turns.marker_of(joints[1], b))].name),
          second);
  }
  for (const Driver& driver : model.drivers) {
    const BodyId spun = driver.kinematics < 0 ? turns.spun_by(driver) : ground;
    if (spun == ground) continue;
    const JointElement& driven = model.joints[at(driver.joint)];
    doubt("locked",
          fmt::format("driver '{}' moves nothing but '{}', about a line on which all of its joints lie: is joint '{}' "
                      "meant about another axis",
                      driver.name, model.bodies[at(spun)].name, driven.name),
          driven);
  }
}

}  // namespace freeplay
