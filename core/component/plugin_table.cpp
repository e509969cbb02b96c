#include "component/plugin_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <set>
#include <string_view>

#include "base/error.h"

namespace freeplay {
namespace {

constexpr std::size_t place_of_contact_pair = 3;  // in struct_sizes
static_assert(struct_sizes[place_of_contact_pair] == sizeof(ContactPair));
constexpr std::uint32_t most_rows = 10000, most_parameters = 1000;  // beyond is a wild pointer, not a table

// What stands in for functions that came after a library was built.
template <class Table>
Table defaults() {
  Table table{};
  table.size = sizeof table;
  return table;
}
template <>
abi::JointTable defaults<abi::JointTable>() {
  abi::JointTable table{};
  table.size = sizeof table;
  table.step_limit = [](const void*, const JointInput*, double* dt, Message*) noexcept {
    *dt = unbounded;
    return Status::ok;
  };
  table.place = [](const void*, double, Pose*, std::int32_t* can, Message*) noexcept {
    *can = 0;
    return Status::ok;
  };
  table.initial_offset = [](const void*, Span<const double>, InitialOffset*, Message*) noexcept { return Status::ok; };
  table.warning = [](const void*, const JointInput*, const char** text, Message*) noexcept {
    *text = nullptr;
    return Status::ok;
  };
  table.free_distance = [](const void*, const JointInput*, double* distance, Message*) noexcept {
    *distance = 0.0;
    return Status::ok;
  };
  table.next_corner = [](const void*, double, double* corner, Message*) noexcept {
    *corner = unbounded;
    return Status::ok;
  };
  table.contacts = [](const void*, const JointInput*, Span<double>, Message*) noexcept { return Status::ok; };
  table.kinks = [](const void*, const JointInput*, Span<double>, Message*) noexcept { return Status::ok; };
  table.free_levers = [](const void*, const JointInput*, Span<double>, Message*) noexcept { return Status::ok; };
  return table;
}
// A law without switches.
template <class Table, class State>
void has_no_switches(Table& table) {
  table.switches = [](const void*, std::int32_t* count, Message*) noexcept {
    *count = 0;
    return Status::ok;
  };
  table.decide = [](const void*, const State*, Span<double>, Message*) noexcept { return Status::ok; };
}
template <>
abi::ContactLawTable defaults<abi::ContactLawTable>() {
  abi::ContactLawTable table{};
  table.size = sizeof table;
  has_no_switches<abi::ContactLawTable, ContactState>(table);
  return table;
}
template <>
abi::FrictionLawTable defaults<abi::FrictionLawTable>() {
  abi::FrictionLawTable table{};
  table.size = sizeof table;
  table.kinks = [](const void*, Span<const double>* speeds, Message*) noexcept {
    *speeds = {};
    return Status::ok;
  };
  has_no_switches<abi::FrictionLawTable, FrictionState>(table);
  table.memory = [](const void*, Span<double>, Span<MemoryReset>, Message*) noexcept { return Status::ok; };
  table.stored = [](const void*, Span<const double>, double* energy, Span<double> slopes, Message*) noexcept {
    std::fill(slopes.begin(), slopes.end(), 0.0);
    *energy = 0.0;
    return Status::ok;
  };
  return table;
}

// Function tables are a size, then pointers: all of those that the library has must point somewhere.
bool has_null(const void* table, std::uint32_t size) {
  for (std::size_t at = sizeof(void*); at + sizeof(void*) <= size; at += sizeof(void*)) {
    void* entry = nullptr;
    std::memcpy(&entry, static_cast<const char*>(table) + at, sizeof entry);
    if (entry == nullptr) return true;
  }
  return false;
}

// A row of a library, of which this program may know fewer fields, or more: those have their defaults.
template <class Row>
Row as_known(const char* row, std::uint32_t size) {
  Row known{};
  std::memcpy(static_cast<void*>(&known), row, std::min<std::size_t>(size, sizeof(Row)));
  return known;
}

std::string bytes(std::uint32_t theirs, std::uint32_t ours) {
  return "(" + std::to_string(theirs) + " bytes, this program has " + std::to_string(ours) + ")";
}

}  // namespace

PluginTable::PluginTable(PluginEntry entry, const std::string& library) : library_(library) {
  const Host host{sizeof(Host), abi_version, abi_fingerprint, struct_sizes};
  Manifest manifest{};
  const Status status = entry(&host, &manifest);
  check(manifest, status);
  name_ = manifest.name;
  version_ = manifest.version ? manifest.version : "";
  compiler_ = manifest.compiler ? manifest.compiler : "";
  if (manifest.struct_sizes.size > place_of_contact_pair)
    contact_pair_size_ = manifest.struct_sizes[place_of_contact_pair];
  const auto* row = reinterpret_cast<const char*>(manifest.components.data);
  for (std::size_t i = 0; i < manifest.components.size; ++i, row += manifest.component_size) {
    copy_row(as_known<Component>(row, manifest.component_size), manifest);
  }
}

void PluginTable::refuse(const std::string& why) const {
  throw Error(Error::Category::plugin, "plugin-refused", "plugin '" + library_ + "' " + why);
}

void PluginTable::check(const Manifest& manifest, Status status) const {
  if (manifest.size == 0) refuse("did not fill its manifest");
  if (manifest.abi_version != abi_version) {
    refuse("was built for plugin ABI " + std::to_string(manifest.abi_version) + ", this program has ABI " +
           std::to_string(abi_version) + (manifest.abi_version > abi_version ? ": update Freeplay" : ": rebuild it"));
  }
  if (manifest.fingerprint == nullptr || std::strcmp(manifest.fingerprint, abi_fingerprint) != 0) {
    refuse("was built for another machine: its fingerprint is '" +
           std::string(manifest.fingerprint ? manifest.fingerprint : "") + "', this program's '" + abi_fingerprint +
           "'");
  }
  if (status != Status::ok) refuse("refuses this program");
  // Rows are copied field by field up to the smaller size; what came first is always there.
  if (manifest.size < first_manifest_size)
    refuse("has a manifest that is too small " + bytes(manifest.size, first_manifest_size));
  if (manifest.component_size < first_component_size) {
    refuse("has rows of another size " + bytes(manifest.component_size, first_component_size));
  }
  if (manifest.parameter_size < first_parameter_size) {
    refuse("has parameters of another size " + bytes(manifest.parameter_size, first_parameter_size));
  }
  if (manifest.struct_sizes.size > std::size(struct_sizes))
    refuse("knows structs that this program does not: update Freeplay");
  for (std::size_t i = 0; i < manifest.struct_sizes.size; ++i) {
    if (manifest.struct_sizes[i] > struct_sizes[i]) {
      refuse("was built with a newer SDK: its struct number " + std::to_string(i + 1) + " is larger " +
             bytes(manifest.struct_sizes[i], struct_sizes[i]) + ": update Freeplay");
    }
  }
  if (!std::ranges::equal(manifest.fixed_sizes, fixed_sizes)) refuse("lays out its structs differently");
  if (manifest.name == nullptr || *manifest.name == '\0') refuse("has no name");
  if (manifest.components.size == 0 || manifest.components.data == nullptr) refuse("publishes no types");
  if (manifest.components.size > most_rows) refuse("publishes an impossible number of types");
}

void PluginTable::copy_row(const Component& row, const Manifest& manifest) {
  if (row.kind > ComponentKind::integrator) refuse("publishes a type of an unknown kind");
  if (row.description.name == nullptr || *row.description.name == '\0') refuse("publishes a type without a name");
  const std::string named = "publishes '" + std::string(row.description.name) + "' ";
  if (row.description.missing != nullptr) {
    missing_.push_back(row);
    return;
  }
  if (row.table == nullptr) refuse(named + "without a function table");
  if (row.create == nullptr) refuse(named + "without a way to create it");
  const JointFace& in_space = row.description.in_space;
  if ((in_space.table == nullptr) != (in_space.create == nullptr)) refuse(named + "with half a class for space");
  if (row.description.parameters.size > most_parameters) refuse(named + "with an impossible number of parameters");

  Component copy = row;
  std::vector<Parameter>& parameters = parameters_.emplace_back();
  const auto* parameter = reinterpret_cast<const char*>(row.description.parameters.data);
  for (std::size_t i = 0; i < row.description.parameters.size; ++i, parameter += manifest.parameter_size) {
    parameters.push_back(as_known<Parameter>(parameter, manifest.parameter_size));
  }
  copy.description.parameters = {parameters.data(), parameters.size()};
  // A text that is left out is an empty one.
  const auto say_nothing = [](const char*& text) { text = text == nullptr ? "" : text; };
  Description& d = copy.description;
  for (const char** text : {&d.summary, &d.formula, &d.validity, &d.references}) say_nothing(*text);
  for (Parameter& p : parameters) say_nothing(p.summary);
  switch (row.kind) {
    case ComponentKind::joint:
      copy.table = copy_table(row, row.table, joints_);
      if (d.in_space.table != nullptr) d.in_space.table = copy_table(row, d.in_space.table, joints_);
      break;
    case ComponentKind::contact_law:
      copy.table = copy_table(row, row.table, contact_laws_);
      break;
    case ComponentKind::friction_law:
      copy.table = copy_table(row, row.table, friction_laws_);
      break;
    case ComponentKind::integrator:
      copy.table = copy_table(row, row.table, integrators_);
      break;
  }
  check_parameters(copy);
  components_.push_back(copy);
}

template <class Table>
const void* PluginTable::copy_table(const Component& row, const void* functions, std::deque<Table>& tables) {
  std::uint32_t size = 0;
  std::memcpy(&size, functions, sizeof size);
  const std::string named = "publishes '" + std::string(row.description.name) + "' ";
  if (size < 2 * sizeof(void*) || size > 64 * sizeof(void*))
    refuse(named + "with a function table of an impossible size");
  if (has_null(functions, std::min<std::uint32_t>(size, sizeof(Table)))) refuse(named + "with a null function pointer");
  Table& table = tables.emplace_back(defaults<Table>());
  std::memcpy(&table, functions, std::min<std::size_t>(size, sizeof(Table)));
  table.size = sizeof(Table);
  if (has_null(&table, sizeof(Table))) refuse(named + "with a function table that is too small");
  return &table;
}

void PluginTable::check_parameters(const Component& row) const {
  std::set<std::string_view> names;
  for (const Parameter& p : row.description.parameters) {
    const std::string named = std::string("publishes '") + row.description.name + "' with ";
    if (p.name == nullptr || *p.name == '\0' || p.unit == nullptr) refuse(named + "a parameter without name or unit");
    const std::string parameter = "parameter '" + std::string(p.name) + "' ";
    if (p.kind > ParameterKind::table) refuse(named + parameter + "of an unknown kind");
    const bool has_points = p.kind == ParameterKind::list || p.kind == ParameterKind::table;
    const bool has_variables = p.kind == ParameterKind::formula || p.kind == ParameterKind::table;
    if (has_variables && p.variables == nullptr) refuse(named + parameter + "without variables");
    if (has_points && (p.least > p.most || p.most == 0)) refuse(named + parameter + "whose length leaves nothing");
    if (!names.insert(p.name).second) refuse(named + "two parameters called '" + p.name + "'");
    if (p.minimum > p.maximum) refuse(named + parameter + "whose bounds leave nothing");
    const bool has_default = !std::isnan(p.default_value) && p.default_value != optional;
    if (has_points && has_default) refuse(named + parameter + "that has a default, which only numbers and words have");
    if (!has_default || (p.kind != ParameterKind::number && p.kind != ParameterKind::integer)) continue;
    const auto open = [&](Open end) {
      return (static_cast<std::uint32_t>(p.open) & static_cast<std::uint32_t>(end)) != 0;
    };
    const bool inside = (open(Open::minimum) ? p.default_value > p.minimum : p.default_value >= p.minimum) &&
                        (open(Open::maximum) ? p.default_value < p.maximum : p.default_value <= p.maximum);
    if (!inside) refuse(named + parameter + "whose default lies outside its bounds");
  }
}

}  // namespace freeplay
