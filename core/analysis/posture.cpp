#include "analysis/posture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/angle.h"
#include "base/error.h"
#include "base/index.h"

namespace freeplay {
namespace {

// Lengths relative to the size of the model, angles in rad.
constexpr double last_correction = 1e-9;  // what is left is its square
constexpr double residual_limit = 1e-9;
constexpr double longest_step = 0.3;     // of one piece of a way
constexpr double longest_bend = 0.05;    // from the tangent at its start to its end
constexpr double shortest_piece = 1e-6;  // of a way
constexpr int most_pieces = 2000;
constexpr double near_the_end = 1e-3;  // share of a way within which its end may be a fold
constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();
constexpr int most_halvings = 60;  // of the distance to a fold

/// Centre of mass of a body whose point `pin` (body frame) is at (x, y).
void put(const Body& body, double px, double py, double x, double y, double angle, double* q) {
  const double dx = body.com[0] - px, dy = body.com[1] - py, c = std::cos(angle), s = std::sin(angle);
  q[0] = x + c * dx - s * dy;
  q[1] = y + s * dx + c * dy;
  q[2] = angle;
}

}  // namespace

std::string Unreachable::text(const IdealMechanism& mechanism) const {
  const Model& model = mechanism.model();
  if (contradiction) return "no posture has these inputs together";
  if (beyond >= 0) {
    const JointElement& joint = model.joints[at(beyond)];
    const char* unit = joint.ideal_layout().coordinate == Coordinate::angle ? "rad" : "m";
    return fmt::format("{} '{}' would stand at {:.6g} {}, beyond the end of its way at {:.6g} {}",
                       joint.is_force ? "force" : "joint", joint.name, place, unit, end, unit);
  }
  if (input < 0) return "the mechanism does not reach it from its start";
  const std::string& name = model.joints[at(mechanism.platform().inputs[at(input)])].name;
  if (most <= 0.0) return fmt::format("the leg of '{}' does not reach it from its start", name);
  return fmt::format(
      "the leg of '{}' does not reach it: its pins are {:.6g} m apart, the leg reaches from {:.6g} m to "
      "{:.6g} m",
      name, distance, least, most);
}

PostureSolver::PostureSolver(const IdealMechanism& mechanism)
    : mechanism_(mechanism),
      system_(mechanism.system()),
      frame_(system_, mechanism.platform().marker),
      state_(system_.layout(), 0),
      e_(system_),
      increment_(at(system_.layout().nv())),
      column_(mechanism.model().bodies.size()),
      local_row_(at(system_.layout().nc())) {}

PostureSolver::Task PostureSolver::whole_task() const {
  Task task;
  for (int b = 0; b < static_cast<int>(mechanism_.model().bodies.size()); ++b) task.bodies.push_back(b);
  for (int r = 0; r < system_.layout().nc(); ++r) task.rows.push_back(r);
  task.whole = true;
  return task;
}

bool PostureSolver::load(double t, const Posture& posture, unsigned terms) {
  state_.t() = t;
  std::ranges::copy(posture.q, state_.q().begin());
  if (!posture.h.empty()) std::ranges::copy(posture.h, state_.h().begin());
  return system_.evaluate(point(state_), terms | term_coordinate, e_);
}

const Evaluation& PostureSolver::evaluate(double t, const Posture& posture, unsigned terms) {
  std::ranges::fill(state_.v(), 0.0);
  return look(t, posture, terms);
}

const Evaluation& PostureSolver::evaluate_moving(double t, const Posture& posture, const std::vector<double>& v,
                                                 unsigned terms) {
  std::ranges::copy(v, state_.v().begin());
  return look(t, posture, terms);
}

const Evaluation& PostureSolver::look(double t, const Posture& posture, unsigned terms) {
  if (!load(t, posture, terms)) {
    const char* text = e_.fault.kind == Fault::Kind::motion ? e_.fault.motion.text : e_.fault.message.text;
    throw Error(Error::Category::numerical, "analysis-failed", text);
  }
  return e_;
}

std::vector<double> PostureSolver::inputs(const Posture& posture) {
  if (!load(state_.t(), posture, 0)) throw Error(Error::Category::numerical, "analysis-failed", e_.fault.message.text);
  std::vector<double> out;
  for (const int j : mechanism_.platform().inputs) out.push_back(e_.coordinate[at(j)]);
  return out;
}

bool PostureSolver::place_platform(const Demand& demand, Posture& posture) const {
  if (!is_whole(demand)) return false;
  FramePose pose;
  for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = demand.pose[i].value;
  frame_.place(pose, posture.q);
  return true;
}

Posture PostureSolver::blank() const {
  return {std::vector<double>(at(system_.layout().nq())), std::vector<double>(at(system_.layout().nh()))};
}

bool PostureSolver::place(const Limb& part, int elbow, const Demand& demand, Posture& posture) const {
  Leg leg = *part.leg;
  leg.elbow = elbow;
  Unreachable why;
  return place_leg(part, leg, demand, posture, why);
}

bool PostureSolver::place_leg(const Limb& part, const Leg& leg, const Demand& demand, Posture& posture,
                              Unreachable& why) const {
  const Model& model = mechanism_.model();
  const double turn = demand.pose[2].value - model.markers[at(mechanism_.platform().marker)].angle;
  const LegAngles angles = leg_angles(leg, demand.pose[0].value, demand.pose[1].value, std::cos(turn), std::sin(turn));
  if (!angles.reachable) {
    why = {part.inputs[0], angles.distance, std::abs(leg.crank - leg.coupler), leg.crank + leg.coupler, false};
    return false;
  }
  put(model.bodies[at(leg.crank_body)], leg.crank_pin_x, leg.crank_pin_y, leg.ax, leg.ay, angles.crank,
      &posture.q[3 * at(leg.crank_body)]);
  const double direction = angles.crank + leg.crank_direction;
  put(model.bodies[at(leg.coupler_body)], leg.coupler_pin_x, leg.coupler_pin_y,
      leg.ax + leg.crank * std::cos(direction), leg.ay + leg.crank * std::sin(direction), angles.coupler,
      &posture.q[3 * at(leg.coupler_body)]);
  return true;
}

// Rows and -residual of the task at a posture.
void PostureSolver::assemble(const Task& task, const Demand& demand) {
  const Model& model = mechanism_.model();
  const Platform& platform = mechanism_.platform();
  const int width = system_.layout().body_velocities();
  pose_rows_.clear();
  if (task.whole) frame_.rows(demand.given, demand.pose, e_, pose_rows_);
  const auto held = std::ranges::count_if(demand.inputs, [](const Jet& input) { return !std::isnan(input.value); });
  const auto extra = static_cast<Eigen::Index>(pose_rows_.size()) + (task.whole ? held : 0);
  const int rows = static_cast<int>(task.rows.size());
  matrix_.setZero(rows + extra, width * static_cast<Eigen::Index>(task.bodies.size()));
  right_.setZero(rows + extra);
  std::ranges::fill(column_, -1);
  std::ranges::fill(local_row_, -1);
  for (std::size_t i = 0; i < task.bodies.size(); ++i) column_[at(task.bodies[i])] = width * static_cast<int>(i);
  for (int i = 0; i < rows; ++i) {
    local_row_[at(task.rows[at(i)])] = i;
    right_[i] = -e_.phi[at(task.rows[at(i)])];
  }
  for (const JacobianBlock& block : system_.jacobian().blocks()) {
    const int column = column_[at(block.body)];
    if (column < 0) continue;
    for (int r = 0; r < block.rows; ++r) {
      const int row = local_row_[at(block.row + r)];
      if (row < 0) continue;
      for (int c = 0; c < width; ++c) matrix_(row, column + c) += e_.jacobian[at(block.offset + width * r + c)];
    }
  }
  if (!task.whole) return;
  int row = rows;
  for (const PoseRow& wanted : pose_rows_) {
    double entries[spatial::velocities];
    system_.markers().row(platform.marker, wanted.g, e_, entries);
    for (int c = 0; c < width; ++c) matrix_(row, column_[at(mechanism_.platform_body())] + c) = entries[c];
    right_[row++] = wanted.gap;
  }
  for (std::size_t i = 0; i < demand.inputs.size(); ++i) {
    if (std::isnan(demand.inputs[i].value)) continue;
    const int j = platform.inputs[i];
    double entries[2 * spatial::velocities], bias = 0.0;
    system_.joints().coordinate_row(j, e_, entries, bias);
    const JointElement& joint = model.joints[at(j)];
    const BodyId bodies[2] = {model.markers[at(joint.marker_a)].body, model.markers[at(joint.marker_b)].body};
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < width && bodies[k] != ground; ++c) {
        matrix_(row, column_[at(bodies[k])] + c) += entries[width * k + c];
      }
    }
    const double gap = demand.inputs[i].value - e_.coordinate[at(j)];
    right_[row++] = mechanism_.is_angle(static_cast<int>(i)) ? without_turns(gap) : gap;
  }
}

