// WholeResult: whether the files of a result are those that its summary speaks of.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/json_text.h"
#include "results/reader.h"

namespace freeplay {

/// The model or an input beside a result that is not the one it was made from.
struct ChangedSource {
  std::string name;       ///< "the model", "'motor.csv' of the inputs"
  std::string then, now;  ///< first digits of their fingerprints; now: "gone" where there is none left
};

/// The first of them; `record` is the provenance of the result.
std::optional<ChangedSource> changed_source(const std::filesystem::path& directory, const Json& record);

/// Why rows and events are not those that the summary counts and has fingerprints of: "'FILE' has 100 rows, its summary
/// counts 301"; empty where they are. Either of results.csv and results.h5 may be gone, not both. Reads every row;
/// throws Error{file} "unreadable-result" where a file cannot be read.
std::string misfit_of(const std::filesystem::path& directory, const Json& summary);

/// What follows the last line of results.csv or events.csv, which its run has ended: "'FILE' ends in part of a line".
/// Empty where nothing does.
std::string part_of_a_line(const std::filesystem::path& directory);

/// What is missing of that table of a file of rows, as far as a count shows: the results.h5 that it stands for, lines
/// of a results.csv that its summary counts, events that it has the fingerprint of, the end of a last line, text that
/// the record beside a table has the fingerprint of. Empty where nothing is known to be.
std::string missing_part(ResultReader& reader, const std::string& table = "results");

/// The part of it that shows without reading the rows: a results.h5 that they stand for, the end of a last line.
std::string visibly_missing(const ResultReader& reader);

}  // namespace freeplay
