// TableDifference: where two tables differ, number by number.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "results/mat_table.h"
#include "results/reader.h"

namespace freeplay {

/// What a comparison of tables found.
struct TableDifference {
  std::size_t rows = 0, rows_now = 0, columns = 0;
  std::string first;  ///< "row 17, t = 0.0016 s, NAME: 1 recorded, 2 now"; empty: they are the same
};

/// How tables are compared: `as_far_as_it_goes` leaves out what only the second has more of, and a last line without
/// its end.
struct TableRules {
  std::string row = "row";  ///< what messages call one
  bool as_far_as_it_goes = false;
};

/// Two files of text with a line of names, byte by byte. Throws Error{file} "unreadable-result".
TableDifference compare_csv(const std::filesystem::path& then, const std::filesystem::path& now,
                            const TableRules& rules);

/// The rows of two results, or their events (words by what they stand for), bit by bit.
TableDifference compare_rows(ResultReader& then, ResultReader& now, const TableRules& rules);
TableDifference compare_events(ResultReader& then, ResultReader& now, const TableRules& rules);

TableDifference compare_mat(const MatTable& then, const MatTable& now);

}  // namespace freeplay
