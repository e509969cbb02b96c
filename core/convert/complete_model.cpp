#include "convert/complete_model.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "format/key_table.h"
#include "format/name_rule.h"
#include "yaml/text.h"

namespace freeplay {
namespace {

/// Copies a tree and renames on the way.
class Copy {
 public:
  Copy(Document& target, const std::set<std::string>& renamed) : target_(target), renamed_(renamed) {}

  /// `names`: scalars are references, else they are so only where nothing else can be meant.
  const Node& copy(const Node& node, bool names = false) {
    Node& made = target_.add(node.kind, 1, 1);
    made.quoted = node.quoted;
    made.text = node.is_scalar() && (names || !is_number(node.text)) ? rename(node.text) : node.text;
    for (const Node* item : node.items) made.items.push_back(&copy(*item, names));
    for (const Node::Entry& entry : node.entries) {
      const bool refers = std::ranges::find(reference_keys_, entry.key->text) != reference_keys_.end();
      made.entries.push_back({&copy(*entry.key, true), &copy(*entry.value, refers)});
    }
    return made;
  }

 private:
  /// A name such as 1 or 2e3 that a value may have, too.
  static bool is_number(const std::string& text) {
    double value = 0.0;
    return std::from_chars(text.data(), text.data() + text.size(), value).ptr == text.data() + text.size();
  }

  /// Keys under which a model file names frames, bodies and joints.
  static std::vector<std::string_view> reference_keys() {
    std::vector<std::string_view> keys;
    for (const FormatMap& map : format_maps()) {
      for (const FormatKey& key : map.keys) {
        for (const std::string_view sort : {"frame", "name", "list of frame", "list of name"}) {
          if (key.value == sort || key.value.starts_with(std::string(sort) + " |")) keys.push_back(key.name);
        }
      }
    }
    return keys;
  }

  /// NAME, or one or both sides of BODY/FRAME.
  std::string rename(const std::string& text) const {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) return renamed_.contains(text) ? "_" + text : text;
    return rename(text.substr(0, slash)) + "/" + rename(text.substr(slash + 1));
  }

  Document& target_;
  const std::set<std::string>& renamed_;
  const std::vector<std::string_view> reference_keys_ = reference_keys();
};

void collect_foreign(const Node& node, std::set<std::string>& names) {
  for (const Node* item : node.items) collect_foreign(*item, names);
  for (const Node::Entry& entry : node.entries) {
    if (entry.key->foreign && !is_name(entry.key->text)) names.insert(entry.key->text);
    collect_foreign(*entry.value, names);
  }
}

}  // namespace

std::string complete_model_text(const Document& document, std::vector<std::string>& renamed) {
  std::set<std::string> names;
  collect_foreign(document.root(), names);
  renamed.assign(names.begin(), names.end());
  Document target(document.file_name(), "");
  return yaml_text(Copy(target, names).copy(document.root()));
}

}  // namespace freeplay
