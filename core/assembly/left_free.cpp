#include "assembly/left_free.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>

#include "assembly/driver_reach.h"
#include "assembly/element_number.h"
#include "assembly/missed_joint.h"
#include "assembly/row_space.h"
#include "base/index.h"
#include "model/force_element.h"

namespace freeplay {

using Eigen::MatrixXd;

namespace {

constexpr double hangs_below = 0.5;  // cosine from the plumb line

class FreeMotions {
 public:
  FreeMotions(const System& closed, const Evaluation& shut) : model_(closed.model()), closed_(closed), shut_(shut) {}

  LeftFree find() const {
    LeftFree found;
    const MatrixXd rows = held_by_drivers(), spins = idle_spins(rows);
    found.bodies = moving_in(rows, spins, &found.motions);
    if (found.motions <= 0) found.bodies.clear();
    if (!found.bodies.empty()) judge(rows, found);
    if (found.doubt.empty()) find_idle(spins, found);
    if (found.doubt.empty()) find_apart(found);
    return found;
  }

 private:
  /// Is it said where the free bodies start, and does anything act on them? Pendulums and loads are given a start.
  void judge(const MatrixXd& held, LeftFree& found) const {
    const auto is_moving = [&](BodyId body) { return std::ranges::count(found.bodies, body) > 0; };
    const bool acts = acts_on(is_moving);
    MissedJoint missed = missed_joint(closed_, shut_, is_moving);
    spread(missed.bodies);
    const std::vector<int> unrestrained = acts ? without_start(is_moving, held, missed.bodies) : found.bodies;
    if (unrestrained.empty()) return;
    const bool guessed = std::ranges::any_of(unrestrained, [&](int body) { return missed.bodies[at(body)] != 0; });
    found.doubtful = unrestrained.front();
    found.doubt = fmt::format(
        "{} left over with all drivers at rest, and {} {}: add the missing {}guide, joint or driver; what is "
        "meant to move freely gets a start {}",
        found.motions == 1 ? std::string("1 freedom is") : fmt::format("{} freedoms are", found.motions),
        acts ? "no start is given for" : "nothing acts on", names_of(unrestrained), acts ? "" : "gravity, force, ",
        !acts ? "speed under 'initial', if only 0"
        : !guessed
            ? "under 'initial', or a 'pose' with its angle"
            : fmt::format("under 'initial' (a 'pose' counts as a guess while nothing stands on {})", missed.frame));
  }

  /// A wheel on its own bearing on ground that nothing turns, as one whose gear was forgotten.
  void find_idle(const MatrixXd& spins, LeftFree& found) const {
    const int width = closed_.layout().body_velocities();
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      if (spins.middleRows(width * b, width).norm() <= counts_as_motion || !rests_on_ground(b)) continue;
      found.doubtful = b;
      found.doubt = fmt::format(
          "'{}' never moves: it turns in its bearing on ground alone, and no gear, driver, force or start turns it; "
          "add what is missing, or delete it",
          model_.bodies[at(b)].name);
      return;
    }
  }

  /// Bodies left free where drivers turn rotors alone, to which nothing ties them, as a pump whose gear was forgotten.
  void find_apart(LeftFree& found) const {
    const std::vector<char> reached = reached_by_drivers(model_);
    for (BodyId b = 0; b < static_cast<BodyId>(reached.size()); ++b) {
      if (reached[at(b)] && !stands_on_ground_alone(b)) return;
    }
    const auto apart = std::ranges::find_if(found.bodies, [&](BodyId body) { return !reached[at(body)]; });
    if (apart == found.bodies.end()) return;
    const std::vector<int> groups = tied_groups(model_);
    std::vector<int> bodies;
    for (int b = 0; b < static_cast<int>(groups.size()); ++b) {
      if (groups[at(b)] == groups[at(*apart)]) bodies.push_back(b);
    }
    found.doubtful = bodies.front();
    found.doubt = fmt::format(
        "no driver moves {}: no joint, gear or force ties {} to what drivers move; add what is missing, or a driver",
        names_of(bodies), bodies.size() == 1 ? "it" : "any");
  }

  std::string names_of(const std::vector<int>& bodies) const {
    const auto name = [&](int body) { return fmt::format("'{}'", model_.bodies[at(body)].name); };
    if (bodies.size() > 5) return fmt::format("{} and {} others", name(bodies.front()), bodies.size() - 1);
    std::string names;
    for (const int body : bodies) names += (names.empty() ? "" : ", ") + name(body);
    return names;
  }

