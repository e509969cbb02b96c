// Exports of a study's table, with the record of how it was made.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json_text.h"
#include "study/open_study.h"

namespace freeplay {

struct TableExport {
  const OpenStudy& study;
  std::filesystem::path folder;
  std::vector<std::string> channels;  ///< patterns of columns; none: all. The number of the point always comes
};

/// As study.csv is. Throws Error{usage} "unknown-channel", Error{input} "file-not-found".
void give_study_csv(const TableExport& of, const std::function<void(std::string_view)>& take);
/// `{"table", "columns", "units", "rows", "provenance"}`, a row a line; what is empty is null. Throws the same.
void give_study_json(const TableExport& of, const Json& provenance, const std::function<void(std::string_view)>& take);

/// study.json, and every file that it was begun from: what makes the table again.
Json study_provenance(const OpenStudy& study, const StudyFolder& folder);
/// Puts these files into a new folder. Throws Error{file} "no-provenance" for a record that has none, or names places
/// outside.
void stage_study(const Json& provenance, const std::filesystem::path& folder);

}  // namespace freeplay
