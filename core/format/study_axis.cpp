#include "format/study_axis.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/expression.h"
#include "format/draft.h"
#include "format/grid.h"
#include "format/map_reader.h"

namespace freeplay {
namespace {

/// Such as a law, an integrator or a frame: what is no quantity and could not be meant as one either. Texts in quotes
/// are meant as they are.
bool is_word(const Node& node) {
  if (!node.is_scalar()) return true;
  if (constant_quantity(node.text)) return false;
  if (node.quoted && node.text.find('$') == std::string::npos) return true;
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto inside = [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || std::string_view("-.*/").find(c) != std::string_view::npos;
  };
  return !node.text.empty() && letter(node.text.front()) && std::ranges::all_of(node.text, inside);
}

/// Reads one entry.
class AxisReader {
 public:
  AxisReader(const CheckedValue& entry, const TargetDimension& dimension_of)
      : axis_{entry, entry.key(), entry.key()}, dimension_of_(dimension_of) {}

  std::optional<StudyAxis> read() {
    const Node& node = axis_.entry.node();
    if (!node.is_map()) find_dimension();
    const bool good = node.is_map() ? read_map() : read_values(axis_.entry);
    if (!good) return std::nullopt;
    return std::move(axis_);
  }

 private:
  void find_dimension() {
    if (dimension_of_ && !axis_.each) axis_.dimension = dimension_of_(axis_.target);
  }

  static constexpr std::array forms = {"linspace", "logspace", "list",       "cases", "table",
                                       "normal",   "uniform",  "triangular", "fit"};

  bool read_map() {
    MapReader map(axis_.entry, "study axis");
    const auto target = map.find("target"), each = map.find("each"), present = map.find("where_present");
    bool good = !map.conflict("target", "each");
    if (target) axis_.target = named(*target);
    if (each) {
      axis_.target = named(*each);
      axis_.each = true;
    }
    if ((target || each) && axis_.target.empty()) good = false;
    find_dimension();
    if (present) axis_.where_present = present->boolean().value_or(false);
    good = read_form(map) && good;
    if (target || each || !axis_.cases.empty()) Draft::check_name(axis_.entry);
    map.finish();
    return good;
  }

  static std::string named(const CheckedValue& value) {
    const auto text = value.string();
    if (text && text->empty()) value.fail("wrong-type", fmt::format("'{}' must not be empty", value.path()));
    return text.value_or("");
  }

  bool read_form(MapReader& map) {
    const char* form = nullptr;
    for (const char* word : forms) {
      if (!map.find(word)) continue;
      if (form != nullptr && map.conflict(form, word)) return false;
      form = word;
    }
    if (form == nullptr) {
      map.find("truncate"), map.find("diameter"), map.find("law");
      map.owner().fail_at_key("missing-key", fmt::format("'{}' says no values", axis_.entry.path()), {},
                              "one of " + either({forms.begin(), forms.end()}));
      return false;
    }
    const std::string word = form;
    if (word == "fit") return read_fit(map);
    if (word == "cases" || word == "table") {
      axis_.target.clear();
      if (map.has("target") || map.has("each")) {
        return !map.conflict(word, "target") && !map.conflict(word, "each");
      }
      return word == "cases" ? read_cases(*map.find("cases")) : read_table(*map.find("table"));
    }
    if (word == "list") return read_values(*map.find("list"));
    if (word == "linspace" || word == "logspace") {
      axis_.grid = read_space(*map.find(word), word == "logspace", axis_.dimension);
      return axis_.grid.has_value();
    }
    axis_.distribution = read_distribution(map, axis_.dimension);
    return axis_.distribution.has_value();
  }

  /// A value or a list of values.
  bool read_values(const CheckedValue& value) {
    if (value.node().is_list() && value.node().items.empty()) {
      value.fail("wrong-length", fmt::format("'{}' must have at least 1 item", value.path()));
      return false;
    }
    if (value.node().is_null()) {
      value.wrong_type("a value or a list of values");
      return false;
    }
    const auto items = value.one_or_list();
    if (!items) return false;
    const bool words = std::ranges::any_of(*items, [](const CheckedValue& item) { return is_word(item.node()); });
    if (!words) {
      axis_.grid = read_grid(value, axis_.dimension);
      return axis_.grid.has_value();
    }
    axis_.list = *items;
    bool good = true;
    for (const CheckedValue& item : *items) {
      if (!item.node().is_null() && (is_word(item.node()) || item.any_quantity())) continue;
      if (item.node().is_null()) item.wrong_type("a value");
      good = false;
    }
    return good;
  }

