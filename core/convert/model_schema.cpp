#include <algorithm>
#include <cmath>
#include <string_view>

#include "component/json_schema.h"
#include "format/key_table.h"
#include "format/parameter_tree.h"

namespace freeplay {
namespace {

constexpr const char* dialect = "https://json-schema.org/draft/2020-12/schema";
constexpr const char* note_pattern = "^x-";

Json reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

/// Names of definitions have no blanks, so that references are plain.
std::string definition_name(std::string_view map) {
  std::string name(map);
  std::ranges::replace(name, ' ', '-');
  return name;
}

Json array_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

/// Names to something; an empty section means none.
Json entries_of(Json entry) {
  return {{"type", {"object", "null"}},
          {"patternProperties", {{note_pattern, true}}},
          {"additionalProperties", std::move(entry)}};
}

Json any_of(Json alternatives) {
  return alternatives.size() == 1 ? alternatives.front() : Json{{"anyOf", std::move(alternatives)}};
}

/// What may stand in the place of an alternative of the format table.
Json alternative(std::string_view text) {
  const auto after = [&](std::string_view word) { return std::string_view(text).substr(word.size()); };
  if (text.starts_with("'")) return {{"const", text.substr(1, text.size() - 2)}};
  if (text.starts_with("list of ")) return array_of(alternative(after("list of ")));
  if (text.starts_with("entries of ")) return entries_of(alternative(after("entries of ")));
  if (text.starts_with("map ")) return reference(definition_name(after("map ")));
  if (text == "contents") return {{"type", "object"}};
  if (text == "frame value") return any_of({reference("vector"), reference("frame")});
  if (text == "grid") return any_of({reference("quantity"), array_of(reference("quantity")), reference("grid")});
  if (text == "axis") return any_of({reference("text"), array_of(reference("value")), reference("study-axis")});
  if (text == "value") return reference("value");
  if (text == "vector") return reference("vector");
  if (text == "text" || text == "name" || text == "frame") return reference("text");
  if (text == "boolean") return {{"type", "boolean"}};
  if (text == "time function" || text == "integer") return reference(definition_name(text));
  return reference("quantity");  // every other scalar is an expression
}

/// Alternatives joined by " | ".
Json value_schema(std::string_view text) {
  Json alternatives = Json::array();
  Json words = Json::array();
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(" | "), text.size());
    const std::string_view one = text.substr(0, end);
    if (one.starts_with("'")) {
      words.push_back(one.substr(1, one.size() - 2));
    } else {
      alternatives.push_back(alternative(one));
    }
    text.remove_prefix(std::min(end + 3, text.size()));
  }
  if (!words.empty()) alternatives.insert(alternatives.begin(), Json{{"enum", words}});
  return any_of(std::move(alternatives));
}

void annotate(Json& schema, std::string_view meaning, std::string_view unit, std::string_view fallback,
              std::string_view example = {}) {
  if (!meaning.empty()) schema["description"] = meaning;
  if (!fallback.empty() && fallback != "required") schema["default"] = fallback;
  if (!unit.empty()) schema["x-unit"] = unit;
  if (!example.empty()) schema["examples"] = Json::array({example});
}

/// A map with these keys and no others. What is required may come from a preset where the map `use`s one.
Json object(Json properties, Json required) {
  Json schema = {{"type", "object"},
                 {"properties", std::move(properties)},
                 {"patternProperties", {{note_pattern, true}}},
                 {"additionalProperties", false}};
  if (required.empty()) return schema;
  if (!schema["properties"].contains("use")) {
    schema["required"] = std::move(required);
  } else {
    schema["anyOf"] = {{{"required", {"use"}}}, {{"required", std::move(required)}}};
  }
  return schema;
}

Json properties_of(const FormatMap& map) {
  Json properties = Json::object();
  for (const FormatKey& key : map.keys) {
    Json& schema = properties[std::string(key.name)] = value_schema(key.value);
    annotate(schema, key.meaning, key.unit, key.fallback, key.example);
  }
  return properties;
}

