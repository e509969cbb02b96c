#include <map>

#include "run_model.h"

namespace freeplay::test {
namespace {

std::map<std::string, Event> first_contacts(const ModelRun& run) {
  std::map<std::string, Event> first;
  for (const Event& event : run.events()) {
    if (event.kind == "contact_begin") first.try_emplace(event.joint, event);
  }
  return first;
}

ModelRun run_3rrr(double end, double step, const std::string& interval) {
  const std::string text =
      replaced(mechanism("3-rrr"), "{interval: 0.1 ms, discard: $T/5}", "{interval: " + interval + "}");
  return ModelRun(text, {.set = {}, .ideal = {}, .end = end, .step = step, .integrator = {}});
}

// The limit is what a hand-written integration of second order reaches at this step on its unlucky days, 1.4e-8 m, with
// a margin for the sensitivity of the motion.
TEST(ClearanceTrajectory, ThreeRrrFollowsTheReferenceForTwentyMilliseconds) {
  const ModelRun run = run_3rrr(20e-3, 0.5e-6, "1 ms");
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  const double worst = largest_distance(run, read_table("rrr3_friction_trajectory.csv"));
  record("worst_distance", worst);
  EXPECT_LE(worst, 1e-7);
  EXPECT_LT(run.statistics().position_residual(), 1e-10);
  EXPECT_LT(run.statistics().velocity_residual(), 1e-8);

  // Quadruple precision, contacts located: time [s] and rate of penetration [m/s].
  const std::map<std::string, std::array<double, 2>> known = {
      {"leg1.B", {0.00548333785509636, 0.0363891332871}}, {"leg3.B", {0.00590306015414261, 0.0344726453761}},
      {"leg1.C", {0.0067390359026056, 0.0751708758559}},  {"leg3.C", {0.00744866421410308, 0.0755453855636}},
      {"leg2.B", {0.00844143722135433, 0.0246816867264}}, {"leg2.C", {0.00851851940436134, 0.0612186877896}}};
  const auto first = first_contacts(run);
  double late = 0.0, speed = 0.0;
  for (const auto& [joint, numbers] : known) {
    ASSERT_TRUE(first.contains(joint)) << joint;
    late = std::max(late, std::abs(first.at(joint).time - numbers[0]));
    speed = std::max(speed, std::abs(first.at(joint).fields[0] / numbers[1] - 1.0));
  }
  record("first_contact_time_error", late);
  record("first_contact_speed_relative_error", speed);
  EXPECT_LE(late, 1e-6);
  EXPECT_LE(speed, 1e-4);  // an acceleration of 10 m/s^2 over a time error of 1e-7 s, of 0.02 m/s
}

// Errors of a hand-written program with predicted approach speeds over 10 ms: 3.9e-8, 8.6e-9, 2.3e-9, 5.9e-10 m. Single
// runs are lucky or not, so each may be three times as large; three halvings together show the order.
TEST(ClearanceTrajectory, ThreeRrrErrorsAreOfSecondOrderInTheStep) {
  const Table table = read_table("rrr3_friction_platform.csv");
  const double known[] = {3.9e-8, 8.6e-9, 2.3e-9, 5.9e-10};
  std::vector<double> errors;
  for (int i = 0; i < 4; ++i) {
    errors.push_back(largest_distance(run_3rrr(10e-3, 4e-6 / (1 << i), "0.1 ms"), table));
    record("error_at_" + std::to_string(4000 / (1 << i)) + "_ns", errors.back());
    EXPECT_LE(errors.back(), 3.0 * known[i]);
  }
  const double mean_order = order(errors[0], errors[3]) / 3.0;
  record("mean_order", mean_order);
  EXPECT_GE(mean_order, 1.7);
}

// Fourteen short contacts, then almost permanent contact. 4e-7 m is three times the unlucky run of a hand-written
// program at this step.
TEST(ClearanceTrajectory, SliderCrankFollowsTheReferenceForThirtyMilliseconds) {
  std::string text = replaced(mechanism("slider-crank"), "contact: {law: lankarani-nikravesh, restitution: 0.9}",
                              "contact: {law: lankarani-nikravesh, restitution: 0.9}\n"
                              "      friction: {law: ambrosio, mu: 0.1, v0: 1e-4, v1: 1e-3}");
  text = replaced(text, "output: {interval: 20 us, discard: 12 ms}", "output: {interval: 1 ms}");
  const ModelRun run(text, {.set = {}, .ideal = {}, .end = 30e-3, .step = 0.1e-6, .integrator = {}});
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  const double worst = largest_distance(run, read_table("slider_crank_friction_trajectory.csv"));
  record("worst_distance", worst);
  EXPECT_LE(worst, 4e-7);
  const auto first = first_contacts(run);
  ASSERT_TRUE(first.contains("wrist"));
  record("first_contact_time_error", first.at("wrist").time - 0.000227286032039783);
  EXPECT_NEAR(first.at("wrist").time, 0.000227286032039783, 1e-10);
  EXPECT_NEAR(first.at("wrist").fields[0], 4.38578314528, 1e-5);  // the cubic of a step in which contact pushes
}

// Quadruple precision, every contact located: the first ten.
TEST(ClearanceTrajectory, SliderCrankTouchesAndLosesTouchAsTheReference) {
  std::string text = replaced(mechanism("slider-crank"), "contact: {law: lankarani-nikravesh, restitution: 0.9}",
                              "contact: {law: lankarani-nikravesh, restitution: 0.9}\n"
                              "      friction: {law: ambrosio, mu: 0.1, v0: 1e-4, v1: 1e-3}");
  text = replaced(text, "output: {interval: 20 us, discard: 12 ms}", "output: {interval: 1 ms}");
  const ModelRun run(text, {.set = {}, .ideal = {}, .end = 2.6e-3, .step = 0.1e-6, .integrator = {}});
  const double begins[] = {0.000227286032039783, 0.00050974654116297, 0.000723129497430007, 0.00109907930099612,
                           0.00123185996437583,  0.0014767498789248,  0.00171999102836693,  0.00191665388614583,
                           0.00220903805839532,  0.00247739939196768};
  const double ends[] = {0.000281147931823485, 0.000556379565886364, 0.000783654294514244, 0.00116269661290457,
                         0.00130257844123677,  0.00153663203112261,  0.00179905136710703,  0.00200219886073809,
                         0.00228684667166968,  0.00253446848259282};
  std::vector<double> begin, end;
  for (const Event& event : run.events()) (event.kind == "contact_begin" ? begin : end).push_back(event.time);
  ASSERT_EQ(begin.size(), 10u);
  ASSERT_EQ(end.size(), 10u);
  double worst = 0.0;
  for (std::size_t i = 0; i < 10; ++i) {
    worst = std::max({worst, std::abs(begin[i] - begins[i]), std::abs(end[i] - ends[i])});
  }
  record("worst_time", worst);
  EXPECT_LE(worst, 1e-7);  // of a step; errors of an impact are carried to the next
}

}  // namespace
}  // namespace freeplay::test
