// study_page: a study as one HTML file that needs no network.
#pragma once

#include <filesystem>
#include <string>

#include "study/open_study.h"

namespace freeplay {

/// Its pictures and its points; a click on a mark shows the values of its point and the command that repeats it. Of
/// many points some are left out, which the page says. Throws Error{input} where there is no table.
std::string study_page(const OpenStudy& study, const std::filesystem::path& folder);

}  // namespace freeplay
