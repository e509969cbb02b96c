// LeftOutLoads: largest values over the steps before the statistics window, for which no output row is made.
#pragma once

#include <span>
#include <vector>

#include "run/largest_values.h"
#include "system/system.h"

namespace freeplay {

/// Raises the values before the window by an accepted state, to the same bits as its row would.
class LeftOutLoads {
 public:
  LeftOutLoads(const System& system, const Channels& channels);

  /// Speeds of bodies, forces of joints (not their torques), efforts of drivers, loads of `forces`. `e` is evaluated at
  /// the state.
  void see(const State& state, const Evaluation& e, LargestValues& largest) const;
  /// Normal force, penetration and eccentricity of a joint whose own channels stand in the row.
  void see_contact(int joint, std::span<const double> row, LargestValues& largest) const;

 private:
  struct Rows {  // of a joint: those of Phi_q, and where their entries stand in the columns of one of its bodies
    int offset = -1, first = 0, count = 0;
    bool second = false, of_gear = false;
  };
  template <class Bodies>
  double force(int joint, const Evaluation& e, std::span<const double> lambda) const;
  template <class Bodies>
  [[gnu::noinline]] double force_of_gear(int joint, const Evaluation& e, std::span<const double> lambda) const;
  template <class Bodies>
  void see_in(const State& state, const Evaluation& e, LargestValues& largest) const;

  const System& system_;
  const Channels& channels_;
  std::vector<Rows> rows_;  // by joint
};

}  // namespace freeplay
