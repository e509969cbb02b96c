// study run: runs what is open of a study.
#pragma once

#include "cli/study_options.h"

namespace freeplay {

int study_run(const StudyOptions& options, const CommonOptions& common);

}  // namespace freeplay
