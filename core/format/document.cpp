#include "format/document.h"

#include <algorithm>
#include <utility>

#include "base/text.h"

namespace freeplay {

const char* Node::kind_name() const {
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::scalar:
      return "a scalar";
    case Kind::list:
      return "a list";
    case Kind::map:
      break;
  }
  return "a map";
}

const Node* Node::find(std::string_view key) const {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key->text == key; });
  return found == entries.end() ? nullptr : found->value;
}

Location Node::location_at(int offset) const {
  Location place = location();
  if (verbatim) place.column += offset + (quoted ? 1 : 0);
  return place;
}

namespace {

void make_scalar(Node& node, std::string text) {
  node.kind = Node::Kind::scalar;
  node.length = std::max(1, character_count(text));
  node.verbatim = text.find('\n') == std::string::npos;
  node.text = std::move(text);
}

}  // namespace

Document::Document(std::string file_name, std::string text) : text_(std::move(text)) {
  files_.push_back(std::move(file_name));
  root_ = &add(Node::Kind::null, 1, 1);
}

Document Document::scalar(std::string file_name, std::string text) {
  Document document(std::move(file_name), std::move(text));
  make_scalar(document.nodes_.front(), document.text_);
  return document;
}

bool Document::replace_value(const Node& map, std::string_view key, std::string file_name, std::string text) {
  const auto owned = std::find_if(nodes_.begin(), nodes_.end(), [&](const Node& node) { return &node == &map; });
  if (owned == nodes_.end()) return false;
  const auto entry =
      std::find_if(owned->entries.begin(), owned->entries.end(), [&](const auto& e) { return e.key->text == key; });
  if (entry == owned->entries.end()) return false;
  Node& value = add(Node::Kind::scalar, 1, 1);
  value.file = &files_.emplace_back(std::move(file_name));
  make_scalar(value, std::move(text));
  entry->value = &value;
  return true;
}

const std::string* Document::add_file(std::string name, std::string text) {
  const std::string* kept = &files_.emplace_back(std::move(name));
  attachments_.push_back({kept, std::move(text)});
  return kept;
}

Node& Document::add(Node::Kind kind, int line, int column) {
  Node& node = nodes_.emplace_back();
  node.kind = kind;
  node.line = line;
  node.column = column;
  node.file = &files_.front();
  return node;
}

}  // namespace freeplay