  bool read_cases(const CheckedValue& section) {
    bool good = true;
    for (const CheckedValue& entry : entries_of(section)) {
      check_table_word(entry);
      StudyCase made{entry.key(), {}};
      for (const CheckedValue& value : entries_of(entry)) {
        if (value.node().is_null()) value.wrong_type("a value");
        good = good && !value.node().is_null();
        made.values.push_back({value.key(), value});
      }
      good = good && entry.node().is_map();
      axis_.cases.push_back(std::move(made));
    }
    if (axis_.cases.empty() && section.node().is_map()) section.fail("wrong-length", "there is no case");
    return good && !axis_.cases.empty();
  }

  bool read_table(const CheckedValue& value) {
    if (!value.string()) return false;
    axis_.table = value;
    return true;
  }

  bool read_fit(MapReader& map) {
    const auto codes = map.find("fit"), diameter = map.require("diameter"), law = map.find("law"),
               cut = map.find("truncate");
    axis_.dimension = dimension::length;
    const auto items = codes->one_or_list();
    const std::optional<double> size = diameter ? diameter->quantity(dimension::length, positive) : std::nullopt;
    const std::optional<int> word = law ? law->word({"normal", "uniform"}) : std::optional<int>(0);
    const auto ends = cut ? read_ends(*cut, axis_.dimension) : std::nullopt;
    if (!items || !size || !word || (cut && !ends)) return false;
    if (items->empty()) codes->fail("wrong-length", fmt::format("'{}' must have at least 1 item", codes->path()));
    for (const CheckedValue& code : *items) {
      auto fit = limits_of(code, *size);
      if (!fit) continue;
      fit->normal = *word == 0;
      if (!(cut ? cut_fit(*fit, *cut, *ends) : true) || !has_clearance(*fit, *size, code)) continue;
      if (std::ranges::find(axis_.fits, fit->code, &StudyFit::code) != axis_.fits.end())
        code.fail("duplicate-name", fmt::format("'{}' stands there twice", fit->code));
      axis_.fits.push_back(std::move(*fit));
    }
    return !items->empty() && axis_.fits.size() == items->size();
  }

  static std::optional<StudyFit> limits_of(const CheckedValue& code, double size) {
    const auto text = code.string();
    if (!text) return std::nullopt;
    const std::optional<IsoFit> limits = iso_fit(*text, size);
    if (limits) return StudyFit{*limits, true, limits->smallest_clearance(), limits->largest_clearance(), *text};
    code.fail("bad-fit", fmt::format("'{}' on {:.6g} mm is no fit that is known", *text, size * 1e3), {},
              "holes D to H and JS, shafts d to h and js, grades 5 to 11, up to 500 mm, such as H7/g6");
    return std::nullopt;
  }

  static std::string range_of(const StudyFit& fit) {
    return fmt::format("{:.6g} to {:.6g} um", fit.low * 1e6, fit.high * 1e6);
  }

  static bool cut_fit(StudyFit& fit, const CheckedValue& cut, const std::pair<double, double>& ends) {
    if (ends.first >= fit.high || ends.second <= fit.low) {
      cut.fail("out-of-range",
               fmt::format("the radial clearance of {} is {}: nothing is left", fit.code, range_of(fit)));
      return false;
    }
    fit.low = std::max(fit.low, ends.first);
    fit.high = std::min(fit.high, ends.second);
    return true;
  }

  static bool has_clearance(const StudyFit& fit, double size, const CheckedValue& code) {
    if (fit.low > 0.0) return true;
    code.fail("out-of-range",
              fmt::format("the radial clearance of {} on {:.6g} mm is {}; it must be > 0", fit.code, size * 1e3,
                          range_of(fit)),
              {}, "another fit, or `truncate: [low, high]`");
    return false;
  }

  StudyAxis axis_;
  const TargetDimension& dimension_of_;
};

}  // namespace

std::optional<Quantity> constant_quantity(const std::string& text) {
  try {
    return Expression::compile(text, EmptyScope(), false).constant();
  } catch (const ExpressionError&) {
    return std::nullopt;
  }
}

void check_table_word(const CheckedValue& entry) {
  const std::string name = entry.key();
  const auto strange = [](char c) { return (c >= 0 && c < ' ') || c == '\x7f' || c == ',' || c == '"'; };
  if (!name.empty() && name.front() != ' ' && name.back() != ' ' && std::ranges::none_of(name, strange)) return;
  entry.fail_at_key("bad-name", "'" + name + "' cannot stand in a table", {},
                    "a name without commas, quotes and line feeds, and no blank at its ends");
}

std::optional<StudyAxis> read_study_axis(const CheckedValue& entry, const TargetDimension& dimension_of) {
  return AxisReader(entry, dimension_of).read();
}

}  // namespace freeplay
