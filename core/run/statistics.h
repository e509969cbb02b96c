// Statistics: maxima, time means and counts over every accepted step from `discard` on.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "run/largest_values.h"
#include "run/mean_noise.h"

namespace freeplay {

/// NaN where nothing was seen.
struct JointStatistics {
  double max_force, rms_force, max_normal_force, max_penetration, max_eccentricity, contact_fraction, dissipated;
  long contacts;
  double max_torque;
};
/// Of an entry of `forces`; the work is that on the bodies [J].
struct ForceStatistics {
  double max_force, max_torque, work;
};
struct DriverStatistics {
  double max_abs, rms, work;
};
struct PathStatistics {
  double max_position, rms_position, max_angle, rms_angle;
};

/// The part of a run that statistics are about [s]. Without length there are none.
struct StatisticsWindow {
  double from, to;
};

/// Accumulates while a run goes on; means weigh each step by its length (trapezoidal rule; where steps are long, by the
/// parabolas through their ends and the rows inside), and begin with the first row that is added from the instant on
/// that `discard` names. Rows before it have maxima of their own.
class Statistics {
 public:
  /// `long_steps`: as an accuracy chooses them, which end where values jump.
  Statistics(const Model& model, const Channels& channels, bool long_steps = false);

  /// Whether a state at t is one of those that count.
  bool counts(double t) const;
  /// Whether the first instant that counts lies inside a step and was not added yet.
  bool begins_inside(double from, double to) const;
  double first_instant() const { return discard_until_; }
  /// The accepted row at the end of a step (or the start row). Work and losses by driver, joint and force come from the
  /// energy account, `position` and `velocity` are the largest constraint residuals [m or rad, per s].
  void add(std::span<const double> row, std::span<const double> driver_work, std::span<const double> joint_loss,
           std::span<const double> force_work, double position, double velocity);
  /// A row inside a step: its values may be the largest.
  void note(std::span<const double> row);
  /// The same of one that is as accurate as the ends of steps, and a node of means; in the order of time.
  void note_inside(std::span<const double> row);
  /// The row at the end of a step before an event or a kink, where values may jump: the next to be added, at the same
  /// instant, is on the other side. False where it does not count. A step that is the only one since the last such
  /// instant, or far longer than those, has no third point for a parabola: `row_at` gives the row half way, or none,
  /// unless the step is a small part of all means.
  bool end_stretch(std::span<const double> row, const std::function<std::span<const double>(double)>& row_at);
  /// After the row that was added last values go on otherwise than before.
  void begin_stretch();
  /// A row that is written; of one that was noted when it was seen.
  void note_written(std::span<const double> row);
  void note_written_later(std::span<const double> row);
  void add_contact(int joint, double time);

  JointStatistics joint(int index) const;
  /// `index` into Model::force_elements.
  ForceStatistics force(int index) const;
  DriverStatistics driver(int index) const;
  PathStatistics path(int index) const;
  double body_max_speed(int index) const;
  StatisticsWindow window() const { return {discard_until_, any() ? last_time_ : discard_until_}; }
  bool any() const { return duration_ > 0.0; }
  long instants() const { return instants_; }  ///< that statistics are of
  LargestValues& largest() { return largest_; }
  const LargestValues& largest() const { return largest_; }
  long contacts() const { return contacts_; }
  long contacts_total() const { return contacts_total_; }
  double position_residual() const { return position_; }
  double velocity_residual() const { return velocity_; }
  double energy_residual() const { return energy_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.largest_, self.last_time_, self.duration_);
    archive(self.seen_, self.instants_, self.joints_, self.forces_, self.drivers_, self.paths_, self.contacts_);
    archive(self.contacts_total_, self.position_, self.velocity_, self.energy_, self.mean_noise_);
  }

 private:
  friend class FigureNoise;
  struct Mean {  // of a square over time
    double integral = 0.0, last = 0.0;
    double before = 0.0, length = 0.0;  ///< the square at the start of the last step, and its length
    double pending = 0.0;               ///< what the parabola to come does not take off the last step, if none comes
    int known = 0;                      ///< ends of like steps since values went on smoothly
    void add(double value, double dt, bool first, bool by_parabolas);
    void begin_anew();
    bool wants_middle() const;
    void add_middle(double value);
    double rms(double duration) const;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.integral, self.last, self.before, self.length, self.pending, self.known);
    }
  };
  struct JointSums {
    Mean force;
    double contact_time = 0.0, last_contact = 0.0;
    double loss = 0.0, loss_start = 0.0;
    long contacts = 0;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.force, self.contact_time, self.last_contact, self.loss, self.loss_start, self.contacts);
    }
  };
  struct ForceSums {
    double work = 0.0, work_start = 0.0;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.work, self.work_start);
    }
  };
  struct DriverSums {
    Mean effort;
    double work = 0.0, work_start = 0.0;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.effort, self.work, self.work_start);
    }
  };
  struct PathSums {
    Mean position, angle;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.position, self.angle);
    }
  };
  void add_means(std::span<const double> row, double dt, bool first);
  void add_inside(std::span<const double> row, double t);
  double wants_middle() const;  ///< length of the last step, if half way is wanted
  /// Calls `visit(mean, place)` for all, with the place of the value that it is of.
  template <class Self, class Visit>
  static void each_mean(Self& self, const Visit& visit) {
    const PeakValues& places = self.largest_.places();
    for (int j = 0; j < static_cast<int>(self.joints_.size()); ++j)
      visit(self.joints_[static_cast<std::size_t>(j)].force, places.force(j));
    for (int d = 0; d < static_cast<int>(self.drivers_.size()); ++d)
      visit(self.drivers_[static_cast<std::size_t>(d)].effort, places.effort(d));
    for (int p = 0; p < static_cast<int>(self.paths_.size()); ++p) {
      visit(self.paths_[static_cast<std::size_t>(p)].position, places.position_error(p));
      visit(self.paths_[static_cast<std::size_t>(p)].angle, places.angle_error(p));
    }
  }

  const Channels& channels_;
  LargestValues largest_;
  double discard_until_;
  double last_time_ = 0.0, duration_ = 0.0;
  bool seen_ = false;
  long instants_ = 0;
  std::vector<JointSums> joints_;
  std::vector<ForceSums> forces_;
  std::vector<DriverSums> drivers_;
  std::vector<PathSums> paths_;
  long contacts_ = 0, contacts_total_ = 0;
  double position_ = 0.0, velocity_ = 0.0, energy_ = 0.0;
  bool long_steps_;
  MeanNoise mean_noise_;  // of the means, in the order of each_mean()
};

}  // namespace freeplay
