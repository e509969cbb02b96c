#include "contract/sample_parameters.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/expression_error.h"
#include "base/unit.h"
#include "component/instances.h"
#include "contract/sample_values.h"
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

/// What a block says beyond its defaults.
struct Plan {
  std::set<std::string> given{};            ///< optional parameters
  std::map<std::string, int> words{};       ///< choices, and words in the place of numbers
  std::map<std::string, double> numbers{};  ///< SI
  std::map<std::string, std::shared_ptr<const ParameterBlock>> laws{};
  std::map<std::string, std::size_t> lengths{};  ///< of lists and tables
  SampleOrder order = SampleOrder::rising;
};

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
      add_lengths(all);
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
    const double tilt = plan.order == SampleOrder::equal ? 0.0 : plan.order == SampleOrder::rising ? 0.07 : -0.03;
    const double usual = usual_size(unit.dimension) * (1.0 + tilt * place);
    const bool by_default = !is_required(p) && !is_optional(p);
    const double size = by_default ? p.default_value * unit.factor : usual;
    if (p.kind == ParameterKind::choice) {
      value.word = by_default ? static_cast<int>(p.default_value) : 0;
    } else if (p.kind == ParameterKind::vector) {
      value.vector = {within(p, unit.factor, 0.5 * size), within(p, unit.factor, -0.3 * size),
                      within(p, unit.factor, 0.0)};
    } else if (p.kind == ParameterKind::function) {
      set_sample_function(size, value);
    } else if (p.kind == ParameterKind::formula) {
      const std::vector<VariableRow> variables = variables_of(p);
      const Unit first = variables.empty() ? Unit{} : unit_of(variables.front().unit, block).value_or(Unit{});
      if (unit.dimension == dimension::length && first.dimension == dimension::angle) {
        set_closed_sample(size, value);
      } else {
        // Bodies in samples move by about 1 m/s: friction that grows with it stays one that occurs.
        const double usual_speed = 1.0;
        set_sample_formula(size / (first.dimension == dimension::velocity ? usual_speed : usual_size(first.dimension)),
                           value);
      }
    } else if (p.kind == ParameterKind::list || p.kind == ParameterKind::table) {
      const std::vector<VariableRow> variables = variables_of(p);
      const Unit x = variables.empty() ? Unit{} : unit_of(variables.front().unit, block).value_or(Unit{});
      const auto length = plan.lengths.find(p.name);
      value.points =
          sample_points(p, unit.factor, usual, usual_size(x.dimension), plan.order,
                        length == plan.lengths.end() ? std::clamp<std::size_t>(3, p.least, p.most) : length->second);
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
    // Lengths and speeds that a constructor compares may have to rise or to fall along the table.
    for (const SampleOrder order : {SampleOrder::rising, SampleOrder::falling, SampleOrder::equal}) {
      plan.order = order;
      if (const std::optional<Plan> found = with_more(plan, 3)) return found;
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

  /// The shortest and a long form of what has a length.
  void add_lengths(const Plan& plan) {
    constexpr std::size_t long_enough = 40;
    for (const Parameter& p : table()) {
      const bool given = is_required(p) || plan.given.contains(p.name);
      if ((p.kind != ParameterKind::list && p.kind != ParameterKind::table) || !given) continue;
      for (const std::size_t length : {std::size_t{p.least}, std::min<std::size_t>(p.most, long_enough)}) {
        Plan next = plan;
        next.lengths[p.name] = length;
        add("'" + std::string(p.name) + "' has the length " + std::to_string(length), next);
      }
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
