// InputActivity: when the inputs of a model change, found before a step goes there. Inputs are the motions, forces,
// torques and efforts that the model file gives as functions of time, and what joints of plugins make of the time.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/formula_course.h"
#include "run/idle_loads.h"
#include "run/jump_error.h"
#include "run/light_loads.h"
#include "run/step_resolution.h"
#include "run/unseen_change.h"
#include "system/system.h"

namespace freeplay {

/// What may jump at a corner of an input: nothing (ends of smooth ramps), accelerations (a load jumps or has a kink),
/// or speeds as well (a motion has one).
enum class CornerKind { smooth, load, motion };

class InputActivity {
 public:
  /// `shortest`: duration of the changes that no step may go over where a
  /// formula cannot be analysed and a joint does not say how fine its dependence on time is [s]. `allowed`: by which
  /// positions may err in a step [m]; what moves them by much less does not matter. `idle`: knows which loads move
  /// nothing; none does where it is null.
  [[gnu::cold]] InputActivity(const System& system, double shortest, double allowed, IdleLoads* idle = nullptr);

  /// Where formulas have changes that last less, and no rule says how fast they may change, they are looked at as
  /// closely as these need, down to a duration of `least` [s]. Returns what even that does not show.
  struct Unresolved;
  std::vector<Unresolved> look_closer(double least);

  /// The first corner after t, if it is `until` or earlier; else a later time, or infinity. False, with `fault`, when a
  /// joint fails. Times grow from step to step.
  bool next_corner(double t, double until, double& corner, Fault& fault);
  /// The kind of the corners that lie within `margin` of a time.
  CornerKind kind_of(double corner, double margin) const;

  /// The length, dt or less, of a step from t that no corner lies in and that resolves all formulas and tables: their
  /// values at the samples are, to a hundredth of their range, what a polynomial through five of them makes of them; to
  /// a fifty-thousandth where a load moves nothing, as then no error of a step shows what it does to forces.
  double resolved(double t, double dt);
  /// The same for joints that may depend on time, as `here` has their markers, internal variables and history: the
  /// start of the step, or its end once it is made.
  bool resolved_by_joints(const Point& here, const Evaluation& e, double t, double& dt, Fault& fault);
  bool watches_joints() const { return !joints_.empty(); }

  /// Whether at t an input changes for a short time: between two corners of a formula or straight table, or declared by
  /// a joint, or where a step had to be shortened. Short is a tenth of the run, of a prescribed motion a hundredth.
  bool acts_quickly(double t);

  /// How many times more than it shows a step from t of the length dt may err beside a corner of a load towards which
  /// its second derivative has no bound: a pair of methods that look at the same instants shares most of that error.
  double hidden_error(double t, double dt) const;
  /// Whether there is such a corner before or after t.
  bool hides_errors(double t) const { return hidden_error(t, std::numeric_limits<double>::infinity()) > 1.0; }

  /// An input that steps of one size go over, by the name of what has it.
  struct Unresolved {
    const char* section;  ///< "driver", "force" or "joint"
    const std::string* name;
    double from, to;  ///< its closest two corners, or where it changes in between [s]
    bool corners;
    JumpError jumps{};  ///< else, with `jumps`, what they make of it
  };
  /// To be asked before any step is: those with corners closer than `step`, those that do something between the
  /// ends of steps that these do not show, and loads that jump inside of steps so that these are off by a tenth. Joints
  /// are looked at as `here` has their markers, variables and history.
  static constexpr double off_by_jumps = 0.1;
  [[gnu::cold]] std::vector<Unresolved> unresolved_by(double step, const Point& here, const Evaluation& e);

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.formulas_, self.tables_, self.telling_, self.joints_, self.told_from_, self.told_until_, self.told_);
    archive(self.seen_from_, self.seen_to_);
  }

 private:
  struct Stretch {
    double from = -unbounded, to = -unbounded;
    double length() const { return to - from; }
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.from, self.to);
    }
  };
  enum class Unit { force, torque, length, angle, other };
  struct Formula {
    const char* section;
    const std::string* name;
    const Expression* expression;
    FormulaCourse course;
    CornerKind sharp;  ///< kind of its kinks
    Unit unit;
    double shortest;          ///< duration of its changes that no step may go over [s]
    int bends = 0;            ///< the derivative that moves bodies whose motion is known: no error of a step shows it
    int load = -1;            ///< its number in IdleLoads
    double most = unbounded;  ///< longest step to look at: some times the last that had to be shortened
    double quick_until = -unbounded;  ///< there the change lies that had it shortened
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.course, self.most, self.quick_until);
    }
  };
  struct Table {
    const std::string* name;
    const TimeTable* table;
    CornerKind sharp;
    Unit unit;
    int bends = 0;
    int load = -1;
    double most = unbounded;
    double quick_until = -unbounded;
    Stretch between{};  ///< two points
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.most, self.quick_until, self.between);
    }
  };
  struct TellingJoint {
    int joint;
    Stretch between{};  ///< two corners
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.between);
    }
  };
  struct TimedJoint {
    int joint;
    double shortest;
    std::size_t signals;
    int load = -1;
    double most = unbounded;
    double quick_until = -unbounded;
    bool varies = false;  ///< it has been seen to: then the shortest steps are looked at, too
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.most, self.quick_until, self.varies);
    }
  };

  static constexpr double samples_per_change = 3.0;  ///< in the duration of the shortest change

  [[gnu::cold]] void add(const char* section, const std::string& name, const Expression& expression, CornerKind sharp,
                         Unit unit, int bends = 0, const std::optional<ActsOn>& on = std::nullopt);
  /// Its number in IdleLoads.
  int load_on(const std::optional<ActsOn>& on) const;
  bool is_idle(int load) const { return idle_ != nullptr && idle_->is_idle(load); }
  int bends(int driver) const;
  static Unit unit_of(DriverKind kind);
  double negligible(Unit unit, double dt) const;
  auto light(Unit unit, int bends) const;
  [[gnu::cold]] void add_joint(int joint);
  bool ask(int joint, double t, double& corner, Fault& fault) const;
  double quick(CornerKind sharp) const;
  template <class Input>
  void note_change(Input& input, double t, double dt, CornerKind sharp) const;
  double resolved_formula(Formula& formula, double t, double dt);
  double resolved_table(Table& table, double t, double dt);
  bool signals_of(const TimedJoint& timed, JointInput in, double t, double* out, Fault& fault);
  /// Of the forces of a joint, between the ends of steps.
  std::optional<UnseenChange::Found> unseen_force(const TimedJoint& timed, double step, const Point& here,
                                                  const Evaluation& e);

  const System& system_;
  double start_, end_, shortest_;
  LightLoads light_;
  IdleLoads* idle_;
  double short_length_, small_angle_;  ///< that do not matter [m, rad]
  std::vector<Formula> formulas_;
  std::vector<Table> tables_;
  std::vector<TellingJoint> telling_;  ///< joints that may declare corners
  std::vector<TimedJoint> joints_;
  StepResolution resolution_;
  std::vector<double> rate_, phi_, jacobian_, nu_, gamma_;  // of a joint that is asked
  double told_from_ = 0.0, told_until_ = 0.0,
         told_ = 0.0;                       // the last answer of next_corner(): none is before the second
  double seen_from_ = 0.0, seen_to_ = 0.0;  // a span that was resolved
};

}  // namespace freeplay
