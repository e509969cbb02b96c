// ReportedRun: a result that is to be reported, with all that its files say of it besides rows.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "load/load.h"
#include "results/reader.h"

namespace freeplay {

struct ReportedRun {
  std::string name;  ///< of the model, with -ideal for an ideal run
  std::unique_ptr<ResultReader> reader;
  std::vector<RecordColumn> columns;  ///< of the reader, with units where the model knows them
  /// summary.json without `performance`; what else is known where a run goes on or was killed.
  Json summary = Json::object();
  std::string model_text;
  Json inputs = Json::array();   ///< `{name, sha256, text}`
  std::string note;              ///< what is missing and why; empty where nothing is
  std::unique_ptr<Model> model;  ///< null where it cannot be had
};

/// Opens a result directory, a results.csv or a results.h5. Throws Error{file} "unreadable-result".
ReportedRun open_reported(const std::filesystem::path& path, const LoadOptions& options);

/// What runs it again, for a shell.
std::string rerun_command(const ReportedRun& run);

}  // namespace freeplay
