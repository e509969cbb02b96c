// KeptInput: what a result directory keeps for the model that stands in it.
#pragma once

#include <string>
#include <vector>

namespace freeplay {

/// Where to read the file `path` that `model_file` names. A run keeps copies of what its model read in the folder
/// `inputs` of its result: where `path` is not there and the model stands in a result, the copy called `kept_name`; in
/// a folder with `only_copies` always the copy.
std::string kept_input(const std::string& model_file, const std::string& path, const std::string& kept_name);

/// Marks a folder whose model is to read the copies, whatever stands at the places that it names.
inline constexpr const char* only_copies = "inputs/.only";

/// Does the model stand in a folder with `only_copies`?
bool is_kept_copy(const std::string& model_file);

/// Libraries that stand beside the copy of a model: those that it was made with, sorted.
std::vector<std::string> kept_libraries(const std::string& model_file);
/// Where they stand, from the folder of the model.
inline constexpr const char* libraries_folder = "plugins";

/// The copy of the model in a result: model.urdf, model.sdf or model.xml, else model.yaml, whether it is there or not.
std::string kept_model(const std::string& folder);

/// Name of the model whose copy stands in the result of a run; empty for another file.
std::string kept_model_name(const std::string& model_file);

/// Files of the plugins that the run was made with in whose result `model_file` stands, as they were called there.
std::vector<std::string> kept_plugins(const std::string& model_file);

}  // namespace freeplay
