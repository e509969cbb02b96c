#include "study/design_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/input_text.h"
#include "format/study_axis.h"

namespace freeplay {
namespace {

std::string unquoted(std::string_view field) {
  if (field.size() > 1 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
  return std::string(field);
}

}  // namespace

std::optional<DesignTable> DesignTable::read(const std::string& place, const CheckedValue& written) {
  std::string text;
  const std::string why = read_input(place, text);
  if (!why.empty()) {
    written.fail("file-not-found", fmt::format("cannot read '{}': {}", written.node().text, why));
    return std::nullopt;
  }
  DesignTable made;
  made.bytes_ = std::make_shared<const std::string>(text);
  made.text_ = std::make_shared<const CsvText>(written.node().text, std::move(text));
  const CsvText& csv = *made.text_;
  const auto fail = [&](const std::string& id, const std::string& message) {
    written.fail(id, fmt::format("'{}' {}", written.node().text, message));
    return std::nullopt;
  };
  if (csv.too_large() || made.bytes_->size() > largest_input) return fail("too-large", "has more than 16 MiB");
  if (csv.names().empty() || csv.rows() == 0) return fail("wrong-length", "has no row of values");
  for (const std::string& name : csv.names()) made.targets_.push_back(unquoted(name));
  made.words_.assign(made.targets_.size(), false);
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const std::size_t fields = csv.fields(row);
    if (fields != made.targets_.size()) {
      return fail("wrong-length", fmt::format("has {} {} in line {}, not {}", fields, fields == 1 ? "field" : "fields",
                                              csv.field(row, 0).location.line, made.targets_.size()));
    }
    for (std::size_t column = 0; column < fields; ++column) {
      const CsvText::Field field = csv.field(row, column);
      if (field.text.empty()) {
        return fail("wrong-length",
                    fmt::format("has nothing in line {} for '{}'", field.location.line, made.targets_[column]));
      }
      if (!csv_number(field.text) && !constant_quantity(unquoted(field.text))) made.words_[column] = true;
    }
  }
  return made;
}

int DesignTable::line(std::uint64_t row) const { return text_->field(static_cast<std::size_t>(row), 0).location.line; }

AxisValue DesignTable::value(std::uint64_t row, std::size_t column) const {
  const std::string_view field = text_->field(static_cast<std::size_t>(row), column).text;
  if (const auto number = csv_number(field)) return AxisValue::of(*number, std::nullopt);
  return AxisValue::of(unquoted(field));
}

}  // namespace freeplay
