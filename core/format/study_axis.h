// StudyAxis: an entry of `axes` of a study, as it is written.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "format/checked_value.h"
#include "format/distribution.h"
#include "format/iso_fit.h"
#include "model/grid_values.h"

namespace freeplay {

/// A target and its value: a quantity, a word, a list or a map.
struct TargetValue {
  std::string target;
  CheckedValue value;
};

/// Named values of several targets that go together.
struct StudyCase {
  std::string name;
  std::vector<TargetValue> values;
};

/// A random radial clearance.
struct StudyFit {
  IsoFit limits;
  bool normal = true;            ///< else uniform over the zones
  double low = 0.0, high = 0.0;  ///< of the clearance, as it is cut [m]
  std::string code{};            ///< such as H7/g6
};

struct StudyAxis {
  CheckedValue entry;  ///< for messages
  std::string name;    ///< its key
  std::string target;  ///< a pattern with `each`; empty with cases and tables
  bool each = false, where_present = false;

  // What it has one of:
  std::optional<GridValues> grid{};
  std::vector<CheckedValue> list{};  ///< with words, lists or maps among its values
  std::vector<StudyCase> cases{};
  std::optional<CheckedValue> table{};  ///< name of a file
  std::optional<Distribution> distribution{};
  std::vector<StudyFit> fits{};          ///< several: a grid of distributions, for which all targets have the same
  std::optional<Dimension> dimension{};  ///< of its quantities; nothing: they have none

  bool random() const { return distribution || !fits.empty(); }
  /// Numbers that are drawn for a value.
  std::size_t draws() const { return !fits.empty() ? 2 : distribution ? 1 : 0; }
};

/// Dimension of the values that a target takes, where it is known.
using TargetDimension = std::function<std::optional<Dimension>(const std::string& target)>;

/// Reports a key that cannot stand in a table without quotes: models and cases have names of any other kind.
void check_table_word(const CheckedValue& entry);

/// Nothing after an error.
std::optional<StudyAxis> read_study_axis(const CheckedValue& entry, const TargetDimension& dimension_of);

/// A quantity that is a constant; nothing, and no message, for what is a word, a list, a map or uses parameters.
std::optional<Quantity> constant_quantity(const std::string& text);

}  // namespace freeplay
