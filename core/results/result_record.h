// ResultRecord: the provenance of what is made from a result.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "results/reader.h"

namespace freeplay {

/// How something was made from a result.
struct MadeOfResult {
  std::string made;                    ///< the command: "export"
  std::string command;                 ///< the command line as typed
  std::vector<std::string> arguments;  ///< what is needed to make it again, without output paths
};

/// The record of the run with texts of model and inputs, of what was made from it; null where the result has none. How
/// the run was started stands in `run`.
Json record_of(const std::filesystem::path& path, const ResultReader& reader, const MadeOfResult& made);

}  // namespace freeplay
