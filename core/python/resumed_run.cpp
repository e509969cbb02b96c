#include "python/resumed_run.h"

#include "base/number_text.h"

namespace freeplay {

std::shared_ptr<OpenedModel> model_of(const Resumption& resumption, bool allow_plugins) {
  OpenRequest request;
  request.file = resumption.model;
  request.words = static_cast<const RunWords&>(resumption.words);
  request.load = {.strict = resumption.words.strict,
                  .plugins = resumption.words.plugins,
                  .allow_plugins = allow_plugins,
                  .recorded_plugins = resumption.recorded_plugins};
  request.name = resumption.model_name;
  auto model = std::make_shared<OpenedModel>(request);
  if (request.words.interval.empty() && model->model().settings.interval != resumption.interval) {
    request.words.interval = number_text(resumption.interval) + " s";  // it follows from the end, which is a later one
    model = std::make_shared<OpenedModel>(request);
  }
  return model;
}

void go_on_with(const Resumption& resumption, const std::string& path, RunRequest& request) {
  const KeptWords& words = resumption.words;
  request.out = path;
  request.force = !resumption.goes_on;
  request.inputs = words.inputs;
  request.repeat = words.repeat;
  request.seed = words.seed;
  request.verify = words.verify;
  request.twin = words.twin;
  request.resumed = &resumption;
}

}  // namespace freeplay
