#include "format/study_section.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "format/draft.h"
#include "format/map_reader.h"
#include "format/name_rule.h"

namespace freeplay {
namespace {

constexpr long most_samples = 1'000'000'000'000;
constexpr long most_seed = 9'223'372'036'854'775'807;

/// Number of the axis of this name, or nothing after a message.
std::optional<std::size_t> axis_of(const CheckedValue& value, const std::vector<StudyAxis>& axes) {
  const auto name = value.string();
  if (!name) return std::nullopt;
  const auto found = std::ranges::find(axes, *name, &StudyAxis::name);
  if (found != axes.end()) return static_cast<std::size_t>(found - axes.begin());
  std::vector<std::string> names;
  for (const StudyAxis& axis : axes) names.push_back(axis.name);
  value.fail("unknown-name", "unknown axis '" + *name + "'", nearest(*name, names));
  return std::nullopt;
}

/// Reads the section into a StudySection.
class StudyReader {
 public:
  StudyReader(const CheckedValue& section, bool in_model, const TargetDimension& dimension_of)
      : study_{section}, in_model_(in_model), dimension_of_(dimension_of) {}

  StudySection read() {
    MapReader map(study_.section, "study");
    const auto name = map.find("name"), description = map.find("description");
    if (name) study_.name = name->string().value_or("");
    if (description) description->string();
    read_models(map);
    if (const auto set = present(map, "set")) read_set(*set);
    if (const auto axes = present(map, "axes")) read_axes(*axes);
    read_combination(map);
    const auto sample = map.find("sample");
    if (sample) read_sample(*sample);
    check_sample(sample);
    if (const auto what = map.find("do")) read_analysis(*what);
    if (const auto warm = present(map, "warm_start")) read_warm_start(*warm);
    if (const auto reducers = present(map, "reducers")) read_reducers(*reducers);
    if (const auto stop = present(map, "stop")) read_stop(*stop);
    if (const auto plots = present(map, "plots")) read_plots(*plots);
    map.finish();
    return std::move(study_);
  }

 private:
  static std::optional<CheckedValue> present(MapReader& map, const char* key) {
    auto value = map.find(key);
    if (value && value->node().is_null()) value.reset();
    return value;
  }

  void read_models(MapReader& map) {
    const auto models = in_model_ ? map.find("models") : map.require("models");
    if (!models) return;
    if (in_model_) {
      models->fail_at_key("conflicting-keys", "a study that stands in a model is of that model", {},
                          "give the study a file of its own");
      return;
    }
    if (models->node().is_map()) {
      for (const CheckedValue& entry : entries_of(*models)) {
        check_table_word(entry);
        if (entry.string()) study_.models.push_back({entry.key(), entry});
      }
    } else if (const auto items = models->list()) {
      for (const CheckedValue& item : *items) {
        if (item.string()) study_.models.push_back({"", item});
      }
    }
    const bool empty = models->node().items.empty() && models->node().entries.empty();
    if (empty && (models->node().is_map() || models->node().is_list())) {
      models->fail("wrong-length", "a study has at least one model");
    }
  }

  void read_set(const CheckedValue& section) {
    for (const CheckedValue& entry : entries_of(section)) {
      if (entry.node().is_null()) {
        entry.wrong_type("a value");
      } else {
        study_.set.push_back({entry.key(), entry});
      }
    }
  }

  void read_axes(const CheckedValue& section) {
    for (const CheckedValue& entry : entries_of(section)) {
      if (auto axis = read_study_axis(entry, dimension_of_)) {
        study_.axes.push_back(std::move(*axis));
      } else {
        whole_ = false;
      }
    }
  }

  bool any_random() const { return std::ranges::any_of(study_.axes, &StudyAxis::random); }

  void read_combination(MapReader& map) {
    const auto combine = map.find("combine"), zip = map.find("zip");
    if (combine) {
      const auto word = combine->word({"grid", "zip", "star"});
      study_.combine = static_cast<StudySection::Combine>(word.value_or(0));
      if (study_.combine == StudySection::Combine::star && any_random()) {
        combine->fail("conflicting-keys", "random axes have no values to take one at a time");
      }
      if (zip && study_.combine != StudySection::Combine::grid && word) {
        zip->fail_at_key("conflicting-keys", "`zip` names axes of a grid; `combine` is no grid");
        return;
      }
    }
    if (study_.combine == StudySection::Combine::zip) {
      std::vector<std::size_t> all;
      for (std::size_t i = 0; i < study_.axes.size(); ++i) {
        if (!study_.axes[i].random()) all.push_back(i);
      }
      if (all.size() > 1) study_.side_by_side.push_back(std::move(all));
    }
    if (!zip || !whole_) return;
    const auto lists = zip->list();
    for (const CheckedValue& list : lists.value_or(std::vector<CheckedValue>{})) read_zip(list);
  }

