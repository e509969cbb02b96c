// Observer: turns an accepted state into the numbers of a result row.
#pragma once

#include <span>
#include <vector>

#include "model/channel.h"
#include "system/motion_channels.h"
#include "system/system.h"

namespace freeplay {

/// Fills every column but dissipated, work and residual, which the energy account knows.
class Observer {
 public:
  Observer(const System& system, const Channels& channels);

  /// `e` holds all terms at the point of `state`. False, with `fault` filled, when a joint's observation fails.
  bool observe(const State& state, const Evaluation& e, std::span<double> row, Fault& fault);
  /// Of the same columns those alone of which every run keeps largest values: time, motions of bodies, wrenches,
  /// efforts and energies. The others stay as they are.
  void observe_loads(const State& state, const Evaluation& e, std::span<double> row) const;
  /// The channels of a joint's type.
  bool observe_own(int index, const Point& point, const Evaluation& e, std::span<const double> lambda,
                   std::span<double> row, Fault& fault) const;

 private:
  void observe_body(int index, const Evaluation& e, std::span<double> row) const;
  void write_wrench(const double* wrench, double* to) const;
  void observe_coordinate(int index, const Evaluation& e, std::span<double> row) const;
  void observe_driver(int index, const Evaluation& e, std::span<double> row) const;
  bool observe_path(int index, const Point& point, const Evaluation& e, std::span<double> row, Fault& fault);
  void observe_force(int index, const Evaluation& e, std::span<double> row) const;
  void observe_frame(int index, const Evaluation& e, std::span<double> row) const;
  void observe_accelerations(std::span<const double> a, const Evaluation& e, std::span<double> row) const;

  const System& system_;
  MotionWork motion_work_;
  const Channels& channels_;
  MotionChannels motion_;
  std::vector<int> with_own_;  // joints whose type has channels
};

}  // namespace freeplay
