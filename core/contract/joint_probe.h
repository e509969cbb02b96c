// JointProbe: calls a joint as the host does and watches what it writes.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "component/joint_ref.h"
#include "contract/conditions.h"
#include "contract/finding.h"
#include "contract/guarded_numbers.h"
#include "contract/marker_states.h"

namespace freeplay {

/// All that a joint may depend on.
struct JointMoment {
  double t = 0.0;
  MarkerPair markers;
  double coordinate = 0.0;  ///< last known value, for angles over more than a turn
  std::vector<double> z, h;
  double per_contact = 0.0;                                     ///< JointInput::per_contact
  const double *mobility = nullptr, *whole_mobility = nullptr;  ///< of on_event()
  double lost = 0.0;                                            ///< sum of what on_event() and commit() dissipated [J]
};

struct ProbedRows {
  std::vector<double> phi, jacobian, nu, gamma;
};
struct ProbedCoordinate {
  double value = 0.0, bias = 0.0;
  std::vector<double> jacobian;
};
struct ProbedForces {
  std::vector<double> wrench;  ///< on a and on b, 12 numbers
  double potential = 0.0;
  std::vector<double> z_rate, derivatives;
  double potential_rate = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not given
};
struct ProbedEvents {
  std::vector<double> g, rate;
};

/// One object of a joint type. What is wrong with a call itself is noted under the rules "answers", "stays-in-span",
/// "finite" and "allocation"; a call that fails or gives a number that is not finite gives empty vectors.
class JointProbe {
 public:
  JointProbe(const JointRef& joint, Space space, const Conditions& conditions, Findings& findings);

  const JointLayout& layout() const { return layout_; }
  Space space() const { return space_; }
  const JointRef& joint() const { return joint_; }

  ProbedRows rows(const JointMoment& moment) const;
  ProbedCoordinate coordinate(const JointMoment& moment) const;
  ProbedForces forces(const JointMoment& moment, bool derivatives = false) const;
  ProbedEvents events(const JointMoment& moment) const;
  std::vector<double> observe(const JointMoment& moment) const;
  /// Three numbers for each of `count` contacts; empty where the joint leaves them as they are.
  std::vector<double> contacts(const JointMoment& moment, std::size_t count) const;
  double step_limit(const JointMoment& moment) const;
  double free_distance(const JointMoment& moment) const;
  std::array<double, 3> free_levers(const JointMoment& moment) const;
  double next_corner(double t) const;
  /// False when there is nothing to warn of.
  bool warns(const JointMoment& moment) const;
  /// False when the type cannot place a body.
  bool place(double coordinate, Pose& b_in_a) const;
  InitialOffset initial_offset(Span<const double> reaction) const;

  // These change z and h of the moment.
  void initialize(JointMoment& moment) const;
  void begin_step(const JointMoment& accepted, const Twelve& acceleration, double dt, JointMoment& trial) const;
  std::vector<double> on_event(int index, JointMoment& moment) const;
  void commit(JointMoment& moment) const;

  /// Every number that the joint gives at a moment, in one list.
  std::vector<double> all(const JointMoment& moment) const;
  /// A moment with z and h as initialize() leaves them.
  JointMoment start(const MarkerPair& markers, double t) const;

 private:
  struct Fed;            // a JointInput and the numbers that it refers to
  template <class Call>  // returns false when the joint fails, and takes a Message
  bool run(const char* function, const JointMoment* moment, const Call& call) const;
  /// These return false when a number is not finite.
  bool watch(const char* function, const Fed& fed, std::initializer_list<const GuardedNumbers*> written,
             bool nan_allowed = false) const;
  bool expect_finite(const char* function, const Fed& fed, std::span<const double> numbers) const;
  void add_loss(const char* function, const Fed& fed, JointMoment& moment) const;
  void expect_fence(const char* function, bool intact, const JointMoment& moment) const;

  JointRef joint_;
  Space space_;
  Conditions conditions_;
  Findings& findings_;
  JointLayout layout_;
};

}  // namespace freeplay
