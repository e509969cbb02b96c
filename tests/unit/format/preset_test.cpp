#include "format/preset.h"

#include <gtest/gtest.h>

#include "model_text.h"

namespace freeplay {
namespace {

double mass(const std::string& presets, const std::string& body) {
  const Built built = build("freeplay: 1\npresets: " + presets + "\nbodies: {a: " + body + "}\n");
  EXPECT_TRUE(built.model) << built.report;
  return built.model ? built.model->bodies[0].mass : 0.0;
}

TEST(Presets, GiveWayToKeysOfTheMapItself) {
  EXPECT_EQ(mass("{p: {mass: 2, inertia: 1}}", "{use: p}"), 2.0);
  EXPECT_EQ(mass("{p: {mass: 2, inertia: 1}}", "{use: p, mass: 3}"), 3.0);
}

TEST(Presets, ALaterNameWins) {
  EXPECT_EQ(mass("{p: {mass: 2, inertia: 1}, q: {mass: 4}}", "{use: [p, q]}"), 4.0);
  EXPECT_EQ(mass("{p: {mass: 2, inertia: 1}, q: {mass: 4}}", "{use: [q, p]}"), 2.0);
}

TEST(Presets, MayUsePresets) {
  EXPECT_EQ(mass("{p: {use: q, inertia: 1}, q: {mass: 4, inertia: 2}}", "{use: p}"), 4.0);
}

TEST(Presets, AreCheckedWhereTheyAreUsed) {
  const Built built = build(
      "freeplay: 1\npresets:\n  p: {mas: 1, inertia: -1}\nbodies:\n  a: {use: p, mass: 1}\n  b: {use: p, mass: 1}\n");
  EXPECT_EQ(built.places, "3:7 unknown-key 3:24 out-of-range ");
  EXPECT_NE(built.report.find("unknown key 'mas' in 'presets.p' [unknown-key]"), std::string::npos);
  EXPECT_NE(built.report.find("      = used in 'bodies.a'\n"), std::string::npos);
}

TEST(Presets, MustExistAndNotUseThemselves) {
  EXPECT_EQ(build("freeplay: 1\npresets:\n  p: {use: q}\n  q: {use: p}\nbodies:\n"
                  "  a: {use: p, mass: 1, inertia: 1}\n  b: {use: r, mass: 1, inertia: 1}\n")
                .places,
            "4:12 cyclic-preset 7:12 unknown-name ");
}

TEST(Presets, OfOneEntryAreLimited) {
  std::string presets = "freeplay: 1\npresets:\n", use;
  for (int i = 0; i < 300; ++i) {
    presets += "  p" + std::to_string(i) + ": {mass: 1}\n";
    use += (i > 0 ? ", p" : "p") + std::to_string(i);
  }
  const Built built = build(presets + "bodies: {b: {inertia: 1, use: [" + use + "]}}\n");
  EXPECT_NE(built.report.find("an entry uses more than 256 presets [too-large]"), std::string::npos);
}

TEST(Presets, ServeTheBlockOfAJointWithPlay) {
  const Built built =
      build(with_rod("presets: {fit: {gap: 1 mm, contact: {law: power, K: 1}}}\n"
                     "joints: {a: {type: pin, between: [ground, rod], play: {use: fit, gap: 2 mm}}}\n"));
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_DOUBLE_EQ(built.model->joints[0].layout.clearance, 2e-3);
}

}  // namespace
}  // namespace freeplay
