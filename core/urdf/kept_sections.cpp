#include "urdf/kept_sections.h"

#include <algorithm>

#include "base/expression.h"

namespace freeplay {
namespace {

void collect_uses(const Node& node, std::set<std::string>& names) {
  for (const Node* item : node.items) collect_uses(*item, names);
  for (const Node::Entry& entry : node.entries) {
    if (entry.key->text == "use") {
      if (entry.value->is_scalar()) names.insert(entry.value->text);
      for (const Node* item : entry.value->items) names.insert(item->text);
    }
    collect_uses(*entry.value, names);
  }
}

void collect_parameters(const Node& node, std::set<std::string>& names) {
  if (node.is_scalar()) {
    for (const std::string& name : referenced_parameters(node.text)) names.insert(name);
  }
  for (const Node* item : node.items) collect_parameters(*item, names);
  for (const Node::Entry& entry : node.entries) collect_parameters(*entry.value, names);
}

/// Words of a study that may be parameters: its targets, and those that values of `set` use.
void collect_targets(const Node& node, std::set<std::string>& names) {
  collect_parameters(node, names);
  if (node.is_scalar()) names.insert(node.text);
  for (const Node* item : node.items) collect_targets(*item, names);
  for (const Node::Entry& entry : node.entries) {
    names.insert(entry.key->text);
    collect_targets(*entry.value, names);
  }
}

}  // namespace

bool mentions(const Node& kept, const std::string& frame) {
  const auto in_entry = [&](const Node::Entry& entry) { return mentions(*entry.value, frame); };
  return kept.text.find(frame) != std::string::npos || std::ranges::any_of(kept.entries, in_entry) ||
         std::ranges::any_of(kept.items, [&](const Node* item) { return mentions(*item, frame); });
}

void KeptSections::put(Node& owner, const char* key, const Node& value) {
  Node& name = target_.add(Node::Kind::scalar, 1, 1);
  name.text = key;
  owner.entries.push_back({&name, &value});
}

void KeptSections::add(Node& root, Node& content, const char* section, Names wanted,
                       const std::function<void(const Node&, Names&)>& collect) {
  const Node* all = source_.find(section);
  if (all == nullptr || !all->is_map()) return;
  for (std::size_t before = 0; before != wanted.size();) {
    before = wanted.size();
    for (const Node::Entry& entry : all->entries) {
      if (wanted.contains(entry.key->text)) collect(*entry.value, wanted);
    }
  }
  Node& kept = target_.add(Node::Kind::map, 1, 1);
  for (const Node::Entry& entry : all->entries) {
    if (wanted.contains(entry.key->text)) kept.entries.push_back(entry);
  }
  if (kept.entries.empty()) return;
  put(root, section, kept);
  put(content, section, kept);
}

void KeptSections::add_presets(Node& root, Node& content) {
  Names wanted;
  collect_uses(content, wanted);
  add(root, content, "presets", wanted, collect_uses);
}

bool KeptSections::add_parameters(Node& root, Node& content) {
  const Node* all = source_.find("parameters");
  if (all == nullptr || !all->is_map() || all->entries.empty()) return false;
  Names wanted;
  collect_parameters(content, wanted);
  if (const Node* study = source_.find("study"); study != nullptr && study->is_map()) collect_targets(*study, wanted);
  add(root, content, "parameters", wanted, collect_parameters);
  return true;
}

}  // namespace freeplay
