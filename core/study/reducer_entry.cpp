#include "study/reducer_entry.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "format/draft.h"
#include "format/map_reader.h"

namespace freeplay {
namespace {

using Source = ReducerEntry::Source;

struct SourceKey {
  const char* key;
  Source source;
};
constexpr std::array<SourceKey, 7> source_keys = {{{"channel", Source::channel},
                                                   {"value", Source::value},
                                                   {"summary", Source::summary},
                                                   {"events", Source::events},
                                                   {"joint", Source::set},
                                                   {"column", Source::column},
                                                   {"of", Source::of}}};

const std::vector<std::string> reductions = {"min",          "max",           "absmax", "first",   "final",
                                             "peak-to-peak", "mean",          "rms",    "std",     "percentile",
                                             "median",       "time-fraction", "count",  "poincare"};
constexpr std::array<Reduction, 13> kinds = {
    Reduction::min,        Reduction::max,        Reduction::absmax,
    Reduction::first,      Reduction::final,      Reduction::peak_to_peak,
    Reduction::mean,       Reduction::rms,        Reduction::standard_deviation,
    Reduction::percentile, Reduction::percentile, Reduction::time_fraction,
    Reduction::count};
constexpr std::size_t percentile_word = 9, poincare_word = 13;

/// Reads one entry.
class EntryReader {
 public:
  EntryReader(const CheckedValue& value, bool analysis) : map_(value, "study reducer"), analysis_(analysis) {}

  std::optional<ReducerEntry> read() {
    if (!map_.good()) return std::nullopt;
    std::optional<ReducerEntry> entry = read_source();
    if (!entry) return std::nullopt;
    if (analysis_ != (entry->source == Source::column) && entry->source != Source::of) {
      entry->subject.fail_at_key("conflicting-keys",
                                 analysis_ ? "points that are an analysis have columns alone: use `column`"
                                           : "there is no analysis to take a column of: `do` says which");
    }
    read_rest(*entry);
    map_.finish();
    return entry;
  }

 private:
  std::optional<ReducerEntry> read_source() {
    std::optional<ReducerEntry> entry;
    std::string first;
    for (const SourceKey& key : source_keys) {
      const auto subject = map_.find(key.key);
      if (!subject) continue;
      if (entry) {
        map_.conflict(first, key.key);
        continue;
      }
      first = key.key;
      if (!subject->string()) return std::nullopt;
      entry.emplace(ReducerEntry{.name = map_.owner().key(), .source = key.source, .subject = *subject});
    }
    if (!entry) {
      map_.owner().fail_at_key("missing-key", fmt::format("reducer '{}' needs one of channel, value, summary, events, "
                                                          "joint, column and of",
                                                          map_.owner().key()));
    }
    return entry;
  }

  void read_rest(ReducerEntry& entry) {
    switch (entry.source) {
      case Source::summary:
        return read_over(entry);
      case Source::of:
        return;
      case Source::set:
        if (const auto set = map_.require("set")) set->word({"clearance"});
        return;
      case Source::events:
        read_events(entry);
        break;
      case Source::column:
        read_reduction(entry, percentile_word);
        break;
      default:
        read_reduction(entry, poincare_word);
        if (entry.section) read_section(entry);
    }
    if (entry.source == Source::column) return;
    entry.from = map_.find("from");
    entry.until = map_.find("until");
  }

  void read_over(ReducerEntry& entry) {
    const auto over = map_.find("over");
    if (!over) return;
    if (const auto word = over->word({"max", "min", "sum", "mean"}))
      entry.over = static_cast<ReducerEntry::Over>(*word);
  }

  void read_events(ReducerEntry& entry) {
    read_reduction(entry, percentile_word);
    const bool counts = entry.reduction == Reduction::count;
    if (const auto field = counts ? map_.find("field") : map_.require("field"))
      entry.field = field->string().value_or("");
    if (const auto kind = map_.find("kind")) entry.kind = kind->string().value_or("");
    entry.above = map_.find("above");
    if (counts && entry.above && entry.field.empty()) map_.report_missing("field");
  }

  /// `last`: of the words that may stand; only sections of values over time are poincare.
  void read_reduction(ReducerEntry& entry, std::size_t last) {
    const auto reduce = map_.require("reduce");
    if (!reduce) return;
    std::vector<std::string> words = reductions;
    if (last != poincare_word) words.pop_back();
    const auto word = reduce->word(words);
    if (!word) return;
    const auto which = static_cast<std::size_t>(*word);
    entry.section = which == poincare_word;
    if (entry.section) return;
    entry.reduction = kinds[which];
    if (which == percentile_word) entry.p = map_.require("p");
    const bool bounded = *entry.reduction == Reduction::time_fraction || *entry.reduction == Reduction::count;
    if (!bounded || entry.source == Source::events) return;
    entry.above = map_.find("above");
    entry.below = map_.find("below");
    if (entry.above && entry.below) map_.conflict("above", "below");
    if (!entry.above && !entry.below && !(entry.source == Source::column && *entry.reduction == Reduction::count))
      map_.report_missing("above");
  }

  void read_section(ReducerEntry& entry) {
    entry.every = map_.find("every");
    entry.phase = map_.find("phase");
    const auto when = map_.find("when");
    if (entry.every && when) map_.conflict("every", "when");
    if (entry.phase && when) map_.conflict("phase", "when");
    if (!entry.every && !when) map_.report_missing("every");
    if (!when) return;
    MapReader passage(*when, "study passage");
    entry.channel = passage.require("channel");
    entry.crosses = passage.require("crosses");
    if (entry.channel && !entry.channel->string()) entry.channel.reset();
    if (const auto direction = passage.find("direction")) {
      const int word = direction->word({"up", "down", "both"}).value_or(0);
      entry.up = word != 1;
      entry.down = word != 0;
    }
    passage.finish();
  }

  MapReader map_;
  bool analysis_;
};

}  // namespace

std::vector<ReducerEntry> read_reducers(const CheckedValue& section, bool analysis) {
  std::vector<ReducerEntry> entries;
  for (const CheckedValue& value : entries_of(section)) {
    Draft::check_name(value, {"index", "model", "direction", "sample", "start", "exit_code", "error_of_point"});
    if (auto entry = EntryReader(value, analysis).read()) entries.push_back(std::move(*entry));
  }
  return entries;
}

}  // namespace freeplay
