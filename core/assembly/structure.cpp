#include "assembly/structure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/index.h"
#include "base/text.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;

constexpr double rank_threshold = 1e-9;    // as that of the facts
constexpr double moves = 1e-6;             // share of a unit vector that counts as motion, or as force
constexpr double odd_free_length = 100.0;  // between the free length of a spring and its length


Eigen::ColPivHouseholderQR<MatrixXd> decompose(const MatrixXd& matrix) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(matrix);
  qr.setThreshold(rank_threshold);
  return qr;
}

int rank_of(const MatrixXd& matrix) { return matrix.size() == 0 ? 0 : static_cast<int>(decompose(matrix).rank()); }

/// Columns are orthonormal and span the x with matrix x = 0.
MatrixXd kernel(const MatrixXd& matrix) {
  const Eigen::Index n = matrix.cols();
  if (matrix.rows() == 0) return MatrixXd::Identity(n, n);
  const auto qr = decompose(matrix.transpose());
  const MatrixXd q = qr.householderQ();
  return q.rightCols(n - qr.rank());
}

MatrixXd stacked(const MatrixXd& above, const MatrixXd& below) {
  MatrixXd all(above.rows() + below.rows(), std::max(above.cols(), below.cols()));
  if (above.rows() > 0) all.topRows(above.rows()) = above;
  if (below.rows() > 0) all.bottomRows(below.rows()) = below;
  return all;
}

class Examination {
 public:
  Examination(const System& released, const Evaluation& open, const System& closed, const Evaluation& shut)
      : model_(released.model()), released_(released), closed_(closed), open_(open), shut_(shut) {
    for (const JacobianBlock& block : closed.jacobian_blocks()) blocks_.emplace(block.row, &block);
  }

  Structure run() {
    find_loose_ends();
    judge_springs();
    judge_pairs();
    if (closed_.layout().nv() > Structure::most_examined) return std::move(structure_);
    const MatrixXd open = matrix_of(released_, open_);
    judge_plays(open);
    find_undetermined(open);
    find_left_free();
    return std::move(structure_);
  }

 private:
  bool doubt(const char* id, const std::string& message, const std::string& name, const Location& location) {
    if (structure_.doubts.size() >= Structure::most_doubts) return false;
    const std::string own = name.substr(name.rfind('.') + 1);  // instances declare it without their name
    structure_.doubts.push_back({id, message, location, character_count(own)});
    return true;
  }

