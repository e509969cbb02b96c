// TableView: one table of a result as columns, to be written as other files.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/json_text.h"
#include "results/reader.h"

namespace freeplay {

/// Words of the tables that a result has: results, events, impacts.
std::span<const char* const> table_words();

/// What a table is made of.
struct TableRequest {
  std::string table = "results";
  std::vector<std::string> channels{"*"};  ///< patterns, of `results`
  RowWindow window;
};

class TableView {
 public:
  /// `reader` outlives it. Throws Error{usage} "unknown-channel" with a suggestion where a pattern fits none.
  TableView(ResultReader& reader, const TableRequest& request);

  const std::vector<RecordColumn>& columns() const { return columns_; }
  /// Numbers row after row, in blocks.
  void rows(const ResultReader::Take& take);
  /// What a number of a column stands for where that is a word; null where it is a number. After rows() began.
  const std::string* word(std::size_t column, double number) const;
  /// Columns of the reader, for a file with the layout of a run.
  const std::vector<std::size_t>& picked() const { return picked_; }

 private:
  void pick_channels(const std::vector<std::string>& patterns);
  void list_impacts();

  ResultReader& reader_;
  TableRequest request_;
  std::vector<RecordColumn> columns_;
  std::vector<std::size_t> picked_;
};

}  // namespace freeplay