void PostureSolver::move(const Task& task, const Eigen::VectorXd& step, Posture& posture) {
  const std::size_t width = at(system_.layout().body_velocities());
  std::ranges::fill(increment_, 0.0);
  for (std::size_t b = 0; b < task.bodies.size(); ++b) {
    std::copy_n(step.data() + width * b, width, &increment_[width * at(task.bodies[b])]);
  }
  system_.coordinates().retract(posture.q, increment_, posture.q);
}

// Newton's method. The first step follows the tangent; the others together measure how far the way bends from it.
PostureSolver::Step PostureSolver::correct(const Task& task, const Demand& demand, Posture& posture, double longest,
                                           int iterations) {
  const double size = system_.size();
  double bend = 0.0;
  for (int i = 0; i < iterations; ++i) {
    std::ranges::fill(state_.v(), 0.0);
    if (!load(demand.t, posture, term_position)) return Step::too_far;
    assemble(task, demand);
    if (right_.size() == 0) return Step::converged;
    solver_.compute(matrix_);
    const Eigen::VectorXd step = solver_.solve(right_);
    double largest = 0.0;
    for (Eigen::Index k = 0; k < step.size(); ++k) {
      const double change = std::abs(step[k]) / (system_.coordinates().is_turn(static_cast<int>(k)) ? 1.0 : size);
      if (!(change <= largest)) largest = change;
    }
    if (i == 0 ? !(largest <= longest) : !((bend += largest) <= longest * longest_bend / longest_step)) {
      return Step::too_far;
    }
    move(task, step, posture);
    if (largest > last_correction) continue;
    if (!load(demand.t, posture, term_position)) return Step::too_far;
    assemble(task, demand);
    return right_.lpNorm<Eigen::Infinity>() <= residual_limit * std::max(size, 1.0) ? Step::converged
                                                                                    : Step::contradiction;
  }
  return Step::too_far;
}

