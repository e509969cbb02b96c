#include "assembly/force_doubts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "assembly/element_number.h"
#include "assembly/given_damping.h"
#include "base/index.h"
#include "model/force_element.h"
#include "model/whole_mass.h"

namespace freeplay {
namespace {

constexpr double odd_free_length = 100.0;  // between the free length of a spring and its length
constexpr double no_length = 1e-9;         // of a spring [m]
constexpr double strong_pull = 10.0;       // of a spring without a free length, by the weight of all bodies
constexpr double most_pulled = 5.0;        // of a spring that pulls so, by its free length
constexpr double earth = 9.81;             // [m/s^2]
constexpr double most_damping = 1000.0;    // by that of the limit of swinging
constexpr double most_stretch = 10.0;      // of a spring by a weight, by the model's size
constexpr double most_press = 1.0;         // the same of one that is pressed together, by its length
constexpr double slow_swing = 30.0;        // period of a body on springs, in runs
constexpr double hardly_moved = 0.01;      // way that springs push it in the run, by the model's size

class ForceDoubts {
 public:
  using Doubt = std::function<void(const char*, const std::string&, const JointElement&)>;
  ForceDoubts(const System& system, const Evaluation& at_start, const Doubt& doubt)
      : system_(system),
        model_(system.model()),
        at_start_(at_start),
        doubt_(doubt),
        joints_of_(model_.bodies.size()),
        driven_(model_.joints.size(), 0) {
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) list_at_bodies(j);
    for (const Driver& driver : model_.drivers) driven_[at(driver.joint)] = 1;
  }

  void run() const {
    for (const JointElement& joint : model_.joints) {
      if (!is_force_element(joint) || !joint.parameters || joint.has_play) continue;
      if (does_nothing(joint)) {
        doubt_("unused",
               fmt::format("'{}' does nothing: none of its numbers that make a force is given; delete it, "
                           "or give them",
                           joint.name),
               joint);
      } else {
        judge_length(joint);
        judge_pretension(joint);
        judge_damping(joint);
      }
    }
    judge_pairs();
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) judge_softness(b);
  }

