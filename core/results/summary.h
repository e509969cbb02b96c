// Summary: summary.json, what a run did in one object.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/json_text.h"
#include "model/model.h"
#include "results/contact_advice.h"
#include "run/simulation.h"

namespace freeplay {

/// Everything that goes into a summary.
struct RunRecord {
  const Model& model;
  const Channels& channels;
  const ModelFacts& facts;
  const Outcome& outcome;
  const Statistics& statistics;
  const ClearanceStatistics& clearances;
  std::span<const double> last_row;  ///< every channel
  const ContactAdvice& advice;
  std::vector<std::string> warnings;
  std::vector<std::string> files;  ///< names in the result directory
  /// Observed errors by channel, and until when two runs agree [s]; null without a second run.
  std::vector<std::pair<std::string, double>> verify{};
  double agree_until = std::numeric_limits<double>::quiet_NaN();
  RunExtremes extremes{};
  Json verification{};  ///< what the second run was and what it says of the first; null without one
  Verdict trust{};
  std::vector<JointMemory> memory{};            ///< by joint, at the end; empty: not known
  Json hashes = nullptr, provenance = nullptr;  ///< of Recording
  Json repeat = nullptr;                        ///< of RepeatSummary, of a repeated run
  Json twin = nullptr;                          ///< of TwinComparison, of a run beside its ideal twin
};

/// completed, stopped, failed or interrupted.
const char* status_word(RunStatus status);

/// The object of section 2.4 of the command-line contract.
Json summary(const RunRecord& record);

/// Its field `settings`.
Json settings_json(const Model& model);

/// Name and type of an entry of Model::force_elements.
struct ForceWords {
  std::string name, type;
};
ForceWords force_words(const Model& model, int index);

/// True if the joint publishes what the contact part of its statistics needs.
bool has_contact_statistics(const JointColumns& columns);

}  // namespace freeplay
