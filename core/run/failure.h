// RunFailure: why a run cannot go on, in words.
#pragma once

#include <string>
#include <string_view>

#include "run/context.h"
#include "run/event_storm.h"

namespace freeplay {

/// Ends of messages, which a likely cause takes the place of.
namespace advice {
inline constexpr std::string_view smaller_step = "; try a smaller step";
inline constexpr std::string_view accuracy = "; ask for an accuracy in place of a step";
inline constexpr std::string_view other_steps = "; ask for less accuracy, or for steps of one size";
inline constexpr std::string_view jump =
    "; a force or the energy stored in a joint jumps there, or the integrator errs";
inline constexpr std::string_view error = "; allow smaller steps or a larger error";
}  // namespace advice
inline constexpr std::string_view cause_words = "; likely cause: ";

class RunFailure {
 public:
  explicit RunFailure(RunContext& run) : run_(run) {}

  /// Each ends the run with its outcome; returns false.
  [[gnu::cold]] bool fail(int exit_code, std::string reason);
  [[gnu::cold]] bool fail_with(const Fault& fault, double t);
  /// A joint has written past the end of the state's history.
  [[gnu::cold]] bool fail_beside(int joint);
  /// Whether steps as short as dt [s] are due to drivers that have no value shortly after the accepted state; the run
  /// is over then.
  [[gnu::cold]] bool comes_to_end_of_path(double dt);
  /// The formula of an applied force changes its form without end.
  [[gnu::cold]] bool fail_in_switching(const EventStorm::Finding& found);
  [[gnu::cold]] bool fail_in_storm(const StepEvents::Happening& last, const EventStorm::Finding& found);

  [[gnu::cold]] std::string why_not_converged(double dt) const;
  [[gnu::cold]] std::string why_open(double position) const;
  [[gnu::cold]] std::string why_singular() const;
  /// Of a state at t that could not be made to hold its constraints, without a fault of an element.
  [[gnu::cold]] std::string why_unsolved(double t) const;
  /// `limiting_joint`: that asks for a step so short, or -1.
  [[gnu::cold]] std::string why_so_small(double dt, double smallest, int limiting_joint) const;
  /// `gained`: energy without work in a step of length dt [J].
  [[gnu::cold]] std::string why_energy_grows(double dt, double gained);
  /// likely_cause() at t [s] with steps of dt [s] and the joint that went wrong, or -1; where no number is out of range
  /// and everything moves faster than in machines, what put the energy in.
  [[gnu::cold]] std::string likely_cause_at(double t, double dt, int joint) const;
  [[gnu::cold]] std::string hardest_worker(double least) const;
  std::string row_name(int row_index) const;
  bool all_built_in() const;

  /// Once the run is over: better reasons than the loop could give.
  [[gnu::cold]] bool explain_dead_point();
  [[gnu::cold]] void explain_failure();

 private:
  void locate_end_of_motion(double& t, MotionFault& fault);
  [[gnu::cold]] bool explain_end_of_path();
  bool ends_within(double ahead);
  [[gnu::cold]] void explain_singular_position();
  [[gnu::cold]] std::string why_singular(double t) const;
  [[gnu::cold]] std::string why_beyond_bounds(double t, int joint) const;
  int hardest_joint(BodyId body) const;
  [[gnu::cold]] std::string what_stores(double least) const;

  RunContext& run_;
  int failed_joint_ = -1;  // whose law the run came to the end of
};

}  // namespace freeplay
