// TextTable: columns that line up.
#pragma once

#include <string>
#include <vector>

namespace freeplay {

/// Cells of any width in characters; the columns are set two blanks apart.
class TextTable {
 public:
  enum class Align { left, right };

  /// Columns beyond `alignment` are left-aligned.
  explicit TextTable(std::vector<Align> alignment = {}) : alignment_(std::move(alignment)) {}

  void add_row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Every line begins with `indent` and ends with a line feed.
  std::string text(const std::string& indent = "") const;

 private:
  std::vector<Align> alignment_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace freeplay
