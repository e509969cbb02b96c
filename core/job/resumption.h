// Resumption: `freeplay run --resume DIR`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "job/kept_words.h"
#include "results/checkpoint.h"

namespace freeplay {

/// How a run goes on that did not come to its end.
struct Resumption {
  KeptWords words;         ///< of that run, with a later end where one was asked for
  std::string model;       ///< the copy that stands in the result
  std::string model_name;  ///< of the run, which the copy may not have
  std::vector<std::string> recorded_plugins;
  Checkpoint checkpoint;
  bool goes_on = true;        ///< else it is made again from its start, and replaces what is there
  double interval = 0.0;      ///< between rows, of that run [s]
  std::string nothing_to_do;  ///< why not; empty where there is something
};

/// Reads what is there and changes nothing. `end`: as --end says it; empty: that of the run. Throws Error{usage} for an
/// end that is not later, Error{file} "unreadable-result", "no-checkpoint", "bad-checkpoint", Error{input}
/// "resume-mismatch" where another program made the result.
Resumption read_resumption(const std::filesystem::path& directory, const std::string& end);

/// Throws Error{input} "resume-mismatch" where another program made the checkpoint.
void require_same_program(const Checkpoint& checkpoint);
/// The same where the model, an input or a plugin of a run whose provenance is `now` is not the one of the run that
/// goes on.
void require_same_making(const Checkpoint& checkpoint, const Json& now);
/// The same where the settings are others.
void require_same_settings(const Checkpoint& checkpoint, const Json& now);

}  // namespace freeplay
