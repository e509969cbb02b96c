#include "study/point_words.h"

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

std::vector<std::string> point_words(const StudyPlan& plan, const std::filesystem::path& folder,
                                     const StudyPoint& point) {
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
  if (analysis == nullptr) return words;
  for (const Node::Entry& entry : analysis->entries) {
    if (entry.key->text == "analyze") continue;
    words.push_back("--" + entry.key->text);
    words.push_back(option_text(*entry.value));
  }
  return words;
}

}  // namespace freeplay
