// The parts of a run. Private to simulation.cpp and the files named below.
#pragma once

#include <chrono>
#include <limits>
#include <optional>
#include <string_view>

#include "run/drive_kinks.h"
#include "run/energy_account.h"
#include "run/event_bracket.h"
#include "run/event_storm.h"
#include "run/inner_motion.h"
#include "run/input_activity.h"
#include "run/observer.h"
#include "run/peak_search.h"
#include "run/resting_joints.h"
#include "run/simulation.h"
#include "run/step_control.h"
#include "run/step_events.h"
#include "stage/newton_stage_solver.h"

namespace freeplay {

/// Ends of messages, which a likely cause takes the place of.
namespace advice {
inline constexpr std::string_view smaller_step = "; try a smaller step";
inline constexpr std::string_view accuracy = "; ask for an accuracy in place of a step";
inline constexpr std::string_view other_steps = "; ask for less accuracy, or for steps of one size";
inline constexpr std::string_view error = "; allow smaller steps or a larger error";
}  // namespace advice
inline constexpr double rounding = std::numeric_limits<double>::epsilon();
/// Regularity below which no motion is interpolated and steps that fail are tried in other lengths.
inline constexpr double near_singular = 1e-2;

struct Simulation::Impl {
  Impl(const System& owner, const Start& start, const Channels& all_channels, std::span<Sink* const> all_sinks);

  Outcome run(const RunHooks& hooks);

  // Each returns false when the run is over, with `outcome` filled.
  bool begin();
  bool step(double dt, bool& converged);
  bool check_step(double dt);
  bool evaluate_all(State& state, KeptEvaluation& e);
  /// The numbers that an attempt may use as it likes; behind them stand marks.
  Span<double> scratch_space() { return {scratch.data(), scratch.size() - guard::marks}; }
  bool begin_steps(double dt, State& state);
  bool accept(const StepEvents::Passage& located, double kink = unbounded);
  void add_energy();
  // Steps that end with too much energy (energy_growth.cpp).
  double energy_of(const Evaluation& e) const;
  double energy_of_drives() const;
  bool gains_energy();
  std::string why_energy_grows(double dt);
  std::string why_beyond_bounds(double t, int joint) const;
  bool all_built_in() const;
  bool refresh();
  bool know_row();
  bool record_step();
  bool watch_row(double dt);
  bool note_warnings();
  bool tell_sinks();
  bool check_stop();
  bool check_interrupt(const RunHooks& hooks);

  // Runs in fixed steps (fixed_run.cpp).
  bool run_fixed(const RunHooks& hooks);
  bool advance_to(double target, const RunHooks& hooks);

  // Corners of inputs (motion_kinks.cpp).
  bool next_corner(double dt, double& corner);
  bool resolve_inputs(double& dt);
  bool resolves_joints(double& dt);
  bool loads_jump(double corner);
  void format_unresolved();
  static double before(double kink);
  bool pass_kink(double kink);
  bool note_jumps(double kink);
  void book_jump(double kink);
  void note_driven(const Evaluation& e);
  int row_that_jumps() const;
  void book_impulses(Evaluation& behind);
  void format_jumps();

  // Runs with error control (adaptive_run.cpp).
  bool run_adaptive(const RunHooks& hooks);
  bool adaptive_step();
  bool bounded_step(double& dt, int& limiting_joint);
  bool take_detour(bool passed, std::size_t& detours, double& asked, double& dt);
  bool write_rows_inside();
  bool write_row_at(double t);
  void know_inside();
  double error_by_missing(double s);
  bool settle_inside(double t);
  bool look_inside(double t);
  bool settle_between();
  // Records and the largest values inside a step (recording.cpp).
  struct Leg {
    const State& start;
    const Evaluation& e_start;
    const State& end;
    const Evaluation& e_end;
  };
  bool observe_inside(double t, const Leg& leg);
  void seek_peaks(const Leg& leg);
  bool note_abrupt_end();
  bool begin_statistics_inside();
  // and their ends at events (event_pursuit.cpp).
  double before_event(double dt, double shorter, StepEvents::Passage& hunted);
  bool pursue(StepEvents::Passage& hunted, EventBracket& bracket, double& dt, int hunts, bool& done);
  bool end_inside(const StepEvents::Passage& hunted, double dt, int hunts, double longest);
  double defect_inside(double dt);
  bool is_sharp(const StepEvents::Passage& end) const;
  double aim_past(const StepEvents::Passage& end, double dt) const;
  double event_lateness() const;
  std::string why_so_small(double dt, int limiting_joint) const;
  std::string why_singular();
  double row_time(long index) const;

