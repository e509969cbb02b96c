// BuildOptions: what the command line changes in a model.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "format/document.h"
#include "model/model.h"

namespace freeplay {

class Readout;

struct BuildOptions {
  /// Parameter, or path in the expanded model, and text; the last one of a name wins.
  std::vector<std::pair<std::string, std::string>> set;
  std::vector<std::string> ideal;                     ///< names or patterns of joints with play, or "all"
  std::optional<double> end, step;                    ///< [s]
  std::optional<double> accuracy = std::nullopt;      ///< [m per s]; in place of any step
  std::optional<std::string> integrator;              ///< name
  std::optional<ResultFormat> format = std::nullopt;  ///< of the results
  Readout* readout = nullptr;                         ///< receives what values and names came to
  std::optional<double> largest_step = std::nullopt;  ///< of runs with an accuracy [s]
  std::optional<double> interval = std::nullopt;      ///< of output rows [s]
  std::vector<std::string> channels{};                ///< patterns, in place of those of the file
  bool without_study = false;                         ///< the section `study` is not read
  std::vector<std::string>* addresses = nullptr;      ///< receives the paths of the expanded model
  std::vector<std::string>* offered = nullptr;        ///< receives those of keys that may stand there, written or not
  /// `set` gives them as maps: what the file has in their place does not count.
  bool step_by_map = false, integrator_by_map = false;
  /// Reads a list or map of `set`; a file name for messages comes second.
  std::function<std::optional<Document>(std::string, const std::string&, Diagnostics&)> parse_value{};
};

}  // namespace freeplay