  /// Whether all joints and forces between bodies are to ground, and no other force acts on it.
  bool stands_on_ground_alone(BodyId body) const {
    const auto to_another = [&](const JointElement& joint) {
      const BodyId a = body_of(joint.marker_a), b = body_of(joint.marker_b);
      return joint.gear < 0 && (a == body || b == body) && a != ground && b != ground;
    };
    const auto on_it = [&](const AppliedForce& force) { return body_of(force.marker) == body; };
    return std::ranges::none_of(model_.joints, to_another) && std::ranges::none_of(model_.forces, on_it);
  }

  /// Is one bearing on ground without play all that touches the body?
  bool rests_on_ground(BodyId body) const {
    if (has_velocity(model_.bodies[at(body)])) return false;
    int bearing = -1;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      const BodyId a = body_of(joint.marker_a), b = body_of(joint.marker_b);
      if (joint.gear >= 0 || (a != body && b != body)) continue;
      if ((a == ground || b == ground) && only_brakes(joint)) continue;
      if (bearing >= 0 || joint.is_force || joint.has_play || joint.start_speed || (a != ground && b != ground))
        return false;
      bearing = j;
    }
    const auto turns = [&](const Gear& gear) { return gear.first == bearing || gear.second == bearing; };
    return bearing >= 0 && std::ranges::none_of(model_.gears, turns) &&
           std::ranges::count(model_.drivers, bearing, &Driver::joint) == 0 &&
           std::ranges::none_of(model_.forces, [&](const AppliedForce& force) {
             return body_of(force.marker) == body && !only_brakes(force);
           });
  }

  /// Whether it acts on an axis by neither a spring nor a preload, as friction and dampers.
  static bool only_brakes(const JointElement& joint) {
    const auto has = [&](const char* name) { return std::abs(element_number(joint, name)) > 0.0; };
    return is_force_element(joint) && joint.ideal_layout().coordinate != Coordinate::none && joint.by_motion.empty() &&
           !has("stiffness") && !has("preload");
  }

