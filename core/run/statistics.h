// Statistics: maxima, time means and counts over every accepted step from `discard` on.
#pragma once

#include <span>
#include <vector>

#include "run/channel.h"

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

/// Accumulates while a run goes on; means weigh each step by its length (trapezoidal rule).
class Statistics {
 public:
  Statistics(const Model& model, const Channels& channels);

  /// Whether a state at t is one of those that count.
  bool counts(double t) const;
  /// The accepted row at the end of a step (or the start row). Work and losses by driver, joint and force come from the
  /// energy account, `position` and `velocity` are the largest constraint residuals [m or rad, per s].
  void add(std::span<const double> row, std::span<const double> driver_work, std::span<const double> joint_loss,
           std::span<const double> force_work, double position, double velocity);
  void add_contact(int joint, double time);

  JointStatistics joint(int index) const;
  /// `index` into Model::force_elements.
  ForceStatistics force(int index) const;
  DriverStatistics driver(int index) const;
  PathStatistics path(int index) const;
  double body_max_speed(int index) const;
  long contacts() const { return contacts_; }
  long contacts_total() const { return contacts_total_; }
  double position_residual() const { return position_; }
  double velocity_residual() const { return velocity_; }
  double energy_residual() const { return energy_; }

 private:
  struct Mean {  // of a square over time
    double integral = 0.0, last = 0.0, maximum = -1.0;
    void add(double value, double dt, bool first);
    double rms(double duration) const;
  };
  struct JointSums {
    Mean force;
    double torque = -1.0;
    double normal = -1.0, penetration = 0.0, eccentricity = -1.0, contact_time = 0.0, last_contact = 0.0;
    double loss = 0.0, loss_start = 0.0;
    long contacts = 0;
    bool any = false;
  };
  struct ForceSums {
    int column = 0;  ///< first of its wrench
    double force = -1.0, torque = -1.0, work = 0.0, work_start = 0.0;
  };
  struct DriverSums {
    Mean effort;
    double work = 0.0, work_start = 0.0;
  };
  struct PathSums {
    Mean position, angle;
  };
  const Channels& channels_;
  double discard_until_;
  double last_time_ = 0.0, duration_ = 0.0;
  bool seen_ = false;
  std::vector<JointSums> joints_;
  std::vector<ForceSums> forces_;
  std::vector<DriverSums> drivers_;
  std::vector<PathSums> paths_;
  std::vector<double> body_speed_;
  bool planar_;
  long contacts_ = 0, contacts_total_ = 0;
  double position_ = 0.0, velocity_ = 0.0, energy_ = 0.0;
};

}  // namespace freeplay