  void read_zip(const CheckedValue& value) {
    const auto names = value.list();
    if (!names) return;
    std::vector<std::size_t> group;
    for (const CheckedValue& item : *names) {
      const auto axis = axis_of(item, study_.axes);
      if (!axis) continue;
      const auto has = [&](const std::vector<std::size_t>& other) {
        return std::ranges::find(other, *axis) != other.end();
      };
      if (has(group) || std::ranges::any_of(study_.side_by_side, has)) {
        item.fail("duplicate-name", "the axis '" + study_.axes[*axis].name + "' goes side by side with others already");
      } else if (study_.axes[*axis].random()) {
        item.fail("conflicting-keys", "the values of a random axis follow the samples");
      } else {
        group.push_back(*axis);
      }
    }
    if (group.size() > 1) study_.side_by_side.push_back(std::move(group));
  }

  void read_sample(const CheckedValue& section) {
    MapReader map(section, "study sample");
    const auto method = map.require("method"), points = map.require("points"), seed = map.require("seed");
    const auto word = method ? method->word({"random", "latin-hypercube", "sobol"}) : std::nullopt;
    const auto count = points ? points->integer(1, most_samples) : std::nullopt;
    const auto number = seed ? read_seed(*seed) : std::nullopt;
    map.finish();
    sample_written_ = map.good();
    if (!word || !count || !number) return;
    study_.sample = {static_cast<StudySample::Method>(*word), static_cast<std::uint64_t>(*count), *number};
  }

  /// Numbers above 2^53 are whole only where they are read as such.
  static std::optional<std::uint64_t> read_seed(const CheckedValue& value) {
    const std::string& text = value.node().text;
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    const bool whole = value.node().is_scalar() && error == std::errc() && end == text.data() + text.size();
    if (whole && seed >> 63 == 0) return seed;
    if (value.node().is_scalar() && !text.empty() && text.find_first_not_of("0123456789") == std::string::npos) {
      value.fail("out-of-range", fmt::format("'{}' must be <= {}, not {}", value.path(), most_seed, text));
      return std::nullopt;
    }
    const auto number = value.integer(0, 1L << 53);
    return number ? std::optional(static_cast<std::uint64_t>(*number)) : std::nullopt;
  }

  void check_sample(const std::optional<CheckedValue>& sample) {
    const auto random = std::ranges::find_if(study_.axes, &StudyAxis::random);
    if (random != study_.axes.end() && !sample) {
      random->entry.fail_at_key("missing-key", "the axis '" + random->name + "' is random: the study needs `sample`",
                                {}, "sample: {method: latin-hypercube, points: 1000, seed: 1}");
    }
    if (random == study_.axes.end() && sample && whole_ && sample_written_) {
      sample->warn_at_key("unused", "no axis is random: `sample` is not used");
      study_.sample.reset();
    }
  }

  void read_analysis(const CheckedValue& value) {
    if (!value.node().is_map()) {
      value.word({"run"});
      return;
    }
    known_keys(value, "study analysis");
    study_.analysis = &value.node();
  }

  /// What other rooms read: keys, and words where nothing but words may stand, are those of the table.
  static void known_keys(const CheckedValue& value, const char* format) {
    MapReader map(value, format);
    for (const FormatKey& key : format_map(format).keys) {
      const auto written = map.find(std::string(key.name));
      const std::vector<std::string> words = words_of(key);
      if (written && !words.empty()) written->word(words);
    }
    map.finish();
  }

  /// Of "'one' | 'two'"; none where something else may stand, too.
  static std::vector<std::string> words_of(const FormatKey& key) {
    std::vector<std::string> words;
    for (std::string_view rest = key.value; !rest.empty();) {
      const std::string_view one = rest.substr(0, rest.find(" | "));
      if (!one.starts_with('\'')) return {};
      words.emplace_back(one.substr(1, one.size() - 2));
      rest.remove_prefix(std::min(one.size() + 3, rest.size()));
    }
    return words;
  }

