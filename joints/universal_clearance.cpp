#include <array>

#include "freeplay/kit/play_parameters.h"
#include "revolute_clearance_in_space.h"

namespace freeplay {
namespace {

/// Judges the cross; the two pins judge what is theirs.
class UniversalClearance final : public Joint {
 public:
  explicit UniversalClearance(const Parameters& p) {
    const std::array<double, 3> moments = p.vector("clearance.cross.inertia");
    const double sum = moments[0] + moments[1] + moments[2];
    for (const double one : moments) {
      if (one > (1.0 + 1e-6) * (sum - one))
        throw BadParameter("clearance.cross.inertia", "out-of-range",
                           "no body has this inertia: its largest moment is above the sum of the others");
    }
  }
  void declare(JointLayout& layout) const override { layout.time_scale = unbounded; }
};

constexpr Parameter cross_rows[] = {
    {.name = "clearance.cross.mass",
     .unit = "kg",
     .default_value = required,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Mass of the cross, whose centre of mass is where its pins meet."},
    {.name = "clearance.cross.inertia",
     .kind = ParameterKind::vector,
     .unit = "kg*m^2",
     .default_value = required,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Moments of inertia of the cross about its first pin, its second pin and across both."}};
constexpr auto universal_clearance_parameters = play::joined(play::radius_rows, bearing_length_rows, play::law_rows,
                                                             play::start_rows, play::tilt_start_rows, cross_rows);

constexpr JointChain cross_chain{.first = {"first", "revolute-clearance", {1.0, 0.0, 0.0}},
                                 .second = {"second", "revolute-clearance", {0.0, 1.0, 0.0}},
                                 .body = "cross",
                                 .mass = "clearance.cross.mass",
                                 .inertia = "clearance.cross.inertia",
                                 .coordinate = "coordinate"};

}  // namespace

Component universal_clearance() {
  return joint<UniversalClearance>(
      {.name = "universal-clearance",
       .space = Space::spatial,
       .summary = "Cardan joint with play: a cross with mass, whose two pins float in their bearings.",
       .formula =
           "two revolute joints with play: of the cross about x of the first frame, and of the second frame about "
           "y of the cross; the block is that of each.",
       .validity = "As of a revolute joint with play in space.",
       .references = "Flores and Lankarani 2016, Contact Force Models for Multibody Dynamics",
       .parameters = {universal_clearance_parameters.data(), universal_clearance_parameters.size()},
       .ideal = "universal",
       .block = "clearance",
       .chain = &cross_chain});
}

}  // namespace freeplay
