#include "results/table_view.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <unordered_set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "results/channel_choice.h"

namespace freeplay {
namespace {

constexpr const char* tables[] = {"results", "events", "impacts", "bearing", "spectra", "poincare", "lyapunov"};

/// What a table is made of where nothing else is asked for.
std::vector<std::string> usual_channels(const std::string& table) {
  if (table == "results") return {"*"};
  if (table == "spectra") return {"driver.*.torque", "driver.*.force", "joint.*.fn"};
  return {"joint.*.ex", "joint.*.ey"};
}

/// One row per contact that ended: names of its columns, and of those of events that they come from.
constexpr struct {
  const char *name, *field;
} impact_columns[] = {
    {"joint", "joint"},
    {"begin", "time"},  // less the duration
    {"duration", "duration"},
    {"approach_speed", "approach_speed"},
    {"separation_speed", "speed"},
    {"tangential_speed", "tangential_speed"},
    {"direction", "direction"},
    {"max_fn", "max_fn"},
    {"max_delta", "max_delta"},
    {"impulse", "impulse"},
    {"tangential_impulse", "tangential_impulse"},
    {"energy_lost", "energy_lost"},
    {"steps", "steps"},
    {"impact", "impact"},
};

std::size_t place_of(const std::vector<RecordColumn>& columns, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(columns, name, &RecordColumn::name) - columns.begin());
}

}  // namespace

std::span<const char* const> table_words() { return tables; }

TableView::TableView(ResultReader& reader, const TableRequest& request) : reader_(reader), request_(request) {
  const bool of_rows = request_.table == "results" || request_.table == "spectra" || request_.table == "poincare" ||
                       request_.table == "lyapunov";
  if (of_rows) {
    pick_channels(request_.channels);
    if (request_.table == "results") return;
    derived_ = derived_table(reader_, request_.table, picked_, request_.window, request_.period, request_.phase);
    columns_ = derived_.columns;
  } else if (request_.table == "bearing") {
    derived_ = bearing_table(reader_);
    columns_ = derived_.columns;
  } else if (request_.table == "impacts") {
    list_impacts();
  } else {
    columns_ = reader_.layout().events;
  }
}

void TableView::pick_channels(const std::vector<std::string>& patterns) {
  const std::vector<RecordColumn>& all = reader_.layout().columns;
  std::vector<char> wanted(all.size(), 0);
  wanted[0] = 1;
  const bool usual = patterns.empty();
  if (usual) {
    for (const std::string& pattern : usual_channels(request_.table)) {
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (matches(pattern, all[i].name)) wanted[i] = 1;
      }
    }
  } else {
    for (const std::size_t i : chosen_channels(reader_, patterns)) wanted[i] = 1;
  }
  if (usual && all.size() > 1 && std::ranges::count(wanted, 1) < 2) {
    throw Error(Error::Category::usage, "unknown-channel",
                fmt::format("'{}' has none of the channels that {} are usually made of: {}", reader_.file(),
                            request_.table, fmt::join(usual_channels(request_.table), ", ")),
                {}, "name others with --channels");
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (wanted[i] == 0) continue;
    picked_.push_back(i);
    columns_.push_back(all[i]);
  }
}

void TableView::list_impacts() {
  const std::vector<RecordColumn>& events = reader_.layout().events;
  for (const auto& column : impact_columns) {
    const std::size_t place = place_of(events, column.field);
    const RecordColumn from = place < events.size() ? events[place] : RecordColumn{};
    columns_.push_back({column.name, from.unit, from.long_name, from.source});
  }
}

void TableView::rows(const ResultReader::Take& take) {
  if (request_.table == "results") return reader_.rows(picked_, request_.window, take);
  if (is_derived()) {
    if (!derived_.rows.empty()) take(derived_.rows);
    return;
  }
  const std::vector<RecordColumn>& events = reader_.layout().events;
  const std::size_t width = events.size();
  const bool impacts = request_.table == "impacts";
  std::vector<std::size_t> places;
  for (const auto& column : impact_columns) places.push_back(place_of(events, column.field));
  const std::size_t duration = place_of(events, "duration");
  const RowWindow& window = request_.window;
  std::size_t met = 0;
  std::vector<double> some;
  reader_.events([&](std::span<const double> block) {
    some.clear();
    for (; !block.empty(); block = block.subspan(width)) {
      const auto event = block.first(width);
      if (event[0] < window.from || event[0] > window.until) continue;
      const std::string& kind = reader_.layout().kinds[static_cast<std::size_t>(event[2])];
      if (impacts && !kind.ends_with("contact_end")) continue;
      if (met++ % window.every != 0) continue;
      if (!impacts) {
        some.insert(some.end(), event.begin(), event.end());
        continue;
      }
      for (const std::size_t place : places) {
        some.push_back(place < width ? event[place] : std::numeric_limits<double>::quiet_NaN());
      }
      double& begin = *(some.end() - static_cast<std::ptrdiff_t>(places.size()) + 1);
      begin = duration < width ? begin - event[duration] : std::numeric_limits<double>::quiet_NaN();
    }
    if (!some.empty()) take(some);
  });
}

const std::string* TableView::word(std::size_t column, double number) const {
  if (request_.table == "results") return nullptr;
  const std::string& name = columns_[column].name;
  const RecordLayout& layout = reader_.layout();
  const std::vector<std::string>& joints = is_derived() ? layout.bearings : layout.joints;
  const std::vector<std::string>* words = name == "joint" ? &joints : name == "kind" ? &layout.kinds : nullptr;
  if (words == nullptr || !(number >= 0.0) || static_cast<std::size_t>(number) >= words->size()) return nullptr;
  return &(*words)[static_cast<std::size_t>(number)];
}

}  // namespace freeplay
