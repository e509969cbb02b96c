// ClearanceStatistics: what joints with play go through in the time that counts: contact, load, sliding, wear.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "model/channel.h"
#include "run/mean_noise.h"
#include "run/sink.h"
#include "system/system.h"

namespace freeplay {

/// Of one joint with a normal force; NaN: nothing was seen, or the joint does not tell.
struct PlayFigures {
  double flight, impact, lasting;  ///< parts of the time, their sum is 1
  long impacts;
  double max_approach_speed, max_impulse;  ///< of contacts that ended [m/s, N s]
  double mean_normal_force;                ///< [N]
  double load_angle, load_concentration;   ///< of the load by bearing angle: direction [rad] and part in it
  double load_elevation;                   ///< of a socket: from the plane of that angle [rad]
  double sliding, work;                    ///< [m, J]
  double pv_mean, pv_max;                  ///< pressure times slip [Pa m/s]
  double carried_in, carried_out;          ///< lost before the time by contacts that end in it or later, and by those
                                           ///< that are on at its end [J]
};

/// By bearing angle, that of the eccentricity in the axes of the first frame: sector k holds [k, k + 1) 2 pi/72. In
/// space it is the angle about z of these axes: for a ball, sectors reach from pole to pole of its socket.
struct BearingTable {
  static constexpr std::size_t sectors = 72;
  using Column = std::array<double, sectors>;
  Column contact_time{}, impulse{}, sliding{}, work{}, pv_mean{}, pv_max{};  ///< [s, N s, m, J, Pa m/s, Pa m/s]
  /// Centre of a sector [rad].
  static double angle(std::size_t sector);
};

/// Integrals by the trapezoidal rule over accepted steps, from the first instant that counts on; each end of a step
/// counts half of it, in its own sector.
class ClearanceStatistics {
 public:
  [[gnu::cold]] ClearanceStatistics(const Model& model, const Joints& joints, const Channels& channels);

  bool active() const { return !joints_.empty(); }
  /// A row at the end of a step, in rising order of time and from the first instant that counts on; `e` is evaluated
  /// there, and joints have lost `joint_loss` since the start of the run. Of two at one instant the first is before an
  /// event and the second after it.
  void add(std::span<const double> row, const Evaluation& e, std::span<const double> joint_loss);
  /// The end of a contact at a time that counts, or before.
  void add_contact(int joint, double end, const ContactRecord& contact);
  void add_contact_before(int joint, const ContactRecord& contact);
  /// A contact that is on at the end.
  void add_open_contact(int joint, const ContactRecord& contact);

  /// Whether the joint has figures, and whether it has a bearing angle.
  bool has(int joint) const { return index_[static_cast<std::size_t>(joint)] >= 0; }
  bool has_table(int joint) const { return has(joint) && of(joint).is_bearing; }
  [[gnu::cold]] PlayFigures figures(int joint) const;
  BearingTable table(int joint) const;
  /// By how much the way that surfaces slide [m], and load times slip [J], vary from run to run as far as parts of this
  /// one tell, with so many contacts in it.
  struct SumNoise {
    double sliding, work;
  };
  [[gnu::cold]] SumNoise sum_noise(int joint, double contacts) const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.seen_, self.time_, self.duration_, self.joints_, self.sum_noise_);
  }

 private:
  /// What is integrated over time.
  struct Rates {
    double contact = 0.0, normal = 0.0, slip = 0.0, rub = 0.0;
    int sector = -1;
    double cosine = 0.0, sine = 0.0;  ///< of the bearing angle
    double flat = 1.0, rise = 0.0;    ///< cosine and sine of the angle from the plane of that angle
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.contact, self.normal, self.slip, self.rub, self.sector, self.cosine, self.sine, self.flat);
      archive(self.rise);
    }
  };
  struct OfJoint {
    int joint = 0, marker = 0;
    bool is_bearing = false, is_socket = false;
    double area = 0.0;  ///< 2 R_B L [m^2]; NaN: not known
    Rates last;
    double contact_time = 0.0, impulse = 0.0, sliding = 0.0, work = 0.0, largest_rub = 0.0;
    double load_x = 0.0, load_y = 0.0, impact_time = 0.0;
    double across_x = 0.0, across_y = 0.0, along_z = 0.0;  ///< of a socket: the load by its direction in space
    long impacts = 0;
    double fastest = -1.0, hardest = -1.0;
    double carried_in = 0.0, carried_out = 0.0;
    BearingTable table;  ///< pv: F_N |v_T| and its integral
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.last, self.contact_time, self.impulse, self.sliding, self.work, self.largest_rub);
      archive(self.across_x, self.across_y, self.along_z);
      archive(self.load_x, self.load_y, self.impact_time, self.impacts, self.fastest, self.hardest, self.carried_in);
      archive(self.table.contact_time, self.table.impulse, self.table.sliding, self.table.work, self.table.pv_max);
    }
  };
  const OfJoint& of(int joint) const {
    return joints_[static_cast<std::size_t>(index_[static_cast<std::size_t>(joint)])];
  }
  Rates rates(const OfJoint& joint, std::span<const double> row, const Evaluation& e) const;
  static void add_half(OfJoint& joint, const Rates& rates, double half);

  const Channels& channels_;
  double from_;
  bool seen_ = false;
  double time_ = 0.0, duration_ = 0.0;
  std::vector<int> index_;  // by joint: into joints_, or -1
  std::vector<OfJoint> joints_;
  MeanNoise sum_noise_;  // of the way and of load times slip, by joint
};

}  // namespace freeplay
