#include "assembly/idle_elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "assembly/element_number.h"
#include "assembly/element_rates.h"
#include "assembly/given_damping.h"
#include "assembly/row_space.h"
#include "base/index.h"
#include "base/text.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double held = 1e-9;            // motion along an element that rows leave, of a unit vector
constexpr double held_by_play = 1e-3;    // likewise, by a joint with play
constexpr double by_sound = 1e-6;        // stop of a body [s]: sound crosses 5 mm of steel in it
constexpr double far_below_step = 0.01;  // of a fixed step, or of the time between rows
constexpr double most_beyond = 0.1;      // of the way between the ends of a stop
constexpr double least_beyond = 0.01;    // rad, or of the size of the model
constexpr double most_pressed = 0.02;    // of that way, by a driver
constexpr double in_turns = 0.5 / std::numbers::pi;
constexpr double most_unwound = 0.125;  // of a spring that is wound by a turn, but for this turn [turns]
constexpr double same_ratio = 1e-6;     // of strands and of a gear between their wheels
constexpr double most_strain = 0.1;     // of strands by drivers of both their wheels: none bears a tenth
constexpr int looks_of_run = 256;       // at what drivers prescribe

class Elements {
 public:
  Elements(const System& system, const Evaluation& e, const System& closed, const Evaluation& shut,
           Structure& structure)
      : system_(system),
        model_(system.model()),
        e_(e),
        closed_(closed),
        shut_(constraint_matrix(closed.jacobian(), shut)),
        rates_(system, e),
        structure_(structure) {}

