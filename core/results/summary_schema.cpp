#include "base/version.h"
#include "component/json_schema.h"

namespace freeplay {
namespace {

Json number() { return {{"type", "number"}}; }
Json number_or_null() { return {{"type", {"number", "null"}}}; }
Json integer() { return {{"type", "integer"}}; }
Json integer_or_null() { return {{"type", {"integer", "null"}}}; }
Json text() { return {{"type", "string"}}; }

/// Exactly these fields, all there.
Json record(Json fields) {
  Json required = Json::array();
  for (const auto& [name, schema] : fields.items()) required.push_back(name);
  return {
      {"type", "object"}, {"properties", std::move(fields)}, {"required", required}, {"additionalProperties", false}};
}

/// Names to something.
Json by_name(Json value) { return {{"type", "object"}, {"additionalProperties", std::move(value)}}; }

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Json numbers(std::initializer_list<const char*> names) {
  Json fields = Json::object();
  for (const char* name : names) fields[name] = number_or_null();
  return record(std::move(fields));
}

/// SHA-256.
Json digits() { return {{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}}; }
Json digits_or_null() { return {{"type", {"string", "null"}}, {"pattern", "^[0-9a-f]{64}$"}}; }

Json model_part() {
  return record({{"name", text()},
                 {"file", text()},
                 {"sha256", digits()},
                 {"space", {{"enum", {"planar", "spatial"}}}},
                 {"bodies", integer()},
                 {"joints", integer()},
                 {"clearance_joints", integer()},
                 {"drivers", integer()},
                 {"dof", integer_or_null()},
                 {"dof_driven", integer_or_null()},
                 {"redundant", integer_or_null()}});
}

Json settings_part() {
  const Json step = {{"type", "object"},
                     {"properties", {{"size", number()}, {"adaptive", {{"type", "boolean"}}}}},
                     {"required", {"size", "adaptive"}}};
  const Json integrator = {{"type", "object"}, {"properties", {{"type", text()}}}, {"required", {"type"}}};
  return record({{"start", number()},
                 {"end", number()},
                 {"integrator", integrator},
                 {"step", step},
                 {"interval", number()},
                 {"discard", number()},
                 {"set", by_name(text())},
                 {"ideal", list_of(text())}});
}

/// Of contacts; all null where there is none.
void add_contacts(Json& fields) {
  for (const char* name : {"max_fn", "max_delta", "max_eccentricity"}) fields[name] = number_or_null();
  fields["contacts"] = integer_or_null();
  for (const char* name : {"contact_fraction", "dissipated"}) fields[name] = number_or_null();
}

Json play_part() {
  Json part = numbers({"flight", "impact", "lasting", "max_approach_speed", "max_impulse", "mean_fn", "load_angle",
                       "load_concentration", "load_elevation", "sliding", "work", "pv_mean", "pv_max", "carried_in",
                       "carried_out"});
  part["properties"]["impacts"] = integer();
  part["required"].push_back("impacts");
  part["type"] = {"object", "null"};
  return part;
}

Json joint_part() {
  Json fields = {{"type", text()}};
  for (const char* name : {"max_force", "max_torque", "rms_force"}) fields[name] = number_or_null();
  add_contacts(fields);
  const Json round = numbers({"radial_clearance", "bearing_radius", "journal_radius", "length"});
  fields["clearance"] = {{"anyOf", {round, numbers({"gap", "length"}), {{"type", "null"}}}}};
  fields["play"] = play_part();
  return record(std::move(fields));
}

Json verification_part() {
  Json part = record({{"method", text()},
                      {"steps", integer()},
                      {"until", number()},
                      {"agreement", {{"enum", {"agree", "err", "part", "disagree"}}}},
                      {"limit", number()},
                      {"largest", number_or_null()},
                      {"at", number()},
                      {"peaks", list_of(record({{"name", text()},
                                                {"run", number_or_null()},
                                                {"second", number_or_null()},
                                                {"differs", {{"type", "boolean"}}}}))}});
  part["type"] = {"object", "null"};
  return part;
}

Json trust_part() {
  const Json reason = record({{"id", text()},
                              {"level", {{"enum", {"doubtful", "bad"}}}},
                              {"message", text()},
                              {"element", {{"type", {"string", "null"}}}},
                              {"value", number_or_null()},
                              {"limit", number_or_null()}});
  return record({{"verdict", {{"enum", {"good", "doubtful", "bad"}}}}, {"reasons", list_of(reason)}});
}

Json force_part() {
  Json fields = {{"type", text()}};
  for (const char* name : {"max_force", "max_torque", "work"}) fields[name] = number_or_null();
  add_contacts(fields);
  fields["play"] = play_part();
  return record(std::move(fields));
}

/// Null where nothing in the model can touch.
Json noise_part() {
  Json part = record({{"growing_impacts", integer()},
                      {"joints", by_name(numbers({"max_force", "max_torque", "max_fn", "max_delta", "max_eccentricity",
                                                  "rms_force", "contacts", "contact_fraction"}))},
                      {"drivers", by_name(numbers({"max_abs", "rms"}))},
                      {"forces", by_name(numbers({"max_force", "max_torque"}))},
                      {"paths", by_name(numbers({"max_position", "max_angle", "rms_position", "rms_angle"}))}});
  part["type"] = {"object", "null"};
  return part;
}

/// Null in a run that was not repeated.
Json repeat_part() {
  const Json spread = record({{"median", number_or_null()},
                              {"min", number_or_null()},
                              {"max", number_or_null()},
                              {"values", list_of(number_or_null())}});
  const Json failed = record({{"run", integer()}, {"exit_code", integer()}, {"reason", text()}});
  Json fields = {{"runs", integer()},  {"seed", integer()},      {"moved", number()},
                 {"pushed", number()}, {"completed", integer()}, {"failed", list_of(failed)}};
  for (const char* part : {"joints", "drivers", "forces", "paths"}) fields[part] = by_name(by_name(spread));
  Json part = record(std::move(fields));
  part["type"] = {"object", "null"};
  return part;
}

/// Null in a run without a twin.
Json twin_part() {
  Json part = record({{"bodies", by_name(numbers({"max_position", "rms_position", "max_angle", "rms_angle"}))},
                      {"drivers", by_name(numbers({"max", "rms", "ripple"}))}});
  part["type"] = {"object", "null"};
  return part;
}

Json driver_part() {
  return record({{"kind", {{"enum", {"angle", "position", "velocity", "torque", "force"}}}},
                 {"max_abs", number_or_null()},
                 {"rms", number_or_null()},
                 {"work", number_or_null()}});
}

Json statistics_part() {
  const Json before = record({{"joints", by_name(numbers({"max_force"}))}, {"drivers", by_name(numbers({"max_abs"}))}});
  return record({{"from", number()}, {"to", number_or_null()}, {"before", {{"anyOf", {before, {{"type", "null"}}}}}}});
}

Json provenance_part() {
  const Json file = record({{"name", text()}, {"sha256", digits()}});
  return record(
      {{"freeplay", text()},
       {"schema", {{"const", schema_version}}},
       {"build", text()},
       {"compiler", text()},
       {"plugin_abi", integer()},
       {"platform", text()},
       {"arithmetic", {{"type", "string"}, {"pattern", "^[0-9a-f]{16}$"}}},
       {"made", text()},
       {"command", text()},
       {"arguments", list_of(text())},
       {"model", file},
       {"inputs", list_of(file)},
       {"plugins",
        list_of(record({{"name", text()}, {"version", text()}, {"file", text()}, {"sha256", digits_or_null()}}))},
       {"seed", integer_or_null()},
       {"hashes", record({{"rows", digits_or_null()}, {"events", digits_or_null()}})},
       {"data_sha256", digits_or_null()}});
}

}  // namespace

Json summary_schema() {
  Json schema = record(
      {{"freeplay", record({{"version", text()}, {"schema", {{"const", schema_version}}}})},
       {"model", model_part()},
       {"settings", settings_part()},
       {"status", {{"enum", {"completed", "stopped", "failed", "interrupted"}}}},
       {"stop_reason", {{"type", {"string", "null"}}}},
       {"exit_code", integer()},
       {"time",
        record({{"reached", number()}, {"smallest_step", number_or_null()}, {"largest_step", number_or_null()}})},
       {"counts", record({{"rows", integer()},
                          {"steps", integer()},
                          {"rejected", integer()},
                          {"iterations", integer()},
                          {"factorizations", integer()},
                          {"contacts", integer()},
                          {"contacts_total", integer()}})},
       {"statistics", statistics_part()},
       {"residuals", numbers({"position_max", "velocity_max", "energy_max"})},
       {"bodies", by_name({{"type", "object"}, {"additionalProperties", number_or_null()}})},
       {"joints", by_name(joint_part())},
       {"drivers", by_name(driver_part())},
       {"forces", by_name(force_part())},
       {"paths", by_name(numbers({"max_position", "rms_position", "max_angle", "rms_angle"}))},
       {"memory", by_name(record({{"internal", list_of(number())}, {"history", list_of(number())}}))},
       {"energy", numbers({"kinetic", "potential", "dissipated", "work", "residual"})},
       {"advice",
        record(
            {{"under_resolved", integer()}, {"min_steps_per_contact", number_or_null()}, {"step", number_or_null()}})},
       {"verify", {{"type", {"object", "null"}}, {"additionalProperties", number_or_null()}}},
       {"agree_until", number_or_null()},
       {"verification", verification_part()},
       {"trust", trust_part()},
       {"noise", noise_part()},
       {"repeat", repeat_part()},
       {"hashes", record({{"rows", digits_or_null()}, {"events", digits_or_null()}})},
       {"provenance", provenance_part()},
       {"twin", twin_part()},
       {"performance", record({{"wall_seconds", number()},
                               {"steps_per_second", number()},
                               {"resumed", integer()},
                               {"resumed_from", number_or_null()}})},
       {"files", list_of(text())},
       {"warnings", list_of(text())}});
  Json head = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Freeplay summary.json"}};
  head.update(schema);
  return head;
}

}  // namespace freeplay
