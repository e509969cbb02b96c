// EnergyAccount: work put in and energy dissipated since the start, by element.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "model/channel.h"
#include "stage/flows.h"
#include "system/system.h"

namespace freeplay {

/// Power of a wrench (force and moment) at a marker [W].
double power(const double* wrench, const MarkerKinematics& k);

/// Booked are work of drivers, applied forces and rows of joints that depend on time, and the loss of joints: minus the
/// power of their wrenches and the rate of what they store. That is what a damper or a friction law dissipates at this
/// instant, and nothing for an elastic force, whatever the step; joints that do not give the rate are booked by
/// differences of what they store, which takes errors of the method for losses. What an integrator or a projection
/// loses is never booked; it is the residual. The powers ("flows": drivers, applied forces, joints with forces, in this
/// order) are integrated over accepted steps by the cubic through their values at the ends of the last steps, by
/// Simpson's rule where there are none yet, or by the integrator itself, along with z, where it can: then to its order;
/// those of rows by the trapezoidal rule.
class EnergyAccount final : public Flows {
 public:
  explicit EnergyAccount(const System& system);

  int flows() const override { return static_cast<int>(power_.size()); }
  /// Powers [W] at an evaluated point (forces and coordinates), flows() numbers.
  void flow(const Evaluation& e, std::span<const double> lambda, std::span<double> out) const override;

  /// The start of a run. `row` needs the observed columns.
  void start(const Evaluation& e, std::span<const double> lambda, const Channels& channels,
             std::span<const double> row);
  /// The end of an accepted step, with the flows() integrals since the start.
  void take(double dt, const Evaluation& e, std::span<const double> lambda, std::span<const double> integrals);
  /// The end of an accepted step that goes on smoothly like those before: with the powers P at its ends and theirs,
  /// dt/24 (9 P_1 + 19 P_0 - 5 P_-1 + P_-2). False, and nothing is done, where the steps before were of another length
  /// or had other forces on than `e` has, since the last event, or where these powers are far from a parabola.
  bool add_smooth(double dt, const Evaluation& e, std::span<const double> lambda);
  /// The same of any step, with the powers in its middle.
  void add(double dt, std::span<const double> half_way, const Evaluation& e, std::span<const double> lambda);
  /// The same of a step in which powers may jump, part by part, with those at the begin, in the middle and at the end
  /// of each; then the whole step.
  void begin_parts() { std::copy(integral_.begin(), integral_.end(), integral_inside_.begin()); }
  void add_part(double dt, std::span<const double> begin, std::span<const double> half_way,
                std::span<const double> end);
  void take_parts(double dt, const Evaluation& e, std::span<const double> lambda) {
    flow(e, lambda, power_end_);
    take(dt, e, lambda, power_end_, integral_inside_);
  }
  /// What of the account is wanted: all of its columns; dissipated, work and residual alone; joint_loss() alone.
  enum class Part { all, sums, losses };
  /// Fills it into a row that holds the observed columns, at the end of the last step.
  void fill(const Evaluation& e, const Channels& channels, std::span<double> row, Part part = Part::all) {
    if (part == Part::all) return fill(e, channels, row, integral_, row_work_);
    if (part == Part::sums) return fill_sums(e, channels, row, integral_, row_work_);
    find_losses(e, integral_);
  }
  /// The flows() integrals at the fraction s of a step of the length dt that begins at the end of the last one, from
  /// the powers there and at its end and the integrals at its end. False where the powers are too far from a straight
  /// line for a parabola to be as good as a step of the integrator.
  bool integrate_to(double s, double dt, const Evaluation& here, std::span<const double> lambda_here,
                    const Evaluation& end, std::span<const double> lambda_end, std::span<const double> integral_end,
                    std::span<double> out);
  /// Dissipated, work and residual at the fraction s of the last step, where `e` and `lambda` are: powers as parabolas
  /// over the step.
  void fill_inside(double s, const Evaluation& e, std::span<const double> lambda, const Channels& channels,
                   std::span<double> row);
  /// Whether powers of joints at the fraction s of the last step are so far from a straight line that the work there
  /// wants more than a parabola: see_half_way() half way from s to the nearer end, then fill_bent().
  bool bends(double s, const Evaluation& e, std::span<const double> lambda);
  void see_half_way(const Evaluation& e, std::span<const double> lambda) { flow(e, lambda, power_end_); }
  /// As fill_inside(), by Simpson's rule from the nearer end.
  void fill_bent(double s, const Evaluation& e, std::span<const double> lambda, const Channels& channels,
                 std::span<double> row);
  /// Of what gives energy at one end or at the other of a step: the sum of the larger powers [W]. Drivers that
  /// prescribe motion count at the start alone.
  double largest_power(const Evaluation& start, std::span<const double> lambda_start, const Evaluation& end,
                       std::span<const double> lambda_end);
  /// What was dissipated, less work and energy at the start, at the end of the last step [J]: with the energy there it
  /// is the residual.
  double lost_less_given(const Evaluation& e) const;
  /// The same with the flows() integrals there.
  void fill_inside(double s, const Evaluation& e, std::span<const double> lambda, std::span<const double> integrals,
                   const Channels& channels, std::span<double> row) {
    fill(e, channels, row, integrals, row_work_inside(s, e, lambda));
  }
  /// An event changed what acts at the end of the last step.
  void renew(const Evaluation& e, std::span<const double> lambda) {
    flow(e, lambda, power_);
    look(e, lambda);
    steps_alike_ = 0;
  }

