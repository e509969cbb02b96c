// PeakNoise: how far the digits of the largest values of a run mean anything.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "model/model.h"
#include "run/peak_values.h"
#include "run/ringing.h"

namespace freeplay {

/// Impacts make small differences grow: what another step, machine or start changes by little changes the impacts that
/// follow more and more. So do motions without impacts, of which SmallDifference says how much they do. Two estimates,
/// both without a second run, for each group of bodies that joints, gears and springs hold together:
///
/// 1. Growth. Of a difference of half a hundredth of the play, what has come of it at the time of a peak is
///    g = min(1, 0.005 (2.7^n - 1)) of all that chance can do. n counts the impacts so far, in the joint of the group
///    that has most, that come faster than the body left the contact before: those that do not, as of a ball that comes
///    to rest, let differences die out.
/// 2. What chance can do. The time of the statistics is cut into 32 parts. Those whose largest value is above that of
///    the part before and not below that of the next are separate bursts, as neighbours show the same one, and their
///    values X1 > X2 > ... are taken as draws from a distribution with an exponential tail, whose scale is the mean of
///    i (X_i - X_i+1) over the first five (Weissman 1978, J Am Stat Assoc 73). 3 times that, at least X1 - X2, is the
///    noise: it has 95 % of the differences of two such maxima where the tail ends, as forces do. Where five parts
///    agree to a hundredth the same peak comes again and again, and a hundredth of it is: another start may settle to a
///    motion a little beside. The forces of all loose joints of the group must agree so, as one alone does by chance,
///    or the five to 1e-4.
/// 3. What comes later. A peak that stands early in the window, where little has grown yet, is that of every run, but
///    what chance does after it may pass it: the noise reaches to as far as 2. says of the bursts after it.
///
/// 4. Ringing under an accuracy. Where all contacts of the group stay less deep than the accuracy and one of them
/// rests, errors within it let the force swing about what it would be: the noise is at least the largest such swing
/// (see Ringing).
///
/// The noise is the peak at most: then its power of ten is all that is known.
///
/// Where differences do not grow and nothing rings the noise is zero, and so is that of loads that the model gives. The
/// cost is a comparison for each value and step.
class PeakNoise {
 public:
  [[gnu::cold]] PeakNoise(const Model& model, const PeakValues& places);

  /// Values inside the window of the statistics, in rising order of time [s].
  void see(double t, std::span<const double> values) { add(t, values); }
  /// An event of a joint: contacts begin and end with a field `speed` [m/s].
  void event(int joint, int event, std::span<const double> fields);
  /// What SmallDifference knows of each group now.
  void differences_grow(std::span<const double> grown) { std::ranges::copy(grown, grown_.begin()); }

  /// Whether anything in the model can touch.
  bool active() const { return active_; }
  /// Whether differences have grown in any group.
  bool differences_grew() const {
    return std::ranges::any_of(grown_, [](double grown) { return grown > 0.0; });
  }
  /// By how much the largest value may differ in another run; of its unit.
  double of(std::size_t value) const;
  /// What has become of a small difference by now, of all that chance can do to a value: g of the class.
  double grown(std::size_t value) const;
  /// Whether the loose joints that a value hangs on have the same peaks again and again.
  bool is_settled(std::size_t value) const { return !active_ || groups_[value] < 0 || repeats(groups_[value]); }
  /// Whether two values hang on the same impacts.
  bool share_chance(std::size_t a, std::size_t b) const {
    return active_ && groups_[a] >= 0 && groups_[a] == groups_[b];
  }
  /// Impacts that let differences grow, in the joint that has most.
  int growing_impacts() const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.part_end_, self.parts_over_, self.impacts_, self.grown_, self.values_, self.contacts_, self.ringing_,
            self.shallow_);
  }

 private:
  static constexpr std::size_t parts = 32;
  struct Part {
    double largest = 0.0;
    double grown = 0.0;  // at that time
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.largest, self.grown);
    }
  };
  struct Value {
    std::array<Part, parts> part{};
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.part);
    }
  };
  struct Contact {
    double separation = -1.0;  // speed after the last one [m/s]; negative: there was none
    int growing = 0;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.separation, self.growing);
    }
  };
  struct ShallowContact {
    std::size_t depth = 0;  // the value of its penetration
    int steps = 0;          // in a row that it was on; negative: one of its group was deeper than the accuracy
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.steps);
    }
  };
  struct EventKind {
    bool begins = false, ends = false;
    int speed = -1;  // index of the field
  };
  void add(double t, std::span<const double> values);
  void follow_ringing(std::span<const double> values);
  std::span<const Part> seen(std::size_t value) const { return std::span(values_[value].part).first(parts_over_ + 1); }
  double largest_seen(std::size_t value) const;
  double by_chance(std::size_t value) const;
  double by_ringing(std::size_t value) const;
  /// By how much the largest of five parts differs from the fifth.
  double apart(std::size_t value) const;
  /// How far bursts reach beyond the largest of them by chance, and that one, of the parts that are `chosen`.
  struct Bursts {
    double largest = 0.0, beyond = 0.0;
  };
  static Bursts bursts(std::span<const Part> seen, const std::function<bool(const Part&)>& chosen);
  /// Whether all loose joints of a group have the same peak again and again.
  bool repeats(int group) const;

  bool active_ = false;
  double accuracy_;  ///< 0: steps of one size [m]
  double from_, part_length_, part_end_;
  std::size_t parts_over_ = 0;
  std::vector<int> impacts_;   // by group
  std::vector<double> grown_;  // by group: what has become of a small difference, of all that chance can do
  std::vector<int> groups_;    // of each value
  std::vector<Value> values_;
  std::vector<Ringing> ringing_;  // of each value, in a run with error control
  std::vector<ShallowContact> shallow_;
  std::vector<int> rests_;           // by group: for how many steps a contact has been on, less deep than the accuracy
  std::vector<Contact> contacts_;    // by joint
  std::vector<std::size_t> forces_;  // the value of each joint
  std::vector<std::vector<EventKind>> kinds_;  // by joint and event
};

}  // namespace freeplay