  static MatrixXd matrix_of(const System& system, const Evaluation& e) {
    std::vector<SparseEntry> entries;
    system.jacobian_entries(e, entries);
    MatrixXd matrix = MatrixXd::Zero(system.layout().nc(), system.layout().nv());
    for (const SparseEntry& entry : entries) matrix(entry.row(), entry.col()) += entry.value();
    return matrix;
  }

  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }

  // --- what hangs on what ----------------------------------------------------------------------------------------

  /// Bodies that nothing ties to the others and on which nothing acts.
  void find_loose_ends() {
    const int bodies = static_cast<int>(model_.bodies.size());
    std::vector<int> group(at(bodies + 1));  // the last is ground
    std::iota(group.begin(), group.end(), 0);
    const auto root = [&](int i) {
      while (group[at(i)] != i) i = group[at(i)] = group[at(group[at(i)])];
      return i;
    };
    const auto place = [&](BodyId body) { return body == ground ? bodies : body; };
    std::vector<char> acted(at(bodies + 1), 0);
    for (const JointElement& joint : model_.joints) {
      if (joint.gear >= 0) continue;
      const int a = place(body_of(joint.marker_a)), b = place(body_of(joint.marker_b));
      group[at(root(a))] = root(b);
      acted[at(a)] = acted[at(b)] = 1;
    }
    for (const AppliedForce& force : model_.forces) acted[at(place(body_of(force.marker)))] = 1;
    int held = 0;
    for (int i = 0; i < bodies; ++i) held += root(i) == root(bodies) ? 1 : 0;
    if (held == 0) return;  // a model that flies as a whole
    for (int i = 0; i < bodies; ++i) {
      const Body& body = model_.bodies[at(i)];
      if (acted[at(i)] || has_velocity(body)) continue;
      doubt("not-connected",
            fmt::format("no joint or force holds body '{}', which {}: connect it, or delete it", body.name,
                        body.gravity == Vector3{} ? "stays where it is" : "falls freely"),
            body.name, body.location);
    }
  }

  static bool has_velocity(const Body& body) {
    const auto any = [](const Vector3& v) { return v[0] != 0.0 || v[1] != 0.0 || v[2] != 0.0; };
    return any(body.velocity) || any(body.angular_velocity);
  }

  void judge_springs() {
    for (const JointElement& joint : model_.joints) {
      if (!joint.is_force || !joint.parameters) continue;
      const auto found = joint.parameters->values.find("free_length");
      if (found == joint.parameters->values.end() || !(found->second.number > 0.0)) continue;
      const double* a = open_.markers[at(joint.marker_a)].position;
      const double* b = open_.markers[at(joint.marker_b)].position;
      const double length = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]), free = found->second.number;
      if (length < 1e-9 || (free <= odd_free_length * length && length <= odd_free_length * free)) continue;
      doubt("doubtful-length",
            fmt::format("the free length of '{}' is {:.4g} m, but its ends are {:.4g} m apart at the start: check the "
                        "number and its unit",
                        joint.name, free, length),
            joint.name, joint.location);
    }
  }

  // --- joints between the same two bodies ------------------------------------------------------------------------

  /// Rows of a joint of the closed mechanism in the columns of two bodies.
  MatrixXd rows_of(int joint, const std::pair<BodyId, BodyId>& bodies) const {
    const Slice slice = closed_.layout().rows(joint);
    const int width = closed_.body_velocities();
    MatrixXd rows = MatrixXd::Zero(slice.size, 2 * width);
    for (auto [found, end] = blocks_.equal_range(slice.offset); found != end; ++found) {
      const JacobianBlock& block = *found->second;
      const int column = block.body == bodies.first ? 0 : width;
      for (int r = 0; r < block.rows; ++r) {
        for (int c = 0; c < width; ++c) rows(r, column + c) = shut_.jacobian[at(block.offset + r * width + c)];
      }
    }
    return rows;
  }

  void judge_pairs() {
    std::map<std::pair<BodyId, BodyId>, std::vector<int>> pairs;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (model_.joints[at(j)].gear >= 0 || closed_.layout().rows(j).size == 0) continue;
      pairs[std::minmax(body_of(model_.joints[at(j)].marker_a), body_of(model_.joints[at(j)].marker_b))].push_back(j);
    }
    for (const auto& [bodies, joints] : pairs) {
      for (std::size_t k = 1; k < joints.size(); ++k) {
        for (std::size_t i = 0; i < k; ++i) {
          if (judge_pair(joints[i], joints[k], bodies)) break;
        }
      }
    }
  }

  /// True after a message.
  bool judge_pair(int first, int second, const std::pair<BodyId, BodyId>& bodies) {
    const MatrixXd a = rows_of(first, bodies), b = rows_of(second, bodies);
    const int both = rank_of(stacked(a, b)), rank_a = rank_of(a), rank_b = rank_of(b);
    const JointElement& one = model_.joints[at(first)];
    const JointElement& other = model_.joints[at(second)];
    if (one.has_play != other.has_play) {
      const bool bypassed = both == (one.has_play ? rank_b : rank_a);
      return bypassed && bypass(one.has_play ? first : second,
                                fmt::format("'{}', which holds the same two bodies without play",
                                            (one.has_play ? other : one).name),
                                "delete one of the two joints, or give both clearance");
    }
    if (one.has_play || (both > rank_a && both > rank_b)) return false;
    const JointElement& idle = both == rank_a ? other : one;
    const JointElement& holder = both == rank_a ? one : other;
    return doubt("duplicate-joint",
                 fmt::format("joint '{}' holds nothing that '{}' does not hold between the same two bodies: how they "
                             "share the force is arbitrary; delete one of them",
                             idle.name, holder.name),
                 idle.name, idle.location);
  }

  bool bypass(int joint, const std::string& by, const std::string& remedy) {
    bypassed_.push_back(joint);
    const JointElement& loose = model_.joints[at(joint)];
    return doubt("play-bypassed", fmt::format("the play of joint '{}' is bypassed by {}: {}", loose.name, by, remedy),
                 loose.name, loose.location);
  }

  // --- the whole mechanism ---------------------------------------------------------------------------------------

  /// A play in which no motion of the running model can move its pin.
  void judge_plays(const MatrixXd& open) {
    if (model_.clearance_joints() == 0) return;
    const MatrixXd free = kernel(open);
    const MatrixXd shut = matrix_of(closed_, shut_);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (!model_.joints[at(j)].has_play || std::ranges::count(bypassed_, j) > 0) continue;
      const Slice slice = closed_.layout().rows(j);
      const MatrixXd rows = shut.middleRows(slice.offset, slice.size);
      if (slice.size == 0 || (rows * free).norm() > moves * rows.norm()) continue;
      bypass(j, "the other joints and drivers, which let it move nowhere",
             "it stays where it starts; give clearance to another joint of its loop, or leave out a constraint");
    }
  }

  /// Joints that take part in a state of stress without load.
  void find_undetermined(const MatrixXd& open) {
    const MatrixXd stresses = kernel(open.transpose());
    if (stresses.cols() == 0) return;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const Slice slice = released_.layout().rows(j);
      if (slice.size > 0 && stresses.middleRows(slice.offset, slice.size).norm() > moves) {
        structure_.undetermined.push_back(model_.joints[at(j)].name);
      }
    }
  }

  /// Rows of the closed mechanism, and coordinates on which efforts act.
  MatrixXd held_by_drivers() const {
    MatrixXd rows = matrix_of(closed_, shut_);
    const int width = closed_.body_velocities();
    for (const Driver& driver : model_.drivers) {
      if (prescribes(driver.kind)) continue;
      double row[12], bias = 0.0;
      closed_.coordinate_row(driver.joint, shut_, row, bias);
      MatrixXd one = MatrixXd::Zero(1, rows.cols());
      const JointElement& joint = model_.joints[at(driver.joint)];
      const int bodies[2] = {body_of(joint.marker_a), body_of(joint.marker_b)};
      for (int k = 0; k < 2; ++k) {
        for (int c = 0; c < width && bodies[k] != ground; ++c) one(0, width * bodies[k] + c) += row[width * k + c];
      }
      rows = stacked(rows, one);
    }
    return rows;
  }

  /// Spins of single bodies about their centres of mass, which nothing else notices: of rollers, of rods between two
  /// balls.
  MatrixXd idle_spins(const MatrixXd& rows) const {
    const int width = closed_.body_velocities(), turns = model_.space == Space::planar ? 1 : 3;
    MatrixXd spins(rows.cols(), 0);
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      const int first = width * b + width - turns;
      const MatrixXd own = kernel(rows.middleCols(first, turns));
      if (rows.middleCols(first, turns).norm() <= rank_threshold) {
        spins.conservativeResize(Eigen::NoChange, spins.cols() + turns);
        spins.rightCols(turns).setZero();
        spins.block(first, spins.cols() - turns, turns, turns).setIdentity();
      } else if (own.cols() > 0) {
        spins.conservativeResize(Eigen::NoChange, spins.cols() + own.cols());
        spins.rightCols(own.cols()).setZero();
        spins.block(first, spins.cols() - own.cols(), turns, own.cols()) = own;
      }
    }
    return spins;
  }

  void find_left_free() {
    if (model_.drivers.empty()) return;
    const MatrixXd rows = held_by_drivers();
    MatrixXd free = kernel(rows);
    const MatrixXd spins = idle_spins(rows);
    free -= spins * (spins.transpose() * free);
    structure_.free_motions = static_cast<int>(free.cols() - spins.cols());  // spins are among the free motions
    if (structure_.free_motions <= 0) return;
    const int width = closed_.body_velocities();
    std::vector<int> moving;
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      if (free.middleRows(width * b, width).norm() > moves) moving.push_back(b);
    }
    for (const int b : moving) structure_.left_free.push_back(model_.bodies[at(b)].name);
    if (!moving.empty()) judge_left_free(moving);
  }

  /// Is it said where the free bodies start, and does anything act on them? Pendulums and loads are given a start.
  void judge_left_free(const std::vector<int>& moving) {
    const auto is_moving = [&](BodyId body) { return std::ranges::count(moving, body) > 0; };
    std::vector<char> jointed(model_.bodies.size(), 0);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (model_.joints[at(j)].gear >= 0 || closed_.layout().rows(j).size == 0) continue;
      for (const int marker : {model_.joints[at(j)].marker_a, model_.joints[at(j)].marker_b}) {
        if (body_of(marker) != ground) jointed[at(body_of(marker))] = 1;
      }
    }
    // Springs alone hold it, so that its place is not in doubt.
    const auto hangs = [&](BodyId body) { return is_moving(body) && !jointed[at(body)]; };
    bool start = false, acts = false;
    for (const int b : moving) {
      const Body& body = model_.bodies[at(b)];
      start = start || body.angle || body.rotation || body.position || has_velocity(body) ||
              body.location.file != model_.file;  // robots start as their file draws them
      acts = acts || body.gravity != Vector3{} || has_velocity(body);
    }
    for (const JointElement& joint : model_.joints) {
      const bool on_moving =
          joint.gear < 0 && (is_moving(body_of(joint.marker_a)) || is_moving(body_of(joint.marker_b)));
      start = start || (on_moving && (joint.start_coordinate || joint.start_speed));
      acts = acts || (on_moving && (joint.is_force || joint.start_speed));
      start = start || (joint.is_force && (hangs(body_of(joint.marker_a)) || hangs(body_of(joint.marker_b))));
    }
    for (const AppliedForce& force : model_.forces) acts = acts || is_moving(body_of(force.marker));
    if (start && acts) return;
    std::string names;
    for (const int b : moving) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", model_.bodies[at(b)].name);
    if (moving.size() > 5)
      names = fmt::format("'{}' and {} others", model_.bodies[at(moving[0])].name, moving.size() - 1);
    const Body& first = model_.bodies[at(moving.front())];
    doubt("left-free",
          fmt::format("{} left over with all drivers at rest, and {} {}: add the missing guide, joint or driver, or "
                      "say under 'initial' how it starts",
                      structure_.free_motions == 1 ? std::string("1 freedom is")
                                                   : fmt::format("{} freedoms are", structure_.free_motions),
                      acts ? "no start is given for" : "nothing acts on", names),
          first.name, first.location);
  }

  const Model& model_;
  const System& released_;
  const System& closed_;
  const Evaluation& open_;
  const Evaluation& shut_;
  std::multimap<int, const JacobianBlock*> blocks_;  // of the closed system, by their first row
  std::vector<int> bypassed_;
  Structure structure_;
};

}  // namespace

Structure examine_structure(const System& released, const Evaluation& at_start, const System& closed,
                            const Evaluation& closed_at_start) {
  return Examination(released, at_start, closed, closed_at_start).run();
}

}  // namespace freeplay
