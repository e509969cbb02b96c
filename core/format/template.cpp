#include "format/template.h"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "format/name_rule.h"
#include "format/readout.h"

namespace freeplay {
namespace {

constexpr const char* part_sections[] = {"bodies", "frames", "joints", "drivers", "forces"};
constexpr const char* counted_sections[] = {"bodies", "joints", "drivers", "forces"};

constexpr long most_copies = 1'000'000'000'000'000;  // whatever is an integer; the limit of elements comes first

/// Elements that one instance declares.
long element_count(const Node& content) {
  long count = 0;
  for (const char* name : counted_sections) {
    const Node* section = content.find(name);
    if (section != nullptr) count += static_cast<long>(section->entries.size());
  }
  return count;
}

constexpr long most_values = 2'000'000, usual_text = 32;

/// Values of a template, what is long counted as several: each instance reads them all again.
long value_count(const Node& node) {
  long count = 1 + static_cast<long>(node.text.size()) / usual_text;
  for (const Node* item : node.items) count += value_count(*item);
  for (const Node::Entry& entry : node.entries) count += value_count(*entry.value);
  return count;
}

/// The sections of a template that is being read as the part `name`.
void add_part(Draft& draft, MapReader& map, const std::string& name) {
  Part& part = draft.parts.emplace_back();
  part.prefix = name + ".";
  for (const char* word : part_sections) {
    const auto section = map.find(word);
    if (!section || section->node().is_null()) continue;
    // Its entries are addressed by their full names.
    part.sections.emplace(word, *section).first->second.set_address(std::string(word) + "." + name);
  }
  map.finish();
}

class InstanceExpansion {
 public:
  InstanceExpansion(Draft& draft, const std::optional<CheckedValue>& templates, UsedKeys& used,
                    InstanceStorage& storage)
      : draft_(draft), templates_(templates), used_(used), storage_(storage) {}

  void expand(const CheckedValue& entry) {
    Draft::check_name(entry);
    MapReader map(entry, "instance");
    const auto name = map.require("template");
    const auto count = map.find("count");
    const auto with = map.find("with");
    map.finish();
    const std::optional<CheckedValue> content = name ? find_template(*name) : std::nullopt;
    const std::optional<long> copies = count ? count->integer(1, most_copies) : std::optional<long>(1);
    if (!content || !copies || (with && !with->node().is_map())) {
      if (with && !with->node().is_map()) with->wrong_type("a map");
      draft_.broken_instances.push_back(entry.key());
      return;
    }
    elements_ += std::min(*copies, largest_model + 1) * std::max(element_count(content->node()), 1L);
    if (elements_ > largest_model) {
      (count ? *count : entry)
          .fail("too-large", fmt::format("the model would have more than {} elements", largest_model));
      draft_.broken_instances.push_back(entry.key());
      return;
    }
    values_ += *copies * value_count_of(content->node());
    if (values_ > most_values) {
      (count ? *count : entry)
          .fail("too-large", fmt::format("the instances would have more than {} values", most_values));
      draft_.broken_instances.push_back(entry.key());
      return;
    }
    for (long i = 1; i <= *copies; ++i) {
      const std::string full = count ? fmt::format("{}{}", entry.key(), i) : entry.key();
      if (!names_.add(full)) {
        entry.fail_at_key("duplicate-name", "there is an instance '" + full + "' already");
        continue;
      }
      add_instance(entry, *content, with, full, i, *copies);
    }
  }

 private:
  long value_count_of(const Node& content) {
    const auto [known, fresh] = counted_.try_emplace(&content, 0);
    if (fresh) known->second = value_count(content);
    return known->second;
  }

  std::optional<CheckedValue> find_template(const CheckedValue& name) {
    const std::optional<std::string> word = name.string();
    if (!word) return std::nullopt;
    std::vector<std::string> known;
    if (templates_ && templates_->node().is_map()) {
      for (const CheckedValue& content : entries_of(*templates_)) {
        if (content.key() == *word) return checked(content);
        known.push_back(content.key());
      }
    }
    name.fail("unknown-name", "unknown template '" + *word + "'", nearest(*word, known));
    return std::nullopt;
  }

  std::optional<CheckedValue> checked(const CheckedValue& content) {
    used_.insert(content.key_node());
    if (content.node().is_map()) return content;
    content.wrong_type("a map");
    return std::nullopt;
  }

