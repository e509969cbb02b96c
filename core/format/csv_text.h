// CsvText: a table of text with commas, comments and one header row, whose fields know their places.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace freeplay {

/// Fields are separated by commas, lines that begin with '#' are comments, and the first other line names the columns.
/// Blanks around a field and empty lines do not count; there are no quotes. Lines end as in any other text file.
/// Columns and rows beyond the limits are left out.
class CsvText {
 public:
  static constexpr std::size_t most_columns = 10'000, most_rows = 2'000'000;

  CsvText(std::string file, std::string text);
  CsvText(const CsvText&) = delete;
  CsvText& operator=(const CsvText&) = delete;

  /// A field of a row; its text is empty where the row is too short.
  struct Field {
    std::string_view text;
    Location location;
  };

  const std::string& text() const { return text_; }
  const std::vector<std::string>& names() const { return names_; }
  /// The name of a column where it stands; of column 0 also in a text without a header: the begin of the text.
  Field header(std::size_t column) const;
  /// The first byte that is not UTF-8, or a zero byte, which no text has.
  std::optional<Field> foreign_byte() const;
  /// Was anything left out?
  bool too_large() const { return too_large_; }
  std::size_t rows() const { return rows_.size(); }
  /// Number of fields of a row, which the header does not limit.
  std::size_t fields(std::size_t row) const;
  Field field(std::size_t row, std::size_t column) const;
  /// Of the first row of numbers; without one, of the header.
  Location body_location() const;

 private:
  struct Row {
    int line;
    std::string_view text;
  };

  Field field_of(const Row& row, std::size_t column) const;

  std::string file_, text_;
  std::vector<std::string> names_;
  Row header_{1, {}};
  std::vector<Row> rows_;
  bool too_large_ = false;
};

/// A number with a decimal point, whatever the locale; nothing else may stand beside it. Infinite where it is too large
/// for a double, 0 where it is too small.
std::optional<double> csv_number(std::string_view text);

}  // namespace freeplay
