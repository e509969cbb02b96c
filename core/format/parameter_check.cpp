#include "format/parameter_check.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "format/arc_keys.h"
#include "format/doubtful_curve.h"
#include "format/doubtful_points.h"
#include "format/draft.h"
#include "format/parameter_tree.h"
#include "format/point_parameters.h"
#include "format/table_variables.h"
#include "model/table_formula.h"
#include "model/time_function.h"
#include "model/written_formula.h"

namespace freeplay {
namespace {

constexpr std::size_t most_curve_points = 1000;  // of a curve
// By which a cubic may turn back between points that go on, by their range: nine points follow a corner so.
constexpr double turns_back = 0.025;

bool is_law(ParameterKind kind) { return kind == ParameterKind::contact_law || kind == ParameterKind::friction_law; }

ComponentKind law_kind(ParameterKind kind) {
  return kind == ParameterKind::contact_law ? ComponentKind::contact_law : ComponentKind::friction_law;
}

/// The check of one component's block.
class ParameterCheck {
 public:
  ParameterCheck(const Component& component, Draft& draft, MotionParameters* motion)
      : component_(component), draft_(draft), registry_(draft.registry), motion_(motion) {
    block_.component = &component;
  }

  CheckedParameters run(MapReader& entry) {
    const ParameterTree tree(component_.description.parameters);
    bind_children(tree, entry, "");
    std::vector<Binding> waiting = std::move(bindings_);
    // Words come first: they choose units.
    std::stable_partition(waiting.begin(), waiting.end(),
                          [](const Binding& b) { return b.parameter->kind == ParameterKind::choice; });
    // A unit whose exponent is a parameter waits until that one is known.
    for (const bool last : {false, true}) {
      std::vector<Binding> later;
      for (Binding& binding : waiting) {
        if (!read(binding, last)) later.push_back(std::move(binding));
      }
      waiting = std::move(later);
    }
    if (good_) checked_.block = std::move(block_);
    return std::move(checked_);
  }

 private:
  struct Binding {
    const Parameter* parameter;
    std::optional<CheckedValue> value;
    CheckedValue owner;  // of the key, for what is missing
  };

  void bind_children(const ParameterTree& tree, MapReader& map, const std::string& prefix) {
    for (const ParameterTree& child : tree.children) {
      const std::string path = prefix + child.name;
      const std::optional<CheckedValue> value = map.find(child.name);
      if (!value) {
        if (map.good() && child.is_required()) {
          map.report_missing(child.name);
          good_ = false;
        }
        bind_absent(child, map.owner());
        continue;
      }
      checked_.places.emplace(path, *value);
      bind(child, *value, map, path);
    }
  }

  void bind(const ParameterTree& child, const CheckedValue& value, const MapReader& map, const std::string& path) {
    const bool branch = !child.children.empty();
    if (!branch || (child.leaf != nullptr && value.node().is_scalar())) {
      bindings_.push_back({child.leaf, value, map.owner()});
      for (const ParameterTree& inner : child.children) bind_absent(inner, value);
      return;
    }
    if (child.leaf != nullptr) block_.values[child.leaf->name].given = true;
    const char* block = component_.description.block;
    MapReader inner(value, block != nullptr && path == block ? Uses::presets : Uses::nothing);
    good_ = good_ && inner.good();
    bind_children(child, inner, path + ".");
    inner.finish();
  }

  /// Defaults for everything below; what is required has been reported by the caller, or stands in a block that need
  /// not be there.
  void bind_absent(const ParameterTree& tree, const CheckedValue& owner) {
    if (tree.leaf != nullptr) bindings_.push_back({tree.leaf, std::nullopt, owner});
    for (const ParameterTree& child : tree.children) bind_absent(child, owner);
  }

