#include "results/made_text.h"

#include <cctype>
#include <fstream>
#include <utility>

#include "results/result_record.h"

namespace freeplay {
namespace {

/// What characters of XML stand for.
std::string plain_xml(std::string_view text) {
  constexpr std::string_view begin = "<![CDATA[", end = "]]>";
  if (const std::size_t at = text.find(begin); at != std::string_view::npos) {
    const std::size_t from = at + begin.size();
    return std::string(text.substr(from, text.find(end, from) - from));
  }
  constexpr std::pair<std::string_view, char> entities[] = {{"&lt;", '<'},    {"&gt;", '>'},   {"&quot;", '"'},
                                                            {"&apos;", '\''}, {"&#39;", '\''}, {"&amp;", '&'}};
  std::string out;
  while (!text.empty()) {
    std::size_t length = 1;
    char letter = text.front();
    for (const auto& [entity, meant] : entities) {
      if (letter != '&' || !text.starts_with(entity)) continue;
      letter = meant;
      length = entity.size();
      break;
    }
    out += letter;
    text.remove_prefix(length);
  }
  return out;
}

/// Bytes from one mark to another, both included; npos where there are none.
std::pair<std::size_t, std::size_t> between(std::string_view text, std::string_view begin, std::string_view end) {
  const std::size_t from = text.find(begin);
  const std::size_t until = from == std::string_view::npos ? from : text.find(end, from);
  if (until == std::string_view::npos) return {until, until};
  return {from, until + end.size()};
}

/// Goes over the tokens of a JSON text.
class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) { skip_blanks(); }

  bool at_end() const { return at_ >= text_.size(); }
  char now() const { return at_end() ? '\0' : text_[at_]; }
  void step() {
    ++at_;
    skip_blanks();
  }

  /// A string, a list, an object or a word; returns its text.
  std::string_view value() {
    const std::size_t from = at_;
    int depth = 0;
    do {
      const char c = now();
      if (c == '"') {
        pass_string();
      } else if (c == '{' || c == '[') {
        ++depth;
        ++at_;
      } else if (c == '}' || c == ']') {
        --depth;
        ++at_;
      } else if (depth == 0) {
        while (!at_end() && std::string_view(",}] \n\r\t").find(now()) == std::string_view::npos) ++at_;
      } else {
        ++at_;
      }
    } while (depth > 0 && !at_end());
    const std::string_view out = text_.substr(from, at_ - from);
    skip_blanks();
    return out;
  }

 private:
  void pass_string() {
    for (++at_; !at_end() && text_[at_] != '"'; ++at_) at_ += text_[at_] == '\\' ? 1 : 0;
    at_ = at_ + 1 < text_.size() ? at_ + 1 : text_.size();
  }
  void skip_blanks() {
    while (!at_end() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string_view field_text(std::string_view object, std::string_view name) {
  Walk walk(object);
  if (walk.now() != '{') return {};
  for (walk.step(); !walk.at_end() && walk.now() == '"';) {
    const std::string_view key = walk.value();
    if (walk.now() != ':') return {};
    walk.step();
    const std::string_view value = walk.value();
    if (key.substr(1, key.size() - 2) == name) return value;
    if (walk.now() == ',') walk.step();
  }
  return {};
}

bool is_own_picture(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(4096, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  if (!head.starts_with("<svg")) return false;
  const std::string_view rest = std::string_view(head).substr(head.find('>') + 1);
  return rest.starts_with("\n<metadata>{") || rest.starts_with("\n<metadata>null<");
}

MadeText split_json(const std::string& text) {
  Json json = json_of(text);
  if (!json.is_object() || !json.contains("provenance")) return {nullptr, text};
  MadeText out{.record = std::move(json["provenance"]), .data = {}};
  // Nothing else of the text begins a line like this: line feeds of strings are written in another way.
  const std::size_t at = text.rfind("\n  \"provenance\": ");
  json.erase("provenance");
  out.data = at != std::string::npos ? text.substr(0, at) : json.dump();
  return out;
}

MadeText split_picture(const std::string& text) {
  const auto [from, until] = between(text, "<metadata", "</metadata>");
  if (from == std::string::npos) return {nullptr, text};
  std::string inside = text.substr(from, until - from);
  inside.erase(0, inside.find('>') + 1);
  inside.erase(inside.rfind('<'));
  const std::size_t before = from > 0 && text[from - 1] == '\n' ? from - 1 : from;
  return {json_of(plain_xml(inside)), text.substr(0, before) + text.substr(until)};
}

std::string picture_with_record(const std::string& picture, const Json& record) {
  const std::size_t svg = picture.find("<svg"), end = picture.find('>', svg);
  if (svg == std::string::npos || end == std::string::npos) return picture;
  std::string text = "\n<metadata>";
  // In ASCII, so that no control character reaches a terminal.
  for (const char c : record.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<') {
      text += "&lt;";
    } else if (c == '>') {
      text += "&gt;";
    } else if (c == '&') {
      text += "&amp;";
    } else {
      text += c;
    }
  }
  return picture.substr(0, end + 1) + text + "</metadata>" + picture.substr(end + 1);
}

MadeText split_page(const std::string& text) {
  const std::size_t id = text.find("id=\"freeplay-data\"");
  if (id == std::string::npos) return {nullptr, {}};
  const std::size_t from = text.find('>', id), until = text.find("</script>", id);
  if (from == std::string::npos || until == std::string::npos || until < from) return {nullptr, {}};
  const std::string_view inside = std::string_view(text).substr(from + 1, until - from - 1);
  return {json_of(std::string(field_text(inside, "provenance"))), std::string(field_text(inside, "runs"))};
}

}  // namespace freeplay
