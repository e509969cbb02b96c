#include "study/document_json.h"

#include <algorithm>

#include "base/json_text.h"

namespace freeplay {
namespace {

void append_text(std::string& out, const std::string& text) {
  out += Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append_node(std::string& out, const Node& node, std::span<const std::string_view> without) {
  bool first = true;
  const auto next = [&] {
    if (!first) out += ',';
    first = false;
  };
  switch (node.kind) {
    case Node::Kind::null:
      out += "null";
      return;
    case Node::Kind::scalar:
      append_text(out, node.text);
      return;
    case Node::Kind::list:
      out += '[';
      for (const Node* item : node.items) {
        next();
        append_node(out, *item, {});
      }
      out += ']';
      return;
    case Node::Kind::map:
      out += '{';
      for (const Node::Entry& entry : node.entries) {
        if (std::ranges::find(without, entry.key->text) != without.end()) continue;
        next();
        append_text(out, entry.key->text);
        out += ':';
        append_node(out, *entry.value, {});
      }
      out += '}';
      return;
  }
}

}  // namespace

std::string document_json(const Node& node, std::span<const std::string_view> without) {
  std::string out;
  append_node(out, node, without);
  return out;
}

}  // namespace freeplay
