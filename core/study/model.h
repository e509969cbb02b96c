// StudyModel: a model of a study, read once.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "component/registry.h"
#include "format/document.h"
#include "load/options.h"
#include "model/model.h"

namespace freeplay {

using TargetTexts = std::vector<std::pair<std::string, std::string>>;

struct StudyModel {
  std::string name;    ///< in the table
  std::string file;    ///< as the study names it
  std::string sha256;  ///< of what it says, apart from a study, and of the files that it reads
  std::unique_ptr<const Document> document;
  std::vector<InputFile> inputs;   ///< files that it reads
  std::vector<InputFile> plugins;  ///< libraries that it is made with, but for installed ones
  std::set<std::string> parameters;
  bool has_play = false;               ///< a joint of it can have play
  std::vector<std::string> addresses;  ///< paths of the expanded model, sorted, each once
  std::vector<std::string> offered;    ///< likewise of keys that it may have; with a dot at its end: of any name below

  /// Is there something that a value of this target takes the place of?
  bool has(const std::string& target) const;

 private:
  bool may_have(const std::string& target) const;
};

/// SHA-256 of a model: of what it says, apart from a study, and of the files that it reads.
std::string fingerprint(const Document& document, std::vector<InputFile> inputs);

/// Builds a model with values of targets, to see what is wrong with them.
class ModelProbe {
 public:
  /// Loads the plugins of `document`, which outlives it. Throws what loading plugins throws.
  ModelProbe(const Document& document, const LoadOptions& options);

  struct Result {
    std::vector<Diagnostic> errors;
    std::optional<std::string> refused;  ///< the target that no value can stand at; errors has why
    std::unique_ptr<Model> model;        ///< null with errors
  };
  /// `addresses` may be null.
  Result build(const TargetTexts& set, std::vector<std::string>* addresses,
               std::vector<std::string>* offered = nullptr) const;
  const Registry& registry() const { return registry_; }

 private:
  const Document& document_;
  Registry registry_;
};

/// Reads `place`, the file that the study calls `file`; `set` holds at every point. Nothing after errors, of which
/// those about `set` are kept apart in `about_set`. Throws what loading plugins throws.
std::optional<StudyModel> read_study_model(const std::string& place, const std::string& file, const TargetTexts& set,
                                           const LoadOptions& options, Diagnostics& diagnostics,
                                           std::vector<Diagnostic>& about_set);

/// Reads the copy of a model in the folder of a study without building it, so without its plugins; what only building
/// it shows is left open: addresses and play.
std::optional<StudyModel> read_kept_model(const std::string& place, const std::string& file, Diagnostics& diagnostics);

/// All that the models have of a pattern; what is none is itself alone.
std::set<std::string> addressed(const std::vector<StudyModel>& models, const std::string& target);

}  // namespace freeplay
