// ContactRows: rows inside contacts, between those of the output grid.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "model/channel.h"
#include "run/statistics.h"
#include "system/system.h"

namespace freeplay {

/// Keeps, of the states that a run evaluates anyway, those with the largest normal force and penetration of every
/// contact, and Settings::rows_in_contact along an impact: at equal phases of the half sine that the penetration of an
/// impact without loss is, from the speed of approach to its opposite; in steps of fixed size at the ends of steps. A
/// contact that lasts over several intervals has its largest values in each in which they grow; where statistics begin
/// it counts as one that begins. What is a row is known once the next row of the grid is: rows are held back until
/// then, those of the grid that lie inside the same step, too.
class ContactRows {
 public:
  using Give = std::function<void(std::span<const double> row, bool of_grid)>;

  /// `looks_inside`: rows can be had from inside steps.
  [[gnu::cold]] ContactRows(const System& system, const Channels& channels, const Statistics& statistics,
                            bool looks_inside);

  /// Whether there can be such rows at all; without them nothing else is to be called.
  bool active() const { return !joints_.empty(); }
  /// An event of a step that was just accepted, before its end is seen.
  void pass(int joint, int event, double time, std::span<const double> fields);
  /// The row of a state at the end of a step.
  void see_end(std::span<const double> row);
  /// Fractions of that step at which an impact wants rows.
  std::span<const double> wanted_inside() const { return wanted_inside_; }
  /// The row of a state inside the step.
  void see_inside(std::span<const double> row, bool wanted);
  /// A row of the grid inside a step.
  void hold(std::span<const double> row);
  /// Nothing acts and nothing is held: rows of the grid inside the step to come can be written at once.
  bool idle() const { return held_ == 0 && !touching_; }
  // These give rows that are held back, in order of time.
  /// Before a row of the grid at `time`, the end of the last step, is written: all rows before it.
  void give_before_row(double time, const Give& give);
  /// After a step: rows up to the last row of the grid inside it; all rows where too many are held.
  void give_after_step(const Give& give);
  /// When no row of the grid follows.
  void give_all(const Give& give);

  /// What is searched for inside steps: values that a row has, and the largest so far in the present contacts.
  std::span<const double> values(std::span<const double> row);
  std::span<const double> largest() const { return largest_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.joints_, self.largest_, self.counts_, self.held_, self.touching_, self.last_given_, self.last_of_grid_,
            self.last_held_of_grid_);
    archive.list(self.slots_);
    archive.list(self.numbers_);
  }

 private:
  struct EventKind {
    bool begins, ends;
    int speed;  ///< index of the field, or -1
  };
  struct OfJoint {
    int joint, normal, penetration;  ///< columns; the second may be -1
    std::vector<EventKind> kinds;
    std::array<int, 2> best = {-1, -1};  ///< slots of the largest normal force and penetration in this interval
    bool on = false;
    double approach = 0.0;           ///< speed at which the contact began; 0: not known
    double time = 0.0, depth = 0.0;  ///< of the last end of a step in it
    double middle = 0.0, way = 0.0;  ///< of the last step; part of the way there
    double passed = 0.0;             ///< of the way, at its end
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.best, self.on, self.approach, self.time, self.depth, self.middle, self.way, self.passed);
    }
  };
  /// A row that is held back, or room for one.
  struct Slot {
    double time = 0.0;
    bool used = false, wanted = false, of_grid = false;
    bool is_next_of_grid = false;  ///< too close before one of the grid; while rows are given
    int best_of = 0;               ///< values
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.time, self.used, self.wanted, self.of_grid, self.best_of);
    }
  };

  std::span<double> numbers(std::size_t slot) { return std::span(numbers_).subspan(slot * width_, width_); }
  int slot_of(std::span<const double> row);
  void let_go(int& best);
  void begin_anew(std::size_t joint);
  int see(std::span<const double> row);
  bool go_on(OfJoint& joint, std::span<const double> row);
  void give(double until, double next_of_grid, const Give& give);

  const std::size_t width_, time_column_;
  const Statistics& statistics_;
  const int levels_;
  const bool looks_inside_;
  const double same_;  ///< rows closer to one of the grid are that one [s]
  std::vector<OfJoint> joints_;
  std::vector<double> largest_, values_;  ///< normal force and penetration by joint
  std::vector<Slot> slots_;
  std::vector<double> numbers_;  ///< by slot
  std::vector<std::size_t> order_;
  std::vector<double> wanted_inside_;
  std::size_t held_ = 0, most_held_ = 0;
  bool counts_ = false;  ///< statistics have begun
  bool touching_ = false;
  double last_given_, last_of_grid_;  ///< times of rows: given; of the grid, given
  double last_held_of_grid_;
};

}  // namespace freeplay
