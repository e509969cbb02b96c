// AnalyzeOptions: what `freeplay analyze` is asked.
#pragma once

#include <string>
#include <vector>

#include "analysis/request_words.h"
#include "cli/options.h"

namespace freeplay {

struct AnalyzeOptions : AnalysisWords {
  std::string model, out, svg;
  bool coloured = false, force = false;
  ModelOptions build;
};

/// The command line that makes the same table or map of a model, without the model and the files to write.
std::vector<std::string> analyze_arguments(const AnalyzeOptions& options, const CommonOptions& common);

}  // namespace freeplay
