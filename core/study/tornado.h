// tornado_picture: how much each axis of a study moves a number.
#pragma once

#include <filesystem>
#include <string>

#include "study/plan.h"

namespace freeplay {

/// SVG of the table in `file`, a bar an axis, the longest on top. Random axes have their rank correlation with the
/// column `value`, within the combinations of words; the others, in a picture below where there are both, the range of
/// its means at their values, with `star` about the point that sets nothing. `unit`: of the value.
std::string tornado_picture(const StudyPlan& plan, const std::filesystem::path& file, const std::string& value,
                            const std::string& unit);

}  // namespace freeplay
