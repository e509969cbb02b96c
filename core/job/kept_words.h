// KeptWords: what the numbers or the files of a run depend on, in words of the command line.
#pragma once

#include <string>
#include <vector>

#include "base/json_text.h"
#include "load/run_words.h"
#include "model/model.h"
#include "results/provenance.h"

namespace freeplay {

struct KeptWords : RunWords {
  std::string repeat, seed, inputs;
  std::vector<std::string> plugins;
  bool verify = false, twin = false, strict = false;
};

/// Throws Error{usage} for words that exclude each other.
void require_together(const KeptWords& words);
/// Throws Error{usage} "no-clearance" for a model whose twin would be the same.
void require_twin(const Model& model);

/// What says how a run is made, for one that goes on from it; without paths and what is only shown.
Json kept_options(const KeptWords& words);
/// Sets these again. False where `kept` is none of them.
bool keep_options(const Json& kept, KeptWords& words);

/// Its arguments make the same run of the same model file, in whatever words this one was asked for. `command`: as the
/// caller asked.
Making making(const KeptWords& words, const std::string& command, const Model& model);

/// What the run is made from and with, for its checkpoints.
Json made_from(const KeptWords& words, const std::string& command, const Model& model);

/// Seconds of wall time between two checkpoints, as --checkpoint says it; 0: only those that are always made. Throws
/// Error{usage} "bad-value".
double checkpoint_period(const std::string& words);

}  // namespace freeplay