  /// False when the unit needs a parameter that is not known yet.
  bool read(const Binding& binding, bool last) {
    const Parameter& parameter = *binding.parameter;
    const std::optional<Unit> unit = unit_of(parameter, last);
    if (!unit) return false;
    ParameterValue& value = block_.values[parameter.name];
    if (!binding.value) {
      set_default(parameter, *unit, binding.owner, value);
      return true;
    }
    value.given = true;
    good_ = read_value(parameter, *unit, *binding.value, value) && good_;
    return true;
  }

  /// A unit of the table, where all that it may name is known.
  Unit unit_in_table(const std::string& text) const {
    return parse_unit(text, [&](std::string_view name) { return exponent(name, true); });
  }

  std::optional<double> exponent(std::string_view name, bool last) const {
    const auto found = block_.values.find(name);
    if (found != block_.values.end() && std::isfinite(found->second.number)) return found->second.number;
    if (found != block_.values.end() && found->second.word >= 0) return found->second.word;
    // The exponent itself was in error: its unit is a guess, but the mistake has been reported.
    return last && !good_ ? std::optional<double>(1.0) : std::nullopt;
  }

  std::optional<Unit> unit_of(const Parameter& parameter, bool last) const {
    bool known = true;
    const auto exponent = [&](std::string_view name) {
      std::optional<double> found = this->exponent(name, last);
      known = known && (found || last);
      return found || last ? found : 1.0;  // no matter which: the unit waits
    };
    try {
      const Unit unit = parse_unit(parameter.unit, exponent);
      return known ? std::optional<Unit>(unit) : std::nullopt;
    } catch (const ExpressionError& error) {
      if (!last) return std::nullopt;
      throw Error(Error::Category::plugin, "plugin-failed",
                  std::string("'") + component_.description.name + "': unit of parameter '" + parameter.name +
                      "': " + error.message);
    }
  }

  void set_default(const Parameter& parameter, const Unit& unit, const CheckedValue& owner, ParameterValue& value) {
    const double given = parameter.default_value;
    const bool none = std::isnan(given) || given == optional;
    if (is_law(parameter.kind)) {
      if (std::isnan(given)) return;
      const Component* preferred = registry_.preferred(law_kind(parameter.kind));
      MapReader nothing = MapReader::absent(owner);
      if (preferred != nullptr) good_ = read_law(*preferred, nothing, parameter.name, value) && good_;
    } else if (none) {
      return;
    } else if (parameter.kind == ParameterKind::choice) {
      value.word = static_cast<int>(given);
    } else if (parameter.kind == ParameterKind::formula) {
      set_formula(value, Expression::compile(fmt::format("{}", given * unit.factor), EmptyScope(), false), {}, false);
    } else if (parameter.kind == ParameterKind::function) {
      set_function(value, given * unit.factor);
    } else {
      value.number = given * unit.factor;
    }
  }

  bool read_value(const Parameter& parameter, const Unit& unit, const CheckedValue& written, ParameterValue& value) {
    switch (parameter.kind) {
      case ParameterKind::number:
        return read_number(parameter, unit, written, value);
      case ParameterKind::integer:
        return read_integer(parameter, written, value);
      case ParameterKind::choice:
        return read_word(parameter, written, value);
      case ParameterKind::vector:
        return read_vector(parameter, unit, written, value);
      case ParameterKind::function:
        return read_function(parameter, unit, written, value);
      case ParameterKind::formula:
        return read_formula(parameter, unit, written, value);
      case ParameterKind::contact_law:
      case ParameterKind::friction_law:
        return read_law_block(parameter, written, value);
      case ParameterKind::list:
        return (value.points = read_list(draft_, parameter, unit, written, checked_)) != nullptr;
      case ParameterKind::table: {
        const Dimension of_x = unit_in_table(variables_of(parameter).front().unit).dimension;
        return (value.points = read_table(draft_, parameter, of_x, unit, written, checked_)) != nullptr;
      }
    }
    return false;
  }

