// One look at the equations, and one matrix of a stage filled in, factored and solved with.
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "assembly/assembly.h"
#include "bench_model.h"
#include "stage/matrix.h"

namespace freeplay::bench {
namespace {

constexpr unsigned all_terms = term_position | term_velocity | term_acceleration | term_force | term_derivative;

/// A model of the benchmarks at its start.
struct AtStart {
  explicit AtStart(const std::string& name, int windows = 0)
      : model(load_bench_model(name, windows)), system(*model), start(assemble(system)), e(system) {}
  std::unique_ptr<Model> model;
  System system;
  Start start;
  Evaluation e;
};

void evaluate(benchmark::State& state, AtStart at, unsigned terms) {
  for (auto _ : state) {
    at.start.state.t() += 1e-12;  // nothing of the last look is of use
    if (!at.system.evaluate(point(at.start.state), terms, at.e)) state.SkipWithError("an element failed");
    benchmark::DoNotOptimize(at.e.force.data());
  }
  state.counters["per_body"] =
      benchmark::Counter(static_cast<double>(at.model->bodies.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

struct Factored : AtStart {
  explicit Factored(const std::string& name, int windows = 0) : AtStart(name, windows), matrix(system, true) {
    const auto rows = static_cast<std::size_t>(system.layout().nc());
    matrix.set_pattern(std::vector<char>(rows, 0));
    if (!system.evaluate(point(start.state), all_terms, e)) throw std::runtime_error("an element failed");
    right.assign(static_cast<std::size_t>(system.layout().nv()) + rows, 0.0);
    update = right;
  }
  double factor() { return matrix.factor(e, 1e-12, 1e-6, 1e-6); }
  StageMatrix matrix;
  std::vector<double> right, update;
};

void factor(benchmark::State& state, const std::string& name, int windows) {
  Factored at(name, windows);
  for (auto _ : state) benchmark::DoNotOptimize(at.factor());
}

void solve(benchmark::State& state, const std::string& name, int windows) {
  Factored at(name, windows);
  at.factor();
  for (auto _ : state) {
    std::ranges::fill(at.right, 1.0);
    at.matrix.solve(at.right, at.update);
    benchmark::DoNotOptimize(at.update.data());
  }
}

const int system_kernels = [] {
  struct {
    const char* label;
    const char* name;
    int windows;
  } const models[] = {{"slider-crank", "slider-crank", 0}, {"3-rrr", "3-rrr", 0},
                      {"four-bar-5", four_bars, 5},        {"four-bar-40", four_bars, 40},
                      {"four-bar-320", four_bars, 320},    {"four-bar-1000", four_bars, 1000}};
  for (const auto& m : models) {
    const std::string label = m.label;
    const auto add = [&](const std::string& what, auto run) {
      benchmark::RegisterBenchmark((what + "/" + label).c_str(), run);
    };
    add("evaluate",
        [m](benchmark::State& s) { evaluate(s, AtStart(m.name, m.windows), all_terms & ~unsigned{term_derivative}); });
    add("evaluate_derivatives", [m](benchmark::State& s) { evaluate(s, AtStart(m.name, m.windows), all_terms); });
    add("factor", [m](benchmark::State& s) { factor(s, m.name, m.windows); });
    add("solve", [m](benchmark::State& s) { solve(s, m.name, m.windows); });
  }
  return 0;
}();

}  // namespace
}  // namespace freeplay::bench
