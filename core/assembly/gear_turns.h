// GearTurns: whole turns of angles that gears with an offset of their own tie.
#pragma once

#include <span>
#include <vector>

#include "system/layout.h"

namespace freeplay {

/// Angles are known from the positions of bodies up to whole turns. Where a gear holds with a given offset, the turns
/// of one of its joints follow from the coordinate of the other: of a rack at 1 m on a pinion of 0.1 m that it stands
/// at 10 rad. Starts from joints that are `counted` already; where a train of gears has none, the first of its angles
/// lies in (-pi, pi], or, with `from_slides`, its turns follow from where its slides are.
class GearTurns {
 public:
  /// `counted`: by joint, whether its coordinate is given.
  GearTurns(const Model& model, const Layout& layout, std::vector<bool> counted, bool from_slides);

  /// Sets the turns in the history `h` near which angles are counted, from coordinates [rad or m] by joint. True when
  /// a coordinate changes by that.
  bool recount(std::span<const double> coordinate, std::span<double> h);

  /// Sets the turns in `h` of the joints that lead a train, as many as bring its angles nearest to those `given` by
  /// joint up to whole turns (NaN: none), by the sum of squares after the best turn of the whole train.
  void turn_leads(std::span<const double> given, std::span<double> h) const;

 private:
  struct Link {
    int from, to, turn;  ///< joints, and where `h` keeps the turns of `to`
    double ratio, offset;
  };
  struct Lead {
    int joint, turn;
    std::size_t first;  ///< of its links
  };
  std::vector<Link> links_;
  std::vector<Lead> leads_;
  std::vector<double> counted_as_;  ///< by joint, while links are followed
};

}  // namespace freeplay
