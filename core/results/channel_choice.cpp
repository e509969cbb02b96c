#include "results/channel_choice.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "base/suggestion.h"

namespace freeplay {

std::vector<std::size_t> chosen_channels(const ResultReader& reader, const std::vector<std::string>& patterns) {
  const std::vector<RecordColumn>& all = reader.layout().columns;
  std::vector<char> taken(all.size(), 0);
  std::vector<std::size_t> chosen;
  for (const std::string& pattern : patterns) {
    bool fits = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!matches(pattern, all[i].name)) continue;
      fits = true;
      if (taken[i] != 0) continue;
      taken[i] = 1;
      chosen.push_back(i);
    }
    if (fits) continue;
    std::vector<std::string> names;
    for (const RecordColumn& column : all) names.push_back(column.name);
    const auto nearest = suggestion(pattern, names);
    throw Error(Error::Category::usage, "unknown-channel",
                fmt::format("'{}' has no channel '{}'", reader.file(), pattern), {},
                nearest ? fmt::format("did you mean '{}'?", *nearest) : "");
  }
  return chosen;
}

}  // namespace freeplay
