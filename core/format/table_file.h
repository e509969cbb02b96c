// TableFile: a CSV file of a model, whose columns are read as numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "format/draft.h"

namespace freeplay {

/// A file is opened once, however often it is named, and becomes an input of the model. Mistakes are reported where
/// they stand in it.
class TableFile {
 public:
  /// A column, and what its numbers are multiplied by to be SI.
  struct Column {
    std::size_t index = 0;
    double factor = 1.0;
  };

  /// `file` holds the path, from the folder of the model; it must outlive this.
  TableFile(Draft& draft, const CheckedValue& file) : draft_(draft), file_(file) {}

  /// What the first column of numbers does from row to row.
  enum class Rising { times, numbers, none };

  /// False after an error, also where the first row does not name columns of one name each, `least` or more.
  bool open(std::size_t least = 2);
  const CsvText& text() const { return *text_; }
  /// By its name or, without one, the one at the place `standard`.
  std::optional<std::size_t> column(const std::optional<CheckedValue>& value, std::size_t standard) const;
  /// The numbers of `times`, which must increase unless `rising` says else, and of the others. False after an error.
  bool read(const Column& times, const std::vector<Column>& others, std::vector<double>& t,
            std::vector<std::vector<double>>& values, Rising rising = Rising::times) const;
  /// Reports "bad-table" at a field.
  void bad(const CsvText::Field& field, const std::string& message, const std::string& hint = {}) const;

  /// Where a file of this name is.
  static std::string path_of(const Draft& draft, const std::string& name);

 private:
  const CsvText* find() const;
  bool has_header(std::size_t least) const;
  std::optional<double> number(std::size_t row, const Column& column) const;

  Draft& draft_;
  const CheckedValue& file_;
  const CsvText* text_ = nullptr;
};

}  // namespace freeplay
