#include "contract/sample_parameters.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/expression_error.h"
#include "base/unit.h"
#include "component/instances.h"
#include "format/parameter_tree.h"

namespace freeplay {
namespace {

bool is_law(const Parameter& p) {
  return p.kind == ParameterKind::contact_law || p.kind == ParameterKind::friction_law;
}
bool is_required(const Parameter& p) { return std::isnan(p.default_value); }
bool is_optional(const Parameter& p) { return p.default_value == optional; }
ComponentKind law_kind(const Parameter& p) {
  return p.kind == ParameterKind::contact_law ? ComponentKind::contact_law : ComponentKind::friction_law;
}

/// How the numbers of one unit are distinguished: constructors compare lengths or speeds with each other.
enum class Order { rising, falling, equal };

/// What a block says beyond its defaults.
struct Plan {
  std::set<std::string> given{};            ///< optional parameters
  std::map<std::string, int> words{};       ///< choices, and words in the place of numbers
  std::map<std::string, double> numbers{};  ///< SI
  std::map<std::string, std::shared_ptr<const ParameterBlock>> laws{};
  Order order = Order::rising;
  bool closed = false;  ///< formulas come again after one turn
};

/// f(t) = c (1 + sin(2 t)/2): a function whose three values differ from each other.
struct SampleFunction {
  double size;
};
Status evaluate_sample(const void* self, double t, TimeValue* out, Message*) noexcept {
  const double c = static_cast<const SampleFunction*>(self)->size;
  *out = {c * (1.0 + 0.5 * std::sin(2.0 * t)), c * std::cos(2.0 * t), -2.0 * c * std::sin(2.0 * t)};
  return Status::ok;
}

/// f(x, ...) = c x, a formula that rises with its first variable alone; or c (1 + cos(x)/5), a round closed curve as a
/// distance over the angle.
struct SampleFormula {
  double size;
  bool closed;
};
constexpr abi::FormulaTable sample_formula{
    sizeof(abi::FormulaTable),
    [](const void* self, Span<const double> variables, double* value, Span<double> slopes, Message*) noexcept {
      const auto& [c, closed] = *static_cast<const SampleFormula*>(self);
      const double x = variables[0];
      for (std::size_t i = 0; i < slopes.size; ++i) slopes[i] = i > 0 ? 0.0 : closed ? -0.2 * c * std::sin(x) : c;
      *value = closed ? c * (1.0 + 0.2 * std::cos(x)) : c * x;
      return Status::ok;
    },
    [](const void*) noexcept { return std::int32_t{0}; },
    [](const void*, Span<const double>, Span<double>) noexcept {}};

/// A size that occurs in mechanisms [SI].
double usual_size(const Dimension& d) {
  const struct {
    Dimension dimension;
    double size;
  } table[] = {{dimension::length, 0.01}, {dimension::pressure, 2e11}, {dimension::velocity, 0.01},
               {dimension::time, 0.01},   {dimension::stiffness, 1e5}, {dimension::damping, 10.0},
               {dimension::force, 10.0},  {dimension::torque, 1.0},    {dimension::none, 0.3},
               {{0.0, -1.0, 0.0}, 1e5}};  // 1/m: a surface that yields by 10 micrometres
  for (const auto& row : table) {
    if (row.dimension == d) return row.size;
  }
  // Contact stiffness N/m^n: what carries 100 N at 10 micrometres.
  if (d.kg == 1.0 && d.s == -2.0 && d.m <= 0.5) return 100.0 * std::pow(1e5, 1.0 - d.m);
  return 1.0;
}

/// The number nearest to `wish` that lies within the bounds.
double within(const Parameter& p, double factor, double wish) {
  const double low = p.minimum * factor, high = p.maximum * factor;
  const auto opens = [&](Open end) { return p.open == end || p.open == Open::both; };
  if (std::isfinite(low) && std::isfinite(high)) {
    const double margin = 0.1 * (high - low);
    if (wish <= low) return opens(Open::minimum) ? low + margin : low;
    if (wish >= high) return opens(Open::maximum) ? high - margin : high;
    return wish;
  }
  if (wish < low || (wish == low && opens(Open::minimum))) return low + std::max(std::abs(low), 1.0);
  if (wish > high || (wish == high && opens(Open::maximum))) return high - std::max(std::abs(high), 1.0);
  return wish;
}

class Sampler {
 public:
  /// `within`: the components that ask for this one as a law, outermost first.
  Sampler(const Component& component, const Registry& registry, const Conditions& conditions, Space space,
          std::vector<const Component*> within = {})
      : component_(component), registry_(registry), conditions_(conditions), space_(space), chain_(std::move(within)) {
    chain_.push_back(&component);
  }

