#include "cli/analyze_options.h"

namespace freeplay {

std::vector<std::string> analyze_arguments(const AnalyzeOptions& options, const CommonOptions& common) {
  std::vector<std::string> words = arguments_of(options, options.coloured);
  const auto add_each = [&](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) words.insert(words.end(), {option, value});
  };
  add_each("--set", options.build.set);
  add_each("--ideal", options.build.ideal);
  add_each("--plugin", common.plugins);
  return words;
}

}  // namespace freeplay