  /// Whether it follows from speeds of its own body alone, and is nothing at rest, as a drag.
  bool only_brakes(const AppliedForce& force) const {
    const auto is_own_speed = [&](const MotionChannel& channel) {
      const bool speed = channel.of == MotionChannel::Of::velocity || channel.of == MotionChannel::Of::angular_velocity;
      return speed && body_of(channel.element) == body_of(force.marker);
    };
    const std::vector<double> rest(force.by_motion.channels.size(), 0.0);
    const auto is_nothing_at_rest = [&](const StateFormula& formula) {
      double value = 0.0;
      EvaluationFailure failure;
      return formula.value({model_.settings.start, rest}, value, failure) && value == 0.0;
    };
    return !force.by_motion.empty() && force.in_time.empty() &&
           std::ranges::all_of(force.by_motion.channels, is_own_speed) &&
           std::ranges::all_of(force.by_motion.formulas, is_nothing_at_rest);
  }

  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }

  /// Rate of a joint's coordinate by all velocities.
  MatrixXd coordinate_rate(int joint) const {
    double row[12], bias = 0.0;
    closed_.joints().coordinate_row(joint, shut_, row, bias);
    MatrixXd one = MatrixXd::Zero(1, closed_.layout().nv());
    const int width = closed_.layout().body_velocities();
    const int bodies[2] = {body_of(model_.joints[at(joint)].marker_a), body_of(model_.joints[at(joint)].marker_b)};
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < width && bodies[k] != ground; ++c) one(0, width * bodies[k] + c) += row[width * k + c];
    }
    return one;
  }

  /// All velocities of a body.
  MatrixXd body_rates(BodyId body) const {
    const int width = closed_.layout().body_velocities();
    MatrixXd rows = MatrixXd::Zero(width, closed_.layout().nv());
    rows.middleCols(width * body, width).setIdentity();
    return rows;
  }

  /// Rows of the closed mechanism, and coordinates on which efforts act.
  MatrixXd held_by_drivers() const {
    MatrixXd rows = constraint_matrix(closed_.jacobian(), shut_);
    for (const Driver& driver : model_.drivers) {
      if (!prescribes(driver.kind)) rows = stacked(rows, coordinate_rate(driver.joint));
    }
    return rows;
  }

  /// Spins of single bodies about their centres of mass, which nothing else notices: of rollers, of rods between two
  /// balls.
  MatrixXd idle_spins(const MatrixXd& rows) const {
    const int width = closed_.layout().body_velocities(), turns = model_.space == Space::planar ? 1 : 3;
    MatrixXd spins(rows.cols(), 0);
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      const int first = width * b + width - turns;
      const MatrixXd own = null_space(rows.middleCols(first, turns));
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
    MatrixXd free = null_space(rows);
    free -= spins * (spins.transpose() * free);
    if (motions != nullptr) *motions = static_cast<int>(free.cols() - spins.cols());  // spins are among the free ones
    const int width = closed_.layout().body_velocities();
    std::vector<int> moving;
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      if (free.middleRows(width * b, width).norm() > counts_as_motion) moving.push_back(b);
    }
    return moving;
  }

  static bool acts_along_a_line(const JointElement& joint) {
    return is_force_element(joint) && joint.ideal_layout().coordinate == Coordinate::none &&
           joint.parameters->values.contains("free_length");
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

  /// Adds the bodies that joints connect to those that are marked, not by way of ground. `rigidly`: nor of springs.
  void spread(std::vector<char>& reached, bool rigidly = false) const {
    for (bool more = true; std::exchange(more, false);) {
      for (const JointElement& joint : model_.joints) {
        if (rigidly && is_force_element(joint)) continue;
        const BodyId a = body_of(joint.marker_a), b = body_of(joint.marker_b);
        if (a == ground || b == ground || reached[at(a)] == reached[at(b)]) continue;
        reached[at(a)] = reached[at(b)] = 1;
        more = true;
      }
    }
  }

  /// Whether a torque or force of a driver reaches a moving body through joints: links in line with it move though
  /// the joint on which it acts stands still.
  template <class IsMoving>
  bool efforts_act_on(const IsMoving& is_moving) const {
    std::vector<char> reached(model_.bodies.size(), 0);
    for (std::size_t b = 0; b < reached.size(); ++b) reached[b] = is_moving(static_cast<BodyId>(b)) ? 1 : 0;
    spread(reached);
    const auto is_reached = [&](BodyId body) { return body != ground && reached[at(body)]; };
    return std::ranges::any_of(model_.drivers, [&](const Driver& driver) {
      const JointElement& joint = model_.joints[at(driver.joint)];
      return !prescribes(driver.kind) && (is_reached(body_of(joint.marker_a)) || is_reached(body_of(joint.marker_b)));
    });
  }

  /// Bodies that joints tie to one that a driver moves; the others have nothing but springs to hold their freedoms.
  std::vector<char> led_by_joints() const {
    std::vector<char> led(model_.bodies.size(), 0);
    for (const Driver& driver : model_.drivers) {
      const JointElement& joint = model_.joints[at(driver.joint)];
      for (const BodyId body : {body_of(joint.marker_a), body_of(joint.marker_b)}) {
        if (body != ground) led[at(body)] = 1;
      }
    }
    spread(led, true);
    return led;
  }

  /// Whether the body of a marker hangs under the other end of a joint that holds one direction alone: where it is
  /// given it starts, as a load does.
  bool hangs_on_a_rope(int j, int marker) const {
    if (closed_.layout().rows(j).size != 1) return false;
    const JointElement& joint = model_.joints[at(j)];
    const Vector3& gravity = model_.bodies[at(body_of(marker))].gravity;
    const double* own = shut_.markers[at(marker)].position;
    const double* other = shut_.markers[at(marker == joint.marker_a ? joint.marker_b : joint.marker_a)].position;
    const double way[3] = {own[0] - other[0], own[1] - other[1], own[2] - other[2]};
    return way[0] * gravity[0] + way[1] * gravity[1] + way[2] * gravity[2] >
           hangs_below * std::hypot(way[0], way[1], way[2]) * std::hypot(gravity[0], gravity[1], gravity[2]);
  }

  /// Lengths of springs between bodies of which none that moves is tied to a driver: those miss a guide rather.
  template <class IsMoving>
  MatrixXd held_by_springs(const IsMoving& is_moving) const {
    MatrixXd rows(0, closed_.layout().nv());
    const std::vector<char> led = led_by_joints();
    const auto missing = [&](int marker) {
      const BodyId body = body_of(marker);
      return body != ground && is_moving(body) && led[at(body)];
    };
    for (const JointElement& joint : model_.joints) {
      if (acts_along_a_line(joint) && !missing(joint.marker_a) && !missing(joint.marker_b))
        rows = stacked(rows, length_rate(joint));
    }
    return rows;
  }

  /// Of the line between the ends of a spring, by all velocities; none where it has no length.
  MatrixXd length_rate(const JointElement& joint) const {
    MatrixXd one = MatrixXd::Zero(1, closed_.layout().nv());
    const int markers[2] = {joint.marker_a, joint.marker_b}, width = closed_.layout().body_velocities();
    const double* from = shut_.markers[at(markers[0])].position;
    const double* to = shut_.markers[at(markers[1])].position;
    const double length = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    for (int k = 0; k < 2 && length > 0.0; ++k) {
      if (body_of(markers[k]) == ground) continue;
      double twist[6] = {}, row[6];
      for (int i = 0; i < 3; ++i) twist[i] = (k == 0 ? from[i] - to[i] : to[i] - from[i]) / length;
      closed_.markers().row(markers[k], twist, shut_, row);
      for (int c = 0; c < width; ++c) one(0, width * body_of(markers[k]) + c) += row[c];
    }
    return one;
  }

  /// Whether a joint, by its own rows, holds tilts and lets its bodies move in two directions, as on a table.
  bool glides(int j, const MatrixXd& rows) const {
    const Slice own = closed_.layout().rows(j);
    if (model_.space == Space::planar || own.size < 3) return false;
    const JointElement& joint = model_.joints[at(j)];
    const BodyId second = body_of(joint.marker_b), body = second == ground ? body_of(joint.marker_a) : second;
    return null_space(rows.block(own.offset, closed_.layout().body_velocities() * body, own.size, 3)).cols() >= 2;
  }

  /// Bodies that move although all that starts are given for is held. A start of a joint and a speed are meant; so is
  /// what springs alone hold, on a slide, a table or free, or a spring about an axis, as many springs as there are
  /// freedoms where no driver moves what joints tie together, and the pose of a body. As poses are also guesses for
  /// loops, a position without an angle of a body on a pin is none, and that of a body which turns about its own centre
  /// of mass unnoticed is its own alone: what holds a slider without its guide is no start. Nor is any pose of bodies
  /// that miss a joint.
  template <class IsMoving>
  std::vector<int> without_start(const IsMoving& is_moving, const MatrixXd& held,
                                 const std::vector<char>& miss_a_joint) const {
    std::vector<char> jointed(model_.bodies.size(), 0);
    MatrixXd given = held;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (joint.gear >= 0) continue;
      const bool on_moving = is_moving(body_of(joint.marker_a)) || is_moving(body_of(joint.marker_b));
      // Between its ends a stop holds nothing.
      const bool spring = joint.is_force && joint.ideal_layout().coordinate == Coordinate::angle &&
                          !std::isfinite(element_number(joint, "upper"));
      if (on_moving && (spring || joint.start_coordinate || joint.start_speed)) {
        given = stacked(given, coordinate_rate(j));
      }
      const bool slides = joint.ideal_layout().coordinate == Coordinate::position || glides(j, held);
      const bool driven = std::ranges::count(model_.drivers, j, &Driver::joint) > 0;
      if (closed_.layout().rows(j).size == 0 || slides || driven) continue;
      for (const int marker : {joint.marker_a, joint.marker_b}) {
        if (body_of(marker) != ground && !hangs_on_a_rope(j, marker)) jointed[at(body_of(marker))] = 1;
      }
    }
    for (const JointElement& joint : model_.joints) {
      if (!joint.is_force) continue;
      for (const BodyId body : {body_of(joint.marker_a), body_of(joint.marker_b)}) {
        if (body != ground && is_moving(body) && !jointed[at(body)]) given = stacked(given, body_rates(body));
      }
    }
    given = stacked(given, held_by_springs(is_moving));
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      if (is_moving(b) && has_velocity(model_.bodies[at(b)])) given = stacked(given, body_rates(b));
    }
    const MatrixXd idle = idle_spins(given);
    const std::vector<int> candidates = moving_in(given, idle);
    const int width = closed_.layout().body_velocities();
    const auto turns_unnoticed = [&](int b) { return idle.middleRows(width * b, width).squaredNorm(); };
    const auto posed = [&](int b) {
      const Body& body = model_.bodies[at(b)];
      return !miss_a_joint[at(b)] && (body.angle || body.rotation || (body.position && !jointed[at(b)]));
    };
    const double all_turns = (model_.space == Space::planar ? 1.0 : 3.0) - counts_as_motion;
    for (const int b : candidates) {
      if (posed(b) && turns_unnoticed(b) <= all_turns) given = stacked(given, body_rates(b));
    }
    const std::vector<int> moving = moving_in(given, idle_spins(given));
    std::vector<int> unrestrained;
    for (const int b : candidates) {
      if (posed(b)) continue;
      if (std::ranges::count(moving, b) > 0 || turns_unnoticed(b) > counts_as_motion) unrestrained.push_back(b);
    }
    return unrestrained;
  }

  const Model& model_;
  const System& closed_;
  const Evaluation& shut_;
};

}  // namespace

bool has_velocity(const Body& body) {
  const auto any = [](const Vector3& v) { return v[0] != 0.0 || v[1] != 0.0 || v[2] != 0.0; };
  return any(body.velocity) || any(body.angular_velocity);
}

LeftFree left_free(const System& closed, const Evaluation& at_start) { return FreeMotions(closed, at_start).find(); }

}  // namespace freeplay