  ParameterSamples run() {
    for (const Plan& laws : law_plans()) {
      const std::optional<Plan> few = fewest(laws);
      if (!few) continue;
      const bool other_laws = !found_.accepted.empty();
      add(name_of_laws(laws), *few, other_laws);
      if (other_laws) continue;  // the rest does not depend on the laws
      const Plan many = with_other_numbers(most(*few)), all = with_other_words(many);
      add("as many as possible", many);
      if (all.words != many.words) add("everything given", all);
      add_words(*few);
      add_ends(*few);
    }
    return std::move(found_);
  }

 private:
  const Span<const Parameter>& table() const { return component_.description.parameters; }

  static std::optional<Unit> unit_of(const Parameter& p, const ParameterBlock& block) { return unit_of(p.unit, block); }
  static std::optional<Unit> unit_of(const std::string& unit, const ParameterBlock& block) {
    const auto exponent = [&](std::string_view name) -> std::optional<double> {
      const auto found = block.values.find(name);
      if (found == block.values.end()) return std::nullopt;
      if (found->second.word >= 0) return found->second.word;  // chooses among units
      if (!std::isfinite(found->second.number)) return std::nullopt;
      return found->second.number;
    };
    try {
      return parse_unit(unit, exponent);
    } catch (const ExpressionError&) {
      return std::nullopt;
    }
  }

  std::shared_ptr<const ParameterBlock> make(const Plan& plan) const {
    auto block = std::make_shared<ParameterBlock>();
    block->component = &component_;
    for (const Parameter& p : table()) block->values[p.name];
    // Words choose among units.
    for (const Parameter& p : table()) {
      if (p.kind == ParameterKind::choice) fill(p, Unit{}, plan, 0, *block);
    }
    // Exponents are dimensionless: they come first, and the units that name them after.
    for (const bool last : {false, true}) {
      int same_unit = 0;
      for (const Parameter& p : table()) {
        const std::optional<Unit> unit = unit_of(p, *block);
        if (unit && std::string_view(p.unit).find('^') == std::string_view::npos) ++same_unit;
        if (!unit && !last) continue;
        fill(p, unit.value_or(Unit{}), plan, same_unit, *block);
      }
    }
    mark_branches(*block);
    return block;
  }

