#include "format/csv_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "base/token.h"

namespace freeplay {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

}  // namespace

CsvText::CsvText(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
  end_lines_by_line_feeds(text_);
  std::string_view rest = text_;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  bool header = true;
  for (int number = 1; !rest.empty(); ++number) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const std::string_view content = trimmed(line);
    if (content.empty() || content.starts_with('#')) continue;
    if (!header) {
      too_large_ = too_large_ || rows_.size() == most_rows;
      if (too_large_) return;
      rows_.push_back({number, line});
      continue;
    }
    header = false;
    header_ = {number, line};
    for (std::string_view names = line;;) {
      const std::size_t comma = names.find(',');
      too_large_ = names_.size() == most_columns;
      if (too_large_) return;
      names_.emplace_back(trimmed(names.substr(0, comma)));
      if (comma == std::string_view::npos) break;
      names.remove_prefix(comma + 1);
    }
  }
}

CsvText::Field CsvText::field_of(const Row& row, std::size_t column) const {
  const std::string_view line = row.text;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < column; ++i) {
    const std::size_t comma = line.find(',', begin);
    begin = comma == std::string_view::npos ? line.size() : comma + 1;
  }
  const std::string_view text = trimmed(line.substr(begin, line.find(',', begin) - begin));
  if (!text.empty()) begin = static_cast<std::size_t>(text.data() - line.data());
  return {text, {file_, row.line, character_count(line.substr(0, begin)) + 1}};
}

CsvText::Field CsvText::field(std::size_t row, std::size_t column) const { return field_of(rows_[row], column); }

CsvText::Field CsvText::header(std::size_t column) const { return field_of(header_, column); }

std::size_t CsvText::fields(std::size_t row) const {
  return static_cast<std::size_t>(std::ranges::count(rows_[row].text, ',')) + 1;
}

Location CsvText::body_location() const { return rows_.empty() ? header(0).location : field(0, 0).location; }

std::optional<CsvText::Field> CsvText::foreign_byte() const {
  std::size_t line_begin = 0;
  for (std::size_t i = 0; i < text_.size();) {
    const std::size_t length = text_[i] == '\0' ? 0 : character_bytes(text_, i);
    if (length == 0) {
      const auto line = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(i), '\n');
      const std::string_view before = std::string_view(text_).substr(line_begin, i - line_begin);
      return Field{std::string_view(text_).substr(i, 1),
                   {file_, static_cast<int>(line) + 1, character_count(before) + 1}};
    }
    if (text_[i] == '\n') line_begin = i + 1;
    i += length;
  }
  return std::nullopt;
}

std::optional<double> csv_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const bool negative = text.starts_with('-');
    return (negative ? -1.0 : 1.0) * number_value(text.substr(negative ? 1 : 0));
  }
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace freeplay
