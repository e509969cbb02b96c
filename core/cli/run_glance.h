// RunGlance: what a run leaves to look at, on the terminal and as a page.
#pragma once

#include <filesystem>
#include <string>

#include "cli/options.h"

namespace freeplay {

/// On a terminal how the main channels went, and what makes a page of them unless there will be one; else nothing.
std::string glance(const std::filesystem::path& result, bool has_report);

/// Makes the page of a result as `freeplay report` does.
void write_report_of(const std::filesystem::path& result, const CommonOptions& common);

}  // namespace freeplay