 private:
  /// A gear with the bodies of the joints that it couples.
  void list_at_bodies(int j) {
    const JointElement& joint = model_.joints[at(j)];
    std::set<BodyId> bodies;
    if (joint.gear < 0) {
      bodies = {body_of(joint.marker_a), body_of(joint.marker_b)};
    } else {
      for (const int coupled : {model_.gears[at(joint.gear)].first, model_.gears[at(joint.gear)].second}) {
        bodies.insert(body_of(model_.joints[at(coupled)].marker_a));
        bodies.insert(body_of(model_.joints[at(coupled)].marker_b));
      }
    }
    for (const BodyId body : bodies) {
      if (body != ground) joints_of_[at(body)].push_back(j);
    }
  }

  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }
  BodyId other_body(const JointElement& joint, BodyId body) const {
    return body_of(joint.marker_a) == body ? body_of(joint.marker_b) : body_of(joint.marker_a);
  }

  std::array<double, 3> apart(const JointElement& joint) const {
    const double* a = at_start_.markers[at(joint.marker_a)].position;
    const double* b = at_start_.markers[at(joint.marker_b)].position;
    return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  }

  /// All parameters that are neither lengths, angles nor choices have a force in their unit, and all of these are 0.
  static bool does_nothing(const JointElement& joint) {
    bool any = false;
    for (const Parameter& parameter : joint.parameters->component->description.parameters) {
      if (parameter.kind == ParameterKind::choice) continue;
      const auto value = joint.parameters->values.find(std::string_view(parameter.name));
      if (parameter.kind == ParameterKind::formula && !value->second.given) continue;
      if (parameter.kind != ParameterKind::number || value == joint.parameters->values.end()) return false;
      const std::string_view unit = parameter.unit;
      if (unit == "m" || unit == "rad") continue;
      if (unit.find('N') == unit.npos || value->second.number != 0.0) return false;
      any = true;
    }
    return any;
  }

  /// Where none is given it is zero.
  void judge_pull(const JointElement& joint, double length) const {
    const auto free = joint.parameters->values.find(std::string_view("free_length"));
    const double stiffness = element_number(joint, "stiffness"), preload = element_number(joint, "preload");
    const bool turns = joint.ideal_layout().coordinate == Coordinate::angle;
    if (turns || free == joint.parameters->values.end() || free->second.given || !(preload == 0.0)) return;
    const double mass = whole_mass(model_).mass;
    if (!(stiffness * length > strong_pull * earth * mass)) return;
    doubt_("doubtful-length",
           fmt::format(
               "'{}' has no 'free_length', so that it pulls its ends together with {:.3g} N from the start, {:.2g} "
               "times the weight of all bodies: give the length at which it is slack (its ends are {:.4g} m "
               "apart)",
               joint.name, stiffness * length, stiffness * length / (earth * mass), length),
           joint);
  }

  void judge_length(const JointElement& joint) const {
    const double free = element_number(joint, "free_length");
    const auto [x, y, z] = apart(joint);
    const double length = std::hypot(x, y, z);
    if (free == 0.0) judge_pull(joint, length);
    if (!(free > 0.0)) return;
    if (length < no_length) {
      doubt_("doubtful-length",
             fmt::format("the ends of '{}' are at one place at the start, where it has no direction: with its free "
                         "length of {:.4g} m it pushes nowhere until they part; check its frames",
                         joint.name, free),
             joint);
    } else if (free > odd_free_length * length || length > odd_free_length * free) {
      doubt_("doubtful-length",
             fmt::format("the free length of '{}' is {:.4g} m, but its ends are {:.4g} m apart at the start: check the "
                         "number and its unit",
                         joint.name, free, length),
             joint);
    } else {
      judge_stretch(joint, length, free);
    }
  }

  /// Pulled out from the start, as between frames that are not meant.
  void judge_stretch(const JointElement& joint, double length, double free) const {
    const double stiffness = element_number(joint, "stiffness"), mass = whole_mass(model_).mass;
    const double pull = stiffness * (length - free);
    if (!(length > most_pulled * free && pull > strong_pull * earth * mass)) return;
    doubt_("doubtful-length",
           fmt::format("'{}' starts pulled to {:.3g} times its free length of {:.4g} m, where it pulls with {:.3g} N, "
                       "{:.2g} times the weight of all bodies: check its frames, its free length and its stiffness",
                       joint.name, length / free, free, pull, pull / (earth * mass)),
           joint);
  }

  /// What is longer by its own length before anything pulls.
  void judge_pretension(const JointElement& joint) const {
    const double pretension = element_number(joint, "pretension"), stiffness = element_number(joint, "stiffness");
    const auto [x, y, z] = apart(joint);
    const double length = std::hypot(x, y, z);
    if (!(stiffness > 0.0) || !(pretension > stiffness * std::max(length, system_.size()))) return;
    doubt_(
        "doubtful-value",
        fmt::format("the pretension of '{}' is {:.4g} N, which stretches its {:.4g} N/m by {:.4g} m, though its ends "
                    "are {:.4g} m apart: check both numbers and their units",
                    joint.name, pretension, stiffness, pretension / stiffness, length),
        joint);
  }

  /// What a body sets against an element that acts on it: its mass [kg], or its largest moment about its end [kg m^2].
  double inertia_at(int marker, bool turns) const {
    if (body_of(marker) == ground) return 0.0;
    const Body& body = model_.bodies[at(body_of(marker))];
    const Vector3 &place = model_.markers[at(marker)].position, &com = body.com;
    const double arm = std::hypot(place[0] - com[0], place[1] - com[1], place[2] - com[2]);
    return turns ? std::max({body.inertia[0], body.inertia[4], body.inertia[8]}) + body.mass * arm * arm : body.mass;
  }

  /// Against that which just keeps the heavier of both bodies from swinging on the spring.
  void judge_damping(const JointElement& joint) const {
    const double damping = given_damping(joint), stiffness = element_number(joint, "stiffness");
    const bool turns = joint.ideal_layout().coordinate == Coordinate::angle;
    const double moved = std::max(inertia_at(joint.marker_a, turns), inertia_at(joint.marker_b, turns));
    if (!(stiffness > 0.0) || !(damping > most_damping * 2.0 * std::sqrt(stiffness * moved))) return;
    doubt_(
        "doubtful-value",
        fmt::format("the damping of '{}' is {:.4g} {}, {:.2g} times what keeps {:.4g} {} on its {:.4g} {} from "
                    "swinging: it takes {:.2g} s to follow its spring; check both numbers and their units",
                    joint.name, damping, turns ? "N*m*s/rad" : "N*s/m", damping / (2.0 * std::sqrt(stiffness * moved)),
                    moved, turns ? "kg*m^2" : "kg", stiffness, turns ? "N*m/rad" : "N/m", damping / stiffness),
        joint);
  }

  // --- twice -----------------------------------------------------------------------------------------------------

  bool same_numbers(const ParameterBlock& one, const ParameterBlock& other) const {
    if (one.component != other.component) return false;
    return std::ranges::equal(one.values, other.values, [this](const auto& a, const auto& b) {
      const ParameterValue &x = a.second, &y = b.second;
      const bool same = x.number == y.number || (std::isnan(x.number) && std::isnan(y.number));
      if (a.first != b.first || !same || x.word != y.word || x.vector != y.vector) return false;
      if ((x.law != nullptr) != (y.law != nullptr) || (x.points != nullptr) != (y.points != nullptr)) return false;
      if (x.points && (x.points->x != y.points->x || x.points->y != y.points->y)) return false;
      return same_function(x.function, y.function) && (!x.law || same_numbers(*x.law, *y.law));
    });
  }
  /// At instants of the run.
  bool same_function(const TimeFunction& one, const TimeFunction& other) const {
    constexpr int looks = 32;
    if (one.evaluate == nullptr || other.evaluate == nullptr) return one.evaluate == other.evaluate;
    const double from = model_.settings.start, span = model_.settings.end - from;
    for (int i = 0; i <= looks; ++i) {
      TimeValue a{}, b{};
      Message message;
      const double t = from + span * i / looks;
      if (one.evaluate(one.self, t, &a, &message) != Status::ok) return false;
      if (other.evaluate(other.self, t, &b, &message) != Status::ok || a.value != b.value) return false;
    }
    return true;
  }
  /// Formulas of other variables than time are not compared.
  static bool is_plain(const ParameterBlock& block) {
    return std::ranges::none_of(block.values, [](const auto& entry) {
      const ParameterValue& value = entry.second;
      return value.by_motion || value.formula || (value.law != nullptr && !is_plain(*value.law));
    });
  }
  static double sum_of_numbers(const ParameterBlock& block) {
    double sum = 0.0;
    for (const auto& [name, value] : block.values) {
      if (std::isfinite(value.number)) sum += value.number;
    }
    return sum;
  }

  void judge_pairs() const {
    std::map<std::tuple<const Component*, int, int, double>, std::vector<const JointElement*>> alike;
    for (const JointElement& joint : model_.joints) {
      if (!is_force_element(joint) || !joint.parameters || !is_plain(*joint.parameters)) continue;
      const auto [low, high] = std::minmax(joint.marker_a, joint.marker_b);
      std::vector<const JointElement*>& others =
          alike[{joint.parameters->component, low, high, sum_of_numbers(*joint.parameters)}];
      const auto same = std::ranges::find_if(
          others, [&](const JointElement* other) { return same_numbers(*other->parameters, *joint.parameters); });
      if (same == others.end()) {
        others.push_back(&joint);
        continue;
      }
      doubt_(
          "duplicate-force",
          fmt::format("'{}' has the same frames and numbers as '{}', so that both act as one twice as strong: delete "
                      "one of them, or write its numbers into the other",
                      joint.name, (*same)->name),
          joint);
    }
  }

  // --- too soft --------------------------------------------------------------------------------------------------

  /// Springs that alone hold a body, and what pulls along them.
  struct Hold {
    const JointElement* first = nullptr;
    double stiffness = 0.0, push = 0.0;  ///< of all [N/m], largest sum of their forces at the start [N]
    double longest = 0.0, along = 0.0;   ///< [m], of the gravity that they hold [m/s^2]
    double mass = 0.0;                   ///< of the body and of those that it alone holds [kg]
    bool pressed = true;                 ///< each by the weight, towards its other end
  };

  /// A body that springs alone hold against its weight, on a slide or free.
  void judge_softness(BodyId body) const {
    const std::optional<Hold> hold = hold_of(body);
    if (!hold || hold->first == nullptr) return;
    const Body& held = model_.bodies[at(body)];
    const double stretch = hold->along * hold->mass / hold->stiffness;
    const double most = hold->pressed ? most_press * std::max(hold->longest, system_.size())
                                      : most_stretch * std::max(hold->longest, system_.size());
    if (stretch > most) {
      doubt_("doubtful-value",
             fmt::format("'{}' is so soft that the weight of '{}' would {} it by {:.3g} m{} in a mechanism of {:.2g} "
                         "m: check its stiffness and its unit",
                         hold->first->name, held.name, hold->pressed ? "press" : "stretch", stretch,
                         hold->pressed ? fmt::format(", more than its {:.3g} m,", hold->longest) : std::string(),
                         system_.size()),
             *hold->first);
      return;
    }
    const double span = model_.settings.end - model_.settings.start;
    const double period = 2.0 * std::numbers::pi * std::sqrt(hold->mass / hold->stiffness);
    const double way = 0.5 * hold->push / hold->mass * span * span;
    if (!(period > slow_swing * span) || hold->along > 0.0 || way > hardly_moved * system_.size()) return;
    doubt_("doubtful-value",
           fmt::format("'{}' hardly acts: {:.4g} kg of '{}' swing on {:.3g} N/m with a period of {:.3g} s, {:.0f} "
                       "times the run of {:.3g} s: check its stiffness and its unit, or the end of the run",
                       hold->first->name, hold->mass, held.name, hold->stiffness, period, period / span, span),
           *hold->first);
  }

  /// Nothing where other elements hold the body, too.
  std::optional<Hold> hold_of(BodyId body) const {
    const Vector3& gravity = model_.bodies[at(body)].gravity;
    Hold hold{.along = std::hypot(gravity[0], gravity[1], gravity[2]), .mass = model_.bodies[at(body)].mass};
    for (const int j : joints_of_[at(body)]) {
      const JointElement& joint = model_.joints[at(j)];
      if (joint.gear >= 0) return std::nullopt;
      if (is_force_element(joint) && joint.parameters && has_formula(*joint.parameters)) return std::nullopt;
      const double k = is_force_element(joint) && joint.parameters ? stiffness_along(joint, gravity) : std::nan("");
      if (is_force_element(joint) && k > 0.0 && joint.ideal_layout().coordinate != Coordinate::angle) {
        add_spring(hold, joint, k, body);
      } else if (is_force_element(joint) && (k == 0.0 || element_number(joint, "friction") >= 0.0)) {
        continue;  // holds nothing
      } else if (const BodyId other = other_body(joint, body); other != ground && joints_of_[at(other)].size() == 1) {
        hold.mass += model_.bodies[at(other)].mass;
      } else if (joint.ideal_layout().coordinate == Coordinate::position && on_ground(joint) && driven_[at(j)] == 0) {
        const double* axes = at_start_.markers[at(joint.marker_a)].rotation;
        hold.along = std::abs(axes[0] * gravity[0] + axes[3] * gravity[1] + axes[6] * gravity[2]);
      } else {
        return std::nullopt;
      }
    }
    return hold;
  }

  /// Of a spring along its line; of an elastic bed along gravity, or its least where there is none [N/m].
  double stiffness_along(const JointElement& joint, const Vector3& gravity) const {
    if (const double k = element_number(joint, "stiffness"); !std::isnan(k)) return k;
    const double of_axes[] = {element_number(joint, "stiffness.x"), element_number(joint, "stiffness.y"),
                              element_number(joint, "stiffness.z")};
    const double* axes = at_start_.markers[at(joint.marker_a)].rotation;
    const double amount = std::hypot(gravity[0], gravity[1], gravity[2]);
    double along = 0.0, least = std::nan("");
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::isnan(of_axes[i])) continue;
      least = std::fmin(least, of_axes[i]);
      const double share = (axes[i] * gravity[0] + axes[3 + i] * gravity[1] + axes[6 + i] * gravity[2]) / amount;
      along += share * share * of_axes[i];
    }
    return amount > 0.0 && !std::isnan(least) ? along : least;
  }

  void add_spring(Hold& hold, const JointElement& joint, double k, BodyId body) const {
    const auto [x, y, z] = apart(joint);
    const double length = std::hypot(x, y, z), free = element_number(joint, "free_length"),
                 preload = element_number(joint, "preload");
    const Vector3& gravity = model_.bodies[at(body)].gravity;
    // From the body towards the other end.
    const double towards =
        (body_of(joint.marker_a) == body ? 1.0 : -1.0) * (x * gravity[0] + y * gravity[1] + z * gravity[2]);
    hold.stiffness += k;
    hold.push += std::abs((std::isnan(free) ? 0.0 : k * (length - free)) + (std::isnan(preload) ? 0.0 : preload));
    hold.longest = std::max({hold.longest, length, free});
    const bool bed = std::isnan(element_number(joint, "stiffness"));
    hold.pressed = hold.pressed && (bed || towards > 0.0);
    if (hold.first == nullptr) hold.first = &joint;
  }

  static bool has_formula(const ParameterBlock& block) {
    return std::ranges::any_of(block.values, [](const auto& entry) { return static_cast<bool>(entry.second.formula); });
  }

  bool on_ground(const JointElement& joint) const {
    return body_of(joint.marker_a) == ground || body_of(joint.marker_b) == ground;
  }

  const System& system_;
  const Model& model_;
  const Evaluation& at_start_;
  const Doubt& doubt_;
  std::vector<std::vector<int>> joints_of_;  ///< by body, in their order
  std::vector<char> driven_;                 ///< by joint
};

}  // namespace

void doubt_forces(const System& system, const Evaluation& at_start,
                  const std::function<void(const char*, const std::string&, const JointElement&)>& doubt) {
  ForceDoubts(system, at_start, doubt).run();
}

}  // namespace freeplay
