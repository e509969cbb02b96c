#include "study/point_words.h"

#include <algorithm>

namespace freeplay {
namespace {

/// As an option takes it: items of lists apart by commas, entries of maps as NAME=VALUE.
std::string option_text(const Node& node) {
  std::string text;
  if (node.is_map()) {
    for (const Node::Entry& entry : node.entries) {
      text += (text.empty() ? "" : ",") + entry.key->text + "=" + option_text(*entry.value);
    }
  } else if (node.is_list()) {
    for (const auto& item : node.items) text += (text.empty() ? "" : ",") + option_text(*item);
  } else {
    text = node.text;
  }
  return text;
}

}  // namespace

std::vector<std::string> plugins_from_copies(const StudyPlan& plan, const std::filesystem::path& folder,
                                             const StudyPoint& point, const std::vector<std::string>& plugins) {
  std::vector<std::string> copies;
  for (const std::string& copy : plan.plugin_copies(point.model)) {
    const auto name = std::filesystem::path(copy).filename();
    const auto stands_for_it = [&](const std::filesystem::path& plugin) { return plugin.filename() == name; };
    if (std::ranges::none_of(plugins, stands_for_it)) copies.push_back((folder / copy).string());
  }
  return copies;
}

std::vector<std::string> point_words(const StudyPlan& plan, const std::filesystem::path& folder,
                                     const StudyPoint& point, const std::vector<std::string>& plugins) {
  const Node* analysis = plan.section().analysis;
  std::vector<std::string> words;
  if (analysis == nullptr) {
    words.emplace_back("run");
  } else {
    words = {"analyze", analysis->find("analyze")->text};
  }
  words.push_back((folder / plan.model_copy(point.model)).string());
  for (const StudySetting& setting : point.settings) {
    words.emplace_back("--set");
    words.push_back(setting.target + "=" + setting.text);
  }
  for (std::size_t i = 0; analysis != nullptr && i < analysis->entries.size(); ++i) {
    const Node::Entry& entry = analysis->entries[i];
    if (entry.key->text == "analyze") continue;
    words.push_back("--" + entry.key->text);
    words.push_back(option_text(*entry.value));
  }
  for (const std::string& plugin : plugins) words.insert(words.end(), {"--plugin", plugin});
  for (const std::string& copy : plugins_from_copies(plan, folder, point, plugins)) {
    words.insert(words.end(), {"--plugin", copy});
  }
  return words;
}

}  // namespace freeplay
