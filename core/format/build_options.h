// BuildOptions: what the command line changes in a model.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/model.h"

namespace freeplay {

class Readout;

struct BuildOptions {
  std::vector<std::pair<std::string, std::string>> set;  ///< parameter and text; the last one of a name wins
  std::vector<std::string> ideal;                        ///< names or patterns of joints with play, or "all"
  std::optional<double> end, step;                       ///< [s]
  std::optional<double> accuracy = std::nullopt;         ///< [m per s]; in place of any step
  std::optional<std::string> integrator;                 ///< name
  std::optional<ResultFormat> format = std::nullopt;     ///< of the results
  Readout* readout = nullptr;                            ///< receives what values and names came to
  std::optional<double> largest_step = std::nullopt;     ///< of runs with an accuracy [s]
  std::optional<double> interval = std::nullopt;         ///< of output rows [s]
  std::vector<std::string> channels{};                   ///< patterns, in place of those of the file
};

}  // namespace freeplay
