// StepEvents: finds the zero crossings of joints inside a step and passes them on to the joints.
#pragma once

#include <vector>

#include "run/dense_step.h"
#include "run/load_switches.h"
#include "run/sink.h"
#include "system/system.h"

namespace freeplay {

/// Rounding of a located event function, in its unit.
inline constexpr double event_rounding = 1e-15;

/// Fixed-step runs shorten nothing for events: after a step is accepted every crossing is found on the cubic of
/// (g, g') and the joint's on_event() is called with the state interpolated there (cubic in q, cubic in v).
/// Runs that locate events ask first_crossing() and end their step there; apply_at_end() then handles them at exact
/// states.
class StepEvents {
 public:
  /// Gives the mobility of a joint at the end of a located step, JointInput::mobility, and after it whole_mobility if
  /// the joint wants it; false when it fails.
  using Mobility = bool (*)(void* self, int joint, double* mobility);
  static constexpr std::size_t mobility_numbers = 9 + 36;

  /// `located`: events that are located are handled by apply_at_end() and left alone by apply(). `between` and
  /// `e_between` are lent for each call: what they hold does not matter, and is lost.
  [[gnu::cold]] StepEvents(const System& system, const EvaluationContext& context, bool located, State& between,
                           KeptEvaluation& e_between);

  /// What positions may err by in a step [m], with error control.
  void allow(double error) { switches_.allow(error); }

  /// A crossing that a step passes or ends at. A joint's number beyond those of the model stands for the switches of
  /// applied forces.
  struct Passage {
    int joint = -1, event = 0;
    double fraction = 1.0;  ///< of the step
    double value = 0.0;     ///< of the function at the end, growing through zero [its unit]
    double rate = 0.0;      ///< its time derivative
    double unit = 1.0;      ///< change of the function where it is zero, by what its value means
  };
  /// Looks at the events in an accepted state, from which the next steps start.
  bool look_from(const State& start, const Evaluation& e_start, Fault& fault);
  /// The first located event that is to be expected within `dt` from the start, as the functions went in the step
  /// before; joint -1 without one. A step up to there errs less than one across it, after which other forces act.
  Passage expected_within(double dt) const;
  /// The earliest crossing of a located event within the step from there; joint -1 without one. Looks at both ends and,
  /// where one could be reached, at the middle, and between them at the cubics of (g, g'), then, if `sharp`, along the
  /// interpolated motion. Events that were passed on when the step begins count as passed.
  bool first_crossing(const State& before, const Evaluation& e_before, const State& after, const Evaluation& e_after,
                      bool sharp, Passage& found, Fault& fault);
  /// Value and rate of one event at the end of a step, growing through zero.
  bool at_end(const State& after, const Evaluation& e_after, Passage& passage, Fault& fault);
  /// After apply(): passes on `hunted` and every other located event that grows at the end of the step, within
  /// `tolerance` of its zero or past it by no more than `late`, by which the step may have gone past `hunted`. Nothing
  /// when hunted.joint is -1.
  bool apply_at_end(const Passage& hunted, double late, State& after, const Evaluation& e_after, Mobility mobility,
                    void* self, Fault& fault);
  /// By joint: where JointInput::dissipated of on_event() and commit() points [J]; whoever books it clears it.
  std::span<double> lost() { return lost_; }
  static constexpr double tolerance = 1e-12;  ///< of a located event function, in its unit
  static constexpr int most_per_step = 8;     ///< of one joint inside a step; more are rounding, not motion

  /// Advances z and h of `after` over the events between `before` and `after`; `e_before` and `e_after` are evaluated
  /// there (markers and coordinates of all joints). False, with `fault`, when a joint fails.
  bool apply(const State& before, const Evaluation& e_before, State& after, const Evaluation& e_after,
             Mobility mobility, void* self, Fault& fault);
  /// Passes on rising events whose function is past zero already when the run starts.
  bool at_start(State& start, const Evaluation& e, Fault& fault);

