// How long analyses take: inverse kinematics in closed form and by Newton's method, maps of errors, singularities and
// workspaces on grids of 200 x 200. Times of maps are those of two threads by the clock.
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>

#include "analysis/clearance_error.h"
#include "analysis/play_samples.h"
#include "analysis/singularity.h"
#include "analysis/station.h"
#include "analysis/workspace.h"
#include "component/registry.h"
#include "format/model_builder.h"
#include "source_folder.h"
#include "yaml/document.h"

namespace freeplay {
namespace {

constexpr Components whole{true, true, true};
constexpr int threads = 2;

std::unique_ptr<Model> mechanism_model(const std::string& name) {
  const std::string file = std::string(test::source_folder()) + "/mechanisms/" + name + ".yaml";
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  static const Registry registry = Registry::with_builtins();  // models point into it
  Diagnostics diagnostics;
  const std::optional<Document> document = parse_yaml(text.str(), file, diagnostics);
  std::unique_ptr<Model> model;
  if (document) model = build_model(*document, registry, {}, diagnostics);
  if (!model) throw std::runtime_error(diagnostics.format(0));
  return model;
}

struct Subject {
  explicit Subject(const std::string& name) : model(mechanism_model(name)), mechanism(*model, platform_of(*model)) {}
  std::unique_ptr<Model> model;
  IdealMechanism mechanism;
};

Demand pose(double x, double y, double angle) {
  Demand demand;
  demand.given = whole;
  demand.pose = {Jet::constant(x), Jet::constant(y), Jet::constant(angle)};
  return demand;
}

std::array<GridValues, 3> square(double half) {
  const GridValues axis{{}, -half, half, 200, false};
  return {axis, axis, GridValues::one(0.0)};
}

/// Poses in a second, one thread; all within reach.
void inverse_kinematics(benchmark::State& state, const std::string& name) {
  Subject subject(name);
  PostureSolver solver(subject.mechanism);
  Posture posture = subject.mechanism.closed_form() ? solver.blank() : subject.mechanism.start();
  const Posture from = subject.mechanism.closed_form() ? Posture{} : posture;
  Unreachable why;
  long k = 0;
  Demand demand = pose(0.0, 0.0, 0.0);
  const auto way = [&](double) -> Demand { return demand; };
  for (auto _ : state) {
    const double turn = 0.01 * static_cast<double>(++k);
    demand = pose(0.05 * std::cos(turn), 0.05 * std::sin(turn), 0.1);
    const bool reached = subject.mechanism.closed_form() ? solver.reach(way, from, posture, why)
                                                         : solver.reach(demand, from, posture, why);
    if (!reached) state.SkipWithError("out of reach");
    benchmark::DoNotOptimize(posture.q.data());
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(inverse_kinematics, three_rrr, "3-rrr");
BENCHMARK_CAPTURE(inverse_kinematics, four_rrr, "4-rrr");
BENCHMARK_CAPTURE(inverse_kinematics, three_rpr, "3-rpr");

/// The map from nothing: poses, then the exact and the least-squares bounds at each.
void error_map(benchmark::State& state, const std::string& name) {
  Subject subject(name);
  for (auto _ : state) {
    const auto stations = on_grid(subject.mechanism, square(0.2), whole, threads);
    in_parallel(stations.size(), threads, {}, [&](int, std::size_t first, std::size_t last) {
      PostureSolver solver(subject.mechanism);
      VelocityMapper mapper(subject.mechanism, whole);
      VelocityMap map;
      for (std::size_t i = first; i < last; ++i) {
        if (!stations[i].reachable) continue;
        mapper.map(solver.evaluate(0.0, stations[i].posture, term_position), map);
        benchmark::DoNotOptimize(clearance_error(subject.mechanism, map));
      }
    });
  }
  state.SetItemsProcessed(state.iterations() * 200 * 200);
}
BENCHMARK_CAPTURE(error_map, three_rrr, "3-rrr")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(error_map, four_rrr, "4-rrr")->Unit(benchmark::kMillisecond)->UseRealTime();

void singularity_map(benchmark::State& state, const std::string& name) {
  Subject subject(name);
  for (auto _ : state) {
    const auto stations = on_grid(subject.mechanism, square(0.2), whole, threads);
    in_parallel(stations.size(), threads, {}, [&](int, std::size_t first, std::size_t last) {
      PostureSolver solver(subject.mechanism);
      VelocityMapper mapper(subject.mechanism, whole);
      VelocityMap map;
      for (std::size_t i = first; i < last; ++i) {
        if (!stations[i].reachable) continue;
        mapper.map(solver.evaluate(0.0, stations[i].posture, term_position), map);
        benchmark::DoNotOptimize(singularity_of(map, subject.mechanism.length()));
      }
    });
  }
  state.SetItemsProcessed(state.iterations() * 200 * 200);
}
BENCHMARK_CAPTURE(singularity_map, four_rrr, "4-rrr")->Unit(benchmark::kMillisecond)->UseRealTime();

void workspace(benchmark::State& state, const std::string& name) {
  Subject subject(name);
  const auto axes = square(0.3);
  for (auto _ : state) {
    const auto stations = on_grid(subject.mechanism, axes, whole, threads);
    benchmark::DoNotOptimize(workspace_shape(subject.mechanism, stations, axes, {0, 1}));
  }
  state.SetItemsProcessed(state.iterations() * 200 * 200);
}
BENCHMARK_CAPTURE(workspace, four_rrr, "4-rrr")->Unit(benchmark::kMillisecond)->UseRealTime();

/// Samples of random play in a second, one thread.
void play_samples(benchmark::State& state, const std::string& name, PlayLaw::Kind kind) {
  Subject subject(name);
  PostureSolver solver(subject.mechanism);
  VelocityMapper mapper(subject.mechanism, whole);
  Posture posture;
  Unreachable why;
  if (!solver.reach(pose(0.05, 0.02, 0.0), {}, posture, why)) state.SkipWithError("out of reach");
  VelocityMap map;
  mapper.map(solver.evaluate(0.0, posture, term_position), map);
  constexpr long count = 10'000;
  for (auto _ : state) benchmark::DoNotOptimize(sample_play(subject.mechanism, map, count, 1, {kind}));
  state.SetItemsProcessed(state.iterations() * count);
}
BENCHMARK_CAPTURE(play_samples, three_rrr_uniform, "3-rrr", PlayLaw::Kind::uniform)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(play_samples, four_rrr_uniform, "4-rrr", PlayLaw::Kind::uniform)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(play_samples, four_rrr_normal, "4-rrr", PlayLaw::Kind::normal)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(play_samples, four_rrr_rim, "4-rrr", PlayLaw::Kind::rim)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace freeplay