  void add_instance(const CheckedValue& entry, const CheckedValue& content, const std::optional<CheckedValue>& with,
                    const std::string& full, long number, long count) {
    const Reading& outer = entry.reading();
    ParameterScope& numbers = storage_.scopes.emplace_back(used_, outer.scope);
    numbers.add_constant("i", static_cast<double>(number));
    numbers.add_constant("n", static_cast<double>(count));
    ParameterScope& scope = storage_.scopes.emplace_back(used_, &numbers);
    // Values under `with` see the outer parameters, everything in the template its own.
    Reading& given = storage_.readings.emplace_back(outer);
    given.scope = &numbers;
    given.instance = full;
    Reading& inside = storage_.readings.emplace_back(given);
    inside.scope = &scope;

    CheckedValue body(inside, content.node(), content.key_node(), content.path());
    body.set_address(content.path());
    MapReader map(body, "template");
    add_parameters(entry, map.find("parameters"), with, given, inside, scope);
    if (outer.readout != nullptr) outer.readout->add_instance(full, content.node());
    add_part(draft_, map, full);
  }

  void add_parameters(const CheckedValue& entry, const std::optional<CheckedValue>& declared,
                      const std::optional<CheckedValue>& with, const Reading& given, const Reading& inside,
                      ParameterScope& scope) {
    std::vector<std::string> names;
    if (declared && !declared->node().is_null()) {
      for (const CheckedValue& parameter : entries_of(*declared)) {
        const std::string name = parameter.key();
        names.push_back(name);
        if (!check_parameter_name(parameter)) {
          scope.add_broken(name);
          continue;
        }
        const Node* value = with ? with->node().find(name) : nullptr;
        if (value != nullptr) {
          scope.add(name, *parameter.key_node(), *value, entry.path() + ".with." + name, given);
        } else if (parameter.node().is_scalar() && parameter.node().text == "required") {
          entry.fail_at_key("missing-key", "missing key '" + name + "' in '" + entry.path() + ".with'");
          scope.add_broken(name);
        } else {
          scope.add(name, *parameter.key_node(), parameter.node(), parameter.path(), inside);
        }
      }
    }
    scope.evaluate();
    if (!with) return;
    for (const CheckedValue& value : entries_of(*with)) {
      if (std::find(names.begin(), names.end(), value.key()) != names.end()) continue;
      value.fail_at_key("unknown-key", "the template has no parameter '" + value.key() + "'",
                        nearest(value.key(), names));
    }
  }

  Draft& draft_;
  const std::optional<CheckedValue>& templates_;
  UsedKeys& used_;
  InstanceStorage& storage_;
  NameTable names_;
  long elements_ = 0, values_ = 0;
  std::unordered_map<const Node*, long> counted_;
};

}  // namespace

void expand_alone(Draft& draft, const CheckedValue& content, UsedKeys& used, InstanceStorage& storage) {
  ParameterScope& scope = storage.scopes.emplace_back(used, content.reading().scope);
  scope.add_constant("i", 1.0);
  scope.add_constant("n", 1.0);
  Reading& inside = storage.readings.emplace_back(content.reading());
  inside.scope = &scope;
  inside.readout = nullptr;
  const CheckedValue body(inside, content.node(), content.key_node(), content.path());
  MapReader map(body, "template");
  const auto parameters = map.find("parameters");
  if (parameters && !parameters->node().is_null()) {
    for (const CheckedValue& parameter : entries_of(*parameters)) {
      const bool needed = parameter.node().is_scalar() && parameter.node().text == "required";
      if (!check_parameter_name(parameter) || needed) {
        scope.add_broken(parameter.key());
      } else {
        scope.add(parameter.key(), *parameter.key_node(), parameter.node(), parameter.path(), inside);
      }
    }
  }
  scope.evaluate();
  add_part(draft, map, content.key());
}

void expand_instances(Draft& draft, const std::optional<CheckedValue>& templates, const CheckedValue& instances,
                      UsedKeys& used, InstanceStorage& storage) {
  InstanceExpansion expansion(draft, templates, used, storage);
  for (const CheckedValue& entry : entries_of(instances)) expansion.expand(entry);
}

void check_templates(const CheckedValue& templates) {
  for (const CheckedValue& entry : entries_of(templates)) Draft::check_name(entry);
}

}  // namespace freeplay
