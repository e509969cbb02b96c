// ResultRecord: the provenance of what is made from a result.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "results/reader.h"

namespace freeplay {

/// The record of the run with texts of model and inputs, `made` by export; null where the result has none. How the run
/// was started stands in `run`.
Json record_of_export(const std::filesystem::path& path, const ResultReader& reader, const std::string& command,
                      const std::vector<std::string>& arguments);

}  // namespace freeplay
