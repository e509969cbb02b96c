#include "cli/compare_command.h"

#include <algorithm>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "base/error.h"
#include "base/number_text.h"
#include "cli/study_options.h"
#include "cli/terminal.h"
#include "results/comparison.h"
#include "results/whole_result.h"
#include "study/table_comparison.h"

namespace freeplay {
namespace {

constexpr std::size_t rows_shown = 10;  // without --verbose and --channels

struct CompareOptions {
  std::string a, b, tolerance, absolute, from, until;
  std::vector<std::string> channels;
};

/// A number >= 0 without a unit of its own, or a time.
double value_of(const std::string& option, const std::string& text, bool time) {
  if (time) return signed_quantity(option, text, dimension::time);
  const double value = signed_quantity(option, text, dimension::none);
  if (!(value >= 0.0)) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("bad value '{}' of {}: it must not be negative", text, option));
  }
  return value;
}

ComparisonRules rules_of(const CompareOptions& options) {
  ComparisonRules rules;
  if (!options.tolerance.empty()) rules.relative = value_of("--tolerance", options.tolerance, false);
  if (!options.absolute.empty()) rules.absolute = value_of("--absolute", options.absolute, false);
  if (!options.from.empty()) rules.from = value_of("--from", options.from, true);
  if (!options.until.empty()) rules.until = value_of("--until", options.until, true);
  if (rules.from > rules.until) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("--from {} is after --until {}", options.from, options.until));
  }
  if (!options.channels.empty()) rules.channels = options.channels;
  return rules;
}

std::string row_text(const Difference& d) {
  return fmt::format("{},{},{},{},{},{}\n", d.name, number_text(d.largest), number_text(d.relative), number_text(d.rms),
                     number_text(d.at_time), d.agrees ? "1" : "0");
}

std::string place_of(const std::string& distance) { return distance.substr(0, distance.rfind('.')); }

/// What the rows of two tables are called.
struct Words {
  const char *column, *columns, *at, *rows;
};
constexpr Words of_results = {"channel", "channels", "at_time", "rows"};
constexpr Words of_studies = {"column", "columns", "at_point", "points"};

std::string table_text(const Comparison& comparison, bool all, const Words& words) {
  std::string text = fmt::format("{},max_abs,max_rel,rms,{},ok\n", words.column, words.at);
  const std::span<const Difference> channels = comparison.channels;
  const std::size_t shown = all ? channels.size() : std::min(channels.size(), rows_shown);
  for (const Difference& d : channels.first(shown)) text += row_text(d);
  if (all) {
    for (const Difference& d : comparison.distances) text += row_text(d);
  }
  const auto differing = [](std::span<const Difference> list) {
    return std::ranges::count_if(list, [](const Difference& d) { return !d.agrees; });
  };
  if (const auto rest = channels.subspan(shown); !rest.empty()) {
    const auto differ = differing(rest);
    text += fmt::format("# {} more {}, {}; all with --verbose, some with --channels\n", rest.size(), words.columns,
                        differ == 0 ? "which agree" : fmt::format("of which {} differ", differ));
  }
  text += fmt::format("# {} {} in {} {}: {} differ\n", channels.size(), words.columns, comparison.rows, words.rows,
                      differing(channels));
  for (const std::string& missing : comparison.missing) text += "# " + missing + "\n";
  if (comparison.distances.empty() || comparison.rows == 0) return text;
  return text + fmt::format("# distance of bodies and frames, {} in all: {} m rms\n# farthest: {}, {} m at t = {} s\n",
                            comparison.distances.size(), number_text(comparison.distance.rms),
                            place_of(comparison.farthest), number_text(comparison.distance.largest),
                            number_text(comparison.distance.at_time));
}