void PostureSolver::count_turns(Posture& posture) const {
  for (int j = 0; j < static_cast<int>(mechanism_.model().joints.size()); ++j) {
    if (const int turn = system_.layout().turn(j); turn >= 0) posture.h[at(turn)] = e_.coordinate[at(j)];
  }
}

bool PostureSolver::follow(const Task& task, const std::function<Demand(double)>& way, Posture& posture,
                           Unreachable& why) {
  double done = 0.0, piece = 1.0;
  for (int pieces = 0; done < 1.0; ++pieces) {
    if (pieces == most_pieces) return false;
    const double next = done + piece >= 1.0 - 1e-12 ? 1.0 : done + piece;
    Posture trial = posture;
    const Demand demand = way(next);
    if (!task.whole) place_platform(demand, trial);
    const Step step = correct(task, demand, trial, longest_step, 12);
    if (step == Step::converged) {
      posture = std::move(trial);
      if (!posture.h.empty()) count_turns(posture);
      done = next;
      piece *= 2.0;
      continue;
    }
    piece *= 0.5;
    if (piece >= shortest_piece) continue;
    if (1.0 - done < near_the_end && settle_on_fold(task, way(1.0), posture)) return true;
    why.contradiction = step == Step::contradiction && !demand.inputs.empty();
    return false;
  }
  return true;
}

