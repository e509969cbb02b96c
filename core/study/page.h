// study_page: a study as one HTML file that needs no network.
#pragma once

#include <filesystem>
#include <string>

#include "study/open_study.h"

namespace freeplay {

/// Its pictures and its points; a click on a mark shows the values of its point and the command that repeats it. Of
/// many points some are left out, which the page says. `seen`: the folder of the study from where the page will stand,
/// empty in that folder; nothing else on it tells where the study lies, so it can be moved. Throws Error{input} where
/// there is no table.
std::string study_page(const OpenStudy& study, const std::filesystem::path& folder,
                       const std::filesystem::path& seen = {});

}  // namespace freeplay