Json table_json(const Comparison& comparison, const Words& words) {
  Json list = Json::array();
  const auto put = [&](const Difference& d) {
    list.push_back({{words.column, d.name},
                    {"max_abs", json_number(d.largest)},
                    {"max_rel", json_number(d.relative)},
                    {"rms", json_number(d.rms)},
                    {words.at, json_number(d.at_time)},
                    {"ok", d.agrees}});
  };
  for (const Difference& d : comparison.channels) put(d);
  for (const Difference& d : comparison.distances) put(d);
  if (!comparison.distances.empty()) put(comparison.distance);
  return list;
}

int tell(const Comparison& comparison, const Words& words, const CompareOptions& options, const CommonOptions& common) {
  if (common.json) {
    print_json(table_json(comparison, words));
  } else {
    print(table_text(comparison, common.verbose || !options.channels.empty(), words));
  }
  // The table has said what is missing.
  std::vector<std::string> notes = common.json ? comparison.missing : std::vector<std::string>();
  notes.insert(notes.end(), comparison.aside.begin(), comparison.aside.end());
  for (const std::string& text : notes) print_messages("freeplay: note: " + text + "\n", common.no_color);
  return comparison.agree() ? 0 : 7;
}

/// Of the directories of two studies: their tables, point by point.
int compare_studies(const CompareOptions& options, const ComparisonRules& rules, const CommonOptions& common) {
  for (const std::string& one : {options.a, options.b}) {
    if (StudyFolder(one).holds_study()) continue;
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("'{}' is the directory of a study, and '{}' is none",
                            one == options.a ? options.b : options.a, one),
                {}, "a study is compared with a study, a result with a result");
  }
  if (!options.from.empty() || !options.until.empty()) {
    throw Error(Error::Category::usage, "bad-value", "the table of a study has no times for --from and --until");
  }
  const StudyInFolder a = open_kept(options.a, StudyUse::look, common);
  if (!a.study) return a.exit_code;
  const StudyInFolder b = open_kept(options.b, StudyUse::look, common);
  if (!b.study) return b.exit_code;
  return tell(compare_tables({*a.study, a.folder.path()}, {*b.study, b.folder.path()}, rules), of_studies, options,
              common);
}

int compare_results(const CompareOptions& options, const CommonOptions& common) {
  if (options.a.empty() || options.b.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "compare needs two results");
  }
  const ComparisonRules rules = rules_of(options);
  if (StudyFolder(options.a).holds_study() || StudyFolder(options.b).holds_study()) {
    return compare_studies(options, rules, common);
  }
  const std::unique_ptr<ResultReader> a = ResultReader::open(options.a), b = ResultReader::open(options.b);
  for (ResultReader* const reader : {a.get(), b.get()}) {
    const std::string missing = missing_part(*reader);
    if (!missing.empty()) print_messages("freeplay: warning: " + missing + "\n", common.no_color);
  }
  const Comparison comparison = compare(*a, *b, rules);
  const int exit_code = tell(comparison, of_results, options, common);
  if (comparison.interpolated && !common.quiet) {
    print_messages(fmt::format("freeplay: note: times differ: {} is interpolated linearly\n", b->file()),
                   common.no_color);
  }
  return exit_code;
}

}  // namespace

Command add_compare_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "compare", "Print how far two results agree");
  const auto options = std::make_shared<CompareOptions>();
  add_option(*app, "A", options->a, "Result directory, CSV or HDF5 file, or directory of a study");
  add_option(*app, "B", options->b,
             "Another; it is interpolated where its times differ. Of studies the points that both have");
  add_option(*app, "--tolerance", options->tolerance, "Part of the largest |a| that may differ (1e-6)", "REL");
  add_option(*app, "--absolute", options->absolute, "What may differ besides (1e-12)", "ABS");
  add_repeatable(*app, "--channels", options->channels, "Channels to compare, a name or pattern with *; repeatable",
                 "PATTERN");
  add_option(*app, "--from", options->from, "First time: \"10 ms\"", "T");
  add_option(*app, "--until", options->until, "Last time", "T");
  add_common_options(*app, common);
  return {app, [options, &common] { return compare_results(*options, common); }};
}

}  // namespace freeplay
