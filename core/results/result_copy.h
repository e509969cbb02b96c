// ResultCopy: a result that stands in a directory, written once more.
#pragma once

#include <filesystem>
#include <optional>

#include "base/json_text.h"
#include "model/model.h"

namespace freeplay {

/// Copies the files of the sealed result in `from` to the directory `to`, byte for byte; files beside the result stay
/// where they are. `format`: of the rows, where they are not to be those that stand there; results.csv is then written
/// from results.h5, and the summary names the files of the copy. `summary`: of the result, as it was read.
/// Throws Error{usage} where `to` holds `from`, or results.h5 is asked for and not there; Error{file}
/// "unreadable-result" where the result is no more the one that was read, else as ResultDirectory does.
void copy_result(const std::filesystem::path& from, const Json& summary, const std::filesystem::path& to, bool force,
                 std::optional<ResultFormat> format);

}  // namespace freeplay
