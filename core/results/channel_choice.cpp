#include "results/channel_choice.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "base/suggestion.h"

namespace freeplay {

std::string channel_hint(const std::string& pattern, const std::vector<std::string>& names) {
  if (const auto nearest = suggestion(pattern, names)) return fmt::format("did you mean '{}'?", *nearest);
  std::set<std::string> kinds;
  for (const std::string& name : names) kinds.insert(name.substr(0, name.find('.')));
  constexpr std::size_t most_kinds = 8;
  if (kinds.empty() || kinds.size() > most_kinds) return "";
  return fmt::format("names of channels begin with {}", fmt::join(kinds, ", "));
}

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
    throw Error(Error::Category::usage, "unknown-channel",
                fmt::format("'{}' has no channel '{}'", reader.file(), pattern), {}, channel_hint(pattern, names));
  }
  return chosen;
}

}  // namespace freeplay
