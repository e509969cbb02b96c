#include "format/path_override.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "format/checked_value.h"
#include "format/key_table.h"
#include "format/run_override.h"

namespace freeplay {
namespace {

constexpr std::array unexpanded = {"templates", "presets", "instances", "plugins", "urdf", "study"};

std::string_view first_word(std::string_view path) { return path.substr(0, path.find('.')); }

/// The part of a path that follows a beginning of it.
std::string_view next_word(std::string_view path, const std::string& beginning) {
  return first_word(path.substr(beginning.size() + 1));
}

bool is_item(std::string_view word) { return !word.empty() && word.find_first_not_of("0123456789") == word.npos; }

/// The nearest of what stands below `reached`; if none is near, of the first words of these with the same rest.
std::string suggestion_for(const std::string& rest, const std::string& reached, std::vector<std::string> candidates) {
  for (const char* name : run_override_names()) {
    const std::string_view word = name;
    if (word.starts_with(reached + ".")) candidates.emplace_back(word.substr(reached.size() + 1));
  }
  std::string found = nearest(rest, candidates);
  const std::size_t dot = rest.find('.');
  if (!found.empty() || dot == std::string::npos) return found;
  for (std::string& candidate : candidates) candidate.resize(std::min(candidate.find('.'), candidate.size()));
  found = nearest(rest.substr(0, dot), candidates);
  return found.empty() ? found : found + rest.substr(dot);
}

[[noreturn]] void refuse(const std::string& name, const std::string& why, const std::string& hint = {}) {
  throw Error(Error::Category::usage, "usage", fmt::format("--set {}: {}", name, why), {}, hint);
}

}  // namespace

bool PathOverrides::is_path(std::string_view name) {
  return name.find('.') != std::string_view::npos || name == "gravity" || is_run_override(name);
}

bool PathOverrides::is_path(std::string_view name, std::string_view value) {
  const bool whole = value.starts_with('{') || value.starts_with('[');
  return is_path(name) || (whole && format_map("model").find(name) != nullptr);
}

PathOverrides::PathOverrides(const BuildOptions& options, Diagnostics& diagnostics)
    : addresses_(options.addresses), offered_(options.offered) {
  for (const auto& set : options.set) {
    const auto& name = set.first;
    const auto& text = set.second;
    // Steps and integrators with their keys are maps in the place of a value.
    const bool is_map = text.starts_with('{');
    if (!is_path(name, text) || (is_run_override(name) && !is_map)) continue;
    if (std::ranges::find(unexpanded, first_word(name)) != unexpanded.end()) {
      refuse(name, fmt::format("what stands in '{}' is no part of the model until it is used", first_word(name)),
             "make it a parameter, or give the path in the model: joints.leg1.B ...");
    }
    const std::string file = "--set " + name;
    diagnostics.add_source(file, text);
    const bool flow = text.starts_with('{') || text.starts_with('[');
    if (flow && options.parse_value) {
      Diagnostics messages;
      std::optional<Document> document = options.parse_value(text, file, messages);
      if (!document || messages.has_errors()) {
        refuse(name, fmt::format("'{}' is no list or map: {}", text, messages.sorted().front().message));
      }
      documents_.push_back(std::move(*document));
    } else {
      documents_.push_back(Document::scalar(file, text));
    }
    std::erase_if(entries_, [&path = name](const Entry& entry) { return entry.path == path; });
    entries_.push_back({name, file, &documents_.back().root(), false, {}, nullptr, {}});
  }
}

// Addresses come parents first, so what stands below the longest beginning is complete in the end.
void PathOverrides::note(Entry& entry, const std::string& address, const Node& value) {
  if (first_word(address) == "templates") return;  // its instances stand in the model
  if (entry.path.starts_with(address + ".") && address.size() > entry.reached.size()) {
    entry.reached = address;
    entry.at = &value;
    entry.candidates.clear();
  } else {
    note_candidate(entry, address);
  }
}

void PathOverrides::note_candidate(Entry& entry, const std::string& address) {
  const bool below = entry.reached.empty() || address.starts_with(entry.reached + ".");
  if (!below || entry.candidates.size() >= most_candidates) return;
  entry.candidates.push_back(address.substr(entry.reached.empty() ? 0 : entry.reached.size() + 1));
}

const PathOverrides::Entry* PathOverrides::first_below(const std::string& address) const {
  const auto found = std::ranges::find_if(entries_, [beginning = address + "."](const Entry& entry) {
    return !is_pattern(entry.path) && entry.path.starts_with(beginning);
  });
  // Items of a list have no place without the others.
  if (found == entries_.end() || is_item(next_word(found->path, address))) return nullptr;
  return &*found;
}

const Node::Entry& PathOverrides::make(const std::string& address, const std::string& key, const Entry& from) {
  const auto [place, fresh] = made_.try_emplace(address);
  if (!fresh) return place->second;
  const auto node = [&](Node::Kind kind, std::string text) -> const Node* {
    return &nodes_.emplace_back(
        Node{.kind = kind, .line = 1, .column = 1, .text = std::move(text), .file = from.value->file});
  };
  const Node* value = from.path == address ? from.value : node(Node::Kind::map, {});
  place->second = {node(Node::Kind::scalar, key), value};
  return place->second;
}

const Node::Entry* PathOverrides::added(const std::string& address) {
  const auto whole = std::ranges::find(entries_, address, &Entry::path);
  const Entry* from = whole != entries_.end() ? &*whole : first_below(address);
  return from == nullptr ? nullptr : &make(address, address.substr(address.rfind('.') + 1), *from);
}

std::vector<const Node::Entry*> PathOverrides::added_names(const std::string& address,
                                                           const std::vector<std::string>& written, MapNames names) {
  if (names == MapNames::references) offer(address + ".");
  std::vector<const Node::Entry*> added;
  for (const Entry& entry : entries_) {
    if (is_pattern(entry.path) || !entry.path.starts_with(address + ".")) continue;
    const std::string name = entry.path.substr(address.size() + 1);
    if (std::ranges::find(written, name) != written.end()) continue;
    if (names == MapNames::own && (name.find('.') != name.npos || !nearest(name, written).empty())) continue;
    added.push_back(&make(entry.path, name, entry));
  }
  return added;
}

void PathOverrides::offer(const std::string& address) {
  if (first_word(address) == "templates") return;
  if (offered_ != nullptr) offered_->push_back(address);
  for (Entry& entry : entries_) {
    if (!entry.found && !address.ends_with('.')) note_candidate(entry, address);
  }
}

const Node& PathOverrides::replace(const std::string& address, const Node& written) {
  const Node* value = &written;
  if (addresses_ != nullptr && first_word(address) != "templates") addresses_->push_back(address);
  for (Entry& entry : entries_) {
    const bool fits = is_pattern(entry.path) ? matches(entry.path, address) : entry.path == address;
    if (fits) {
      entry.found = true;
      value = entry.value;
    }
  }
  // A key without a value is as good as none.
  if (value->is_null()) {
    if (const Entry* below = first_below(address)) value = make(address, {}, *below).value;
  }
  for (Entry& entry : entries_) {
    if (!entry.found) note(entry, address, *value);
  }
  return *value;
}

std::string PathOverrides::hint_for(const Entry& entry, const std::string& rest) {
  const std::string start = entry.reached.empty() ? "" : entry.reached + ".";
  const std::string word(first_word(rest));
  if (entry.at != nullptr && entry.at->is_list()) {
    return fmt::format("its items have the numbers 0 to {}", static_cast<long>(entry.at->items.size()) - 1);
  }
  if (entry.at != nullptr && entry.at->is_scalar()) {
    return fmt::format("it is the value '{}' and no map: give it as a whole, --set '{}={{...}}'", entry.at->text,
                       entry.reached);
  }
  if (word != rest && std::ranges::find(entry.candidates, word) != entry.candidates.end()) {
    return fmt::format("nothing is written there: give it as a whole, --set '{}{}=...'", start, word);
  }
  const std::string suggested = suggestion_for(rest, entry.reached, entry.candidates);
  if (!suggested.empty()) return fmt::format("did you mean '{}{}'?", start, suggested);
  std::vector<std::string> words;
  for (const std::string& candidate : entry.candidates) {
    if (std::ranges::find(words, first_word(candidate)) == words.end()) words.emplace_back(first_word(candidate));
  }
  if (words.empty()) return "nothing stands below it";
  constexpr std::size_t most_words = 16;
  const bool all = words.size() <= most_words;
  if (!all) words.resize(most_words);
  return fmt::format("here may stand {}{}", either(words), all ? "" : " and others");
}

void PathOverrides::require_found() const {
  for (const Entry& entry : entries_) {
    if (entry.found) continue;
    if (is_pattern(entry.path)) refuse(entry.path, "nothing in the model has a path of this form");
    const std::string rest = entry.path.substr(entry.reached.empty() ? 0 : entry.reached.size() + 1);
    const std::string where = entry.reached.empty() ? "the model" : fmt::format("'{}'", entry.reached);
    refuse(entry.path, fmt::format("{} has no '{}'", where, rest), hint_for(entry, rest));
  }
}

}  // namespace freeplay
