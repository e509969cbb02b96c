// ResultRecord: the provenance of a result, and of what is made from one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "results/reader.h"

namespace freeplay {

/// The record of the run that wrote the directory, with texts of model and inputs as they stand there now; null where
/// none says how it was made. A run that was killed has left it in its checkpoint.
Json record_of_directory(const std::filesystem::path& folder);

/// The record of the run with texts of model and inputs, from within an HDF5 file; null where it has none.
Json record_inside(ResultReader& reader);

/// How something was made from a result.
struct MadeOfResult {
  std::string made;                    ///< the command: "export"
  std::string command;                 ///< the command line as typed
  std::vector<std::string> arguments;  ///< what is needed to make it again, without output paths
};

/// The record of the run with texts of model and inputs, of what was made from it; null where the result has none. How
/// the run was started stands in `run`, and whether it had come to its end; in `before` what exports made the result of
/// it that is exported again.
Json record_of(const std::filesystem::path& path, ResultReader& reader, const MadeOfResult& made);

/// The summary.json of a result directory; null where there is none, or none that can be read. Throws Error{file}
/// "unreadable-result" for one whose schema this program does not know.
Json read_summary(const std::filesystem::path& folder);

/// What stands for the summary of a run that goes on or was killed: `status` "incomplete", `settings`, `provenance` and
/// the model's name, as the file of rows or the checkpoint beside it has them.
Json summary_of_unfinished(const std::filesystem::path& folder, const ResultReader& reader);

/// " (failed)" of a run that did not come to its end, for headings; empty of one that did.
std::string unfinished_words(const Json& summary);

/// Whether a run with this summary came to its end: neither killed nor interrupted, and all was written.
bool has_ended(const Json& summary);

/// The text as JSON; null where it is none.
Json json_of(const std::string& text);

}  // namespace freeplay
