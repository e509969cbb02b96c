// Reading a model, and rows of results: copied by the run, made into text, and written.
#include <filesystem>
#include <numeric>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/number_text.h"
#include "bench_model.h"
#include "results/hdf5_writer.h"
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
  RecordThread::Writers writers;
  writers.push_back(std::make_unique<RowTextWriter>("/dev/null", layout));
  RecordThread thread(columns.size(), std::move(writers));
  for (auto _ : state) thread.add_row(values, columns);
  thread.close();
  state.counters["per_number"] = benchmark::Counter(
      static_cast<double>(values.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// A second of rows of 2000 channels at 1 kHz after another, as a run gives them; bytes are those of the numbers in
/// memory.
void write_seconds(benchmark::State& state, bool hdf5) {
  constexpr std::size_t channels = 2000, rows = 1000;
  RecordLayout layout;
  for (std::size_t i = 0; i < channels; ++i)
    layout.columns.push_back({i == 0 ? "time" : fmt::format("body.b{}.x", i), "m", "position", "bench"});
  layout.events = {{"time", "s", "time", "bench"}, {"joint", "1", "joint", "bench"}, {"kind", "1", "kind", "bench"}};
  std::vector<std::size_t> columns(channels);
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  std::vector<double> values(channels);
  for (std::size_t i = 0; i < channels; ++i) values[i] = std::sin(static_cast<double>(i) + 0.5);
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("freeplay-bench-{}", ::getpid());
  RecordThread::Writers writers;
  if (hdf5) {
    const Hdf5Writer::Options options{.expected_rows = 1000000, .grows = true};
    writers.push_back(std::make_unique<Hdf5Writer>(file, layout, options));
  } else {
    writers.push_back(std::make_unique<RowTextWriter>(file, layout));
  }
  RecordThread thread(channels, std::move(writers));
  values[0] = 0.0;
  for (auto _ : state) {
    for (std::size_t r = 0; r < rows; ++r) {
      values[0] += 1e-3;
      thread.add_row(values, columns);
    }
  }
  if (const std::string failure = thread.close(); !failure.empty()) state.SkipWithError(failure.c_str());
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(channels * rows * sizeof(double)));
  std::filesystem::remove(file);
}

const int file_kernels = [] {
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
  add("write/csv-2000", [](benchmark::State& s) { write_seconds(s, false); });
  add("write/hdf5-2000", [](benchmark::State& s) { write_seconds(s, true); });
  return 0;
}();

}  // namespace
}  // namespace freeplay::bench
