#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gmock/gmock.h>

#include "assembly/assembly.h"
#include "stage/acceleration_matrix.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::load;
using test::mechanism;
using ::testing::ElementsAre;

/// A cart on a rail that carries a second, both driven, and a pendulum on the second that is free.
constexpr const char* carts =
    "freeplay: 1\n"
    "bodies: {b: {mass: 1, inertia: 1}, bob: {mass: 0.5, inertia: 0.1, com: [0, -0.3]}, a: {mass: 2, inertia: 3}}\n"
    "joints:\n"
    "  second: {type: prismatic, between: [a, b]}\n"
    "  pin: {type: revolute, between: [b, bob]}\n"
    "  first: {type: prismatic, between: [ground, a]}\n"
    "drivers: {one: {joint: first, kind: position, value: 0.1*sin(3*t)}, two: {joint: second, kind: position, value: "
    "0.2*t}}\n"
    "gravity: [0, -9.81]\n";

std::vector<std::string> names(const Model& model, const std::vector<PrescribedBody>& found) {
  std::vector<std::string> out;
  for (const PrescribedBody& one : found) out.push_back(model.bodies[static_cast<std::size_t>(one.body)].name);
  return out;
}

std::vector<std::string> prescribed_in(const std::string& text) {
  const auto model = load(text);
  const System system(*model);
  return names(*model, prescribed_bodies(system.jacobian(),
                                         std::vector<char>(static_cast<std::size_t>(system.layout().nc()), 0)));
}

TEST(PrescribedBodies, AreDrivenCranksAndWhatStandsOnThem) {
  EXPECT_THAT(prescribed_in(mechanism("3-rrr")), ElementsAre("leg1.crank", "leg2.crank", "leg3.crank"));
  EXPECT_THAT(prescribed_in(carts), ElementsAre("a", "b"));
}

TEST(PrescribedBodies, AreNoneWhereNothingIsDriven) { EXPECT_TRUE(prescribed_in(mechanism("pendulum")).empty()); }

TEST(PrescribedBodies, LoseWhatARowLeftOutHeld) {
  const auto model = load(carts);
  const System system(*model);
  std::vector<char> dependent(static_cast<std::size_t>(system.layout().nc()), 0);
  dependent[static_cast<std::size_t>(system.layout().driver_row(1))] = 1;
  EXPECT_THAT(names(*model, prescribed_bodies(system.jacobian(), dependent)), ElementsAre("a"));
}

/// The matrix written out, and its solution.
Eigen::VectorXd dense_solution(const System& system, const Evaluation& e, double beta_q, double beta_v,
                               const Eigen::VectorXd& right) {
  const int nv = system.layout().nv(), nc = system.layout().nc();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(nv + nc, nv + nc);
  for (int i = 0; i < nv; ++i) matrix(i, i) = system.inertia().mass()[static_cast<std::size_t>(i)];
  std::size_t next = 0;
  for (const ForceBlock& block : system.forces().blocks()) {
    const BodyId bodies[2] = {block.a, block.b};
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c, ++next) {
        if (bodies[r / 3] == ground || bodies[c / 3] == ground) continue;
        matrix(3 * bodies[r / 3] + r % 3, 3 * bodies[c / 3] + c % 3) -=
            beta_v * e.force_v[next] + beta_q * e.force_q[next];
      }
    }
  }
  std::vector<SparseEntry> entries;
  system.jacobian().list(e.jacobian, entries);
  for (const SparseEntry& entry : entries) {
    matrix(nv + entry.row(), entry.col()) += entry.value();
    matrix(entry.col(), nv + entry.row()) += entry.value();
  }
  return matrix.fullPivLu().solve(right);
}

/// With and without forces, at the start of a mechanism whose journals are pressed into their bearings.
void expect_solution(const std::string& text, double press) {
  const auto model = load(text);
  System system(*model);
  Start start = assemble(system);
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (double& x : start.state.q()) x += press * uniform(engine);
  for (double& x : start.state.v()) x += uniform(engine);
  Evaluation e(system);
  ASSERT_TRUE(system.evaluate(point(start.state), term_position | term_velocity | term_force | term_derivative, e));
  const int nv = system.layout().nv(), nc = system.layout().nc();
  const std::vector<char> none(static_cast<std::size_t>(nc), 0);
  const auto expect = [&](auto& matrix, const auto& factor, const auto& solve, double beta_q, double beta_v,
                          const char* name) {
    matrix.set_pattern(none);
    for (int pass = 0; pass < 2; ++pass) {  // with fresh pivots, and with those of the first pass
      ASSERT_GT(factor(), 1e-12);
      const Eigen::VectorXd right = Eigen::VectorXd::NullaryExpr(nv + nc, [&] { return uniform(engine); });
      const Eigen::VectorXd want = dense_solution(system, e, beta_q, beta_v, right);
      EXPECT_LT((solve(right) - want).norm(), 1e-9 * want.norm()) << name;
    }
  };
  const auto numbers = [](Eigen::VectorXd& x) { return std::span(x.data(), static_cast<std::size_t>(x.size())); };
  const auto solution_of = [&](StageMatrix& matrix, Eigen::VectorXd right) {
    Eigen::VectorXd update = Eigen::VectorXd::Zero(nv + nc);
    matrix.solve(numbers(right), numbers(update));
    return update;
  };
  AccelerationMatrix index_one(system);
  const auto in_place = [&](Eigen::VectorXd x) {
    index_one.solve(numbers(x).first(static_cast<std::size_t>(nv)), numbers(x).subspan(static_cast<std::size_t>(nv)));
    return x;
  };
  expect(
      index_one, [&] { return index_one.factor(e); }, in_place, 0.0, 0.0, "index 1");
  StageMatrix whole(system, false);
  expect(
      whole, [&] { return whole.factor(e, 0.0, 0.0, 0.0); }, [&](const auto& b) { return solution_of(whole, b); }, 0.0,
      0.0, "without forces");
  StageMatrix stage(system, true);
  expect(
      stage, [&] { return stage.factor(e, 1e-10, 1e-5, 0.0); }, [&](const auto& b) { return solution_of(stage, b); },
      1e-10, 1e-5, "with forces");
}

TEST(StageMatrices, SolveWhatDenseMatricesDo) {
  expect_solution(mechanism("3-rrr"), 2e-4);
  expect_solution(mechanism("slider-crank"), 1e-3);
  expect_solution(mechanism("four-bar"), 1e-3);
  expect_solution(mechanism("pendulum"), 1e-3);
  expect_solution(carts, 1e-3);
}

}  // namespace
}  // namespace freeplay
