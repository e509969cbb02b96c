// One step of each integrator on the 3-RRR, free flight and contacts as they come in the first 8 ms.
#include <benchmark/benchmark.h>

#include "bench_model.h"

namespace freeplay::bench {
namespace {

void step(benchmark::State& state, const std::string& integrator, bool accurate) {
  BuildOptions options;
  options.integrator = integrator;
  options.end = 8e-3;
  if (accurate) {
    options.accuracy = 1e-7;
  } else {
    options.step = 4e-6;
  }
  const auto model = test::load(bench_text("3-rrr"), options);
  System system(*model);
  const Start start = assemble(system);
  const Channels channels(*model);
  double steps = 0.0;
  for (auto _ : state) {
    Simulation simulation(system, start, channels, {});
    const Outcome outcome = simulation.run({});
    if (outcome.exit_code != 0) return state.SkipWithError(outcome.reason.c_str());
    state.SetIterationTime(outcome.wall_seconds);
    steps += static_cast<double>(outcome.steps);
  }
  state.counters["per_step"] = benchmark::Counter(steps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

const int step_kernels = [] {
  const Registry registry = Registry::with_builtins();
  for (const std::string& name : registry.names(ComponentKind::integrator)) {
    for (const bool accurate : {false, true}) {
      const std::string label = std::string(accurate ? "step_accurate/" : "step/") + name;
      benchmark::RegisterBenchmark(label.c_str(), [=](benchmark::State& s) {
        step(s, name, accurate);
      })->UseManualTime();
    }
  }
  return 0;
}();

}  // namespace
}  // namespace freeplay::bench
