// MotionLoads: what loads that depend on the motion do inside the step that was just made.
#pragma once

#include <cmath>
#include <vector>

#include "base/formula_bounds.h"
#include "run/context.h"
#include "run/five_places.h"
#include "run/impulse_error.h"
#include "run/joint_formulas.h"
#include "run/light_loads.h"
#include "run/load_channels.h"
#include "run/motion_pieces.h"

namespace freeplay {

/// A load may act in a small part of a step's way alone, as a press that closes in the last half millimetre or a bump
/// in the angle of a crank, where no stage of an integrator meets it. Its formulas are bounded along the interpolated
/// motion by interval arithmetic, so that none is too narrow to be found. Allocates when it is made alone.
class MotionLoads {
 public:
  explicit MotionLoads(RunContext& run);

  bool any() const { return !loads_.empty() || joints_.any(); }
  /// A hook of tests: switches the search off, so that a test can make a wrong run.
  void go_blind() { loads_.clear(), joints_.go_blind(); }

  /// A longer step is not to be tried, as the last one showed [s].
  double longest() const { return longest_; }
  /// The part of the step in which each formula is, to a hundredth of its range, as a polynomial through five places of
  /// it shows, and no switch changes its side before the end. False where the motion cannot be looked at.
  bool resolved(double& part, Fault& fault);

  /// Of a step of one size: how far loads go beyond what they are at its ends.
  void note();
  /// Once the run is over: those that do more there than the ends of all steps show.
  void format();

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.longest_, self.loads_, self.joints_);
  }

 private:
  struct Formula {
    FormulaBounds bounds;
    int first_switch;                                 ///< in Layout::switches
    int component;                                    ///< of the load
    double low = unbounded, high = -unbounded;        ///< at the ends of all steps
    double beyond = 0.0, at = 0.0;                    ///< farthest beyond both ends of a step, and when [s]
    bool open = false;                                ///< whether more is to be known of it than a first look shows
    ImpulseError impulse{};                           ///< of steps of one size
    bool misses = false;                              ///< the present one may make something else of the impulse
    double made = 0.0;                                ///< what it makes of that [N s or N m s]
    double end_time = std::nan(""), end_value = 0.0;  ///< of the step before
    /// Where the channels may be until a time while the formula stays in a range that is too narrow to hide anything;
    /// empty: not known. Many steps are in one.
    std::vector<Interval> box{};
    Interval in_box{};
    double box_until = -unbounded;
    double box_steps = 16.0;  ///< to all sides of the step for which the next is looked for
    int steps_to_box = 0;     ///< before that is worth while
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.low, self.high, self.beyond, self.at, self.impulse, self.end_time, self.end_value);
      archive(self.in_box.low, self.in_box.high, self.box_until, self.box_steps, self.steps_to_box);
      archive.doubles(self.box);
    }
  };
  struct Load {
    const LoadChannels::Load* load;
    int idle;  ///< its number in IdleLoads
    std::vector<Formula> formulas{};
    MotionPieces motion;
    std::vector<double> end_values{};  ///< of its channels, of the step before
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.formulas, self.end_values);
    }
  };
  /// What a formula is compared with.
  struct Course {
    const Load& load;
    const Formula& formula;
    const double* sides;           ///< that it keeps; null: the values decide
    FivePlaces places{};           ///< from the begin of the step to a part of it
    double low = 0.0, high = 0.0;  ///< of what these show, or of the ends of the step
    double allowed = 0.0;          ///< by which it may be off
    bool crosses = false;          ///< a switch changes its side
    int looks = 0;
  };

  bool follow(Fault& fault);
  void follow_ends();
  bool is_open(const Load& load, Formula& formula);
  bool in_box(const Load& load, const Formula& formula) const;
  bool find_box(const Load& load, Formula& formula);
  bool note_ends(const Load& load, Formula& formula, double& low, double& high);
  double resolved(const Load& load, const Formula& formula);
  bool show(Course& course);
  double value(const Course& course, double s);
  double departure(Course& course, double from, double to);
  void bound(const Course& course, double from, double to);
  bool is_shown(const Course& course, double from, double to) const;
  bool may_cross(const Course& course) const;
  bool crosses(const Course& course, double s);
  void note(const Load& load, Formula& formula);
  double speed_along(const Load& load, const Formula& formula) const;
  bool misses(const Load& load, Formula& formula, const Interval& range);
  double impulse(Course& course, double from, double to);
  bool shows(const Course& course, double length) const;
  /// By how much more it may be off than both ends of a step show.
  static double allowed(const Formula& formula);
  void seek_beyond(Course& course, Formula& formula, double from, double to);

  RunContext& run_;
  LightLoads light_;
  LoadChannels channels_;
  std::vector<Load> loads_;
  JointFormulas joints_;
  double longest_ = unbounded;
  double followed_until_ = std::nan("");  ///< where the last step ended [s], after so many restarts
  long restarts_then_ = 0;
  std::vector<IntervalJet> ranges_;
  std::vector<Interval> reaches_;
  std::vector<Jet> middles_;
  std::vector<double> values_, changes_, decides_, rates_, scale_;
  FormulaBounds::Bounds bounds_;
  std::vector<FormulaBounds::Bounds> switches_;
};

}  // namespace freeplay