  static bool is_word(const Node& node) {
    const auto letter = [](unsigned char c) { return std::isalpha(c) || c == '-' || c == '_'; };
    return node.is_scalar() && !node.text.empty() && std::ranges::all_of(node.text, letter);
  }

  static Range range_of(const Parameter& parameter, const Unit& unit) {
    return {parameter.minimum * unit.factor, parameter.maximum * unit.factor, parameter.open};
  }

  bool read_number(const Parameter& parameter, const Unit& unit, const CheckedValue& written, ParameterValue& value) {
    const std::vector<std::string> words = words_of(parameter);
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (!written.node().is_scalar() || written.node().text != words[i]) continue;
      value.word = static_cast<int>(i);
      return true;
    }
    // A misspelt word, not a number gone wrong.
    if (const std::string meant = nearest(written.node().text, words); !meant.empty() && is_word(written.node())) {
      written.fail(
          "wrong-type",
          "'" + written.path() + "' must be a number or " + either(words) + ", not '" + written.node().text + "'",
          meant);
      return false;
    }
    if (motion_ != nullptr && may_follow_motion(parameter)) {
      const auto formula = written.varying(unit.dimension, range_of(parameter, unit), motion_->names());
      if (!formula) return false;
      if (formula->depends_on_time() || formula->depends_on_variables()) {
        note_time(unit, written, *formula);
        motion_->take(parameter, *formula, written, value);
      } else {
        value.number = formula->constant().value;
      }
      return true;
    }
    const std::optional<double> number = written.quantity(unit.dimension, range_of(parameter, unit));
    if (number) value.number = *number;
    return number.has_value();
  }

  static bool read_integer(const Parameter& parameter, const CheckedValue& written, ParameterValue& value) {
    constexpr double widest = 2147483647.0;  // what Parameters::integer() can return
    const auto open = [&](Open end) { return parameter.open == end || parameter.open == Open::both; };
    // The whole numbers inside: the next one where an end does not belong to the range.
    const double low = open(Open::minimum) ? std::floor(parameter.minimum) + 1.0 : std::ceil(parameter.minimum);
    const double high = open(Open::maximum) ? std::ceil(parameter.maximum) - 1.0 : std::floor(parameter.maximum);
    const long minimum = std::lround(std::max(low, -widest)), maximum = std::lround(std::min(high, widest));
    const std::optional<long> number = written.integer(minimum, maximum);
    if (number) value.number = static_cast<double>(*number);
    return number.has_value();
  }

  static bool read_word(const Parameter& parameter, const CheckedValue& written, ParameterValue& value) {
    const std::optional<int> word = written.word(words_of(parameter));
    if (word) value.word = *word;
    return word.has_value();
  }

  static bool read_vector(const Parameter& parameter, const Unit& unit, const CheckedValue& written,
                          ParameterValue& value) {
    const std::optional<Vector3> vector = written.vector(unit.dimension, range_of(parameter, unit));
    if (vector) value.vector = *vector;
    return vector.has_value();
  }

  void note_time(const Unit& unit, const CheckedValue& written, const Expression& formula) {
    const bool is_motion = unit.dimension == dimension::length || unit.dimension == dimension::angle;
    draft_.timed.push_back({written, formula.time_parts(), !is_motion, !formula.depends_on_variables()});
  }

  bool read_function(const Parameter& parameter, const Unit& unit, const CheckedValue& written, ParameterValue& value) {
    const bool by_motion = motion_ != nullptr && may_follow_motion(parameter);
    std::optional<Expression> expression =
        written.time_function(unit.dimension, 2, by_motion ? &motion_->names() : nullptr);
    if (!expression) return false;
    note_time(unit, written, *expression);
    if (expression->depends_on_variables()) {
      motion_->take(parameter, std::move(*expression), written, value);
      return true;
    }
    set_function(value, std::move(*expression), written.node().location_at(0), written.node().verbatim);
    return true;
  }

