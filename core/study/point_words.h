// point_words: the command that computes one point of a study by itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/plan.h"

namespace freeplay {

/// Words after `freeplay`: `run` or `analyze`, the copy of its model in the study's directory `folder`, and what the
/// point sets. In a chain the point then begins by itself.
std::vector<std::string> point_words(const StudyPlan& plan, const std::filesystem::path& folder,
                                     const StudyPoint& point);

}  // namespace freeplay
