#include "format/parameter_scope.h"

#include <algorithm>
#include <utility>

#include "format/checked_value.h"
#include "format/name_rule.h"

namespace freeplay {

ParameterScope::Entry& ParameterScope::append(const std::string& name) {
  index_.emplace(name, entries_.size());
  entries_.push_back({});
  entries_.back().name = name;
  return entries_.back();
}

void ParameterScope::add(const std::string& name, const Node& key, const Node& value, std::string path,
                         const Reading& reading, bool overridden) {
  Entry& entry = append(name);
  entry.key = &key;
  entry.value = &value;
  entry.path = std::move(path);
  entry.reading = &reading;
  if (overridden) entry.override = &value;
}

void ParameterScope::add_constant(const std::string& name, const Quantity& value) {
  Entry& entry = append(name);
  entry.quantity = value;
  entry.state = State::done;
}

void ParameterScope::add_broken(const std::string& name) { append(name).state = State::broken; }

const ParameterScope::Entry* ParameterScope::entry(std::string_view name) const {
  const auto found = index_.find(std::string(name));
  return found == index_.end() ? nullptr : &entries_[found->second];
}

const Quantity* ParameterScope::find(std::string_view name) const {
  const Entry* own = entry(name);
  if (own == nullptr) return outer_ == nullptr ? nullptr : outer_->find(name);
  if (own->key != nullptr) used_->insert(own->key);
  return &own->quantity;
}

std::vector<std::pair<std::string, Quantity>> ParameterScope::values() const {
  std::vector<std::pair<std::string, Quantity>> values;
  for (const Entry& own : entries_) {
    if (own.state == State::done) values.emplace_back(own.name, own.quantity);
  }
  return values;
}

bool ParameterScope::broken(std::string_view name) const {
  const Entry* own = entry(name);
  if (own != nullptr) return own->state == State::broken;
  return outer_ != nullptr && outer_->broken(name);
}

const Node* ParameterScope::override_of(std::string_view name) const {
  const Entry* own = entry(name);
  if (own != nullptr) return own->override;
  return outer_ == nullptr ? nullptr : outer_->override_of(name);
}

std::vector<std::string> ParameterScope::names() const {
  std::vector<std::string> names;
  if (entries_.size() > most_candidates) return names;
  for (const Entry& own : entries_) names.push_back(own.name);
  if (outer_ == nullptr) return names;
  for (std::string& name : outer_->names()) {
    if (!declares(name)) names.push_back(std::move(name));
  }
  return names;
}

void ParameterScope::evaluate() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].state == State::waiting) evaluate_from(i);
  }
}

std::vector<std::size_t> ParameterScope::needs(const Entry& needing) const {
  std::vector<std::size_t> needed;
  if (needing.reading->scope != this || !needing.value->is_scalar()) return needed;
  for (const std::string& name : referenced_parameters(needing.value->text)) {
    const auto found = index_.find(name);
    if (found != index_.end()) needed.push_back(found->second);
  }
  return needed;
}

/// Depth first with a stack of its own: a long chain of parameters must not exhaust the program's.
void ParameterScope::evaluate_from(std::size_t first) {
  struct Visit {
    std::size_t entry;
    std::vector<std::size_t> needed;
    std::size_t next = 0;
  };
  std::vector<Visit> stack;
  const auto enter = [&](std::size_t i) {
    entries_[i].state = State::open;
    stack.push_back({i, needs(entries_[i])});
  };
  enter(first);
  while (!stack.empty()) {
    Visit& visit = stack.back();
    if (visit.next == visit.needed.size()) {
      compute(entries_[visit.entry]);
      stack.pop_back();
      continue;
    }
    const std::size_t needed = visit.needed[visit.next++];
    if (entries_[needed].state == State::waiting) {
      enter(needed);
    } else if (entries_[needed].state == State::open) {
      std::vector<std::size_t> path;
      for (const Visit& open : stack) path.push_back(open.entry);
      report_cycle(path, needed);
    }
  }
}

void ParameterScope::compute(Entry& computed) {
  if (computed.state == State::broken) return;  // part of a cycle
  const CheckedValue value(*computed.reading, *computed.value, computed.key, computed.path);
  const std::optional<Quantity> quantity = value.any_quantity();
  computed.state = quantity ? State::done : State::broken;
  if (quantity) computed.quantity = *quantity;
  if (computed.override != nullptr || !computed.value->is_scalar()) return;
  for (const std::string& name : referenced_parameters(computed.value->text)) {
    const Node* text = computed.reading->scope->override_of(name);
    if (text != nullptr) computed.override = text;
  }
}

void ParameterScope::report_cycle(const std::vector<std::size_t>& path, std::size_t closing) {
  std::vector<std::size_t> cycle(std::find(path.begin(), path.end(), closing), path.end());
  // What the command line says is to blame, not the file, where it takes part.
  const auto given =
      std::find_if(cycle.begin(), cycle.end(), [&](std::size_t i) { return is_overridden(entries_[i]); });
  if (given != cycle.end()) std::rotate(cycle.begin(), given, cycle.end());
  std::string chain;
  for (const std::size_t i : cycle) {
    chain += entries_[i].name + " -> ";
    entries_[i].state = State::broken;
    used_->insert(entries_[i].key);
  }
  const Entry& named = entries_[cycle.front()];
  const CheckedValue at(*named.reading, *named.value, named.key, named.path);
  const std::string message = "parameter '" + named.name + "' depends on itself: " + chain + named.name;
  is_overridden(named) ? at.fail("cyclic-parameter", message) : at.fail_at_key("cyclic-parameter", message);
}

bool check_parameter_name(const CheckedValue& parameter) {
  const std::string name = parameter.key();
  if (!is_parameter_name(name)) {
    parameter.fail_at_key("bad-name", "'" + name + "' is not a valid name of a parameter", {},
                          name_hint(name, "it has letters, digits and '_' and begins with a letter or '_'"));
    return false;
  }
  for (const char* reserved : {"t", "pi", "i", "n"}) {
    if (name != reserved) continue;
    parameter.fail_at_key("reserved-name", "the parameter name '" + name + "' is reserved");
    return false;
  }
  return true;
}

}  // namespace freeplay
