// DerivedTable: tables that are made from the rows of a result afterwards.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "results/reader.h"

namespace freeplay {

struct DerivedTable {
  std::vector<RecordColumn> columns;
  std::vector<double> rows;        ///< one after the other
  double from = 0.0, until = 0.0;  ///< the rows that a spectrum is made from [s]
  Json summary = nullptr;          ///< of estimates: how far they may be trusted
};

/// Where counting begins: what a result says of its settings, or of rows alone nothing.
struct CountedTime {
  double from = 0.0;      ///< T_c begins [s]
  double interval = 0.0;  ///< between rows [s]; 0: unknown
  double origin = 0.0;    ///< of the grid of rows [s]
};
CountedTime counted_time(const ResultReader& reader, double first_time);

/// `spectra`, `poincare`, `lyapunov` of the columns `picked`, the first of which is time, in rows of `window`, without
/// its beginning in those of T_c. `period` and `phase` [s] as in docs/results.md. Throws Error{numerical}
/// "too-few-rows".
DerivedTable derived_table(ResultReader& reader, const std::string& table, const std::vector<std::size_t>& picked,
                           const RowWindow& window, double period, std::optional<double> phase);

/// The tables by bearing sector, a row for each joint and sector. Throws Error{file} "unreadable-result" where the
/// result has none.
DerivedTable bearing_table(ResultReader& reader);

}  // namespace freeplay