Json required_of(const FormatMap& map) {
  Json required = Json::array();
  for (const FormatKey& key : map.keys) {
    if (key.fallback == "required") required.push_back(key.name);
  }
  return required;
}

// --- components ------------------------------------------------------------------------------------------------------

std::string number_word(double value) { return Json(value).dump(); }

std::string fallback_of(const Parameter& p) {
  if (std::isnan(p.default_value)) return "required";
  if (p.default_value == optional) return "";
  const std::vector<std::string> words = words_of(p);
  if (p.kind == ParameterKind::choice) return words[static_cast<std::size_t>(p.default_value)];
  const bool number = p.kind == ParameterKind::number || p.kind == ParameterKind::integer;
  return number ? number_word(p.default_value) : "";
}

Json array_of(Json items, std::uint32_t least, std::uint32_t most) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}, {"maxItems", most}};
}

void add_file(Json& alternatives, const char* keys) {
  alternatives.push_back({{"type", "string"}, {"pattern", "\\.csv$"}});
  alternatives.push_back(reference(definition_name(keys)));
}

Json leaf_schema(const Parameter& p) {
  const std::vector<std::string> words = words_of(p);
  Json alternatives = Json::array();
  if (!words.empty()) alternatives.push_back({{"enum", words}});
  switch (p.kind) {
    case ParameterKind::number:
    case ParameterKind::integer:
    case ParameterKind::function:
      alternatives.push_back(reference("quantity"));
      break;
    case ParameterKind::formula:
      alternatives.push_back(reference("quantity"));
      alternatives.push_back(reference("points"));
      if (std::string_view(p.unit) == "m") alternatives.push_back(reference("arcs"));
      break;
    case ParameterKind::vector:
      alternatives.push_back(reference("vector"));
      break;
    case ParameterKind::list:
      alternatives.push_back(array_of(reference("quantity"), p.least, p.most));
      add_file(alternatives, "column");
      break;
    case ParameterKind::table:
      alternatives.push_back(array_of(array_of(reference("quantity"), 2, 2), p.least, p.most));
      add_file(alternatives, "column points");
      break;
    case ParameterKind::choice:
      break;
    case ParameterKind::contact_law:
      alternatives.push_back(reference("contact-law"));
      break;
    case ParameterKind::friction_law:
      alternatives.push_back(reference("friction-law"));
      break;
  }
  return any_of(std::move(alternatives));
}

Json tree_schema(const ParameterTree& tree, const char* block);

/// The keys of a parameter table, or of a map in it.
void add_parameters(const ParameterTree& tree, const char* block, Json& properties, Json& required) {
  for (const ParameterTree& child : tree.children) {
    properties[child.name] = tree_schema(child, block);
    const bool listed = std::ranges::find(required, Json(child.name)) != required.end();
    if (child.is_required() && !listed) required.push_back(child.name);
  }
}

Json tree_schema(const ParameterTree& tree, const char* block) {
  Json alternatives = Json::array();
  if (tree.leaf != nullptr) alternatives.push_back(leaf_schema(*tree.leaf));
  if (!tree.children.empty()) {
    Json properties = Json::object(), required = Json::array();
    add_parameters(tree, block, properties, required);
    if (block != nullptr && tree.name == block) properties["use"] = properties_of(format_map("joint"))["use"];
    alternatives.push_back(object(std::move(properties), std::move(required)));
  }
  Json schema = any_of(std::move(alternatives));
  if (tree.leaf == nullptr) return schema;
  const bool plain = std::string_view(tree.leaf->unit) == "1";
  annotate(schema, tree.leaf->summary, plain ? "" : tree.leaf->unit, fallback_of(*tree.leaf));
  return schema;
}

