// point_words: the command that computes one point of a study by itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/plan.h"

namespace freeplay {

/// Words after `freeplay`: `run` or `analyze`, the copy of its model in the study's directory `folder`, what the point
/// sets, and the libraries that the model is made with: `plugins`, and the copies that none of them stands for by its
/// file name. In a chain the point then begins by itself.
std::vector<std::string> point_words(const StudyPlan& plan, const std::filesystem::path& folder,
                                     const StudyPoint& point, const std::vector<std::string>& plugins = {});

/// The copies in `folder` among them.
std::vector<std::string> plugins_from_copies(const StudyPlan& plan, const std::filesystem::path& folder,
                                             const StudyPoint& point, const std::vector<std::string>& plugins);

}  // namespace freeplay
