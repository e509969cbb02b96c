// GearTurnChoice: with which whole turns of its gears a mechanism is put together.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "assembly/closed_mechanism.h"

namespace freeplay {

class GearTurnChoice {
 public:
  /// `held`: by joint, the coordinate that it leads or is driven to [rad or m], or NaN; both are read when asked.
  GearTurnChoice(ClosedMechanism& mechanism, const std::vector<double>& held)
      : mechanism_(mechanism), model_(mechanism.model()), held_(held) {}

  /// Angles of gears are counted from (-pi, pi], or from where slides are.
  void count(bool from_slides);
  /// Newton's method from a guess with turns counted from slides. False, and turns as before, where that does not close
  /// the mechanism.
  bool from_slides(std::span<const double> guess);
  /// The same with turns of given poses or slides, where what was `found` keeps less of what is given. False, and the
  /// position as before, where nothing is better.
  bool from_other_turns(std::span<const double> guess, bool found);

 private:
  void count_turns(int kind);
  std::optional<double> given_angle(int marker) const;

  ClosedMechanism& mechanism_;
  const Model& model_;
  const std::vector<double>& held_;
};

}  // namespace freeplay