  bool write_row();
  bool sinks_are_well();
  bool have_turned(const Evaluation& e) const;
  void note_turns(const Evaluation& e, std::span<double> history);
  [[gnu::cold]] bool fail(int exit_code, std::string reason);
  [[gnu::cold]] bool fail_with(const Fault& fault, double t);
  [[gnu::cold]] bool fail_beside(int joint);
  [[gnu::cold]] bool fail_in_storm(const StepEvents::Happening& last, const EventStorm::Finding& found);
  std::string why_not_converged(double dt) const;
  std::string why_open(double position) const;
  std::string row_name(int row_index) const;
  int hardest_joint(BodyId body) const;
  void format_warnings();
  void note_unused_play();
  void note_event_directions();
  void note_first_forces();
  void explain_dead_point();
  void explain_failure();

  const System& all_bodies;  ///< of the whole model
  const Start& first_start;  ///< of the run
  System system;             ///< of the unknowns
  const Model& model;
  const Settings& settings;
  const Channels& channels;
  std::vector<Sink*> sinks;
  EnergyAccount energy;
  IntegratorLayout integrator_layout;
  bool adaptive;
  int flows;  ///< integrals that the integrator carries along
  NewtonStageSolver solver;
  StepControl control;
  State accepted, trial, between;
  KeptEvaluation e_accepted, e_trial;
  std::optional<KeptEvaluation> own_between;  // with error control
  KeptEvaluation& e_between;                  // else the solver's: between two of its calls it needs nothing of it
  Observer observer;
  StepEvents events;
  EventStorm storm;
  RestingJoints resting;
  DriveKinks kinks;
  std::optional<InputActivity> inputs;          ///< with error control, unless a test blinds it
  CornerKind corner_kind = CornerKind::smooth;  // of the corner at which the step being accepted ends
  Statistics statistics;
  RunWatch watch;
  PeakSearch peaks;  ///< with error control
  std::vector<double> scratch, row, row_between, residual, z_rate, flow_half_way, defect;
  InnerMotion inner;  ///< of the step that was made last, where a row or a peak was sought inside
  std::vector<double> inner_before, rate_defect, start_rate, end_rate;
  std::vector<int> stop_columns, with_history;
  struct Turn {
    std::size_t slot, joint;
  };
  std::vector<Turn> turns;         // into h
  std::vector<double> angle_then;  // of bodies, when turns were noted last; empty where they are in every step
  bool turns_are_due = true;       // in the step that is being accepted
  struct Warning {
    const char* text = nullptr;
    double time = 0.0;
    std::size_t values = 0;  ///< offset into warning_values
  };
  std::vector<Warning> joint_warnings;  ///< by joint
  std::vector<double> warning_values;   ///< the joints' own channels when they warned
  struct SpeedJump {
    int count = 0;
    double time = 0.0, from = 0.0, to = 0.0;  ///< of the first
  };
  std::vector<SpeedJump> speed_jumps;  ///< by driver
  std::vector<TimeValue> motion_before, motion_behind;
  std::vector<double> q_before, v_before, driven_change, impulses;
  std::vector<std::string> warnings;
  /// Time from which drivers pull the mechanism apart, looked for when a journal is deeper than its play.
  std::optional<double> torn_from;
  Outcome outcome;
  Fault plugin_fault;                // of the last attempt
  int failed_joint = -1;             // whose law the run came to the end of
  std::vector<double> first_forces;  ///< of springs and the like, by joint [N]
  double error = 0.0;                // of the last attempt
  double explained_energy = 0.0;     // the largest that work was found for [J]
  double gained = 0.0;               // without work, by the step that was looked at last [J]
  bool left_bounds = false;          // the last attempt ended with numbers that are not finite
  bool ended_inside = false;   // the step that is being accepted was cut short: the integrator has no memory of its end
  bool ended_abruptly = true;  // the last step: at an event or a kink, after which values change abruptly
  double allowed = 0.0;        // by which positions may err in one step, with error control [m]
  bool row_is_known = false;   // `row` is that of the accepted state
  long next_row = 1;
  std::chrono::steady_clock::time_point started;
  double last_progress = 0.0;
  static constexpr unsigned of_equations = term_position | term_velocity | term_force;
  static constexpr unsigned all_terms = of_equations | term_coordinate;
};

}  // namespace freeplay
