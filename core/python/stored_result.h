// StoredResult: rows and events of a result that stands in files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "python/column_block.h"
#include "results/comparison.h"
#include "results/record.h"

namespace freeplay {

struct StoredResult {
  RecordLayout layout;  ///< its columns are those that were read
  std::unique_ptr<ColumnBlock> block;
  std::vector<double> events;
  Json summary;           ///< null where there is none
  std::string directory;  ///< of the whole result; empty for a file that stands alone
};

/// Reads what is complete of any result, the columns that fit `patterns`. Throws Error.
StoredResult read_result(const std::filesystem::path& path, const std::vector<std::string>& patterns);

/// How far two results agree, as the command says; `notes` gets its remarks. Throws Error.
Comparison compare_results(const std::filesystem::path& a, const std::filesystem::path& b, const ComparisonRules& rules,
                           std::vector<std::string>& notes);

}  // namespace freeplay
