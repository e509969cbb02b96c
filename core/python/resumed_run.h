// The model of a run that goes on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "job/resumption.h"
#include "python/run_request.h"

namespace freeplay {

/// That of `resumption`. Throws Refusal.
std::shared_ptr<OpenedModel> model_of(const Resumption& resumption, bool allow_plugins);

/// How it goes on, in the directory `path`. `resumption` outlives the run.
void go_on_with(const Resumption& resumption, const std::string& path, RunRequest& request);

}  // namespace freeplay
