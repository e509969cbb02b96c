// RunWatch: what a run must remember of itself to be judged, and what ends it because going on makes no sense.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/channel.h"
#include "run/largest_values.h"
#include "run/trust.h"
#include "system/system.h"

namespace freeplay {

/// Limits of docs/trust.md that are looked at while the run goes on.
namespace trust {
/// A bearing is at most so many times as large as its play: stands for a radius that is not known.
inline constexpr double radius_by_clearance = 1000.0;
/// Mean pressure F/(2 R L) by E*: beyond the strength that a perfect crystal would have (Frenkel 1926: about G/2 pi).
inline constexpr double ideal_strength = 0.1;
/// Speed at the radius of gyration of a body that turns [m/s]: twice that of sound in steel. What turns so fast bursts:
/// the stress in a ring is its density times the square of its speed.
inline constexpr double fastest_rim = 1e4;
inline constexpr double speed_of_light = 299792458.0;  ///< [m/s]
}  // namespace trust

/// The largest force of rows in some part of a motion.
struct NearForce {
  double force = 0.0, time = 0.0;  ///< [N], [s]
  int joint = -1;
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.force, self.time, self.joint);
  }
};

/// Largest values over a run, from its start on and whatever `discard` says.
struct RunExtremes {
  struct Range {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    void add(double x) {
      if (x < least) least = x;
      if (x > most) most = x;
    }
    double span() const { return most >= least ? most - least : 0.0; }
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.least, self.most);
    }
  };
  Range kinetic, potential, work, dissipated;  ///< [J]
  double exchanged = 0.0;                      ///< work put in and taken out, both positive, by element and step [J]
  double residual = 0.0;                       ///< largest |energy residual| [J]
  double residual_time = 0.0;                  ///< when it had reached half of that [s]
  double residual_inside = 0.0;                ///< the same of rows inside of steps, whose ends may say nothing of it
  double residual_inside_time = 0.0;           ///< [s]
  /// Of each of sixteen parts of the run: largest kinetic energy [J] and largest force of a joint's rows [N].
  static constexpr std::size_t parts = 16;
  std::array<double, parts> part_kinetic{}, part_force{};
  double row_force = 0.0, row_force_time = 0.0;  ///< largest force of rows [N] and when [s]
  int row_force_joint = -1;
  /// The same where the motion is close to a singular position, not quite so close, and further away.
  NearForce near, beside, away;
  /// Forces very close to a singular position, by joint: the largest, and by how much it is above that a little
  /// farther away.
  struct NoisyForce {
    double force = 0.0, off = 0.0, time = 0.0;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.force, self.off, self.time);
    }
  };
  std::vector<NoisyForce> noisy;
  double near_change = 0.0;    ///< largest change of it from step to step near or beside [N]
  double applied_force = 0.0;  ///< largest force, or torque by L, of contacts, springs and loads [N]
  double drive_motion = 0.0;   ///< largest of |alpha| L + omega^2 L, or |a| + v^2/L, of a prescribing driver [m/s^2]
  double drive_effort = 0.0;   ///< largest force, or torque by L, of a driver that applies one [N]
  double beyond_reach = 0.0;   ///< largest distance of a body from the origin by what the lengths allow
  int farthest_body = -1;
  double rim_squared = 0.0;  ///< largest square of the speed at a body's radius of gyration [m^2/s^2]
  int fastest_rim = -1;      ///< its body
  double size = 0.0;         ///< L: of the model [m]
  double least_regularity = 1.0, singular_time = 0.0;  ///< nearest to a singular position, and when [s]
  double passed_at = unbounded;                        ///< the first singular position that was passed, if any [s]
  double open = 0.0;                                   ///< largest residual of a constraint's position [m or rad]

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.kinetic, self.potential, self.work, self.dissipated, self.residual, self.residual_time);
    archive(self.residual_inside, self.residual_inside_time);
    archive(self.part_kinetic, self.part_force, self.row_force, self.row_force_time, self.row_force_joint);
    archive(self.near, self.beside, self.away, self.noisy, self.near_change);
    archive(self.applied_force);
    archive(self.drive_motion, self.drive_effort, self.beyond_reach, self.farthest_body, self.size);
    archive(self.rim_squared, self.fastest_rim);
    archive(self.least_regularity, self.singular_time, self.passed_at, self.open);
  }
};

/// Finds out whether a motion went through a singular position. The root of the regularity is as the distance from it:
/// it falls to zero on a straight line and rises again. Where what two steps say of the next is below zero, no step has
/// seen how near the motion came.
class SingularPassage {
 public:
  /// After a step that ends at t [s].
  void add(double regularity, double t, RunExtremes& seen);
  /// Where the step that was added last ended.
  bool is_near() const { return last_ < near; }
  bool is_beside() const { return last_ >= near && last_ < beside; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.last_, self.last_t_, self.second_last_, self.second_last_t_);
  }

 private:
  static constexpr double near = 0.03;       // the root, where its course counts
  static constexpr double beside = 0.1;      // where forces that are determined are much the same
  static constexpr double there = 1e-8;      // regularity of a step that met the position
  double last_ = 1.0, last_t_ = -unbounded;  // the root
  double second_last_ = 1.0, second_last_t_ = -unbounded;
};

class RunWatch {
 public:
  /// `adaptive`: noise beside a singular position is looked for.
  [[gnu::cold]] RunWatch(const System& system, const Channels& channels, bool adaptive);

