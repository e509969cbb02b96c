// AnalyzeOptions: what `freeplay analyze` is asked, from words to numbers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/request.h"
#include "cli/options.h"

namespace freeplay {

struct AnalyzeOptions {
  std::string kind, model, frame, time, elbow, out, svg, samples, seed, distribution, preload;
  std::vector<std::string> grid, pose, input;
  bool sensitivity = false, branches = false, coloured = false;
  ModelOptions build;
};

/// The command line that makes the same table or map of a model, without the model and the files to write.
std::vector<std::string> analyze_arguments(const AnalyzeOptions& options, const CommonOptions& common);

/// "0.05,0,0" or "x=5 cm,angle=10 deg". Throws Error{usage} "bad-value".
PoseWords pose_of(const PoseForm& form, const std::string& text);
/// "x=FROM:TO:COUNT": the axis and its values. Throws Error{usage} "bad-value".
std::pair<std::size_t, GridValues> grid_axis_of(const PoseForm& form, const std::string& text);
/// "FROM:TO:COUNT" [s]. Throws Error{usage} "bad-value".
GridValues times_of(const std::string& text);
/// "1,-1,1". Throws Error{usage} "bad-value".
std::vector<int> elbow_of(const std::string& text);
/// "JOINT=VALUE,...": values by input, NaN for those that are not named. Throws Error{usage} "bad-value",
/// "unknown-name".
std::vector<Jet> inputs_of(const std::string& text, const Model& model, const std::vector<int>& inputs);
/// "uniform", "rim", "normal" or "normal:SIGMA". Throws Error{usage} "bad-value", "unknown-name".
PlayLaw play_law_of(const std::string& text);

}  // namespace freeplay
