// TableView: one table of a result as columns, to be written as other files.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/json_text.h"
#include "results/derived_table.h"
#include "results/reader.h"

namespace freeplay {

/// Words of the tables that a result has, and of those made from it.
std::span<const char* const> table_words();

/// What a table is made of.
struct TableRequest {
  std::string table = "results";
  std::vector<std::string> channels{};  ///< patterns; empty: all, or what the table is usually made of
  RowWindow window{};
  double period = 0.0;                         ///< of sections and divergence [s]
  std::optional<double> phase = std::nullopt;  ///< of sections: the first instant [s]
};

class TableView {
 public:
  /// `reader` outlives it. Throws Error{usage} "unknown-channel" with a suggestion where a pattern fits none.
  TableView(ResultReader& reader, const TableRequest& request);

  const std::vector<RecordColumn>& columns() const { return columns_; }
  /// Numbers row after row, in blocks.
  void rows(const ResultReader::Take& take);
  /// Of estimates: how far they may be trusted; else null.
  const Json& summary() const { return derived_.summary; }
  /// What a number of a column stands for where that is a word; null where it is a number. After rows() began.
  const std::string* word(std::size_t column, double number) const;
  /// Columns of the reader, for a file with the layout of a run.
  const std::vector<std::size_t>& picked() const { return picked_; }

 private:
  void pick_channels(const std::vector<std::string>& patterns);
  void list_impacts();
  bool is_derived() const { return !derived_.columns.empty(); }

  ResultReader& reader_;
  TableRequest request_;
  std::vector<RecordColumn> columns_;
  std::vector<std::size_t> picked_;
  DerivedTable derived_;
};

}  // namespace freeplay
