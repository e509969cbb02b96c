// StudyFile: the file of a study, read once, with the models and tables that it names.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/json_text.h"
#include "format/document.h"
#include "format/parameter_scope.h"
#include "format/study_section.h"
#include "load/options.h"
#include "study/model.h"
#include "study/planned_axis.h"

namespace freeplay {

/// A file that a study's folder keeps, to be made again from there.
struct KeptFile {
  std::string path;  ///< from the folder
  std::string bytes;
};

/// Has the file nothing but a study, of models that it names?
bool has_study_alone(const Node& root);

/// Whether a study is read from study.yaml in its folder, and if so whether only to be looked at: then its models are
/// not built and no plugin is loaded.
struct KeptStudy {
  bool kept = false, look = false;
};

class StudyFile {
 public:
  /// `file`: a study file or a model with a section `study`; or, kept, study.yaml in the folder of a study, whose
  /// models are read from the copies there. `set`: of the command line; it wins over the file's. Null after errors in
  /// the section or the models; after those in axes all that is good is there.
  /// Throws Error{usage} for what `set` asks for and a model does not have, and what loading plugins throws.
  static std::unique_ptr<StudyFile> read(const std::string& file, const KeptStudy& kept, const TargetTexts& set,
                                         const LoadOptions& options, Diagnostics& diagnostics);

  const std::string& name() const { return name_; }
  /// Were its models not built?
  bool only_looked_at() const { return look_; }
  const StudySection& section() const { return *section_; }
  const std::vector<StudyModel>& models() const { return models_; }
  const std::vector<PlannedAxis>& axes() const { return axes_; }
  /// Random numbers of a sample.
  std::size_t draws() const { return draws_; }
  /// What holds at every point: of the file, then of the command line.
  const std::vector<PlannedSetting>& set() const { return set_; }
  TargetTexts set_texts() const;
  /// Everything that was read, byte for byte, and what else the copies need.
  std::vector<KeptFile> kept_files() const;
  /// Where the copy of a model is among them.
  std::string copy_of(std::size_t model) const;
  /// Those of the libraries that it is made with.
  std::vector<std::string> plugin_copies(std::size_t model) const;
  /// A file that a model reads at some point. False where another one of the name is there.
  bool keep_input(std::size_t model, const InputFile& input);
  /// SHA-256 of all that the points follow from.
  std::string identity() const;

 private:
  StudyFile(Document document, Diagnostics& diagnostics);
  bool read_section(Diagnostics& diagnostics);
  void check_reducers(const CheckedValue& section) const;
  void combine_set(const TargetTexts& set);
  std::optional<StudyModel> read_one_model(std::size_t number, const std::string& place, const std::string& written,
                                           const LoadOptions& options, Diagnostics& diagnostics,
                                           std::vector<Diagnostic>& about_set) const;
  std::vector<std::string> named_addresses(const StudyModel& model) const;
  bool read_models(const LoadOptions& options, Diagnostics& diagnostics);
  void report_about_set(std::vector<Diagnostic> errors, Diagnostics& diagnostics) const;
  void name_models();
  void plan_axes();
  std::vector<std::string> fitting(const StudyAxis& axis) const;
  void plan_axis(const StudyAxis& axis);
  void find_targets(PlannedAxis& axis, const LoadOptions& options) const;
  void check_targets(const LoadOptions& options);
  void check_columns() const;

  Document document_;
  bool kept_ = false, look_ = false, in_model_ = false;
  Json record_ = nullptr;  ///< of a kept study: what its files do not say
  UsedKeys none_used_;
  ParameterScope no_parameters_;
  Reading reading_;
  std::optional<StudySection> section_;
  std::string name_;
  TargetTexts command_set_;
  std::vector<PlannedSetting> set_;
  std::vector<StudyModel> models_;
  std::vector<PlannedAxis> axes_;
  std::size_t draws_ = 0;
};

}  // namespace freeplay
