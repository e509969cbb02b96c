// SmallDifference: what the equations of motion make of a small difference of positions in a mechanism without
// contacts.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "stage/newton_stage_solver.h"
#include "system/system.h"

namespace freeplay {

/// Carries a neighbour of the motion along, whose distance d stays infinitely small, and finds whether d grows
/// exponentially. In the mean exponential growth of nearby orbits (Cincotta and Simo 2000, Astron Astrophys Suppl 147),
///
///   Y(t) = 2/t int_0^t (d'/d) s ds,  with the mean Z(t) = 1/t int_0^t Y ds,
///
/// Z tends to 2 for regular motions, whose differences grow with the time or not at all, and to L t / 2 for chaotic
/// ones, whose differences grow by exp(L t). From Z = 3 on the growth is about exp(2 (Z - 1)).
///
/// The neighbour takes steps of its own by a multistep method, each a small part of the time in which differences swing
/// and as long as one of the run at least: a digit of the exponent is enough. Where steps of the run go over these
/// swings, as of stiff springs, and where constraints are redundant, nothing is known and nothing grows. It is followed
/// for the first 3000 of them, or until a difference as large as the errors of the run has grown to all that it can.
class SmallDifference {
 public:
  /// `system` must outlive it. Nothing is ever due for a system without freedom, or where something can touch.
  [[gnu::cold]] explicit SmallDifference(const System& system);

  /// Whether the accepted state at t is to be followed.
  bool is_due(double t) const { return left_ > 0 && !(t < due_); }
  /// A state with its accelerations, in the order of time.
  void follow(const State& accepted);
  /// By group of bodies (see BodyGroups): what a difference as large as the errors of the run has become, as a part of
  /// the model's size; 1 at most. 0 where nothing grows.
  std::span<const double> grown() const { return grown_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    if (!self.solver_) return;
    archive(self.left_, self.due_, self.start_, self.time_, self.swing_, self.longest_, self.shadow_, *self.solver_);
    archive(self.change_, self.rate_, self.acceleration_, self.previous_, self.older_, self.passed_);
    archive(self.swing_now_, self.long_steps_, self.grown_, self.growth_);
  }

 private:
  struct Growth {           // of one group
    double weighted = 0.0;  // int (d'/d) s ds [s]
    double summed = 0.0;    // int Y ds [s]
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.weighted, self.summed);
    }
  };
  bool begin(const State& accepted);
  bool step(const State& accepted, double dt);
  void forget();
  bool differ(const State& accepted);
  void to_body_axes(const State& accepted);
  void to_world_axes(const State& accepted);
  void grow(double t, double dt);
  void measure();
  void scale();
  void stop() { left_ = 0; }

  const System& system_;
  std::unique_ptr<NewtonStageSolver> solver_;  // none where nothing is ever due
  State shadow_;
  std::vector<int> group_;    // of each unknown
  std::vector<double> unit_;  // of each unknown: 1 for angles, else the model's size [m]
  double first_;              // errors of the run, as a part of the model's size
  double swing_ = 0.0;        // time by which rates count as much as changes [s]
  double swing_now_ = 0.0;    // the shortest at present in which differences swing, over 2 pi [s]
  double longest_ = 0.0;      // of such times [s]
  int left_ = 0;              // steps
  int long_steps_ = 0;        // in a row that were long beside `swing_now_`
  double due_ = 0.0, start_ = 0.0, time_ = 0.0;
  // Of the neighbour from the motion, in tangent increments; rotations in space in world axes.
  std::vector<double> change_, rate_, acceleration_;
  std::vector<double> previous_, older_, expected_;  // accelerations
  std::array<double, 2> passed_{};                   // since the one before, and between both [s]
  std::vector<double> size_;                         // distance, by group
  std::vector<double> grown_;
  std::vector<Growth> growth_;  // by group
  std::vector<double> z_rate_;
};

}  // namespace freeplay