/// `key: NAME` picks a definition: one condition for each name.
Json choice_by(const std::string& key, const std::vector<std::pair<std::string, std::string>>& definitions) {
  Json names = Json::array(), branches = Json::array();
  for (const auto& [name, definition] : definitions) {
    names.push_back(name);
    branches.push_back(
        {{"if", {{"properties", {{key, {{"const", name}}}}}, {"required", {key}}}}, {"then", reference(definition)}});
  }
  return {{"type", "object"}, {"properties", {{key, {{"enum", names}}}}}, {"allOf", branches}};
}

class ModelSchema {
 public:
  ModelSchema(const Registry& registry, const std::vector<std::string>& force_types)
      : registry_(registry), force_types_(force_types) {}

  Json make() {
    definitions_["quantity"] = {{"type", {"number", "string"}},
                                {"description", "A number or an expression, with a unit if it is not SI: 0.1 mm."}};
    definitions_["time-function"] = {{"type", {"number", "string"}}, {"description", "A quantity that may hold t."}};
    definitions_["integer"] = {{"type", {"number", "string"}}, {"description", "A quantity that is an integer."}};
    definitions_["text"] = {{"type", {"string", "number", "boolean"}}};
    definitions_["value"] = {{"description", "A quantity, a word, a list or a map."}};
    definitions_["vector"] = {{"type", "array"}, {"items", reference("quantity")}, {"minItems", 2}, {"maxItems", 3}};
    for (const FormatMap& map : format_maps()) {
      Json& schema = definitions_[definition_name(map.name)] = object(properties_of(map), required_of(map));
      schema["description"] = map.meaning;
      schema["x-where"] = map.where;
    }
    definitions_["model"]["properties"]["bodies"]["properties"] = {{"ground", reference("ground")}};
    definitions_["template"]["properties"]["bodies"]["properties"] = {{"ground", reference("ground")}};
    add_joints();
    add_laws("contact-law", ComponentKind::contact_law);
    add_laws("friction-law", ComponentKind::friction_law);
    add_integrators();

    Json schema = {{"$schema", dialect}, {"title", "Freeplay model file, version 1"}};
    schema.update(definitions_["model"]);
    definitions_.erase("model");
    schema["$defs"] = std::move(definitions_);
    return schema;
  }

 private:
  void add_joints() {
    std::vector<std::pair<std::string, std::string>> joints, forces;
    for (const RegisteredComponent& entry : registry_.components()) {
      if (entry.component->kind != ComponentKind::joint) continue;
      const std::string name = entry.component->description.name;
      add_joint(entry.component->description);
      joints.emplace_back(name, "joint-" + name);
      if (std::ranges::find(force_types_, name) != force_types_.end()) forces.emplace_back(name, "joint-" + name);
    }
    joints.emplace_back("gear", "gear");
    add_block_of_gear();
    for (const FormatMap& map : format_maps()) {
      constexpr std::string_view prefix = "force ";
      if (!map.name.starts_with(prefix)) continue;
      forces.emplace_back(map.name.substr(prefix.size()), definition_name(map.name));
    }
    set_choice("joint", joints);
    set_choice("force", forces);
  }

  void add_block_of_gear() {
    for (const RegisteredComponent& other : registry_.components()) {
      const Description& twin = other.component->description;
      if (twin.ideal == nullptr || twin.block == nullptr || std::string_view(twin.ideal) != "gear") continue;
      for (const ParameterTree& child : ParameterTree(twin.parameters).children) {
        if (child.name != twin.block) continue;
        Json& written = definitions_["gear"]["properties"][twin.block];
        Json keys = tree_schema(child, twin.block);
        keys["description"] = written["description"];
        written = std::move(keys);
      }
    }
  }

  /// An entry without a type has it from a preset.
  void set_choice(const std::string& name, const std::vector<std::pair<std::string, std::string>>& definitions) {
    Json schema = choice_by("type", definitions);
    schema["anyOf"] = {{{"required", {"type"}}}, {{"required", {"use"}}}};
    definitions_[name] = std::move(schema);
  }

