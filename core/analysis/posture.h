// PostureSolver: where all bodies are when the platform's frame, or the inputs, are at a given place.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/QR>

#include "analysis/ideal_mechanism.h"
#include "analysis/platform_frame.h"
#include "base/jet.h"

namespace freeplay {

/// What a posture must fulfil besides the joints. Angles count up to whole turns.
struct Demand {
  double t = 0.0;                           ///< of drivers that stay [s]
  Components given{};                       ///< of the pose
  std::array<Jet, most_components> pose{};  ///< numbers of the frame's pose with time derivatives
  std::vector<Jet> inputs;                  ///< coordinates [rad or m] by input; NaN: free; empty: all free
};

/// Why a pose is out of reach.
struct Unreachable {
  int input = -1;                  ///< of the leg that fails (place in Platform::inputs); -1: not one leg
  double distance = 0.0;           ///< of a two-link leg's end pins [m]
  double least = 0.0, most = 0.0;  ///< distances that it reaches [m]
  bool contradiction = false;      ///< inputs that no posture fulfils together
  int beyond = -1;                 ///< a joint that would stand beyond an end of its way (Model::joints)
  double place = 0.0, end = 0.0;   ///< where it would stand, and that end [rad or m]
  std::string text(const IdealMechanism& mechanism) const;
};

/// Finds postures. A pose that is given whole fixes the platform, and every part by itself follows: a two-link
/// leg in closed form, in the working mode of Platform::elbow; other parts by Newton's method along the straight way
/// from a posture that is known. Other demands are met by Newton's method on the whole mechanism. Not thread-safe: one
/// for each thread; it holds work space.
class PostureSolver {
 public:
  explicit PostureSolver(const IdealMechanism& mechanism);

  /// The posture for `demand`, reached from `from` (empty where everything has a closed form). `way(s)` is the demand
  /// at share s in [0, 1] of the way. False and `why` when it cannot be reached.
  bool reach(const std::function<Demand(double)>& way, const Posture& from, Posture& posture, Unreachable& why);
  /// The same along a straight line from where `from` is.
  bool reach(const Demand& demand, const Posture& from, Posture& posture, Unreachable& why);
  /// Did the last reach() end on a fold of its branch, up to rounding? No way goes on from there: branches meet.
  bool folded() const { return folded_; }
  /// Newton's method from `posture` as it is, of bodies that may be far away, with corrections of least norm. False
  /// when it does not converge.
  bool settle(const Demand& demand, Posture& posture);
  /// The same for one part, with the platform at the demanded pose.
  bool settle(const Limb& part, const Demand& demand, Posture& posture);
  /// Puts the bodies of a part that has a closed form in the mode `elbow`; false when the pose is out of reach.
  bool place(const Limb& part, int elbow, const Demand& demand, Posture& posture) const;
  /// Puts the platform at a pose that is given whole; else returns false.
  bool place_platform(const Demand& demand, Posture& posture) const;
  /// All bodies at the origin.
  Posture blank() const;

  /// Number of driven legs that reach the pose, each by itself; `why` describes the first that does not.
  int legs_in_reach(const Demand& demand, const Posture& from, Unreachable& why);

  /// Speeds and accelerations of all bodies [m/s, rad/s and per s] for the rates of `demand`; false at a singular
  /// posture.
  bool rates(const Demand& demand, const Posture& posture, std::vector<double>& v, std::vector<double>& a);

  /// Pose of the frame, and coordinates of the inputs.
  FramePose frame(const Posture& posture) const { return frame_.pose(posture.q); }
  const PoseForm& form() const { return frame_.form(); }
  std::vector<double> inputs(const Posture& posture);
  /// The system evaluated at a posture at rest; valid until the next call.
  const Evaluation& evaluate(double t, const Posture& posture, unsigned terms);
  /// The same with speeds `v`.
  const Evaluation& evaluate_moving(double t, const Posture& posture, const std::vector<double>& v, unsigned terms);
  const IdealMechanism& mechanism() const { return mechanism_; }

 private:
  // A set of rows, and the bodies that they determine.
  struct Task {
    std::vector<BodyId> bodies;
    std::vector<int> rows;
    bool whole = false;  // pose and inputs of the demand belong to it
  };
  enum class Step { converged, too_far, contradiction };

  Task whole_task() const;
  bool place_leg(const Limb& part, const Leg& leg, const Demand& demand, Posture& posture, Unreachable& why) const;
  bool follow(const Task& task, const std::function<Demand(double)>& way, Posture& posture, Unreachable& why);
  bool settle_on_fold(const Task& task, const Demand& demand, Posture& posture);
  Step correct(const Task& task, const Demand& demand, Posture& posture, double longest, int iterations);
  void assemble(const Task& task, const Demand& demand);
  const Evaluation& look(double t, const Posture& posture, unsigned terms);
  bool load(double t, const Posture& posture, unsigned terms);
  void count_turns(Posture& posture) const;

  bool is_whole(const Demand& demand) const { return count(demand.given) == form().freedoms(); }
  void move(const Task& task, const Eigen::VectorXd& step, Posture& posture);

  const IdealMechanism& mechanism_;
  const System& system_;
  PlatformFrame frame_;
  State state_;
  Evaluation e_;
  bool folded_ = false;
  std::vector<PoseRow> pose_rows_;
  std::vector<double> increment_;
  std::vector<int> column_;     // by body: its first column in the task at hand, or -1
  std::vector<int> local_row_;  // by row of the system: its row in the task at hand, or -1
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd right_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver_;
};

}  // namespace freeplay
