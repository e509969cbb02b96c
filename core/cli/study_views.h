// Views of a study: what it is, how far it is, and the commands of its points.
#pragma once

#include "cli/study_options.h"

namespace freeplay {

int study_plan(const StudyOptions& options, const CommonOptions& common);
int study_status(const StudyOptions& options, const CommonOptions& common);
int study_merge(const StudyOptions& options, const CommonOptions& common);
int study_point(const StudyOptions& options, const CommonOptions& common);
int study_plot(const StudyOptions& options, const CommonOptions& common);
int study_verify(const StudyOptions& options, const CommonOptions& common);
int study_script(const StudyOptions& options, const CommonOptions& common);

}  // namespace freeplay
