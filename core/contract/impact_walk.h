// ImpactWalk: leads a free body through impacts at a joint, with the calls that a run makes.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "contract/joint_walk.h"

namespace freeplay {

/// Body b, its centre of mass in the origin of the marker; body a stands still.
struct FreeBody {
  double mass = 1.0, inertia = 1.0;  ///< [kg], about every axis [kg m^2]
};

class ImpactWalk {
 public:
  struct Handled {
    int index;
    double t, value, rate;  ///< of the event function there
    std::vector<double> fields;
  };

  /// `per_contact` above zero: steps end at events; else events lie inside of steps of one size. Events that happen at
  /// the start are passed on.
  ImpactWalk(const JointProbe& probe, const JointMoment& start, const FreeBody& body, double per_contact);
  ImpactWalk(const ImpactWalk&) = delete;
  ImpactWalk& operator=(const ImpactWalk&) = delete;

  /// A step of the length `dt` at most. False when events do not end or something is not finite.
  bool step(double dt);

  const JointMoment& now() const { return now_; }
  const std::vector<Handled>& handled() const { return handled_; }
  bool storms() const { return handled_.size() > most_events; }
  /// Of motion and stored [J].
  double energy() const;
  /// On a and b; empty when the joint fails.
  std::vector<double> wrench() const { return probe_.forces(now_).wrench; }

 private:
  static constexpr std::size_t most_events = 40;
  Twelve acceleration(const JointMoment& at) const;
  Eigen::VectorXd pushed(const JointMoment& at) const;
  JointMoment attempt(double dt) const;
  bool is_past(std::size_t event, double g) const;
  /// Does an event that was ahead at the start of the step lie past its zero at its end?
  bool passes(const JointMoment& end) const;
  double length_to_event(double dt) const;
  void handle(std::size_t event, const JointMoment& here, JointMoment& state);
  void handle_at_end(JointMoment& trial);
  void handle_inside(JointMoment& trial);

  const JointProbe& probe_;
  FreeBody body_;
  std::vector<std::size_t> free_;  ///< components of the twists in which b moves
  std::array<double, 9> mobility_{};
  std::array<double, 36> whole_mobility_{};
  JointMoment now_;
  std::vector<double> ahead_;     ///< event functions at the start of the step
  std::vector<char> armed_late_;  ///< by another event, when they were past their zero
  std::vector<Handled> handled_;
};

}  // namespace freeplay
