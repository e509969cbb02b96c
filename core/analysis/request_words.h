// AnalysisWords: an analysis as people ask for it, from words to numbers.
#pragma once

#include <string>
#include <vector>

#include "analysis/ideal_mechanism.h"
#include "analysis/platform.h"
#include "analysis/request.h"

namespace freeplay {

/// Words of options of `analyze` and of keys of `do` alike; messages name them as options.
struct AnalysisWords {
  std::string kind;  ///< "ik", "workspace", "singularity", "error" or "inverse-dynamics"
  std::string frame, time, elbow, samples, seed, distribution, preload;
  std::vector<std::string> grid, pose, input;
  bool sensitivity = false, branches = false;
};

/// Throws Error{usage}: "unknown-name" for no kind of analysis, "bad-value" for words that the kind has no use for.
void require_sense(const AnalysisWords& words);
/// What the words put in place of the section. May add a marker. Throws Error{usage} "unknown-name", "bad-value".
PlatformOverrides platform_overrides(Model& model, const AnalysisWords& words);
/// Throws Error{usage} "bad-value", "unknown-name".
[[gnu::cold]] AnalysisRequest request_of(const IdealMechanism& mechanism, const AnalysisWords& words, int threads);
/// The options that ask for the same.
std::vector<std::string> arguments_of(const AnalysisWords& asked, bool coloured);
/// The seed of samples that the words ask for.
long seed_of(const AnalysisWords& words);

}  // namespace freeplay
