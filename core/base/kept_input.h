// KeptInput: the inputs of a model that stands in a result directory.
#pragma once

#include <string>

namespace freeplay {

/// Where to read the file `path` that `model_file` names. A run keeps copies of what its model read in the folder
/// `inputs` of its result: where `path` is not there and the model stands in a result, the copy called `kept_name`.
std::string kept_input(const std::string& model_file, const std::string& path, const std::string& kept_name);

}  // namespace freeplay
