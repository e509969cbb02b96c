// Reading a model, and a row of results: copied by the run, and made into text.
#include <filesystem>
#include <numeric>

#include <benchmark/benchmark.h>

#include "base/number_text.h"
#include "bench_model.h"
#include "results/record_layout.h"
#include "results/record_thread.h"
#include "results/text_writers.h"

namespace freeplay::bench {
namespace {

void load(benchmark::State& state, const std::string& name, int windows) {
  const std::string text = bench_text(name);
  const BuildOptions options = bench_options(windows);
  for (auto _ : state) benchmark::DoNotOptimize(test::load(text, options));
}

void text_of_row(benchmark::State& state) {
  double value = 0.1;
  std::string line;
  for (auto _ : state) {
    line.clear();
    append_number(line, value *= 1.0000001);
    benchmark::DoNotOptimize(line.data());
  }
}

void row(benchmark::State& state, const std::string& name, int windows) {
  const auto model = load_bench_model(name, windows);
  const Channels channels(*model);
  std::vector<std::size_t> columns(channels.all().size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  std::vector<double> values(columns.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i) + 0.5);
  const RecordLayout layout = record_layout(*model, channels, columns);
  std::vector<std::unique_ptr<RecordWriter>> writers;
  writers.push_back(std::make_unique<RowTextWriter>("/dev/null", layout));
  RecordThread thread(columns.size(), {.writers = std::move(writers)});
  for (auto _ : state) thread.add_row(values, columns);
  thread.close();
  state.counters["per_number"] = benchmark::Counter(
      static_cast<double>(values.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const int registered = [] {
  const auto add = [](const std::string& label, auto run) {
    return benchmark::RegisterBenchmark(label.c_str(), run)->MeasureProcessCPUTime()->UseRealTime();
  };
  add("load/slider-crank", [](benchmark::State& s) { load(s, "slider-crank", 0); });
  add("load/3-rrr", [](benchmark::State& s) { load(s, "3-rrr", 0); });
  for (const int n : {40, 320}) {
    add("load/four-bar-" + std::to_string(n), [n](benchmark::State& s) { load(s, four_bars, n); });
    add("row/four-bar-" + std::to_string(n), [n](benchmark::State& s) { row(s, four_bars, n); });
  }
  add("row/3-rrr", [](benchmark::State& s) { row(s, "3-rrr", 0); });
  add("number_text", text_of_row);
  return 0;
}();

}  // namespace
}  // namespace freeplay::bench