  void fill(const Parameter& p, const Unit& unit, const Plan& plan, int place, ParameterBlock& block) const {
    ParameterValue& value = block.values[p.name];
    value.given = is_required(p) || plan.given.contains(p.name) || plan.words.contains(p.name) ||
                  plan.numbers.contains(p.name) || plan.laws.contains(p.name);
    if (is_law(p)) {
      if (const auto law = plan.laws.find(p.name); law != plan.laws.end()) value.law = law->second;
      return;
    }
    if (const auto word = plan.words.find(p.name); word != plan.words.end()) {
      value.word = word->second;
      value.number = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    if (!value.given && is_optional(p)) return;
    const double tilt = plan.order == Order::equal ? 0.0 : plan.order == Order::rising ? 0.07 : -0.03;
    const double usual = usual_size(unit.dimension) * (1.0 + tilt * place);
    const bool by_default = !is_required(p) && !is_optional(p);
    const double size = by_default ? p.default_value * unit.factor : usual;
    if (p.kind == ParameterKind::choice) {
      value.word = by_default ? static_cast<int>(p.default_value) : 0;
    } else if (p.kind == ParameterKind::vector) {
      value.vector = {within(p, unit.factor, 0.5 * size), within(p, unit.factor, -0.3 * size),
                      within(p, unit.factor, 0.0)};
    } else if (p.kind == ParameterKind::function) {
      const auto function = std::make_shared<const SampleFunction>(SampleFunction{size});
      value.function = {&evaluate_sample, function.get()};
      value.function_owner = function;
    } else if (p.kind == ParameterKind::formula) {
      const std::vector<VariableRow> variables = variables_of(p);
      const Unit first = variables.empty() ? Unit{} : unit_of(variables.front().unit, block).value_or(Unit{});
      const auto function = std::make_shared<const SampleFormula>(
          SampleFormula{plan.closed ? size : size / usual_size(first.dimension), plan.closed});
      value.formula = Formula(sample_formula, function.get());
      value.function_owner = function;
    } else {
      const auto number = plan.numbers.find(p.name);
      value.number = number != plan.numbers.end() ? number->second : by_default ? size : within(p, unit.factor, size);
      if (p.kind == ParameterKind::integer && !by_default) value.number = std::max(std::round(value.number), p.minimum);
    }
  }

  /// A map that stands in the place of a word: the word is not written.
  void mark_branches(ParameterBlock& block) const {
    for (const Parameter& branch : table()) {
      const std::string prefix = std::string(branch.name) + ".";
      for (const Parameter& inner : table()) {
        if (!std::string_view(inner.name).starts_with(prefix) || !block.values[inner.name].given) continue;
        block.values[branch.name].given = true;
        block.values[branch.name].word = -1;
      }
    }
  }

  bool accepts(const std::shared_ptr<const ParameterBlock>& block) {
    Instances instances;
    CreationFault fault;
    WatchedCall watched(conditions_, "its constructor");
    switch (component_.kind) {
      case ComponentKind::joint:
        instances.create_joint(*block, space_, fault);
        break;
      case ComponentKind::integrator:
        instances.create_integrator(*block, fault);
        break;
      case ComponentKind::friction_law:
        instances.create_friction_law(*block, fault);
        break;
      case ComponentKind::contact_law:
        instances.create_contact_law(*block, sample_contact_pair(), fault);
        break;
    }
    instances = Instances();
    watched.end();
    if (!fault.id.empty() && found_.refusal.empty()) {
      found_.refusal = fault.path.empty() ? fault.text : "'" + fault.path + "': " + fault.text;
    }
    return fault.id.empty();
  }
  bool accepts(const Plan& plan) { return accepts(make(plan)); }

  void add(const std::string& name, const Plan& plan, bool other_laws = false) {
    const std::shared_ptr<const ParameterBlock> block = make(plan);
    if (accepts(block)) found_.accepted.push_back({name, block, other_laws});
  }

  std::vector<std::string> left_open(const Plan& plan) const {
    std::vector<std::string> names;
    for (const Parameter& p : table()) {
      if (is_optional(p) && !is_law(p) && !plan.given.contains(p.name)) names.emplace_back(p.name);
    }
    return names;
  }

  /// The laws that fit into the table: for each law parameter the preferred or first one, then every other in turn.
  std::vector<Plan> law_plans() const {
    std::vector<Plan> plans(1);
    std::vector<std::pair<std::string, std::vector<std::shared_ptr<const ParameterBlock>>>> all;
    for (const Parameter& p : table()) {
      if (!is_law(p)) continue;
      all.emplace_back(p.name, law_blocks(law_kind(p)));
      if (!all.back().second.empty()) plans[0].laws[p.name] = all.back().second.front();
    }
    const Plan first = plans[0];
    for (const auto& [name, blocks] : all) {
      for (std::size_t i = 1; i < blocks.size(); ++i) {
        plans.push_back(first);
        plans.back().laws[name] = blocks[i];
      }
    }
    return plans;
  }

  std::vector<std::shared_ptr<const ParameterBlock>> law_blocks(ComponentKind kind) const {
    std::vector<std::shared_ptr<const ParameterBlock>> blocks;
    // A law within a law within a law: the innermost asks for none.
    constexpr std::size_t deepest = 3;
    const Component* preferred = registry_.preferred(kind);
    const auto add_samples = [&](const Component& law) {
      if (std::ranges::find(chain_, &law) != chain_.end()) return;
      if (chain_.size() + 1 >= deepest && std::ranges::any_of(law.description.parameters, is_law)) return;
      const ParameterSamples samples = Sampler(law, registry_, conditions_, space_, chain_).run();
      // The one with as many keys as possible asks least of the joint.
      if (!samples.accepted.empty()) blocks.push_back(samples.accepted[samples.accepted.size() > 1 ? 1 : 0].block);
    };
    if (preferred != nullptr) add_samples(*preferred);
    for (const RegisteredComponent& entry : registry_.components()) {
      if (entry.component->kind == kind && entry.component != preferred) add_samples(*entry.component);
    }
    return blocks;
  }

  static std::string name_of_laws(const Plan& plan) {
    std::string words;
    for (const auto& [name, block] : plan.laws)
      words += (words.empty() ? "" : ", ") + name + " " + block->component->description.name;
    return words.empty() ? "as few as possible" : words;
  }

  /// The smallest set of optional parameters with which the constructor is content.
  std::optional<Plan> fewest(Plan plan) {
    // A formula may have to be a closed curve; lengths and speeds that a constructor compares may have to rise or to
    // fall along the table.
    for (const bool closed : {false, true}) {
      plan.closed = closed;
      for (const Order order : {Order::rising, Order::falling, Order::equal}) {
        plan.order = order;
        if (const std::optional<Plan> found = with_more(plan, 3)) return found;
      }
      if (std::ranges::none_of(table(), [](const Parameter& p) { return p.kind == ParameterKind::formula; })) break;
    }
    return std::nullopt;
  }
  std::optional<Plan> with_more(const Plan& plan, int most_more) {
    if (accepts(plan)) return plan;
    const std::vector<std::string> open = left_open(plan);
    for (int more = 1; more <= most_more; ++more) {
      if (const std::optional<Plan> found = with_exactly(plan, open, 0, more)) return found;
    }
    return std::nullopt;
  }
  std::optional<Plan> with_exactly(const Plan& plan, const std::vector<std::string>& open, std::size_t from, int more) {
    for (std::size_t i = from; i < open.size(); ++i) {
      Plan next = plan;
      next.given.insert(open[i]);
      if (more == 1 && accepts(next)) return next;
      if (more == 1) continue;
      if (const std::optional<Plan> found = with_exactly(next, open, i + 1, more - 1)) return found;
    }
    return std::nullopt;
  }

  /// Everything that the constructor takes in addition, alone or in pairs.
  Plan most(Plan plan) {
    for (const std::string& name : left_open(plan)) {
      Plan next = plan;
      next.given.insert(name);
      if (accepts(next)) plan = next;
    }
    const std::vector<std::string> open = left_open(plan);
    for (std::size_t i = 0; i < open.size(); ++i) {
      for (std::size_t k = i + 1; k < open.size(); ++k) {
        Plan next = plan;
        next.given.insert(open[i]);
        next.given.insert(open[k]);
        if (accepts(next)) plan = next;
      }
    }
    return plan;
  }

  /// Numbers that have a default get another value near it, as far as the constructor takes it.
  Plan with_other_numbers(Plan plan) {
    const std::shared_ptr<const ParameterBlock> block = make(plan);
    for (const Parameter& p : table()) {
      const bool number = p.kind == ParameterKind::number || p.kind == ParameterKind::integer;
      if (!number || is_required(p) || is_optional(p)) continue;
      for (const double other : other_numbers(p, unit_of(p, *block).value_or(Unit{}))) {
        Plan next = plan;
        next.numbers[p.name] = other;
        if (!accepts(next)) continue;
        plan = next;
        break;
      }
    }
    return plan;
  }

  /// Values within the bounds that are not the default [SI], the best one first.
  static std::vector<double> other_numbers(const Parameter& p, const Unit& unit) {
    const double standard = p.default_value * unit.factor, low = p.minimum * unit.factor,
                 high = p.maximum * unit.factor;
    // The ends have samples of their own.
    std::vector<double> wishes = {
        1.4 * standard,         0.6 * standard,         usual_size(unit.dimension), -usual_size(unit.dimension),
        0.5 * (standard + low), 0.5 * (standard + high)};
    std::erase_if(wishes, [&](double x) { return !std::isfinite(x) || x == standard || x <= low || x >= high; });
    if (p.kind != ParameterKind::integer) return wishes;
    wishes = {standard + 1.0, standard - 1.0};
    std::erase_if(wishes, [&](double x) { return within(p, 1.0, x) != x; });
    return wishes;
  }

  /// Choices take another word than their default, as far as the constructor takes it.
  Plan with_other_words(Plan plan) {
    for (const Parameter& p : table()) {
      if (p.kind != ParameterKind::choice) continue;
      const auto count = static_cast<int>(words_of(p).size());
      const int standard = is_required(p) || is_optional(p) ? 0 : static_cast<int>(p.default_value);
      for (int word = 0; word < count && !plan.words.contains(p.name); ++word) {
        Plan next = plan;
        next.words[p.name] = (standard + 1 + word) % count;
        if (next.words[p.name] != standard && accepts(next)) plan = next;
      }
    }
    return plan;
  }

  void add_words(const Plan& plan) {
    for (const Parameter& p : table()) {
      if (is_law(p)) continue;
      const std::vector<std::string> words = words_of(p);
      for (std::size_t i = 0; i < words.size(); ++i) {
        Plan next = plan;
        next.words[p.name] = static_cast<int>(i);
        add("'" + std::string(p.name) + "' is '" + words[i] + "'", next);
      }
    }
  }

  /// The ends of the ranges of dimensionless numbers: there formulas divide by zero.
  void add_ends(const Plan& plan) {
    for (const Parameter& p : table()) {
      if (p.kind != ParameterKind::number || std::string_view(p.unit) != "1") continue;
      const auto closed = [&](Open end) { return p.open != end && p.open != Open::both; };
      const auto add_end = [&](double number) {
        Plan next = plan;
        next.numbers[p.name] = number;
        add("'" + std::string(p.name) + "' at the end of its range", next);
      };
      if (std::isfinite(p.minimum) && closed(Open::minimum)) add_end(p.minimum);
      if (std::isfinite(p.maximum) && closed(Open::maximum)) add_end(p.maximum);
    }
  }

  const Component& component_;
  const Registry& registry_;
  const Conditions& conditions_;
  Space space_;
  std::vector<const Component*> chain_;
  ParameterSamples found_;
};

}  // namespace

ContactPair sample_contact_pair() {
  const Material steel{2.07e11, 0.3};
  return {0.01, 0.0099, 0.0001, 0.02, steel, steel};
}

ParameterSamples sample_parameters(const Component& component, const Registry& registry, const Conditions& conditions,
                                   Space space) {
  return Sampler(component, registry, conditions, space).run();
}

}  // namespace freeplay
