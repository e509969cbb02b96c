// ReducerEntry: an entry of the section `reducers`, as it is written.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "format/checked_value.h"
#include "study/reducer.h"

namespace freeplay {

/// Words are checked; names, formulas and quantities are read for a model (study/point_reducers.h), whose parameters
/// they may use.
struct ReducerEntry {
  enum class Source { channel, value, summary, events, set, column, of };
  enum class Over { max, min, sum, mean };

  std::string name;
  Source source;
  CheckedValue subject;  ///< the channel, formula, path or pattern
  std::optional<Reduction> reduction{};
  bool section = false;  ///< poincare: many values
  std::optional<Over> over{};
  std::string field{}, kind = "contact_begin";  ///< of events
  std::optional<CheckedValue> p{}, above{}, below{}, from{}, until{};
  std::optional<CheckedValue> every{}, phase{}, channel{}, crosses{};  ///< of a section
  bool up = true, down = false;

  std::string text() const { return subject.node().text; }
};

/// Reports what is wrong to the diagnostics of `section`'s reading, which must outlive the entries. Without `do`
/// (`analysis`) there are no columns of an analysis, with it nothing else but formulas of these.
std::vector<ReducerEntry> read_reducers(const CheckedValue& section, bool analysis);

}  // namespace freeplay
