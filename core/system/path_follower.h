// PathFollower: the ideal mechanism led by the frames of its paths, for driven joints without a closed form.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "linear/least_squares.h"
#include "system/path_bridge.h"
#include "system/path_row.h"

namespace freeplay {

/// Of a run: as closely as the end of a way is known.
inline constexpr double shortest_path_piece = 1e-9;
/// Nearness to a singular place, as of one that the run starts in.
inline constexpr double singular_start = 1e-4;
/// ": a singular place, where ..." of a mechanism that cannot follow its path there; empty where it is far from one.
std::string words_of_place(const PathEdge& edge);

/// In the closed mechanism the rows of the drivers of such entries give way to the rows of their paths, and q follows
/// from Phi(q, t) = 0 by Newton's method, v and a from Phi_q v = nu and Phi_q a = gamma. Positions are found once along
/// the whole run, from the assembled start on, at instants so close that the way between two of them is certain. A
/// value at time t is then found from the nearest of them: it depends on t alone, never on earlier calls.
///
/// Where the rows come close to depending on each other, as of an arm that is nearly stretched, pieces of the way get
/// so short that none leaps from one branch to another. A singular place that the motion passes smoothly, to the last
/// digits of the path, is bridged; one that the path comes near to is noted, and at any other the way ends.
class PathFollower final : public FollowedMotion {
 public:
  /// `closed` at the coordinates `q` with angles counted as in `h` stands on the paths at the start time. Throws
  /// Error{input} "ik-unreachable" when it cannot move along them from there.
  [[gnu::cold]] PathFollower(const System& closed, std::span<const double> q, std::span<const double> h);

  std::unique_ptr<FollowedMotion::Work> make_work() const override;
  bool evaluate(double t, Span<TimeValue> out, FollowedMotion::Work& own, MotionFault& fault) const noexcept override;
  bool frame(int kinematics, double t, PathPose& pose, FollowedMotion::Work& own,
             MotionFault& fault) const noexcept override;
  std::span<const PathEdge> edges() const override { return edges_; }

 private:
  /// Work space of one solution; `state` is the solution.
  struct Work final : FollowedMotion::Work {
    Work(const System& system, int rows);
    State state;
    Evaluation e;
    LeastSquares solver;
    std::vector<double> right, step, before;
    std::vector<SparseEntry> entries;
  };
  enum class Found { yes, no, fault };

  [[gnu::cold]] void find_way();
  /// From the last solution to `next`, if the way there is certain and keeps away from singular places.
  [[gnu::cold]] bool advance(double next, Work& work, Work& other);
  /// Across a singular place that is about to come; false where the motion does not pass it smoothly.
  [[gnu::cold]] bool bridge(Work& work);
  [[gnu::cold]] PathBridge::End end_of_bridge(Work& work) const;
  [[gnu::cold]] bool agrees(const PathBridge& bridge, double t, const State& from, Work& work) const;
  [[gnu::cold]] void note_edges();
  [[gnu::cold]] State closest(std::size_t place, double& near) const;
  /// How far the rows in the last solution are from depending on each other: a number without unit.
  [[gnu::cold]] double nearness(const Work& work) const;
  /// The same rows and columns without units.
  [[gnu::cold]] Eigen::MatrixXd scaled_rows(const Work& work, Eigen::VectorXd& rows, Eigen::VectorXd& columns) const;
  [[gnu::cold]] PathEdge edge_at(const State& state) const;
  [[gnu::cold]] std::string names_of_moved(const Eigen::VectorXd& motion, Work& work) const;
  [[gnu::cold]] bool certain(const State& left, const State& right, Work& work);
  Found solve(double t, const State& from, Work& work, MotionFault& fault) const noexcept;
  bool assemble(double t, Work& work, MotionFault& fault) const noexcept;
  int rows() const { return static_cast<int>(kept_.size() + paths_.size()); }
  double distance(std::span<const double> a, std::span<const double> b) const;
  double scaled(std::span<const double> step) const;
  const State& nearest(double t) const;
  void evaluate_drivers(const Work& work, Span<TimeValue> out) const noexcept;
  void pose_of(int kinematics, const Work& work, PathPose& pose) const noexcept;
  bool reach(double t, Work& work, MotionFault& fault) const noexcept;
  void fail(double t, MotionFault& fault) const noexcept;

  const Model& model_;
  System system_;
  std::vector<int> kept_;    ///< rows of the closed system that stay
  std::vector<int> row_of_;  ///< by row of the closed system: its place in kept_, or -1
  std::vector<PathRow> paths_;
  std::vector<int> drivers_;  ///< that follow
  std::vector<State> way_;    ///< solutions in order of time
  std::vector<double> near_;  ///< nearness() of each
  double clear_ = 0.0;        ///< the largest so far
  double tried_ = 1.0;        ///< nearness from which a bridge was tried last
  std::vector<PathBridge> bridges_;
  std::vector<PathEdge> edges_;
  std::string lost_words_;  ///< of the place where the way ends
  double lost_ = 0.0;       ///< where the way ends before the run does; beyond the run: nowhere
};

}  // namespace freeplay
