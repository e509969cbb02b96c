#include "load/channel_check.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "base/suggestion.h"
#include "base/text.h"
#include "base/unit.h"
#include "format/checked_value.h"
#include "format/name_rule.h"
#include "model/channel.h"
#include "model/channel_selection.h"

namespace freeplay {
namespace {

constexpr std::size_t most_comparisons = 50'000'000;  // of patterns with names of channels

std::vector<std::string> channel_names(const Channels& channels) {
  std::vector<std::string> names;
  for (const ChannelInfo& channel : channels.all()) names.push_back(channel.name);
  return names;
}

/// Place of item `index` of simulation.output.channels; the file where the text does not say it.
Location pattern_location(const Document& document, std::size_t index) {
  const Node* node = &document.root();
  for (const char* key : {"simulation", "output", "channels"}) {
    node = node->is_map() ? node->find(key) : nullptr;
    if (node == nullptr) return {document.file_name(), 0, 0};
  }
  if (node->is_list() && index < node->items.size()) return node->items[index]->location();
  return node->location();
}

/// The columns that a study keeps something of. Their section has been checked.
std::vector<const Node*> reduced_channels(const Document& document) {
  const Node* node = &document.root();
  for (const char* key : {"study", "reducers"}) {
    node = node->is_map() ? node->find(key) : nullptr;
    if (node == nullptr) return {};
  }
  std::vector<const Node*> channels;
  for (const Node::Entry& entry : node->entries) {
    const Node* channel = !is_note(entry.key->text) && entry.value->is_map() ? entry.value->find("channel") : nullptr;
    if (channel != nullptr && channel->is_scalar()) channels.push_back(channel);
  }
  return channels;
}

/// A limit must have the dimension of its channel.
void check_limit(const StopCondition& condition, const ChannelInfo& channel, Diagnostics& diagnostics) {
  const Dimension wanted = channel.unit.empty() ? dimension::none : parse_unit(channel.unit).dimension;
  if (fits(condition.quantity, wanted)) return;
  diagnostics.error(condition.quantity_location, 1, "dimension-mismatch",
                    fmt::format("the limit of '{}' must be of {}, not of {}", channel.name, dimension_name(wanted),
                                dimension_name(condition.quantity.dimension)),
                    {},
                    wanted == dimension::none && condition.quantity.dimension == dimension::time
                        ? "in a formula t is a number of seconds; a time is limited by `channel: time`, or by `end`"
                        : "");
}

/// Names of channels, to look for what was meant.
struct KnownNames {
  explicit KnownNames(const Channels& of) : channels(of), all(channel_names(of)) {
    for (const ChannelInfo& channel : of.all()) by_name.emplace(channel.name, &channel);
    for (const std::string& name : all) {
      const std::string_view word = std::string_view(name).substr(0, name.find('.'));
      if (kinds.empty() || kinds.back() != word) kinds.emplace_back(word);
    }
  }
  const Channels& channels;
  std::vector<std::string> all, kinds;  // kinds: first words, as `body`
  std::unordered_map<std::string_view, const ChannelInfo*> by_name;
};

/// The channel or pattern that was meant, which there is: with another first word, or one in front, where its own is no
/// kind of column.
std::string nearest_name(const std::string& name, const KnownNames& known) {
  const std::size_t dot = std::min(name.find('.'), name.size());
  const std::string kind = name.substr(0, dot);
  if (std::ranges::find(known.kinds, kind) != known.kinds.end())
    return is_pattern(name) ? "" : nearest(name, known.all);
  if (!is_pattern(name)) {
    for (const std::string& word : known.kinds) {
      if (known.by_name.contains(word + "." + name)) return word + "." + name;
    }
  }
  const std::string meant = nearest(kind, known.kinds);
  if (meant.empty()) return "";
  const std::string whole = meant + name.substr(dot);
  if (is_pattern(name)) return matches_channel(whole, known.channels) ? whole : "";
  return known.by_name.contains(whole) ? whole : nearest(whole, known.all);
}

[[noreturn]] void refuse_pattern(const std::string& pattern, const std::string& meant) {
  throw Error(Error::Category::usage, "unknown-channel", fmt::format("--channels: no channel fits '{}'", pattern), {},
              meant.empty() ? "freeplay list channels MODEL names them" : fmt::format("did you mean '{}'?", meant));
}

}  // namespace

std::string nearest_channel(const std::string& name, const Channels& channels) {
  return nearest_name(name, KnownNames(channels));
}

void check_channels(const Model& model, const Document& document, const std::vector<std::string>& unsure,
                    bool by_option, bool with_study, Diagnostics& diagnostics) {
  const Channels channels(model);
  const KnownNames known_names(channels);
  const auto unknown = [&](const Location& location, const std::string& name, const std::string& message) {
    const std::string_view fixed = std::string_view(name).substr(0, name.find('*'));
    if (std::ranges::any_of(unsure, [&](const std::string& beginning) {
          return fixed.starts_with(beginning) || (is_pattern(name) && beginning.starts_with(fixed));
        })) {
      return;
    }
    diagnostics.error(location, character_count(name), "unknown-name", message, nearest_name(name, known_names));
  };
  for (const StopCondition& condition : model.settings.stop) {
    if (const auto known = known_names.by_name.find(condition.channel); known != known_names.by_name.end()) {
      check_limit(condition, *known->second, diagnostics);
      continue;
    }
    unknown(condition.location, condition.channel, fmt::format("there is no channel '{}'", condition.channel));
  }
  const auto patterns = static_cast<std::size_t>(std::ranges::count_if(model.settings.channels, is_pattern));
  if (patterns * known_names.all.size() > most_comparisons) {
    diagnostics.error(pattern_location(document, 0), 1, "too-large",
                      fmt::format("{} patterns for {} channels are too many", patterns, known_names.all.size()));
    return;
  }
  for (std::size_t i = 0; i < model.settings.channels.size(); ++i) {
    const std::string& pattern = model.settings.channels[i];
    if (!is_pattern(pattern) && known_names.by_name.contains(pattern)) continue;
    if (is_pattern(pattern) && matches_channel(pattern, channels)) continue;
    if (by_option) refuse_pattern(pattern, nearest_name(pattern, known_names));
    unknown(pattern_location(document, i), pattern, fmt::format("no channel fits '{}'", pattern));
  }
  if (!with_study) return;
  for (const Node* channel : reduced_channels(document)) {
    if (channels.find(channel->text) >= 0) continue;
    unknown(channel->location(), channel->text, fmt::format("there is no channel '{}'", channel->text));
  }
}

}  // namespace freeplay