  bool read_formula(const Parameter& parameter, const Unit& unit, const CheckedValue& written, ParameterValue& value) {
    TableVariables variables;
    for (const VariableRow& row : variables_of(parameter)) variables.add(row.name, unit_in_table(row.unit).dimension);
    if (written.node().is_map()) {
      const VariableRow first = variables_of(parameter).front();
      const Dimension of_x = unit_in_table(first.unit).dimension;
      if (written.node().find("arcs") != nullptr) return read_arcs(written, of_x, unit.dimension, value);
      return read_points(first.name, of_x, unit.dimension, written, value);
    }
    const std::optional<Expression> expression = written.formula(variables, unit.dimension);
    if (!expression) return false;
    doubt_curve(*expression, variables, unit.dimension, written);
    set_formula(value, *expression, written.node().location_at(0), written.node().verbatim);
    return true;
  }

  /// `spring: {points: [[x, y], ...], interpolation: cubic}`: a function of the first variable.
  static bool read_points(const std::string& variable, const Dimension& of_x, const Dimension& of_y,
                          const CheckedValue& written, ParameterValue& value) {
    MapReader map(written, "points");
    const auto points = map.require("points"), interpolation = map.find("interpolation"), ends = map.find("ends");
    map.finish();
    const auto word = interpolation ? interpolation->word({"cubic", "linear"}) : std::optional<int>(0);
    const auto end_word = ends ? ends->word({"natural", "periodic"}) : std::optional<int>(0);
    const auto items = points ? points->list() : std::nullopt;
    if (!items || !word || !end_word) return false;
    const bool periodic = *end_word == 1;
    std::vector<double> x, y;
    for (const CheckedValue& item : *items) {
      const auto pair = item.list(2);
      const auto at = pair ? (*pair)[0].quantity(of_x) : std::nullopt;
      const auto there = pair ? (*pair)[1].quantity(of_y) : std::nullopt;
      if (!at || !there) return false;
      if (!x.empty() && !(*at > x.back())) {
        (*pair)[0].fail("bad-table",
                        fmt::format("the first numbers of points must increase: {} follows {}", *at, x.back()));
        return false;
      }
      x.push_back(*at);
      y.push_back(*there);
    }
    const std::size_t least = periodic ? 3 : 2;
    if (x.size() < least || x.size() > most_curve_points) {
      points->fail(x.size() < least ? "bad-table" : "too-large",
                   fmt::format("a curve has from {} to {} points", least, most_curve_points));
      return false;
    }
    if (periodic && std::abs(y.front() - y.back()) >
                        1e-9 * std::abs(*std::ranges::max_element(y, {}, [](double v) { return std::abs(v); }))) {
      points->fail("bad-table", fmt::format("the first and the last value of periodic points must agree: {} and {}",
                                            y.front(), y.back()));
      return false;
    }
    const TimeTable& table = set_table_formula(value, std::move(x), std::move(y), static_cast<Interpolation>(*word),
                                               periodic ? SplineEnds::periodic : SplineEnds::natural);
    const auto after = [](const Dimension& of) { return of == dimension::none ? "" : " " + si_unit(of); };
    doubt_overshoot(table, *points, {variable, after(of_x), after(of_y), turns_back, !(of_y == dimension::length)});
    return true;
  }

  /// `contact: NAME` or `contact: {law: NAME, ...}`.
  bool read_law_block(const Parameter& parameter, const CheckedValue& written, ParameterValue& value) {
    const ComponentKind kind = law_kind(parameter.kind);
    if (written.node().is_scalar()) {
      const Component* law = find_type(registry_, kind, written);
      MapReader nothing = MapReader::empty(written);
      return law != nullptr && read_law(*law, nothing, parameter.name, value);
    }
    if (!written.node().is_map()) {
      written.wrong_type("the name of a law or a map");
      return false;
    }
    MapReader map(written);
    const std::optional<CheckedValue> name = map.require("law");
    const Component* law = name ? find_type(registry_, kind, *name) : nullptr;
    const bool known = law != nullptr;
    // Keys are judged by the law that was meant; which ones a law has is unknown when that is.
    if (!known && name) law = meant_type(registry_, kind, *name);
    if (law == nullptr) return false;
    const bool good = read_law(*law, map, parameter.name, value);
    map.finish();
    return known && good;
  }

