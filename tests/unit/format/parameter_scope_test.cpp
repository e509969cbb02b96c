#include "format/parameter_scope.h"

#include <gtest/gtest.h>

#include "model_text.h"

namespace freeplay {
namespace {

std::string mass_of(const std::string& mass, const std::string& parameters) {
  return "freeplay: 1\nparameters: " + parameters + "\nbodies:\n  a: {mass: \"" + mass + "\", inertia: 1}\n";
}

TEST(Parameters, MayReferToEachOtherInAnyOrder) {
  const Built built = build(mass_of("$c", "{c: 2*$b, b: $a + 1 kg, a: 3 kg}"));
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_DOUBLE_EQ(built.model->bodies[0].mass, 8.0);
}

TEST(Parameters, KeepTheirDimension) {
  EXPECT_EQ(build(mass_of("$l", "{l: 1 mm}")).places, "4:14 dimension-mismatch ");
}

TEST(Parameters, ReportACycleOnce) {
  const Built built = build(mass_of("$a + $b", "{a: $b, b: $a, c: $a}"));
  EXPECT_EQ(built.places, "2:14 cyclic-parameter ");
  EXPECT_NE(built.report.find("a -> b -> a"), std::string::npos);
}

TEST(Overrides, ThatCloseACycleAreBlamedForIt) {
  BuildOptions options;
  options.set = {{"l", "$k"}};
  const Built built = build(mass_of("1", "{k: $l, l: 2}"), options);
  EXPECT_EQ(built.places, "1:1 cyclic-parameter ");
  EXPECT_NE(built.report.find("--set l:1:1: error: parameter 'l' depends on itself: l -> k -> l"), std::string::npos)
      << built.report;
}

TEST(Parameters, MayFormALongChain) {
  constexpr int count = 20000;
  std::string text = "freeplay: 1\nparameters:\n  p0: 1\n";
  for (int i = count - 1; i > 0; --i) text += "  p" + std::to_string(i) + ": $p" + std::to_string(i - 1) + "\n";
  EXPECT_TRUE(build(text + "bodies: {a: {mass: $p" + std::to_string(count - 1) + ", inertia: 1}}\n").model);
}

TEST(Parameters, AreNamedWithoutHyphenAndNotReserved) {
  EXPECT_EQ(build(mass_of("1", "{l-2: 1, pi: 3}")).places, "2:14 bad-name 2:22 reserved-name ");
}

TEST(Overrides, ReplaceTheTextBeforeAnythingIsEvaluated) {
  BuildOptions options;
  options.set = {{"a", "bad("}};
  EXPECT_THROW(build(mass_of("$a", "{a: 1 q}"), options), Error);
  options.set = {{"a", "1 kg"}, {"a", "$b/2"}};
  const Built built = build(mass_of("$a", "{a: 1 q, b: 3}"), options);
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_DOUBLE_EQ(built.model->bodies[0].mass, 1.5);
  EXPECT_EQ(built.model->overrides.size(), 2u);
}

TEST(Overrides, NeedAParameter) {
  BuildOptions options;
  options.set = {{"aa", "1"}};
  try {
    build(mass_of("$a", "{a: 1}"), options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_EQ(error.hint(), "did you mean 'a'?");
  }
}

TEST(Overrides, AreBlamedForWhatTheyBreak) {
  BuildOptions options;
  options.set = {{"a", "-1 kg"}};
  const Built built = build(mass_of("2*$b", "{b: $a, a: 1 kg}"), options);
  EXPECT_EQ(built.report,
            "--set a:1:1: error: 'bodies.a.mass' must be > 0 kg, not -2 kg [out-of-range]\n"
            "    1 | -1 kg\n"
            "      | ^~~~~\n"
            "      = at m.yaml:4:13\n");
}

}  // namespace
}  // namespace freeplay
