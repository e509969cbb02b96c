#include "yaml/text.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace freeplay {
namespace {

constexpr int line_width = 110;

bool is_plain(const std::string& text) {
  const auto letter_or_digit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const auto allowed = [&](char c) {
    return letter_or_digit(c) || std::string_view("_./+*^()$<>= -").find(c) != std::string_view::npos;
  };
  if (text.empty() || text == "~" || text == "null" || text == "Null" || text == "NULL") return false;
  if (!std::ranges::all_of(text, allowed) || text.back() == ' ') return false;
  const char first = text.front();
  if (letter_or_digit(first) || first == '_' || first == '.' || first == '+' || first == '(' || first == '/') {
    return text != "..." && !text.starts_with("... ");
  }
  return (first == '$' || first == '-') && text.size() > 1 && text[1] != ' ' && !text.starts_with("---");
}

void append_map(std::string& out, const Node& map, int indent, bool sections);

void append_value(std::string& out, const Node& value, int indent, int used, bool open) {
  const bool collection = (value.is_map() && !value.entries.empty()) || (value.is_list() && !value.items.empty());
  const std::string line = collection && open ? std::string() : yaml_flow(value);
  const bool fits = !collection || (!open && used + 2 + character_count(line) <= line_width);
  if (fits) {
    out += (line.empty() ? "" : " ") + line + "\n";
  } else if (value.is_map()) {
    out += "\n";
    append_map(out, value, indent + 2, false);
  } else {
    out += "\n";
    for (const Node* item : value.items) out += fmt::format("{:{}}- {}\n", "", indent + 2, yaml_flow(*item));
  }
}

/// `sections`: the values are maps from names to things and always stand open.
void append_map(std::string& out, const Node& map, int indent, bool sections) {
  for (const Node::Entry& entry : map.entries) {
    if (sections && entry.value->is_map() && entry.value->entries.empty()) continue;
    const std::string key = yaml_scalar(entry.key->text) + ":";
    out += fmt::format("{:{}}{}", "", indent, key);
    append_value(out, *entry.value, indent, indent + character_count(key), sections && entry.value->is_map());
  }
}

}  // namespace

std::string yaml_flow(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "";
    case Node::Kind::scalar:
      return yaml_scalar(node.text);
    case Node::Kind::list: {
      std::string out = "[";
      for (const Node* item : node.items) out += (out.size() > 1 ? ", " : "") + yaml_flow(*item);
      return out + "]";
    }
    case Node::Kind::map:
      break;
  }
  std::string out = "{";
  for (const Node::Entry& entry : node.entries) {
    out += (out.size() > 1 ? ", " : "") + yaml_scalar(entry.key->text) + ": " + yaml_flow(*entry.value);
  }
  return out + "}";
}

std::string yaml_scalar(const std::string& text) {
  if (is_plain(text)) return text;
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string yaml_text(const Node& root) {
  std::string out;
  append_map(out, root, 0, true);
  return out;
}

}  // namespace freeplay
