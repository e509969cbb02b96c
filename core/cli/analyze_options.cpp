#include "cli/analyze_options.h"

namespace freeplay {

std::vector<std::string> analyze_arguments(const AnalyzeOptions& options, const CommonOptions& common) {
  std::vector<std::string> words{options.kind};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  const auto add_each = [&](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) add(option, value);
  };
  add("--frame", options.frame);
  add_each("--pose", options.pose);
  add_each("--grid", options.grid);
  add("--time", options.time);
  add_each("--input", options.input);
  add("--elbow", options.elbow);
  if (options.sensitivity) words.emplace_back("--sensitivity");
  add("--samples", options.samples);
  add("--seed", options.seed);
  add("--distribution", options.distribution);
  if (options.branches) words.emplace_back("--branches");
  if (options.coloured) words.emplace_back("--colours");
  add("--preload", options.preload);
  add_each("--set", options.build.set);
  add_each("--ideal", options.build.ideal);
  add_each("--plugin", common.plugins);
  return words;
}

}  // namespace freeplay