  /// Whether the force of some joint with play has grown so much that its row should be looked at: one comparison a
  /// joint.
  bool is_due(const Evaluation& e) const {
    for (const Contact& contact : contacts_) {
      if (force_squared(e, contact.joint) > contact.due) return true;
    }
    return false;
  }
  /// The row of an accepted state; `e` is evaluated there. Of the joints with play the first that is where no journal
  /// can be, or carries what no material does; else -1.
  int add(std::span<const double> row, const Evaluation& e);
  /// A row very close to a singular position, which `largest` saw last, and one a little farther from it.
  [[gnu::cold]] void add_beside(const LargestValues& largest, std::span<const double> farther, double t);
  /// How near to a singular position the last step came (NewtonStageSolver::regularity).
  void add_regularity(double regularity, double t) { passage_.add(regularity, t, seen_); }
  /// Where the motion was first seen to go through one; infinite: nowhere [s].
  double passed_at() const { return seen_.passed_at; }
  /// It was none.
  void forget_passage() { seen_.passed_at = unbounded; }
  /// EnergyAccount::exchanged() by now.
  void note_exchanged(double work) { seen_.exchanged = work; }
  /// A row inside of a step that an accuracy chose.
  void add_inside(std::span<const double> row) {
    const double residual = std::abs(row[at(channels_.energy.residual)]);
    if (!(residual > seen_.residual_inside)) return;
    seen_.residual_inside = residual, seen_.residual_inside_time = row[at(channels_.time)];
  }
  /// Largest residual of positions after a step [m or rad].
  void add_open(double residual) { seen_.open = std::max(seen_.open, residual); }
  /// Why add() returned this joint: the row is the same. Allocates.
  TrustReason why(int joint, std::span<const double> row) const;
  /// The body that was faster than any matter in the row of the last add(), by its centre of mass or at its radius of
  /// gyration, where a joint holds some body to ground; else -1.
  int runaway() const { return runaway_; }
  TrustReason why_runaway(std::span<const double> row) const;

  /// Whether some journal was deeper in its bearing than its play is wide, or pressed with a tenth of what no material
  /// bears.
  bool pressed_through() const {
    for (const Contact& contact : contacts_) {
      if (contact.depth.most > contact.play || contact.hardest > 0.01 * contact.strongest * contact.strongest)
        return true;
    }
    return false;
  }
  /// How many times as hard a joint with play pressed as its stiffness alone does at that depth, in the contact with
  /// the largest force of those in which that was more than most_damped where it pressed hardest and nearly deepest, if
  /// that force is a good part of the largest of all; else 0. Of a force by delta^1.5; of one by delta 0.8 of it.
  double damped_by(int joint) const;
  static constexpr double most_damped = 8.0;  ///< a law for a restitution of 0.2 needs 7
  /// Whether the journal of a joint with play never moved in its bearing, nor touched it.
  bool never_moved(int joint) const;
  const RunExtremes& seen() const { return seen_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.passage_, self.contacts_, self.seen_, self.last_force_, self.was_close_);
  }

 private:
  SingularPassage passage_;
  /// Surfaces that touch, from when they meet until they part.
  struct Press {
    double deepest = 0.0;                 // [m]
    double most = 0.0, depth_then = 0.0;  // square of the largest force [N^2], depth there [m]
    double by_spring = 0.0;               // there: force times depth by what the contact stores
    void add(double squared, double depth, double stored) {
      deepest = std::max(deepest, depth);
      if (squared > most) most = squared, depth_then = depth, by_spring = std::sqrt(squared) * depth / stored;
    }
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.deepest, self.most, self.depth_then, self.by_spring);
    }
  };
  struct Contact {
    int joint = 0, penetration = -1;
    double play = 0.0;       // clearance [m]
    double deepest = 0.0;    // clearance and smaller radius [m]
    double strongest = 0.0;  // force that no material carries [N]
    RunExtremes::Range depth{};
    double due = 0.0;      // square of the force from which on the row is looked at again [N^2]
    double hardest = 0.0;  // square of the largest force [N^2]
    Press now{};           // since the surfaces met last
    Press damped{};        // the one with the largest force of those that damping has pressed too hard
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.depth, self.due, self.hardest, self.now, self.damped);
    }
  };
  static Press harder_damped(const Press& one, const Press& other);
  static double force_squared(const Evaluation& e, int joint) {
    const double* f = &e.wrench[12 * static_cast<std::size_t>(joint) + 6];
    return f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
  }
  void add_places(std::span<const double> row);
  void add_speeds(std::span<const double> row);
  void add_energy(std::span<const double> row, std::size_t part);
  void add_forces(std::span<const double> row, std::size_t part);
  void add_change(double force);
  void add_drivers(std::span<const double> row, const Evaluation& e);

  const System& system_;
  const Channels& channels_;
  std::vector<Contact> contacts_;
  struct Reach {
    int body, column;
    double inverse_squared;  // of the largest distance from the origin [1/m^2]
  };
  std::vector<Reach> reaches_;
  struct Mover {
    int body, velocity, directions;  // the first column of its velocity; after so many that of its turning comes
    double gyration_squared;         // [m^2]; 0: it may turn as fast as it likes
    double rim_squared(std::span<const double> row) const;
    double speed_squared(std::span<const double> row) const;
  };
  std::vector<Mover> movers_;
  int runaway_ = -1;
  std::vector<char> has_rows_;        // by joint
  std::vector<double> values_aside_;  // PeakValues
  bool planar_;
  double last_force_ = 0.0;  // of joints' rows, at the last look [N]
  bool was_close_ = false;   // to a singular position, there
  RunExtremes seen_;
};

}  // namespace freeplay
