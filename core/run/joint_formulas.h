// JointFormulas: what formulas and points that joints are given do inside the step that was just made.
#pragma once

#include <vector>

#include "component/formula_calls.h"
#include "run/context.h"
#include "run/five_places.h"
#include "run/light_loads.h"
#include "run/motion_pieces.h"

namespace freeplay {

/// The force of a spring or a curve may change in a small part of the way that its variables go in a step, where no
/// stage of an integrator asks for it. At five places of the step joints are asked what they ask their formulas for;
/// along cubics between them the formulas are bounded, so that nothing is too narrow to be found.
class JointFormulas {
 public:
  [[gnu::cold]] explicit JointFormulas(RunContext& run);

  bool any() const { return !joints_.empty(); }
  /// A hook of tests: switches the search off, so that a test can make a wrong run.
  void go_blind() { joints_.clear(), courses_.clear(); }
  /// The begin (0), the ends of quarters of the step, and its end, one after another, as they are evaluated (events).
  void follow(std::size_t place, const Point& here, const Evaluation& e);
  /// Whether all formulas stay where they have nothing to hide, as their variables at both ends of the step say.
  bool stay_known();
  /// The part of the step in which each formula is, to a hundredth of its range in the run, as a polynomial through
  /// five places of it shows.
  double resolved();

  /// Of a step of one size: notes what its ends show. Whether a formula may go beyond that inside, so that follow() is
  /// to be called for its places, and note_inside() after.
  bool note_ends();
  void note_inside();
  /// Once a run in steps of one size is over: formulas that do more inside of steps than their ends show.
  [[gnu::cold]] void format();

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.courses_, self.ends_, self.ends_at_);
  }

 private:
  using Numbers = std::array<double, Formula::most_variables>;
  /// A formula along the step.
  struct Course {
    const ServedFormula* formula;
    enum class Kind { force, torque, length } kind;
    bool by_angle;  ///< of a curve that may be closed
    MotionPieces variables;
    FivePlaces places{};
    double low = unbounded, high = -unbounded;  ///< in the run
    double allowed = 0.0;                       ///< by which it may be off
    int looks = 0;
    bool known = false;             ///< asked for at all places
    std::size_t count = 0;          ///< of its variables
    double beyond = 0.0, at = 0.0;  ///< farthest beyond both ends of a step of one size, and when [s]
    bool open = false;              ///< whether it may be farther in the present one
    Numbers last_change{};          ///< of the variables, in the last such step
    /// Where the formula is as good as a parabola in every step in which no variable changes by more than these.
    Numbers box_low{}, box_high{}, most_change{};
    bool has_box = false;

    bool keeps_in_box(std::span<const double> begin, std::span<const double> end) const;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.low, self.high, self.box_low, self.box_high, self.most_change, self.has_box, self.known);
      archive(self.beyond, self.at, self.last_change);
    }
  };
  struct AskedJoint {
    int joint;
    std::size_t first, end;  ///< of courses_
  };

  [[gnu::cold]] void add(int joint, const Parameter& parameter, const ParameterValue& value);
  void ask(const AskedJoint& asked, const Point& here, const Evaluation& e);
  double resolved(Course& course);
  bool show(Course& course);
  double departure(Course& course, double from, double to);
  void find_box(Course& course);
  void ask_ends();
  bool note_ends(Course& course, std::span<const double> begin, std::span<const double> end);
  static double hidden(const Course& course);
  static Interval values(const Course& course, std::span<const Interval> ranges);
  void seek_beyond(Course& course, double from, double to);
  void bound(const Course& course, double from, double to, FormulaBounds::Bounds& bounds) const;

  RunContext& run_;
  LightLoads light_;
  std::vector<AskedJoint> joints_;
  std::vector<Course> courses_;
  std::vector<FormulaCalls::Watched> calls_;          // as courses_
  std::vector<FormulaCalls::Watched> begins_, ends_;  // likewise, of the step that was looked at last
  double ends_at_ = std::nan("");                     // [s]
  std::vector<double> rate_, phi_, jacobian_, nu_, gamma_;
};

}  // namespace freeplay
