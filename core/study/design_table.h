// DesignTable: points that another program has chosen, as text with commas.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "format/checked_value.h"
#include "format/csv_text.h"
#include "study/axis_value.h"

namespace freeplay {

class DesignTable {
 public:
  /// Reads `place`, the file that `written` names, and checks every field. Nothing after an error.
  static std::optional<DesignTable> read(const std::string& place, const CheckedValue& written);

  const std::vector<std::string>& targets() const { return targets_; }
  std::uint64_t rows() const { return text_->rows(); }
  AxisValue value(std::uint64_t row, std::size_t column) const;
  /// Of the file.
  int line(std::uint64_t row) const;
  /// Of the values of a column: quantities, not words; and their unit.
  bool words(std::size_t column) const { return words_[column]; }
  /// Byte for byte.
  const std::string& bytes() const { return *bytes_; }

 private:
  std::shared_ptr<const std::string> bytes_;
  std::shared_ptr<const CsvText> text_;
  std::vector<std::string> targets_;
  std::vector<bool> words_;
};

}  // namespace freeplay
