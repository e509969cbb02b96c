// Models of the benchmarks.
#pragma once

#include <memory>
#include <string>

#include "validation/run_model.h"

namespace freeplay::bench {

inline constexpr const char* four_bars = "validation/a02-chain";  ///< N-four-bar, `windows` of them

/// Text of a model that comes with the program.
inline std::string bench_text(const std::string& name) { return test::mechanism(name); }

/// `windows` 0: the model has no such parameter.
inline BuildOptions bench_options(int windows) {
  BuildOptions options;
  if (windows > 0) options.set.emplace_back("windows", std::to_string(windows));
  return options;
}

inline std::unique_ptr<Model> load_bench_model(const std::string& name, int windows = 0) {
  return test::load(bench_text(name), bench_options(windows));
}

}  // namespace freeplay::bench