  /// Work of an impulse at the end of the last step [J].
  void add_driver_work(int driver, double work) {
    integral_[static_cast<std::size_t>(driver)] += work;
    exchanged_ += std::abs(work);
  }
  /// What a joint that acts by forces lost at the end of the last step as its history changed [J]. Nothing is done, and
  /// false returned, where it gives no rate of what it stores: the differences of that have it already. The index is
  /// that of its flow.
  bool add_history_loss(int joint, double loss, const Evaluation& e, std::size_t& flow);
  /// Work put in and taken out since the start, both counted as positive, by element and step [J].
  double exchanged() const { return exchanged_; }

  std::span<const double> driver_work() const { return driver_work_; }  ///< at the last fill() [J]
  std::span<const double> joint_loss() const { return joint_loss_; }    ///< [J]
  /// Of Model::force_elements on the bodies [J].
  std::span<const double> force_work() const { return force_work_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.dt_, self.initial_, self.exchanged_, self.row_power_, self.row_work_, self.row_power_before_,
            self.row_work_before_);
    archive(self.driver_work_, self.joint_loss_, self.force_work_, self.power_, self.integral_);
    archive.list(self.stored_start_);
    archive(self.power_earlier_, self.steps_alike_, self.acting_, self.power_before_, self.integral_before_);
  }

 private:
  void fill(const Evaluation& e, const Channels& channels, std::span<double> row, std::span<const double> integral,
            double row_work);
  void fill_sums(const Evaluation& e, const Channels& channels, std::span<double> row, std::span<const double> integral,
                 double row_work);
  /// Returns their sum.
  double find_losses(const Evaluation& e, std::span<const double> integral);
  double row_power(const Evaluation& e, std::span<const double> lambda) const;
  double row_work_inside(double s, const Evaluation& e, std::span<const double> lambda) const {
    return row_work_before_ + 0.5 * s * dt_ * (row_power_before_ + row_power(e, lambda));
  }
  bool is_like_last(double dt, const Evaluation& e) const;
  void take(double dt, const Evaluation& e, std::span<const double> lambda, std::span<const double> powers,
            std::span<const double> integrals);
  /// With the powers of joints, drivers and forces in `power_`.
  void look(const Evaluation& e, std::span<const double> lambda) {
    row_power_ = row_power(e, lambda);
    acting_ = e.acting;
  }
  struct Ends {
    double start, end;
  };
  static double integral_at(double s, double dt, const Ends& integral, double begin, double here, double end);

  const System& system_;
  double dt_ = 0.0, initial_ = 0.0, exchanged_ = 0.0;
  double row_power_ = 0.0, row_work_ = 0.0;                // at the end of the last step
  double row_power_before_ = 0.0, row_work_before_ = 0.0;  // at its start
  std::vector<double> driver_work_, joint_loss_, stored_start_, force_work_;
  std::vector<double> power_, integral_;  // at the end of the last step
  std::vector<double> power_earlier_;     // at the start of the step before that
  int steps_alike_ = 0;                   // in length and forces, the last ones
  std::uint64_t acting_ = 0;              // ForceValues::acting at the end of the last
  std::vector<double> power_before_, integral_before_, power_end_, integral_inside_;  // of the last step
};

}  // namespace freeplay