  void add_joint(const Description& joint) {
    const FormatMap& map = format_map("joint");
    Json properties = properties_of(map), required = required_of(map);
    properties["type"] = {{"const", joint.name}};
    const bool named_ends = joint.first_end != nullptr && joint.second_end != nullptr;
    if (named_ends) {
      for (const char* end : {joint.first_end, joint.second_end}) {
        properties[end] = {{"$ref", "#/$defs/text"},
                           {"description", "Frame; with the other end instead of `between`."}};
      }
      std::erase(required.get_ref<Json::array_t&>(), Json("between"));
    }
    add_parameters(ParameterTree(joint.parameters), joint.block, properties, required);
    // A twin's block, which makes this type that twin; its own keys are allowed then, too.
    for (const RegisteredComponent& other : registry_.components()) {
      const Description& twin = other.component->description;
      const bool mine = twin.ideal != nullptr && std::string_view(twin.ideal) == joint.name && twin.block != nullptr;
      if (other.component->kind != ComponentKind::joint || !mine) continue;
      Json none = Json::array();
      add_parameters(ParameterTree(twin.parameters), twin.block, properties, none);
    }
    Json schema = object(std::move(properties), std::move(required));
    if (named_ends) {
      schema["allOf"] = {{{"anyOf",
                           {{{"required", {"use"}}},
                            {{"required", {"between"}}},
                            {{"required", {joint.first_end, joint.second_end}}}}}}};
    }
    schema["description"] = joint.summary;
    definitions_["joint-" + std::string(joint.name)] = std::move(schema);
  }

  /// The name of a law, or a map with `law` and its parameters.
  void add_laws(const std::string& definition, ComponentKind kind) {
    std::vector<std::pair<std::string, std::string>> laws;
    for (const RegisteredComponent& entry : registry_.components()) {
      if (entry.component->kind != kind) continue;
      laws.emplace_back(entry.component->description.name, add_component(definition, "law", *entry.component));
    }
    Json map = choice_by("law", laws);
    map["required"] = {"law"};
    definitions_[definition] = any_of({{{"enum", map["properties"]["law"]["enum"]}}, map});
  }

  void add_integrators() {
    std::vector<std::pair<std::string, std::string>> integrators;
    for (const RegisteredComponent& entry : registry_.components()) {
      if (entry.component->kind != ComponentKind::integrator) continue;
      integrators.emplace_back(entry.component->description.name,
                               add_component("integrator", "type", *entry.component));
    }
    Json map = choice_by("type", integrators);
    map["required"] = {"type"};
    definitions_["integrator"] = std::move(map);
    definitions_["simulation"]["properties"]["integrator"]["anyOf"][0] = {
        {"enum", definitions_["integrator"]["properties"]["type"]["enum"]}};
  }

  /// Adds the map of one component, in which `key` names it; returns the name of the definition.
  std::string add_component(const std::string& kind, const std::string& key, const Component& component) {
    const Description& description = component.description;
    Json properties = {{key, {{"const", description.name}}}}, required = {key};
    add_parameters(ParameterTree(description.parameters), nullptr, properties, required);
    std::string name = kind + "-" + description.name;
    definitions_[name] = object(std::move(properties), std::move(required));
    definitions_[name]["description"] = description.summary;
    return name;
  }

  const Registry& registry_;
  const std::vector<std::string>& force_types_;
  Json definitions_ = Json::object();
};

}  // namespace

Json model_schema(const Registry& registry, const std::vector<std::string>& force_types) {
  return ModelSchema(registry, force_types).make();
}

Json study_schema(const Json& model) {
  Json schema = model;
  schema["title"] = "Freeplay study file, version 1";
  schema["description"] = format_map("study").meaning;
  schema["properties"] = {{"freeplay", model["properties"]["freeplay"]}, {"study", model["properties"]["study"]}};
  schema["required"] = {"freeplay", "study"};
  return schema;
}

}  // namespace freeplay
