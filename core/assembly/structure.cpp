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
constexpr double coarse_accuracy = 0.5;    // by a clearance
constexpr double deep_start = 1.5;         // eccentricity of a journal, by its clearance

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

  Structure run(const std::optional<DeadStart>& dead) {
    if (dead) {
      const Driver& driver = model_.drivers[at(dead->driver)];
      doubt("dead-point", words(*dead, model_), driver.name, driver.location);
    }
    find_loose_ends();
    judge_springs();
    judge_journals();
    judge_pairs();
    judge_gears();
    if (closed_.layout().nv() > Structure::most_examined) return std::move(structure_);
    const MatrixXd open = matrix_of(released_, open_);
    judge_plays(open);
    find_undetermined(open);
    if (!dead) find_left_free();
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
    flies_ = held == 0;
    if (flies_) return;
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

  /// Journals that start in the wall of their bearings, and an accuracy that does not see them move.
  void judge_journals() {
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      const double play = joint.layout.clearance;
      if (!joint.has_play || !(play > 0.0)) continue;
      if (model_.settings.accuracy > coarse_accuracy * play) {
        doubt("doubtful-value",
              fmt::format("the accuracy of {:.3g} m is coarse against the clearance of joint '{}', {:.3g} m: ask for a "
                          "tenth of it or less",
                          model_.settings.accuracy, joint.name, play),
              joint.name, joint.location);
      }
      const MarkerKinematics &a = open_.markers[at(joint.marker_a)], &b = open_.markers[at(joint.marker_b)];
      double apart[3], along = 0.0;
      for (std::size_t i = 0; i < 3; ++i) apart[i] = b.position[i] - a.position[i];
      // Of a pin in space its axis, z of the first marker, does not count.
      const bool pin = model_.space == Space::spatial && joint.ideal_layout.coordinate == Coordinate::angle;
      for (std::size_t i = 0; i < 3 && pin; ++i) along += apart[i] * a.rotation[3 * i + 2];
      for (std::size_t i = 0; i < 3 && pin; ++i) apart[i] -= along * a.rotation[3 * i + 2];
      const double eccentricity = std::hypot(apart[0], apart[1], apart[2]);
      if (eccentricity <= deep_start * play) continue;
      doubt(
          "doubtful-clearance",
          fmt::format("the journal of joint '{}' starts {:.3g} m from the centre of its bearing, {:.3g} m deep in its "
                      "wall, as the clearance is {:.3g} m: check 'initial' and the clearance",
                      joint.name, eccentricity, eccentricity - play, play),
          joint.name, joint.location);
    }
  }

  /// The same two joints geared twice.
  void judge_gears() {
    for (std::size_t k = 1; k < model_.gears.size(); ++k) {
      for (std::size_t i = 0; i < k; ++i) {
        const Gear &one = model_.gears[i], &other = model_.gears[k];
        if (std::minmax(one.first, one.second) != std::minmax(other.first, other.second)) continue;
        const JointElement& joint = model_.joints[at(other.joint)];
        doubt(
            "duplicate-joint",
            fmt::format("gear '{}' couples the same two joints as '{}': how they share the torque is arbitrary; delete "
                        "one of them",
                        joint.name, model_.joints[at(one.joint)].name),
            joint.name, joint.location);
        break;
      }
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

  /// Rate of a joint's coordinate by all velocities.
  MatrixXd coordinate_rate(int joint) const {
    double row[12], bias = 0.0;
    closed_.coordinate_row(joint, shut_, row, bias);
    MatrixXd one = MatrixXd::Zero(1, closed_.layout().nv());
    const int width = closed_.body_velocities();
    const int bodies[2] = {body_of(model_.joints[at(joint)].marker_a), body_of(model_.joints[at(joint)].marker_b)};
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < width && bodies[k] != ground; ++c) one(0, width * bodies[k] + c) += row[width * k + c];
    }
    return one;
  }

  /// All velocities of a body.
  MatrixXd body_rates(BodyId body) const {
    const int width = closed_.body_velocities();
    MatrixXd rows = MatrixXd::Zero(width, closed_.layout().nv());
    rows.middleCols(width * body, width).setIdentity();
    return rows;
  }

  /// Rows of the closed mechanism, and coordinates on which efforts act.
  MatrixXd held_by_drivers() const {
    MatrixXd rows = matrix_of(closed_, shut_);
    for (const Driver& driver : model_.drivers) {
      if (!prescribes(driver.kind)) rows = stacked(rows, coordinate_rate(driver.joint));
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

  /// Bodies that motions within the kernel of `rows` move; spins that nothing notices do not count.
  std::vector<int> moving_in(const MatrixXd& rows, const MatrixXd& spins, int* motions = nullptr) const {
    MatrixXd free = kernel(rows);
    free -= spins * (spins.transpose() * free);
    if (motions != nullptr) *motions = static_cast<int>(free.cols() - spins.cols());  // spins are among the free ones
    const int width = closed_.body_velocities();
    std::vector<int> moving;
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      if (free.middleRows(width * b, width).norm() > moves) moving.push_back(b);
    }
    return moving;
  }

  void find_left_free() {
    if (model_.drivers.empty()) return;
    const MatrixXd rows = held_by_drivers(), spins = idle_spins(rows);
    const std::vector<int> moving = moving_in(rows, spins, &structure_.free_motions);
    if (structure_.free_motions <= 0) return;
    for (const int b : moving) structure_.left_free.push_back(model_.bodies[at(b)].name);
    if (!moving.empty() && !flies_) judge_left_free(moving, rows, spins);
  }

  /// Is it said where the free bodies start, and does anything act on them? Pendulums and loads are given a start.
  void judge_left_free(const std::vector<int>& moving, const MatrixXd& held, const MatrixXd& spins) {
    const auto is_moving = [&](BodyId body) { return std::ranges::count(moving, body) > 0; };
    const bool acts = acts_on(is_moving);
    const std::vector<int> unrestrained = acts ? without_start(is_moving, held, spins) : moving;
    if (unrestrained.empty()) return;
    std::string names;
    for (const int b : unrestrained)
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", model_.bodies[at(b)].name);
    if (unrestrained.size() > 5)
      names = fmt::format("'{}' and {} others", model_.bodies[at(unrestrained[0])].name, unrestrained.size() - 1);
    const Body& first = model_.bodies[at(unrestrained.front())];
    doubt("left-free",
          fmt::format("{} left over with all drivers at rest, and {} {}: add the missing guide, joint or driver, or "
                      "say under 'initial' how it starts",
                      structure_.free_motions == 1 ? std::string("1 freedom is")
                                                   : fmt::format("{} freedoms are", structure_.free_motions),
                      acts ? "no start is given for" : "nothing acts on", names),
          first.name, first.location);
  }

  template <class IsMoving>
  bool acts_on(const IsMoving& is_moving) const {
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      const Body& body = model_.bodies[at(b)];
      if (is_moving(b) && (body.gravity != Vector3{} || has_velocity(body))) return true;
    }
    for (const JointElement& joint : model_.joints) {
      const bool on_moving =
          joint.gear < 0 && (is_moving(body_of(joint.marker_a)) || is_moving(body_of(joint.marker_b)));
      if (on_moving && (joint.is_force || joint.start_speed)) return true;
    }
    if (efforts_act_on(is_moving)) return true;
    return std::ranges::any_of(model_.forces,
                               [&](const AppliedForce& force) { return is_moving(body_of(force.marker)); });
  }

  /// Whether a torque or force of a driver reaches a moving body through joints: links in line with it move though
  /// the joint on which it acts stands still.
  template <class IsMoving>
  bool efforts_act_on(const IsMoving& is_moving) const {
    std::vector<char> reached(model_.bodies.size(), 0);
    for (std::size_t b = 0; b < reached.size(); ++b) reached[b] = is_moving(static_cast<BodyId>(b)) ? 1 : 0;
    const auto is_reached = [&](BodyId body) { return body != ground && reached[at(body)]; };
    for (bool more = true; std::exchange(more, false);) {
      for (const JointElement& joint : model_.joints) {
        const BodyId a = body_of(joint.marker_a), b = body_of(joint.marker_b);
        if (a == ground || b == ground || is_reached(a) == is_reached(b)) continue;
        reached[at(a)] = reached[at(b)] = 1;
        more = true;
      }
    }
    return std::ranges::any_of(model_.drivers, [&](const Driver& driver) {
      const JointElement& joint = model_.joints[at(driver.joint)];
      return !prescribes(driver.kind) && (is_reached(body_of(joint.marker_a)) || is_reached(body_of(joint.marker_b)));
    });
  }

  /// Bodies that move although all that starts are given for is held. A start of a joint and a speed are meant; so is
  /// what springs alone hold, on a slide or free, or a spring about an axis. A pose may be a guess for a loop: it does
  /// not count where some frame that a loop may have closed on is used by nothing, nor for what hangs on the body and
  /// may turn about its own centre of mass unnoticed, as a slider without its guide does.
  template <class IsMoving>
  std::vector<int> without_start(const IsMoving& is_moving, const MatrixXd& held, const MatrixXd& spins) const {
    std::vector<char> jointed(model_.bodies.size(), 0);
    MatrixXd given = held;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (joint.gear >= 0) continue;
      const bool on_moving = is_moving(body_of(joint.marker_a)) || is_moving(body_of(joint.marker_b));
      const bool spring = joint.is_force && joint.ideal_layout.coordinate == Coordinate::angle;
      if (on_moving && (spring || joint.start_coordinate || joint.start_speed)) {
        given = stacked(given, coordinate_rate(j));
      }
      const bool slides = joint.ideal_layout.coordinate == Coordinate::position;
      const bool driven = std::ranges::count(model_.drivers, j, &Driver::joint) > 0;
      if (closed_.layout().rows(j).size == 0 || slides || driven) continue;
      for (const int marker : {joint.marker_a, joint.marker_b}) {
        if (body_of(marker) != ground) jointed[at(body_of(marker))] = 1;
      }
    }
    for (const JointElement& joint : model_.joints) {
      if (!joint.is_force) continue;
      for (const BodyId body : {body_of(joint.marker_a), body_of(joint.marker_b)}) {
        if (body != ground && is_moving(body) && !jointed[at(body)]) given = stacked(given, body_rates(body));
      }
    }
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      if (is_moving(b) && has_velocity(model_.bodies[at(b)])) given = stacked(given, body_rates(b));
    }
    std::vector<int> candidates = moving_in(given, idle_spins(given));
    if (has_unused_frame(is_moving)) return candidates;
    const auto posed = [&](int b) {
      const Body& body = model_.bodies[at(b)];  // robots start as their file draws them
      return body.angle || body.rotation || body.position || body.location.file != model_.file;
    };
    for (const int b : candidates) {
      if (posed(b)) given = stacked(given, body_rates(b));
    }
    std::vector<int> unrestrained = moving_in(given, idle_spins(given));
    const int width = closed_.body_velocities();
    for (const int b : candidates) {
      const bool turns_unnoticed = spins.middleRows(width * b, width).norm() > moves;
      if (turns_unnoticed && !posed(b) && std::ranges::count(unrestrained, b) == 0) unrestrained.push_back(b);
    }
    std::ranges::sort(unrestrained);
    return unrestrained;
  }

  /// Of a moving body or of ground: declared, and nothing stands on it.
  template <class IsMoving>
  bool has_unused_frame(const IsMoving& is_moving) const {
    return std::ranges::any_of(model_.frames, [&](const Marker& frame) {
      if (frame.body != ground && !is_moving(frame.body)) return false;
      if (frame.name.ends_with("/origin") || frame.name.ends_with("/com")) return false;
      return std::ranges::none_of(model_.markers, [&](const Marker& used) { return used.name == frame.name; });
    });
  }

  const Model& model_;
  const System& released_;
  const System& closed_;
  const Evaluation& open_;
  const Evaluation& shut_;
  std::multimap<int, const JacobianBlock*> blocks_;  // of the closed system, by their first row
  std::vector<int> bypassed_;
  bool flies_ = false;  // as a whole: nothing ties it to ground
  Structure structure_;
};

}  // namespace

Structure examine_structure(const System& released, const Evaluation& at_start, const System& closed,
                            const Evaluation& closed_at_start, const std::optional<DeadStart>& dead) {
  return Examination(released, at_start, closed, closed_at_start).run(dead);
}

}  // namespace freeplay