// Where a way ends on a fold, legs stretched, say, the equations have a double root: Newton's method only halves the
// distance to it, down to the root of the rounding. The end is in reach when the residual falls to that of rounding.
bool PostureSolver::settle_on_fold(const Task& task, const Demand& demand, Posture& posture) {
  Posture trial = posture;
  if (!task.whole) place_platform(demand, trial);
  std::ranges::fill(state_.v(), 0.0);
  double scale = system_.size(), last = std::numeric_limits<double>::infinity();
  const std::size_t numbers = at(system_.layout().body_coordinates());
  for (std::size_t i = 0; i < trial.q.size(); ++i) {
    if (i % numbers < form().lengths) scale = std::max(scale, std::abs(trial.q[i]));
  }
  for (int i = 0; i < most_halvings; ++i) {
    if (!load(demand.t, trial, term_position)) return false;
    assemble(task, demand);
    // As far down as rounding lets it fall.
    const double residual = right_.lpNorm<Eigen::Infinity>();
    if (const double before = std::exchange(last, residual); residual <= rounding * scale && residual >= 0.5 * before) {
      posture = std::move(trial);
      if (!posture.h.empty()) count_turns(posture);
      folded_ = true;
      return true;
    }
    solver_.compute(matrix_);
    const Eigen::VectorXd step = solver_.solve(right_);
    if (!(step.lpNorm<Eigen::Infinity>() <= longest_step * std::max(1.0, system_.size()))) return false;
    move(task, step, trial);
  }
  return false;
}

bool PostureSolver::reach(const std::function<Demand(double)>& way, const Posture& from, Posture& posture,
                          Unreachable& why) {
  const Demand last = way(1.0);
  why = {};
  folded_ = false;
  posture = from.q.empty() ? blank() : from;
  if (!is_whole(last) || !last.inputs.empty()) return follow(whole_task(), way, posture, why);
  for (const Limb& part : mechanism_.parts()) {
    if (part.leg) continue;
    why = {};
    why.input = part.inputs.empty() ? -1 : part.inputs.front();
    if (!follow(Task{part.bodies, part.rows, false}, way, posture, why)) return false;
  }
  place_platform(last, posture);
  for (const Limb& part : mechanism_.parts()) {
    if (part.leg && !place_leg(part, *part.leg, last, posture, why)) return false;
  }
  return true;
}

bool PostureSolver::reach(const Demand& demand, const Posture& from, Posture& posture, Unreachable& why) {
  if (from.q.empty()) return reach([&](double) { return demand; }, from, posture, why);
  const FramePose here = frame(from);
  std::vector<double> inputs_here;
  if (!demand.inputs.empty()) inputs_here = inputs(from);
  const auto between = [](const Jet& end, double start, bool turns, double s) {
    const double gap = end.value - start;
    Jet out = end;
    if (s < 1.0) out.value = start + s * (turns ? without_turns(gap) : gap);
    return out;
  };
  return reach(
      [&](double s) {
        Demand part = demand;
        for (std::size_t i = 0; i < form().size(); ++i) {
          part.pose[i] = between(demand.pose[i], here[i], form().is_turn(i), s);
        }
        for (std::size_t i = 0; i < part.inputs.size(); ++i) {
          part.inputs[i] = between(demand.inputs[i], inputs_here[i], mechanism_.is_angle(static_cast<int>(i)), s);
        }
        return part;
      },
      from, posture, why);
}

