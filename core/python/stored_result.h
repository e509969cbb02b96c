// StoredResult: rows and events of a result that stands in files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "model/model.h"
#include "python/column_block.h"
#include "results/comparison.h"
#include "results/record.h"

namespace freeplay {

struct StoredResult {
  RecordLayout layout;  ///< its columns are those that were read
  std::unique_ptr<ColumnBlock> block;
  std::vector<double> events;
  Json summary;           ///< null where there is none
  std::string file;       ///< what was read
  std::string directory;  ///< of the whole result; empty for a file that stands alone
  bool whole = false;     ///< all its columns were read
};

/// Reads what is complete of any result, the columns that fit `patterns`. Throws Error.
StoredResult read_result(const std::filesystem::path& path, const std::vector<std::string>& patterns);

/// Writes it once more as a result directory (results/result_copy.h); without a `format` that it has. Throws
/// Error{usage} for a part of a result, and what copy_result() throws.
void save_stored(const StoredResult& result, const std::filesystem::path& path, bool force,
                 std::optional<ResultFormat> format);

/// How far two results agree, as the command says; `notes` gets its remarks. Throws Error.
Comparison compare_results(const std::filesystem::path& a, const std::filesystem::path& b, const ComparisonRules& rules,
                           std::vector<std::string>& notes);

}  // namespace freeplay
