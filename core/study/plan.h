// StudyPlan: the points of a study, computed from their numbers and never stored.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "load/options.h"
#include "study/draws.h"
#include "study/file.h"
#include "study/layout.h"
#include "study/point.h"

namespace freeplay {

struct StudyPlanOptions {
  LoadOptions load{};
  TargetTexts set{};         ///< of the command line: lines of `set` that win over the file's
  bool many_points = false;  ///< more than many_points are allowed
  bool kept = false;         ///< the file is study.yaml in the folder of a study
  /// Of a kept study: no point is to be run, so no model is built and no plugin loaded.
  bool look = false;
};

/// Everything is checked that follows from the file and its models, but for reducers and `do`. One thread at a time.
class StudyPlan {
 public:
  /// Null after errors. Throws Error{usage} for `set`, Error{input} for a folder that is none of a study, and what
  /// loading plugins throws.
  static std::unique_ptr<StudyPlan> read(const std::string& file, const StudyPlanOptions& options,
                                         Diagnostics& diagnostics);

  const StudyFile& file() const { return *file_; }
  const std::string& name() const { return file_->name(); }
  const StudySection& section() const { return file_->section(); }
  const std::vector<StudyModel>& models() const { return file_->models(); }
  /// Have the models been built, so that points can be run?
  bool has_models() const { return !file_->only_looked_at(); }
  /// What holds at every point.
  std::vector<StudySetting> set() const;
  /// SHA-256 of the section without name, description and plots, of what the command line sets, and of all files.
  std::string identity() const { return file_->identity(); }
  /// Byte copies of all that was read, by their path in the folder of the study; `kept` reads them.
  std::vector<KeptFile> kept_files() const { return file_->kept_files(); }
  /// Where the copy of a model is among them.
  std::string model_copy(std::size_t model) const { return file_->copy_of(model); }
  /// And of the libraries that it is made with.
  std::vector<std::string> plugin_copies(std::size_t model) const { return file_->plugin_copies(model); }

  const std::vector<AxisColumn>& axis_columns() const { return columns_; }
  bool has_model_column() const { return models().size() > 1; }
  bool has_direction_column() const { return chained(); }
  bool has_sample_column() const { return file_->draws() > 0; }

  std::uint64_t points() const { return layout_->points(); }
  /// Samples of each combination, point by point: point / samples() is its combination, the rest its sample.
  std::uint64_t samples() const { return layout_->samples(); }
  StudyPoint point(std::uint64_t index) const;
  /// 24 hexadecimal digits.
  std::string hash(std::uint64_t index) const;

  /// As StudyWork says.
  std::uint64_t units() const { return layout_->units(); }
  std::uint64_t unit_size(std::uint64_t unit) const { return layout_->unit_size(unit); }
  std::uint64_t unit_point(std::uint64_t unit, std::uint64_t place) const { return layout_->unit_point(unit, place); }
  UnitPlace place_of(std::uint64_t point) const { return layout_->place_of(point); }
  bool chained() const { return layout_->chained(); }

 private:
  explicit StudyPlan(std::unique_ptr<StudyFile> file);
  void lay_out(const StudyPlanOptions& options, Diagnostics& diagnostics);
  PlacedPoint settings_of(std::uint64_t index, std::vector<PlannedSetting>& settings,
                          std::vector<std::string>& cells) const;
  std::string own_hash(std::uint64_t index, const std::string& before) const;

  std::unique_ptr<StudyFile> file_;
  std::unique_ptr<const StudyLayout> layout_;
  std::unique_ptr<const Draws> draws_;
  std::vector<AxisColumn> columns_;
  // Each hash of a chain follows from those before it.
  mutable std::uint64_t hashed_unit_ = 0;
  mutable std::vector<std::string> hashes_;
};

}  // namespace freeplay
