// ResultModel: the model that a result directory was computed from.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/json_text.h"
#include "format/build_options.h"
#include "load/options.h"
#include "model/model.h"

namespace freeplay {

/// What a result says of its model beside the file.
struct ResultWords {
  std::string name, integrator;  ///< empty: it was no result
};

/// Where `path` is a directory: makes it the model file in it, and adds to `build` the parameters and ideal joints of
/// that run by its summary, before those that are asked for, its end and its step or accuracy. Throws Error{input}
/// "file-not-found" for a directory that holds no result, of which the summary is null.
ResultWords use_model_of_result(std::string& path, const Json& summary, BuildOptions& build);

/// The model beside the rows in the folder of a result, with what its summary says if there is one. Quietly: null where
/// there is none or it has mistakes.
std::unique_ptr<Model> model_beside(const std::filesystem::path& folder, const Json& summary,
                                    const LoadOptions& options);

/// Adds to `build` what `settings` of a summary says: parameters and ideal joints before those that are asked for, the
/// end and the step or accuracy.
void use_settings(const Json& settings, BuildOptions& build);

}  // namespace freeplay
