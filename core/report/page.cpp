#include "report/page.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>

#include "report/base64.h"
#include "report/compact.h"
#include "report/page_parts.h"

namespace freeplay {
namespace {

constexpr std::string_view mark = "<meta name=\"generator\" content=\"freeplay-report\">";

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

bool filled(const Json& json, const char* path) {
  const Json::json_pointer pointer(path);
  if (!json.contains(pointer)) return false;
  const Json& value = json[pointer];
  return value.is_string() ? !value.get_ref<const std::string&>().empty() : !value.empty();  // null is empty, too
}

bool any_play(const Json& run) {
  if (!filled(run, "/summary/joints")) return false;
  for (const auto& [name, joint] : run["summary"]["joints"].items()) {
    if (filled(joint, "/play")) return true;
  }
  return false;
}

bool any_energy(const Json& run) {
  if (filled(run, "/summary/energy")) return true;
  return std::ranges::any_of(run["channels"], [](const Json& channel) {
    return channel["name"].get_ref<const std::string&>().starts_with("energy.");
  });
}

/// Sections that are there only if some run has something for them.
bool has_section(std::string_view name, const Json& runs, bool pictures) {
  using Has = std::function<bool(const Json&)>;
  const auto field = [](const char* path) { return [path](const Json& run) { return filled(run, path); }; };
  static const std::map<std::string_view, Has> sections = {{"mechanism", field("/animation")},
                                                           {"orbits", field("/orbits")},
                                                           {"clearance", any_play},
                                                           {"bearing", field("/bearing")},
                                                           {"impacts", field("/events/rows")},
                                                           {"twin", field("/summary/twin")},
                                                           {"drivers", field("/summary/drivers")},
                                                           {"spectra", field("/spectra")},
                                                           {"energy", any_energy},
                                                           {"advice", any_play},
                                                           {"model", field("/model")}};
  if (name == "side") return runs.size() > 1;
  if (name == "pictures") return pictures;
  return std::ranges::any_of(runs, sections.at(name));
}

/// The text between `<!--[NAME]-->` and `<!--[/NAME]-->` stays where the section is there; the marks go.
std::string with_sections(std::string_view html, const Json& runs, bool pictures) {
  std::string out;
  for (;;) {
    const std::size_t begin = html.find("<!--[");
    out += html.substr(0, begin);
    if (begin == std::string_view::npos) return out;
    const std::size_t name_end = html.find("]-->\n", begin);
    const std::string name(html.substr(begin + 5, name_end - begin - 5)), close = "<!--[/" + name + "]-->\n";
    const std::size_t end = html.find(close, begin);
    if (has_section(name, runs, pictures)) out += html.substr(name_end + 5, end - name_end - 5);
    html.remove_prefix(end + close.size());
  }
}

}  // namespace

std::string page_json(const Json& json) {
  const std::string plain = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size());
  for (const char c : plain) c == '<' ? text += "\\u003c" : text += c;
  return text;
}

std::size_t page_frame_size() {
  const PageParts parts = page_parts();
  return parts.html.size() + compact(parts.style, style_syntax).size() + compact(parts.script, script_syntax).size() +
         parts.plot_style.size() + parts.plot_script.size();
}

std::string picture_element(const std::string& svg) {
  constexpr std::string_view begin = "<title>";
  const std::size_t from = svg.find(begin);
  std::string title;
  if (from != std::string::npos) title = svg.substr(from + begin.size(), svg.find('<', from + 1) - from - begin.size());
  for (std::size_t at = 0; (at = title.find('"', at)) != std::string::npos;) title.replace(at, 1, "&quot;");
  return "<figure><img alt=\"" + title + "\" src=\"data:image/svg+xml;base64," + base64(svg) + "\"></figure>\n";
}

std::string page_text(const std::string& title, const Json& runs, std::string_view data, const std::string& pictures) {
  const PageParts parts = page_parts();
  const std::string html = compact(with_sections(parts.html, runs, !pictures.empty()), html_syntax),
                    name = escaped(title);
  const std::string style = compact(parts.style, style_syntax), script = compact(parts.script, script_syntax);
  const std::map<std::string_view, std::string_view> fields = {{"title", name},
                                                               {"style", style},
                                                               {"plot_style", parts.plot_style},
                                                               {"plot_script", parts.plot_script},
                                                               {"script", script},
                                                               {"data", data},
                                                               {"pictures", pictures}};
  std::string out;
  out.reserve(largest_page);
  for (std::string_view rest = html;;) {
    const std::size_t begin = rest.find("{{"), end = rest.find("}}", begin);
    out += rest.substr(0, begin);
    if (begin == std::string_view::npos) return out;
    out += fields.at(rest.substr(begin + 2, end - begin - 2));
    rest.remove_prefix(end + 2);
  }
}

bool is_page(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(4096, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head.find(mark) != std::string::npos;
}

}  // namespace freeplay
