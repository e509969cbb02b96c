// RunWords: what a caller wants of a model or of its run, in words of the command line.
#pragma once

#include <string>
#include <vector>

#include "format/build_options.h"
#include "model/model.h"

namespace freeplay {

/// Of everything that reads a model.
struct ModelOptions {
  std::vector<std::string> set, ideal;
};

/// Of everything that runs one; empty: what the file says.
struct RunWords {
  std::string end, step, accuracy, interval, integrator, format;
  std::vector<std::string> channels;
  ModelOptions model_options;
};

/// NAME=VALUE pairs and ideal joints, for the model's builder. Throws Error{usage} "bad-value".
BuildOptions build_options(const ModelOptions& options);
/// The same with the settings of a run. Throws Error{usage} "bad-value", "usage".
BuildOptions build_options(const RunWords& words);
/// The words of the command line that make the same run of the model's file: what the model was built with, and
/// `words`.
std::vector<std::string> arguments_of(const Model& model, const RunWords& words);

}  // namespace freeplay