  void judge() {
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& element = model_.joints[at(j)];
      if (!is_force_element(element) || !element.parameters || element.has_play || element.gear >= 0) continue;
      if (judge_idle(j) || judge_unguided(j)) continue;
      judge_damping(j);
      judge_ends(j);
      judge_driven_ends(j);
      judge_turn(j);
      if (!judge_strands(j)) judge_driven_strands(j);
    }
  }

 private:
  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }
  int width() const { return system_.layout().body_velocities(); }

  void doubt(const char* id, const std::string& message, const JointElement& element) {
    if (structure_.doubts.size() >= Structure::most_doubts) return;
    const std::string own = element.name.substr(element.name.rfind('.') + 1);
    structure_.doubts.push_back({id, message, element.location, std::max(character_count(own), 1)});
  }

  std::string body_name(int marker) const {
    return body_of(marker) == ground ? std::string("ground") : model_.bodies[at(body_of(marker))].name;
  }

  // --- what does nothing -----------------------------------------------------------------------------------------

  /// True after a message.
  bool judge_idle(int j) {
    const JointElement& element = model_.joints[at(j)];
    const std::optional<MatrixXd> rate = rates_.of(j);
    for (int i = 0; i < static_cast<int>(model_.joints.size()); ++i) {
      const JointElement& joint = model_.joints[at(i)];
      if (is_force_element(joint) || joint.gear >= 0 || !same_bodies(joint, element)) continue;
      if (rate && leaves_nothing(i, *rate, element)) return say_idle(element, joint), true;
      if (joint.has_play || !acts_along_line(element) || joint.ideal_layout().pin == 0 || rates_.line(joint)) continue;
      const bool first = same_place(joint, element.marker_a), second = same_place(joint, element.marker_b);
      if (first && second ? has_free_length(element) : !first && !second) continue;
      doubt("idle-force",
            first && second
                ? fmt::format("'{}' does nothing: joint '{}' holds its two ends at one place; name the frames between "
                              "which it acts, or write 'kind: rotational' if it turns",
                              element.name, joint.name)
                : fmt::format("'{}' moves nothing: joint '{}' holds its end '{}' in place, so that its length stays "
                              "the same; name the frames between which it acts",
                              element.name, joint.name,
                              model_.markers[at(first ? element.marker_a : element.marker_b)].name),
            element);
      return true;
    }
    return false;
  }

  /// An element along an axis between two bodies that no joint keeps on it, as where their guide is missing. True after
  /// a message.
  bool judge_unguided(int j) {
    const JointElement& element = model_.joints[at(j)];
    if (element.ideal_layout().coordinate != Coordinate::position) return false;
    const auto joins = [&](const JointElement& joint) {
      return !is_force_element(joint) && joint.gear < 0 && same_bodies(joint, element);
    };
    if (std::ranges::any_of(model_.joints, joins)) return false;
    const double* axes = e_.markers[at(element.marker_a)].rotation;
    const Eigen::Vector3d across(axes[1], axes[4], axes[7]);
    const MatrixXd moving = rates_.of_ends(element, across, 0.0, 0.0);
    if (shut_.rows() > 0 && (moving * null_space(shut_)).norm() <= counts_as_motion) return false;
    doubt("left-free",
          fmt::format("'{}' acts along x of '{}', but no joint guides '{}' along it against '{}': is a guide missing",
                      element.name, model_.markers[at(element.marker_a)].name, body_name(element.marker_b),
                      body_name(element.marker_a)),
          element);
    return true;
  }

  bool same_bodies(const JointElement& one, const JointElement& other) const {
    return std::minmax(body_of(one.marker_a), body_of(one.marker_b)) ==
           std::minmax(body_of(other.marker_a), body_of(other.marker_b));
  }

  bool same_place(const JointElement& joint, int marker) const {
    const double* a = e_.markers[at(joint.marker_a)].position;
    const double* b = e_.markers[at(marker)].position;
    return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) < ElementRates::one_place;
  }

  // What is a line between two points, and not what turns as well.
  static bool acts_along_line(const JointElement& element) {
    return element.ideal_layout().coordinate == Coordinate::none && element.parameters->values.contains("free_length");
  }

  // Where it is long it pushes in no direction, which is said elsewhere.
  static bool has_free_length(const JointElement& element) {
    const auto found = element.parameters->values.find("free_length");
    return found != element.parameters->values.end() && found->second.number > 0.0;
  }

  /// A joint whose rows let the element not move where it stands; a line between two points turns, and may move later.
  bool leaves_nothing(int joint, const MatrixXd& rate, const JointElement& element) {
    if (element.ideal_layout().coordinate == Coordinate::none) return false;
    const Slice slice = closed_.layout().rows(joint);
    if (slice.size == 0) return false;
    const BodyId bodies[2] = {body_of(element.marker_a), body_of(element.marker_b)};
    MatrixXd rows = MatrixXd::Zero(slice.size, 2 * width()), own = MatrixXd::Zero(1, 2 * width());
    for (int k = 0; k < 2; ++k) {
      if (bodies[k] == ground) continue;
      rows.middleCols(k * width(), width()) = shut_.block(slice.offset, width() * bodies[k], slice.size, width());
      own.middleCols(k * width(), width()) = rate.middleCols(width() * bodies[k], width());
    }
    // The journal of a loose joint stands off, and what acts at its place turns it a little.
    const double tolerance = model_.joints[at(joint)].has_play ? held_by_play : held;
    return own.norm() > 0.0 && (own * null_space(rows)).norm() <= tolerance * own.norm();
  }

  void say_idle(const JointElement& element, const JointElement& joint) {
    const bool turns = element.ideal_layout().coordinate == Coordinate::angle;
    const std::string kind =
        element.parameters->values.contains("kind")
            ? fmt::format("write 'kind: {}' if that is meant, else ", turns ? "linear" : "rotational")
            : std::string();
    doubt("idle-force",
          fmt::format("'{}' moves nothing: joint '{}' keeps '{}' from {} against '{}'; {}name two bodies that do",
                      element.name, joint.name, body_name(element.marker_b),
                      turns ? std::string("turning")
                            : fmt::format("moving along x of '{}'", model_.markers[at(element.marker_a)].name),
                      body_name(element.marker_a), kind),
          element);
  }

  // --- what stops at once ----------------------------------------------------------------------------------------

  void judge_damping(int j) {
    const JointElement& element = model_.joints[at(j)];
    const double damping = given_damping(element);
    if (!(damping > 0.0) || is_doubted(element)) return;
    const std::optional<MatrixXd> rate = rates_.of(j);
    if (!rate) return;
    const VectorXd mass =
        VectorXd::Map(system_.inertia().mass().data(), static_cast<Eigen::Index>(system_.inertia().mass().size()));
    if (mass.size() != rate->cols() || !(mass.minCoeff() > 0.0)) return;
    const Settings& settings = model_.settings;
    const double span = settings.adaptive ? settings.interval : std::min(settings.step, settings.interval);
    const double shortest = std::min(by_sound, far_below_step * span);
    // Joints and drivers make what moves heavier, never lighter.
    const double alone = (*rate * mass.cwiseInverse().asDiagonal() * rate->transpose())(0, 0);
    if (!(1.0 / alone < shortest * damping)) return;
    const MatrixXd& free = motions();
    const VectorXd along = (*rate * free).transpose();
    if (free.cols() == 0 || !(along.norm() > counts_as_motion * rate->norm())) return;
    const MatrixXd inertia = free.transpose() * mass.asDiagonal() * free;
    const double moved = 1.0 / along.dot(symmetric_solution(inertia, along));
    if (!(moved > 0.0 && moved < shortest * damping)) return;
    const bool turns = element.ideal_layout().coordinate == Coordinate::angle;
    doubt("doubtful-value",
          fmt::format("the damping of '{}' is {:.4g} {}, which stops the {:.3g} {} that it works on in {:.2g} s, "
                      "faster than sound crosses it: check the number and its unit, or hold it by a joint",
                      element.name, damping, turns ? "N*m*s/rad" : "N*s/m", moved, turns ? "kg*m^2" : "kg",
                      moved / damping),
          element);
  }

  // --- stops -----------------------------------------------------------------------------------------------------

  /// A start far beyond an end, where a stop pushes with all of its stiffness.
  void judge_ends(int j) {
    const JointElement& element = model_.joints[at(j)];
    if (element.ideal_layout().coordinate == Coordinate::none) return;
    const double lower = element_number(element, "lower"), upper = element_number(element, "upper"),
                 here = e_.coordinate[at(j)];
    const double beyond = std::fmax(lower - here, here - upper);
    const bool turns = element.ideal_layout().coordinate == Coordinate::angle;
    const double most = std::max(most_beyond * (upper - lower), least_beyond * (turns ? 1.0 : system_.size()));
    if (!(std::isfinite(lower) && std::isfinite(upper) && beyond > most)) return;
    const char* unit = turns ? "rad" : "m";
    doubt("doubtful-value",
          fmt::format("'{}' starts at {:.4g} {}, {:.3g} {} beyond its ends of {:.4g} and {:.4g} {}, where it pushes: "
                      "check its ends and their units, and the start",
                      element.name, here, unit, beyond, unit, lower, upper, unit),
          element);
  }

  /// A driver of a joint between the same bodies that moves it beyond an end by a part of its way.
  void judge_driven_ends(int j) {
    const JointElement& element = model_.joints[at(j)];
    const double lower = element_number(element, "lower"), upper = element_number(element, "upper"),
                 here = e_.coordinate[at(j)];
    const std::optional<MatrixXd> rate = rates_.of(j);
    if (element.ideal_layout().coordinate == Coordinate::none || !(upper > lower) || !rate || is_start_doubted(element))
      return;
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      const JointElement& joint = model_.joints[at(driver.joint)];
      if (!prescribes(driver.kind) || joint.ideal_layout().coordinate != element.ideal_layout().coordinate ||
          !same_bodies(joint, element))
        continue;
      const MatrixXd own = *rates_.of(driver.joint);
      const double by = (*rate * own.transpose())(0, 0) / own.squaredNorm();
      if ((*rate - by * own).norm() > held * rate->norm()) continue;
      const std::vector<double> ways = ways_of(d);
      const auto beyond = [&](double way) { return std::fmax(lower - here - by * way, here + by * way - upper); };
      if (ways.empty()) return;
      const double most = beyond(*std::ranges::max_element(ways, {}, beyond));
      if (!(most > most_pressed * (upper - lower))) continue;
      const bool turns = element.ideal_layout().coordinate == Coordinate::angle;
      doubt("doubtful-value",
            fmt::format("driver '{}' moves joint '{}' {} beyond the ends of '{}', which cannot stop it: check its "
                        "value and the ends",
                        driver.name, joint.name,
                        turns ? fmt::format("{:.3g} deg", 360.0 * in_turns * most) : fmt::format("{:.3g} m", most),
                        element.name),
            element);
      return;
    }
  }

  /// How far a driver has moved its joint since the start, all through the run; empty where it cannot be evaluated.
  std::vector<double> ways_of(int driver) const {
    std::vector<TimeValue> values(model_.drivers.size());
    std::vector<double> ways;
    const double from = model_.settings.start, span = model_.settings.end - from;
    for (int i = 0; i <= looks_of_run; ++i) {
      MotionFault fault;
      if (!system_.motions().evaluate(from + span * i / looks_of_run, {values.data(), values.size()}, fault)) return {};
      ways.push_back(values[at(driver)].value);
    }
    const double start = ways.front();
    for (double& way : ways) way -= start;
    return ways;
  }
  bool is_start_doubted(const JointElement& element) const {
    return std::ranges::any_of(structure_.doubts, [&](const StructureDoubt& doubt) {
      return doubt.message.starts_with(fmt::format("'{}' starts at ", element.name));
    });
  }

  /// A torsion spring wound by a whole turn: from an angle of -10 deg it is one to the direction of 350 deg.
  void judge_turn(int j) {
    const JointElement& element = model_.joints[at(j)];
    const double free = element_number(element, "free_angle"), here = e_.coordinate[at(j)],
                 stiffness = element_number(element, "stiffness");
    const double turns = std::round((here - free) * in_turns), same = free + turns / in_turns;
    const bool by_one = std::abs(turns) == 1.0 && std::abs(here - same) * in_turns < most_unwound;
    const auto spring = element.parameters->values.find("spring");
    const bool acts = stiffness != 0.0 || (spring != element.parameters->values.end() && spring->second.given);
    if (element.ideal_layout().coordinate != Coordinate::angle || !by_one || !acts) return;
    const auto degrees = [](double angle) { return fmt::format("{:.4g} deg", 360.0 * in_turns * angle); };
    doubt(
        "doubtful-angle",
        fmt::format("'{}' starts wound by {}, from its free angle of {} to {}, where it starts: write 'free_angle: {}' "
                    "if no turn is meant; if one is, write its torque besides{}",
                    element.name, degrees(here - free), degrees(free), degrees(here), degrees(same),
                    stiffness > 0.0 ? fmt::format(", 'preload: {:.4g} N*m'", stiffness * (same - free)) : ""),
        element);
  }

  /// Strands round two wheels.
  struct Strands {
    double first = 0.0, second = 0.0;  ///< radii [m]
    double sense = 1.0;                ///< -1: crossed
    double length = 0.0;               ///< between the centres [m]
    Eigen::Vector3d back;              ///< a speed of the second centre by which the line of both turns back [1/m]
  };
  std::optional<Strands> strands_of(const JointElement& element) const {
    const double first = element_number(element, "first_radius"), second = element_number(element, "second_radius");
    const auto strands = element.parameters->values.find("strands");
    const Eigen::Vector3d line = rates_.apart(element);
    if (!(first > 0.0 && second > 0.0) || strands == element.parameters->values.end() ||
        line.norm() < ElementRates::one_place)
      return std::nullopt;
    return Strands{first, second, strands->second.word == 0 ? 1.0 : -1.0, line.norm(),
                   Eigen::Vector3d(line[1], -line[0], 0.0) / line.squaredNorm()};
  }

  /// Strands that want another ratio of their wheels than the joints leave them, as where gears turn one the other way.
  /// True after a message.
  bool judge_strands(int j) {
    const JointElement& element = model_.joints[at(j)];
    const std::optional<Strands> strands = strands_of(element);
    if (!strands) return false;
    const double first = strands->first, second = strands->second, sense = strands->sense;
    // How far both turn against the line of their centres.
    const MatrixXd free = null_space(constraints().topRows(system_.layout().first_driver_row()));
    const MatrixXd a = rates_.of_ends(element, strands->back, 1.0, 0.0) * free,
                   b = rates_.of_ends(element, strands->back, 0.0, 1.0) * free;
    if (free.cols() == 0 || a.norm() < counts_as_motion || b.norm() < counts_as_motion) return false;
    const double ratio = a.row(0).dot(b.row(0)) / a.squaredNorm(), own = sense * first / second;
    if ((b - ratio * a).norm() > counts_as_motion * b.norm() || std::abs(ratio - own) < same_ratio * std::abs(own))
      return false;
    doubt(
        "doubtful-value",
        fmt::format("'{}' turns '{}' by {:.4g} of '{}', but the joints turn it by {:.4g}, which stretches its strands "
                    "by {:.3g} m in each turn: check 'strands' and the radii, or the ratio of the gear",
                    element.name, body_name(element.marker_b), own, body_name(element.marker_a), ratio,
                    std::abs(first - sense * ratio * second) / in_turns),
        element);
    return true;
  }

  /// By how much each radian or metre of each driver winds more strand on the one wheel than off the other, centres at
  /// rest; nothing where drivers do not prescribe it. Rows of angles alone, which hold as they are all through a run.
  std::optional<std::vector<double>> winding_by_driver(const JointElement& element, const Strands& strands) {
    const MatrixXd free = null_space(constraints().topRows(system_.layout().first_driver_row()));
    const MatrixXd line = rates_.of_ends(element, strands.back, 0.0, 0.0);
    if (free.cols() == 0 || (line * free).norm() > counts_as_motion * line.norm()) return std::nullopt;
    const MatrixXd wound =
        rates_.of_ends(element, Eigen::Vector3d::Zero(), strands.first, -strands.sense * strands.second);
    MatrixXd rows = MatrixXd::Zero(constraints().rows(), constraints().cols());
    for (Eigen::Index r = 0; r < rows.rows(); ++r) {
      bool turns_alone = true;
      for (Eigen::Index c = 0; c < rows.cols(); ++c)
        turns_alone = turns_alone && (constraints_(r, c) == 0.0 || system_.coordinates().is_turn(static_cast<int>(c)));
      if (turns_alone) rows.row(r) = constraints_.row(r);
    }
    const VectorXd parts = least_norm_solution(rows.transpose(), VectorXd(wound.transpose()), rank_threshold);
    if (!((rows.transpose() * parts - wound.transpose()).norm() <= counts_as_motion * wound.norm()))
      return std::nullopt;
    std::vector<double> by_driver(model_.drivers.size(), 0.0);
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (!prescribes(driver.kind)) continue;
      const double part = parts[system_.layout().driver_row(d)];
      if (std::abs(part) < counts_as_motion * parts.norm()) continue;
      if (driver.kinematics >= 0) return std::nullopt;
      by_driver[at(d)] = part;
    }
    return by_driver;
  }

  /// Drivers that turn both wheels of strands, and not by the ratio of these.
  void judge_driven_strands(int j) {
    const JointElement& element = model_.joints[at(j)];
    const std::optional<Strands> strands = strands_of(element);
    const auto by_driver = strands ? winding_by_driver(element, *strands) : std::nullopt;
    if (!by_driver) return;
    std::vector<TimeValue> start(model_.drivers.size()), now(start);
    const double from = model_.settings.start, span = model_.settings.end - from;
    double most = 0.0;
    for (int i = 0; i <= looks_of_run; ++i) {
      MotionFault fault;
      std::vector<TimeValue>& values = i == 0 ? start : now;
      if (!system_.motions().evaluate(from + span * i / looks_of_run, {values.data(), values.size()}, fault)) return;
      double wound = 0.0;
      for (std::size_t d = 0; d < values.size() && i > 0; ++d)
        wound += (*by_driver)[d] == 0.0 ? 0.0 : (*by_driver)[d] * (now[d].value - start[d].value);
      most = std::max(most, std::abs(wound));
    }
    if (!(most > most_strain * strands->length)) return;
    std::string names;
    for (std::size_t d = 0; d < by_driver->size(); ++d) {
      if ((*by_driver)[d] != 0.0) names += fmt::format("{}'{}'", names.empty() ? "" : " and ", model_.drivers[d].name);
    }
    doubt(
        "doubtful-value",
        fmt::format("'{}' turns '{}' by {:.4g} of '{}', but {} turn them otherwise, which stretches its strands by up "
                    "to {:.3g} m of {:.3g} m between their wheels: check 'strands' and the radii, or signs and values "
                    "of the drivers",
                    element.name, body_name(element.marker_b), strands->sense * strands->first / strands->second,
                    body_name(element.marker_a), names, most, strands->length),
        element);
  }

  bool is_doubted(const JointElement& element) const {
    return std::ranges::any_of(structure_.doubts, [&](const StructureDoubt& doubt) {
      return doubt.message.starts_with(fmt::format("the damping of '{}' ", element.name));
    });
  }

  const MatrixXd& constraints() {
    if (constraints_.size() == 0) constraints_ = constraint_matrix(system_.jacobian(), e_);
    return constraints_;
  }
  const MatrixXd& motions() {
    if (!motions_) {
      const MatrixXd all = MatrixXd::Identity(system_.layout().nv(), system_.layout().nv());
      motions_ = system_.layout().nc() > 0 ? null_space(constraints()) : all;
    }
    return *motions_;
  }

  const System& system_;
  const Model& model_;
  const Evaluation& e_;
  const System& closed_;
  const MatrixXd shut_;  // its constraints
  ElementRates rates_;
  Structure& structure_;
  MatrixXd constraints_;             // once wanted
  std::optional<MatrixXd> motions_;  // that they leave free
};

}  // namespace

void doubt_elements(const System& system, const Evaluation& at_start, const System& closed, const Evaluation& shut,
                    Structure& structure) {
  if (system.layout().nv() > Structure::most_examined) return;
  Elements(system, at_start, closed, shut, structure).judge();
}

}  // namespace freeplay
