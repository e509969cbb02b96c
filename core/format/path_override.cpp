#include "format/path_override.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "format/checked_value.h"
#include "format/run_override.h"

namespace freeplay {
namespace {

constexpr std::array unexpanded = {"templates", "presets", "instances", "plugins", "urdf", "study"};

std::string_view first_word(std::string_view path) { return path.substr(0, path.find('.')); }

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

PathOverrides::PathOverrides(const BuildOptions& options, Diagnostics& diagnostics) : addresses_(options.addresses) {
  for (const auto& set : options.set) {
    const auto& name = set.first;
    const auto& text = set.second;
    // An integrator with its parameters is a map in the place of a word.
    const bool is_map = text.starts_with('{');
    if (!is_path(name) || (is_run_override(name) && !is_map)) continue;
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
    entries_.push_back({name, file, &documents_.back().root(), false, {}, {}});
  }
}

// Addresses come parents first, so what stands below the longest beginning is complete in the end.
void PathOverrides::note(Entry& entry, const std::string& address) const {
  if (first_word(address) == "templates") return;  // its instances stand in the model
  const bool below = entry.reached.empty() || address.starts_with(entry.reached + ".");
  if (entry.path.starts_with(address + ".") && address.size() > entry.reached.size()) {
    entry.reached = address;
    entry.candidates.clear();
  } else if (below && entry.candidates.size() < most_candidates) {
    entry.candidates.push_back(address.substr(entry.reached.empty() ? 0 : entry.reached.size() + 1));
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
    } else if (!entry.found) {
      note(entry, address);
    }
  }
  return *value;
}

void PathOverrides::require_found() const {
  for (const Entry& entry : entries_) {
    if (entry.found) continue;
    if (is_pattern(entry.path)) refuse(entry.path, "nothing in the model has a path of this form");
    const std::string rest = entry.path.substr(entry.reached.empty() ? 0 : entry.reached.size() + 1);
    const std::string suggested = suggestion_for(rest, entry.reached, entry.candidates);
    const std::string where = entry.reached.empty() ? "the model" : fmt::format("'{}'", entry.reached);
    refuse(entry.path, fmt::format("{} has no '{}'", where, rest),
           suggested.empty()
               ? "a value takes the place of one that the file has"
               : fmt::format("did you mean '{}{}{}'?", entry.reached, entry.reached.empty() ? "" : ".", suggested));
  }
}

}  // namespace freeplay