  /// Steps of fixed size: takes the sides of the switches of applied forces at the end of a step that stands.
  void renew_switches(State& after, const Evaluation& e) {
    if (!located_ && switches_.count() > 0 && switches_.renew(after, e)) switched_ = true;
  }
  const LoadSwitches& switches() const { return switches_; }
  /// Other forces act after the last call: by an event of a joint, or as an applied force changes its form.
  bool changed() const { return !happenings_.empty() || switched_; }
  bool switched() const { return switched_; }
  /// "event 'x' of joint 'y'", for messages.
  [[gnu::cold]] std::string words(const Passage& passage) const;
  /// The force or driver whose formula changed its form last.
  std::string switched_words() const { return switches_.words(last_switch_); }

  /// Events of the last call in order of time, then of declaration.
  struct Happening {
    double time;
    int joint, event;
    std::size_t fields;  ///< offset into field_values()
    std::size_t count;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.time, self.joint, self.event, self.fields, self.count);
    }
  };
  const std::vector<Happening>& happenings() const { return happenings_; }
  std::span<const double> fields(const Happening& h) const { return {values_.data() + h.fields, h.count}; }
  std::span<double> fields(const Happening& h) { return {values_.data() + h.fields, h.count}; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.armed_, self.seen_, self.start_, self.start_rate_, self.end_, self.end_rate_);
    archive(self.earlier_, self.earlier_rate_, self.start_time_, self.earlier_by_);
    archive.list(self.happenings_);
    archive.list(self.values_);
    archive(self.switched_, self.last_switch_);
  }

 private:
  /// A step and its ends as joints see them: with the history that they have now.
  struct Step {
    const State& before;
    const Evaluation& e_before;
    State& after;
    const Evaluation& e_after;
    Point start, end;
    Mobility mobility;
    void* self;
  };
  void arm_located(std::size_t watched);
  bool apply_joint(std::size_t watched, const Step& step, Fault& fault);
  /// Where a joint, or the switches, are asked.
  struct Place {
    Point point;
    std::span<const double> a;
  };
  static Place place(const State& state) { return {point(state), state.a()}; }
  bool are_switches(int joint) const { return joint >= system_.joints().count(); }
  Span<const Event> events_of(int joint) const {
    return are_switches(joint) ? switches_.events() : system_.joints().layout(joint).events;
  }
  bool functions(int joint, const Place& place, const Evaluation& e, std::span<double> g, std::span<double> rate,
                 Fault& fault);
  bool functions_of_all(const Place& place, const Evaluation& e, std::vector<double>& g, std::vector<double>& rate,
                        Fault& fault);
  bool look_between(Fault& fault);
  void leave_zero(int joint, int event);
  bool could_cross(std::size_t event, double sign, double dt) const;
  bool sharpen(const State& before, const Evaluation& e_before, const State& after, const Evaluation& e_after,
               Passage& found, Fault& fault);
  bool handle_inside(int joint, int event, double s, const Step& step, Fault& fault);
  bool handle(int joint, int event, const Point& here, const Evaluation& e, State& state, Fault& fault,
              const double* mobility = nullptr);

  const System& system_;
  const EvaluationContext& context_;
  bool located_;
  LoadSwitches switches_;
  bool switched_ = false;
  int last_switch_ = 0;
  State& between_;
  KeptEvaluation& e_between_;
  std::vector<int> watched_;
  std::vector<std::size_t> first_event_;  // by watched joint: where its events stand in the next two
  std::vector<char> armed_, seen_;        // could the event happen at the last look; the same for the step being tried
  // Functions of all events at both ends of a step, and at the start of the step before.
  std::vector<double> start_, start_rate_, end_, end_rate_, earlier_, earlier_rate_;
  double start_time_ = 0.0, earlier_by_ = 0.0;  // 0: what was before says nothing
  std::vector<char> happening_;                 // by event of one joint
  std::vector<char> inside_;                    // by joint: some of its events are passed on inside a step
  std::vector<double> g0_, r0_, gm_, rm_, g1_, r1_, values_;
  std::vector<Happening> happenings_;
  std::vector<double> lost_;
};

}  // namespace freeplay