  bool read_law(const Component& law, MapReader& map, const std::string& path, ParameterValue& value) {
    CheckedParameters checked = check_parameters(law, map, draft_);
    for (const auto& [inner, place] : checked.places) checked_.places.emplace(path + "." + inner, place);
    for (const auto& [inner, place] : checked.fields) checked_.fields.emplace(path + "." + inner, place);
    if (checked.block) value.law = std::make_shared<const ParameterBlock>(std::move(*checked.block));
    return value.law != nullptr;
  }

  const Component& component_;
  Draft& draft_;
  const Registry& registry_;
  MotionParameters* motion_;
  ParameterBlock block_;
  std::vector<Binding> bindings_;
  CheckedParameters checked_;
  bool good_ = true;
};

}  // namespace

CheckedParameters check_parameters(const Component& component, MapReader& entry, Draft& draft,
                                   MotionParameters* motion) {
  return ParameterCheck(component, draft, motion).run(entry);
}

const Component* find_type(const Registry& registry, ComponentKind kind, const CheckedValue& value,
                           const std::vector<std::string>& others) {
  const std::optional<std::string> word = value.string();
  if (!word) return nullptr;
  const Component* found = registry.find(kind, *word);
  if (found != nullptr) return found;
  if (const char* remedy = registry.remedy(kind, *word)) {
    value.fail("unknown-type", "the type '" + *word + "' in '" + value.path() + "' is not in this build", {}, remedy);
    return nullptr;
  }
  std::vector<std::string> names = registry.names(kind);
  names.insert(names.end(), others.begin(), others.end());
  const std::string suggested = nearest(*word, names);
  value.fail("unknown-type", "unknown type '" + *word + "' in '" + value.path() + "'", suggested,
             suggested.empty() ? "not in this release, which has " + either(names) : "");
  return nullptr;
}

const Component* meant_type(const Registry& registry, ComponentKind kind, const CheckedValue& value,
                            const std::vector<std::string>& others) {
  std::vector<std::string> names = registry.names(kind);
  names.insert(names.end(), others.begin(), others.end());
  return value.node().is_scalar() ? registry.find(kind, nearest(value.node().text, names)) : nullptr;
}

void report_fault(const CreationFault& fault, const CheckedParameters& parameters, const CheckedValue& entry) {
  if (!fault.bad_parameter) {
    throw Error(Error::Category::plugin, "plugin-failed", "in '" + entry.path() + "': " + fault.text,
                entry.key_location());
  }
  if (const auto field = parameters.fields.find(fault.path); field != parameters.fields.end()) {
    const auto& [location, length] = field->second;
    return entry.reading().diagnostics->error(location, length, fault.id, fault.text);
  }
  // The nearest place that is written: the value itself, or the block in which it is missing.
  std::string path = fault.path;
  auto place = parameters.places.find(path);
  const bool written = place != parameters.places.end();
  while (place == parameters.places.end() && !path.empty()) {
    const std::size_t dot = path.rfind('.');
    path.resize(dot == std::string::npos ? 0 : dot);
    place = parameters.places.find(path);
  }
  const CheckedValue& at = place == parameters.places.end() ? entry : place->second;
  const bool about_keys = fault.id == "missing-key" || fault.id == "conflicting-keys";
  if (about_keys || !written) {
    at.fail_at_key(fault.id, fault.text);
  } else {
    at.fail(fault.id, fault.text);
  }
}

}  // namespace freeplay
