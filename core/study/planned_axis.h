// PlannedAxis: the values of an axis of a study, by their number.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/study_axis.h"
#include "study/axis_value.h"
#include "study/design_table.h"
#include "study/fit_clearance.h"

namespace freeplay {

/// What a point sets.
struct PlannedSetting {
  std::string target;
  AxisValue value;
};

/// A column of the table.
struct AxisColumn {
  std::string name, unit;
  bool words = false;   ///< texts, not numbers
  bool random = false;  ///< drawn, not listed
};

class PlannedAxis {
 public:
  /// `source` outlives it; `target` and `name` are its own, or those of one of several that it stands for, or of the
  /// choice among several fits, which has no target. `table` is there for an axis with one; `first_draw`: number of the
  /// first random number that it takes.
  PlannedAxis(const StudyAxis& source, std::string name, std::string target, std::optional<DesignTable> table,
              std::size_t first_draw);

  const StudyAxis& source() const { return *source_; }
  const std::string& name() const { return name_; }
  /// Values; random axes have one, which the sample gives, or one for each of several fits.
  std::uint64_t size() const { return size_; }
  const std::vector<AxisColumn>& columns() const { return columns_; }
  std::vector<std::string> targets() const;

  /// Adds what value `place` sets, and the cells of its columns. `draws`: random numbers of the sample.
  void add(std::uint64_t place, std::span<const double> draws, std::vector<PlannedSetting>& settings,
           std::vector<std::string>& cells) const;
  /// Values that differ in more than a number, to be tried one by one.
  std::vector<std::uint64_t> kinds() const;
  /// Where it is written what value `place` gives the target, or, without a place, that the target is set at all.
  const CheckedValue& written(const std::string& target, std::optional<std::uint64_t> place = {}) const;
  const std::optional<DesignTable>& table() const { return table_; }

  /// Does the model have it? By number of the model; filled by who knows the models.
  std::vector<bool> present{};

  /// Whether it only says which of several fits the axes beside it have.
  bool chooses_fit() const { return target_.empty() && !source_->fits.empty(); }

 private:
  AxisValue value(std::uint64_t place, std::span<const double> draws) const;

  const StudyAxis* source_;
  std::string name_, target_;
  std::optional<DesignTable> table_;
  std::size_t first_draw_;
  std::uint64_t size_ = 1;
  std::vector<AxisColumn> columns_;
  std::vector<FitClearance> clearances_;  // of the fits
};

}  // namespace freeplay