bool PostureSolver::settle(const Demand& demand, Posture& posture) {
  return correct(whole_task(), demand, posture, 1e3, 50) == Step::converged;
}

bool PostureSolver::settle(const Limb& part, const Demand& demand, Posture& posture) {
  place_platform(demand, posture);
  return correct(Task{part.bodies, part.rows, false}, demand, posture, 1e3, 50) == Step::converged;
}

int PostureSolver::legs_in_reach(const Demand& demand, const Posture& from, Unreachable& why) {
  Posture posture = from.q.empty() ? blank() : from;
  const bool whole_pose = is_whole(demand);
  int legs = 0;
  bool explained = false;
  for (const Limb& part : mechanism_.parts()) {
    if (!whole_pose && part.inputs.empty()) continue;
    Unreachable reason;
    reason.input = part.inputs.empty() ? -1 : part.inputs.front();
    bool reached = false;
    if (part.leg && whole_pose) {
      reached = place_leg(part, *part.leg, demand, posture, reason);
    } else if (!from.q.empty()) {
      const FramePose here = frame(from);
      Posture moved = from;
      Task task{part.bodies, part.rows, false};
      if (!whole_pose) {
        // What is left of the mechanism without the other legs.
        task.bodies.push_back(mechanism_.platform_body());
        for (const Limb& other : mechanism_.parts()) {
          if (!other.inputs.empty()) continue;
          task.bodies.insert(task.bodies.end(), other.bodies.begin(), other.bodies.end());
          task.rows.insert(task.rows.end(), other.rows.begin(), other.rows.end());
        }
        task.whole = true;
      }
      reached = follow(
          task,
          [&](double s) {
            Demand share = demand;
            for (std::size_t i = 0; i < form().size(); ++i) {
              const double gap = demand.pose[i].value - here[i];
              share.pose[i].value = here[i] + s * (form().is_turn(i) ? without_turns(gap) : gap);
            }
            return share;
          },
          moved, reason);
    }
    legs += reached ? static_cast<int>(part.inputs.size()) : 0;
    if (!reached && !explained) {
      why = reason;
      explained = true;
    }
  }
  return legs;
}

bool PostureSolver::rates(const Demand& demand, const Posture& posture, std::vector<double>& v,
                          std::vector<double>& a) {
  const Task task = whole_task();
  const Platform& platform = mechanism_.platform();
  v.assign(increment_.size(), 0.0);
  a.assign(increment_.size(), 0.0);
  for (const bool speeds : {true, false}) {
    std::ranges::copy(v, state_.v().begin());
    if (!load(demand.t, posture, term_position | term_velocity | term_acceleration)) return false;
    assemble(task, demand);
    if (speeds) {
      solver_.compute(matrix_);
      // On a fold of its branch a posture is known to the root of the rounding only.
      solver_.setThreshold(1e-7 * std::min(1.0, system_.size()));
      if (solver_.rank() < matrix_.cols()) return false;
    }
    for (int r = 0; r < system_.layout().nc(); ++r) right_[r] = speeds ? e_.nu[at(r)] : e_.gamma[at(r)];
    int row = system_.layout().nc();
    for (const PoseRow& wanted : pose_rows_) {
      right_[row++] =
          speeds ? wanted.rate : wanted.acceleration - system_.markers().row_product(platform.marker, wanted.g, e_);
    }
    for (std::size_t i = 0; i < demand.inputs.size(); ++i) {
      if (std::isnan(demand.inputs[i].value)) continue;
      double entries[2 * spatial::velocities], bias = 0.0;
      system_.joints().coordinate_row(platform.inputs[i], e_, entries, bias);
      right_[row++] = speeds ? demand.inputs[i].rate : demand.inputs[i].acceleration - bias;
    }
    const Eigen::VectorXd solution = solver_.solve(right_);
    std::copy_n(solution.data(), solution.size(), (speeds ? v : a).begin());
  }
  return true;
}

}  // namespace freeplay
