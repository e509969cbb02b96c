// AskedAnalysis: an analysis that a script asked for.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "analysis/request_words.h"
#include "base/json_text.h"
#include "python/opened_model.h"

namespace freeplay {

/// What to draw besides the table.
enum class AskedMap { none, grey, coloured };

/// A column of numbers, NaN where empty, or of words.
struct AnalysedColumn {
  std::string name;
  std::vector<double> numbers{};
  std::vector<std::string> words{};
};

struct AskedAnalysis {
  std::vector<AnalysedColumn> columns;
  std::size_t rows = 0;
  Json summary;
  std::string csv;  ///< as the command writes it
  std::string map;  ///< SVG with the record of its making; empty where none was asked for
  std::vector<std::string> warnings;
};

/// Thrown where the caller wants no more of it.
struct AnalysisStopped : std::exception {
  const char* what() const noexcept override { return "stopped"; }
};

/// The table of `analyze`, and the picture of its --svg. `tick` is called now and then in the thread of the caller;
/// where it returns false the analysis ends. Throws Refusal, Error{usage}, AnalysisStopped.
AskedAnalysis analyse_model(const OpenedModel& opened, const AnalysisWords& words, AskedMap map, int threads,
                            const std::function<bool()>& tick);

}  // namespace freeplay