  void read_warm_start(const CheckedValue& section) {
    MapReader map(section, "study warm start");
    const auto along = map.require("along"), direction = map.find("direction"), pieces = map.find("pieces");
    StudyWarmStart warm;
    const auto axis = along && whole_ ? axis_of(*along, study_.axes) : std::nullopt;
    if (direction) {
      warm.direction = static_cast<StudyWarmStart::Direction>(direction->word({"up", "down", "both"}).value_or(0));
    }
    if (pieces) warm.pieces = static_cast<std::uint64_t>(pieces->integer(1, 1'000'000).value_or(1));
    map.finish();
    if (!axis) return;
    if (study_.axes[*axis].random()) {
      along->fail("conflicting-keys", "a random axis has no order to go along", {}, "an axis with a grid");
    } else if (study_.combine == StudySection::Combine::star) {
      along->fail("conflicting-keys", "with `combine: star` there is no way along an axis");
    } else if (study_.analysis != nullptr) {
      section.fail_at_key("conflicting-keys", "points that are analyses have no end to begin from");
    }
    warm.axis = *axis;
    study_.warm_start = warm;
  }

  void read_reducers(const CheckedValue& section) {
    for (const CheckedValue& entry : entries_of(section)) {
      Draft::check_name(entry);
      known_keys(entry, "study reducer");
    }
    study_.reducers = &section.node();
  }

  void read_stop(const CheckedValue& section) {
    MapReader map(section, "study stop");
    const auto reducer = map.require("reducer"), of = map.require("of"), confidence = map.find("confidence"),
               width = map.find("half_width"), relative = map.find("relative"), least = map.find("min_points"),
               block = map.find("block");
    StudyStop stop;
    if (reducer) {
      check_column(*reducer, "reducer", reducer_names());
      stop.reducer = reducer->node().text;
    }
    if (of) stop.percentile = read_estimate(*of);
    const Range open{.minimum = 0.0, .maximum = 1.0, .open = Open::both};
    if (confidence) stop.confidence = confidence->quantity(dimension::none, open).value_or(0.95);
    if (width) {
      stop.width = *width;
      const auto quantity = width->any_quantity();
      if (quantity) stop.half_width = quantity->value;
      if (quantity && !(quantity->value > 0.0)) width->fail("out-of-range", "'half_width' must be > 0");
    }
    if (relative) stop.relative = relative->quantity(dimension::none, positive);
    if (least) stop.min_points = static_cast<std::uint64_t>(least->integer(2, most_samples).value_or(200));
    if (block) stop.block = static_cast<std::uint64_t>(block->integer(1, most_samples).value_or(100));
    if (!map.conflict("half_width", "relative") && !width && !relative && map.good()) map.report_missing("half_width");
    map.finish();
    if (sample_written_ && study_.sample && study_.sample->method != StudySample::Method::random) {
      section.fail_at_key("conflicting-keys", "only samples of `method: random` can end early");
    } else if (!sample_written_ && map.good()) {
      section.fail_at_key("conflicting-keys", "no axis is random: there are no samples to end");
    }
    study_.stop = stop;
  }

  std::vector<std::string> reducer_names() const {
    std::vector<std::string> names;
    if (study_.reducers == nullptr) return names;
    for (const Node::Entry& entry : study_.reducers->entries) names.push_back(entry.key->text);
    return names;
  }

  /// Columns of sets, tables and axes for each of several paths are known with the models.
  static void check_column(const CheckedValue& value, const char* kind, const std::vector<std::string>& names) {
    const auto name = value.string();
    if (!name) return;
    const bool known = std::ranges::any_of(
        names, [&](const std::string& one) { return *name == one || name->starts_with(one + "."); });
    if (!known) value.fail("unknown-name", fmt::format("unknown {} '{}'", kind, *name), nearest(*name, names));
  }

  bool knows_axes() const {
    return whole_ && std::ranges::none_of(study_.axes, [](const StudyAxis& axis) { return axis.each || axis.table; });
  }

  static std::optional<double> read_estimate(const CheckedValue& value) {
    const auto word = value.string();
    if (!word || *word == "mean") return std::nullopt;
    double percentile = 0.0;
    const char* end = word->data() + word->size();
    const bool number =
        word->size() > 1 && word->front() == 'p' && std::from_chars(word->data() + 1, end, percentile).ptr == end;
    if (number && percentile > 0.0 && percentile < 100.0) return percentile;
    value.fail("wrong-type", "'of' is mean or a percentile such as p50 or p99, not '" + *word + "'");
    return std::nullopt;
  }

