#include "io/complete_model.h"

#include <set>

#include "io/yaml_text.h"
#include "model/name_rule.h"

namespace freeplay {
namespace {

/// Copies a tree and renames on the way.
class Copy {
 public:
  Copy(Document& target, const std::set<std::string>& renamed) : target_(target), renamed_(renamed) {}

  const Node& copy(const Node& node) {
    Node& made = target_.add(node.kind, 1, 1);
    made.quoted = node.quoted;
    made.text = node.is_scalar() ? rename(node.text) : node.text;
    for (const Node* item : node.items) made.items.push_back(&copy(*item));
    for (const Node::Entry& entry : node.entries) made.entries.push_back({&copy(*entry.key), &copy(*entry.value)});
    return made;
  }

 private:
  /// NAME, or one or both sides of BODY/FRAME.
  std::string rename(const std::string& text) const {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) return renamed_.contains(text) ? "_" + text : text;
    return rename(text.substr(0, slash)) + "/" + rename(text.substr(slash + 1));
  }

  Document& target_;
  const std::set<std::string>& renamed_;
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
