// StartBranches: the positions in which a mechanism can be put together, and which of them is nearest to what is given.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "assembly/closed_mechanism.h"
#include "assembly/given_poses.h"

namespace freeplay {

/// Distance of a position: root of the sum of squares of the shifts over the model's size and of the turns [rad] from
/// the given poses; of two that are equally near to them the one that is nearer to the guess in all other bodies. All
/// positions hold the rows of the mechanism; where these leave a motion free, it is used to come as near as can be.
class StartBranches {
 public:
  /// `guess`: where the placing walk puts all bodies.
  StartBranches(ClosedMechanism& mechanism, std::span<const double> guess);

  /// Takes the position that the mechanism's state has for one of them.
  void add_found();
  /// Looks for more of them from the guess, from guesses that are turned by fixed angles, from those in which one of
  /// the given poses has half a turn more, and from the mirror images of those that are found. Does nothing in large
  /// models.
  void search();

  bool any() const { return !found_.empty(); }
  std::size_t count() const { return found_.size(); }
  /// Puts the i-th position that was found into the state.
  void take(std::size_t i);
  /// Whether a position keeps all given poses, to rounding.
  static bool keeps(const GivenPoses& given, std::span<const double> q);
  /// Puts the nearest position into the state.
  void take_nearest();
  /// Another position that is as near as the nearest, if there is one: none that a free motion leads to through others
  /// which are as near, as a rod between two balls spins.
  std::optional<std::vector<double>> as_near() const;

 private:
  struct Position {
    std::vector<double> q;
    double from_given, from_guess;
  };

  void add(std::vector<double> q);
  void come_nearer();
  void refine();
  Eigen::VectorXd slope(const Eigen::MatrixXd& ways) const;
  void count_turns_as_guessed();
  void approach(std::span<const double> start);
  void add_approached(std::span<const double> start);
  void add_from_half_turns();
  std::vector<double> turned(int seed) const;
  Eigen::VectorXd difference(std::span<const double> from, std::span<const double> to) const;
  double from_guess(std::span<const double> q) const;
  bool joined(const Position& a, const Position& b) const;
  bool nearer(const Position& a, const Position& b) const;
  const Position& nearest() const;

  ClosedMechanism& mechanism_;
  const System& system_;
  GivenPoses given_;
  std::vector<double> guess_;
  std::vector<Position> found_;
};

}  // namespace freeplay
