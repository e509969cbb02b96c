// AskedAnalysis: an analysis that a script asked for.
#pragma once

#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "analysis/request_words.h"
#include "analysis/table.h"
#include "python/opened_model.h"

namespace freeplay {

/// What to draw besides the table.
enum class AskedMap { none, grey, coloured };

struct AskedAnalysis {
  AnalysisTable table;
  std::string map;  ///< SVG with the record of its making; empty where none was asked for
  std::vector<std::string> warnings;
};

/// Thrown where the caller wants no more of it.
struct AnalysisStopped : std::exception {
  const char* what() const noexcept override { return "stopped"; }
};

/// The table of `analyze`, and the picture of its --svg. `tick` is called now and then; where it returns false the
/// analysis ends. Throws Refusal, Error{usage}, AnalysisStopped.
AskedAnalysis analyse_model(const OpenedModel& opened, const AnalysisWords& words, AskedMap map, int threads,
                            const std::function<bool()>& tick);

}  // namespace freeplay