  void read_plots(const CheckedValue& section) {
    for (const CheckedValue& entry : entries_of(section)) {
      Draft::check_name(entry);
      MapReader map(entry, "study plot");
      const auto kind = map.require("kind");
      const auto word = kind ? kind->word({"line", "heat", "bifurcation", "histogram", "tornado"}) : std::nullopt;
      check_plot_columns(map);
      if (word) require_plot_keys(map, static_cast<PlotKind>(*word));
      if (word) doubt_plot_keys(map, static_cast<PlotKind>(*word), kind->node().text);
      if (const auto percentiles = map.find("percentiles")) {
        for (const CheckedValue& item : percentiles->list().value_or(std::vector<CheckedValue>{})) {
          item.quantity(dimension::none, Range{.minimum = 0.0, .maximum = 100.0});
        }
      }
      map.finish();
    }
    study_.plots = &section.node();
  }

  enum class PlotKind { line, heat, bifurcation, histogram, tornado };

  /// What a picture of that kind shows; where one number is shown, `y` and `value` are the same.
  void require_plot_keys(MapReader& map, PlotKind kind) const {
    const bool over_x = kind == PlotKind::line || kind == PlotKind::heat || kind == PlotKind::bifurcation;
    const bool heat = kind == PlotKind::heat, samples = kind == PlotKind::bifurcation;
    const char* const shown = kind == PlotKind::line ? "y" : "value";
    if (over_x && !map.has("x")) map.report_missing("x");
    if (heat && !map.has("y")) map.report_missing("y");
    if (!map.has("value") && (heat || samples || !map.has("y"))) map.report_missing(shown);
    const auto value = map.find("value");
    if (!samples || !value || study_.reducers == nullptr) return;
    for (const Node::Entry& entry : study_.reducers->entries) {
      const std::string &name = entry.key->text, &text = value->node().text;
      const Node* reduce = entry.value->find("reduce");
      if ((text != name && !text.starts_with(name + ".")) || (reduce != nullptr && reduce->text == "poincare"))
        continue;
      value->fail("wrong-type", fmt::format("a bifurcation shows a reducer of `reduce: poincare`; '{}' is none", name));
    }
  }

  /// What a picture of that kind does not look at.
  static void doubt_plot_keys(MapReader& map, PlotKind kind, const std::string& word) {
    const bool over_x = kind == PlotKind::line || kind == PlotKind::heat || kind == PlotKind::bifurcation;
    const bool has_families = kind != PlotKind::heat && kind != PlotKind::tornado;
    const auto doubt = [&](const char* key) {
      if (const auto value = map.find(key)) {
        value->warn_at_key("unused", fmt::format("a plot of kind {} does not look at '{}'", word, key));
      }
    };
    if (!over_x) doubt("x");
    if (!has_families) doubt("by");
    if (kind != PlotKind::histogram) doubt("percentiles");
    if (kind == PlotKind::bifurcation) doubt("y");
    if (kind != PlotKind::heat && kind != PlotKind::bifurcation && map.has("y") && map.has("value")) {
      doubt(kind == PlotKind::line ? "value" : "y");
    }
  }

  void check_plot_columns(MapReader& map) const {
    std::vector<std::string> axes, families = {"model", "direction"}, reducers = reducer_names(), any;
    for (const StudyAxis& axis : study_.axes) axes.push_back(axis.name);
    families.insert(families.end(), axes.begin(), axes.end());
    any = families;
    any.insert(any.end(), reducers.begin(), reducers.end());
    const auto x = map.find("x"), y = map.find("y"), value = map.find("value"), by = map.find("by");
    if (x && knows_axes()) check_column(*x, "axis", any);
    if (y && knows_axes()) check_column(*y, "axis or reducer", any);
    if (value) check_column(*value, "reducer", reducers);
    if (by && knows_axes()) check_column(*by, "axis", families);
  }

  StudySection study_;
  bool in_model_;
  const TargetDimension& dimension_of_;
  bool whole_ = true;  // every axis could be read
  bool sample_written_ = false;
};

}  // namespace

StudySection read_study(const CheckedValue& section, bool in_model, const TargetDimension& dimension_of) {
  return StudyReader(section, in_model, dimension_of).read();
}

}  // namespace freeplay
