#include "study/point_analysis.h"

#include <algorithm>

#include "analysis/analyse.h"
#include "format/map_reader.h"

namespace freeplay {
namespace {

std::string text_of(const CheckedValue& value) { return value.string().value_or(""); }

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ",") + text;
  return all;
}

/// NAME=VALUE of each entry.
std::vector<std::string> assignments(const CheckedValue& map) {
  std::vector<std::string> texts;
  for (const CheckedValue& entry : entries_of(map)) texts.push_back(entry.key() + "=" + text_of(entry));
  return texts;
}

std::vector<std::string> texts_of(const CheckedValue& value) {
  if (value.node().is_map()) return assignments(value);
  std::vector<std::string> texts;
  if (const auto items = value.one_or_list()) {
    for (const CheckedValue& item : *items)
      texts.push_back(item.node().is_map() ? joined(assignments(item)) : text_of(item));
  }
  return texts;
}

/// Values of one pose or, as texts or maps, one each.
std::vector<std::string> poses_of(const CheckedValue& value) {
  std::vector<std::string> texts = texts_of(value);
  const bool numbers = !value.node().is_scalar() && std::ranges::none_of(texts, [](const std::string& text) {
    return text.find_first_of(",=") != std::string::npos;
  });
  if (numbers || value.node().is_map()) return {joined(texts)};
  return texts;
}

}  // namespace

AnalysisWords read_analysis_words(const CheckedValue& section) {
  MapReader map(section, "study analysis");
  AnalysisWords words;
  const auto text = [&](const char* key, std::string& out) {
    if (const auto value = map.find(key)) out = text_of(*value);
  };
  if (const auto kind = map.require("analyze")) {
    const std::vector<std::string> kinds = {"ik", "workspace", "singularity", "error", "inverse-dynamics"};
    if (const auto word = kind->word(kinds)) words.kind = kinds[static_cast<std::size_t>(*word)];
  }
  text("frame", words.frame);
  text("time", words.time);
  text("elbow", words.elbow);
  text("samples", words.samples);
  text("seed", words.seed);
  text("distribution", words.distribution);
  text("preload", words.preload);
  if (const auto grid = map.find("grid")) words.grid = texts_of(*grid);
  if (const auto pose = map.find("pose")) words.pose = poses_of(*pose);
  if (const auto input = map.find("input")) {
    words.input = texts_of(*input);
    if (input->node().is_map()) words.input = {joined(words.input)};
  }
  if (const auto sensitivity = map.find("sensitivity")) words.sensitivity = sensitivity->boolean().value_or(false);
  if (const auto branches = map.find("branches")) words.branches = branches->boolean().value_or(false);
  map.finish();
  return words;
}

AnalysisTable analysis_of(Model& model, const AnalysisWords& words) {
  require_sense(words);
  const TickOf no_ticks = [](const char*, std::size_t) { return Tick([](long) {}); };
  IdealMechanism mechanism(model, platform_of(model, platform_overrides(model, words)));
  const AnalysisRequest request = request_of(mechanism, words, 1);
  const RequestedStations stations(mechanism, request, no_ticks);
  return analyse(mechanism, request, stations, no_ticks).table;
}

}  // namespace freeplay
