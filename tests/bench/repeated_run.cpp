// Runs a model again and again in one process, as programs written by hand do, and prints what the quickest took [s].
//
// repeated_run MODEL --end S --integrator NAME (--step S | --accuracy M) [--set NAME=VALUE]...
//
// Rows are made and thrown away. At most 60 runs, until 0.2 s have passed and three at least.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "load/load.h"
#include "run/simulation.h"

namespace freeplay {
namespace {

constexpr int fewest = 3, most = 60;
constexpr double long_enough = 0.2;  // [s]

class NoFile final : public Sink {
 public:
  void row(std::span<const double>) override {}
  void event(const EventRecord&) override {}
  void open_contact(const EventRecord&) override {}
  bool ok() const override { return true; }
};

BuildOptions options_of(int count, char** words) {
  BuildOptions options;
  for (int i = 0; i + 1 < count; i += 2) {
    const std::string name = words[i], value = words[i + 1];
    if (name == "--end") {
      options.end = std::stod(value);
    } else if (name == "--integrator") {
      options.integrator = value;
    } else if (name == "--step") {
      options.step = std::stod(value);
    } else if (name == "--accuracy") {
      options.accuracy = std::stod(value);
    } else if (const std::size_t equals = value.find('='); name == "--set" && equals != std::string::npos) {
      options.set.emplace_back(value.substr(0, equals), value.substr(equals + 1));
    } else {
      throw std::runtime_error("unknown word " + name);
    }
  }
  return options;
}

double quickest(const char* file, const BuildOptions& options) {
  LoadedModel loaded = load_model(file, options, {});
  const std::unique_ptr<AssembledModel> assembled = loaded.model ? assemble_model(loaded) : nullptr;
  if (!assembled) throw std::runtime_error(loaded.diagnostics.format(0));
  const Channels channels(*loaded.model);
  double best = std::numeric_limits<double>::infinity(), all = 0.0;
  for (int run = 0; run < most && (run < fewest || all < long_enough); ++run) {
    NoFile none;
    Sink* sinks[] = {&none};
    Simulation simulation(assembled->system, assembled->start, channels, sinks);
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = simulation.run({});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (outcome.status != RunStatus::completed) throw std::runtime_error(outcome.reason);
    best = std::min(best, seconds), all += seconds;
  }
  return best;
}

}  // namespace
}  // namespace freeplay

int main(int count, char** words) {
  try {
    if (count < 2) throw std::runtime_error("repeated_run MODEL [OPTION VALUE]...");
    std::printf("%.9g\n", freeplay::quickest(words[1], freeplay::options_of(count - 2, words + 2)));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
