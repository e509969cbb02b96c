#include "system/leg_edges.h"

#include <fmt/format.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::load;
using test::mechanism;
using test::replaced;

constexpr double run = 2.0, closest = 0.8, bends = 0.05;  // [s, s, m/s^2]

/// Of the first leg of the 3-RRR with a shorter coupler, whose platform goes straight away from the pin of its crank so
/// that at `closest` the pins are `apart` from each other, and farther (outward) or less far at other times.
std::vector<PathEdge> edges_where(double (*apart)(const Leg&, double), double away, double outward) {
  const std::string text = replaced(mechanism("3-rrr"), "l2: 240 mm", "l2: 200 mm");
  const Leg leg = *closed_form_leg(*load(text), 0);
  const double c = 0.6, s = 0.8, d = apart(leg, away);
  const auto along = [&](double pin, double direction, double off) {
    return fmt::format("{:.17g} + {:.17g}*({:.17g} + {:.17g}*(t - {:.17g})^2)", pin - off, direction, d,
                       outward * bends, closest);
  };
  const std::string path = replaced(replaced(text, "$R*cos(2*pi*t/$T)", "\"" + along(leg.ax, c, leg.cx) + "\""),
                                    "$R*sin(2*pi*t/$T)", "\"" + along(leg.ay, s, leg.cy) + "\"");
  const auto model = load(path);
  const Leg moved = *closed_form_leg(*model, 0);
  return leg_edges(*model, 0, moved, 0.0, run);
}
double stretched(const Leg& leg, double by) { return leg.crank + leg.coupler - by; }
double folded(const Leg& leg, double by) { return std::abs(leg.crank - leg.coupler) + by; }

TEST(LegEdges, NoteWhenAndHowFarFromItsReachALegIsClosest) {
  for (const double away : {1e-4, 1e-6, 1e-9}) {
    const auto far = edges_where(stretched, away, -1.0), near = edges_where(folded, away, 1.0);
    for (const auto& seen : {far, near}) {
      ASSERT_EQ(1U, seen.size()) << away;
      EXPECT_NEAR(closest, seen[0].time, 1e-6);
      EXPECT_NEAR(away, seen[0].distance, 1e-6 * away + 1e-14);
      EXPECT_FALSE(seen[0].jumps);
    }
    EXPECT_EQ("joint 'leg1.A' (its leg stretched)", far[0].joints);
    EXPECT_EQ("joint 'leg1.A' (its leg folded)", near[0].joints);
  }
}

TEST(LegEdges, SpeedsOfACrankThatTurnsBackAtTheEdgeJump) {
  for (const auto& seen : {edges_where(stretched, 0.0, -1.0), edges_where(folded, 0.0, 1.0)}) {
    ASSERT_EQ(1U, seen.size());
    EXPECT_TRUE(seen[0].jumps);
  }
}

TEST(LegEdges, AreNoneWhereALegKeepsAwayFromThem) {
  EXPECT_TRUE(edges_where(stretched, 0.05, -1.0).empty());
  EXPECT_TRUE(edges_where(folded, 0.05, 1.0).empty());
}

}  // namespace
}  // namespace freeplay
