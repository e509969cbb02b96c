#include "urdf/referee.h"

#include <exception>
#include <set>
#include <string_view>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "base/text.h"

namespace freeplay::urdf {
namespace {

/// Takes what urdfdom says, which would go to stderr, for as long as it lives.
class Listener : public console_bridge::OutputHandler {
 public:
  Listener() { console_bridge::useOutputHandler(this); }
  ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

void append_escaped(std::string& out, const std::string& text) {
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\t':  // blanks, as XML reads attributes; urdfdom takes no others between numbers
      case '\n':
      case '\r':
        out += ' ';
        break;
      default:
        out += c;
    }
  }
}

bool is_name(const std::string& attribute) {
  return attribute == "name" || attribute == "link" || attribute == "joint" || attribute == "filename";
}

/// Without the blanks around it; urdfdom takes them around the numbers of a list, and around a single number none.
std::string trimmed(const std::string& text) {
  constexpr const char* blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

void append(std::string& out, const XmlElement& element) {
  out += "<" + element.name;
  for (const XmlAttribute& attribute : element.attributes) {
    out += " " + attribute.name + "=\"";
    append_escaped(out, is_name(attribute.name) ? attribute.value : trimmed(attribute.value));
    out += "\"";
  }
  out += ">";
  for (const XmlElement& child : element.children) append(out, child);
  out += "</" + element.name + ">";
}

bool is_judged(const XmlElement& element) {
  return element.name == "link" || element.name == "joint" || element.name == "material";
}

/// Start tag of the robot, `content`, end tag: plain text that no XML reader can trip over.
std::string robot_text(const XmlElement& root, const std::string& content) {
  std::string out = "<robot name=\"robot\"";
  if (const XmlAttribute* version = root.attribute("version")) {
    out += " version=\"";
    append_escaped(out, version->value);
    out += "\"";
  }
  return out + ">" + content + "</robot>";
}

std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string out;
  for (std::size_t at = text.find(from); at != std::string_view::npos; at = text.find(from)) {
    out.append(text.substr(0, at)).append(to);
    text.remove_prefix(at + from.size());
  }
  return out.append(text);
}

// urdfdom logs words of the file as formats of printf, where a '%' reads or writes memory that is not there.
constexpr std::string_view percent = "%", wide_percent = "\uFF05";

/// Why urdfdom refuses the text, or "".
std::string refusal(const std::string& text) {
  Listener listener;
  try {
    const bool taken = ::urdf::parseURDF(replaced(text, percent, wide_percent)) != nullptr;
    // A model can come back although an error was logged: part of it is then missing.
    if (taken && listener.first().empty()) return {};
  } catch (const std::exception& error) {
    if (listener.first().empty()) return replaced(error.what(), wide_percent, percent);
  }
  return listener.first().empty() ? "no reason given" : replaced(listener.first(), wide_percent, percent);
}

/// An element alone, with links for the ends of a joint and a link where there would be none.
std::string alone(const XmlElement& element) {
  std::string content;
  const auto add_link = [&](const std::string& name) {
    content += "<link name=\"";
    append_escaped(content, name);
    content += "\"/>";
  };
  if (element.name == "material") add_link("link");
  for (const char* side : {"parent", "child"}) {
    const XmlElement* end = element.name == "joint" ? element.child(side) : nullptr;
    const XmlAttribute* link = end == nullptr ? nullptr : end->attribute("link");
    if (link != nullptr) add_link(link->value);
  }
  append(content, element);
  return content;
}

/// The first element that is refused by itself, materials before those that may use them; null when there is none.
const XmlElement* find_culprit(const XmlElement& root, std::string& why) {
  constexpr std::size_t too_many = 2000;
  if (root.children.size() > too_many) return nullptr;
  std::string materials;
  for (const bool material : {true, false}) {
    for (const XmlElement& child : root.children) {
      if (!is_judged(child) || (child.name == "material") != material) continue;
      const std::string own = refusal(robot_text(root, (material ? "" : materials) + alone(child)));
      if (!own.empty()) {
        why = own;
        return &child;
      }
      if (material) append(materials, child);
    }
  }
  return nullptr;
}

}  // namespace

void ask_referee(const XmlElement& root, Messages& messages) {
  std::string all, why;
  std::set<std::string> children;
  const XmlElement* culprit = nullptr;
  for (const XmlElement& child : root.children) {
    if (!is_judged(child)) continue;
    const XmlElement* end = child.name == "joint" ? child.child("child") : nullptr;
    const XmlAttribute* link = end == nullptr ? nullptr : end->attribute("link");
    if (link == nullptr || children.insert(link->value).second) {
      append(all, child);
    } else if (culprit == nullptr) {
      // A second parent can make a ring of links, which urdfdom would never free again.
      why = refusal(robot_text(root, alone(child)));
      if (!why.empty()) culprit = &child;
    }
  }
  if (culprit == nullptr) {
    why = refusal(robot_text(root, all));
    if (why.empty()) return;
    std::string own = why;
    // What is refused of a robot with one bare link is the fault of its start tag.
    const XmlAttribute* version = root.attribute("version");
    const std::string of_tag = version == nullptr ? "" : refusal(robot_text(root, "<link name=\"link\"/>"));
    if (!of_tag.empty()) {
      messages.error(spot_of(*version), "bad-urdf",
                     fmt::format("urdfdom refuses the version of the robot: {}", printable(of_tag)));
      return;
    }
    culprit = find_culprit(root, own);
    why = own;
  }
  const XmlElement& blamed = culprit == nullptr ? root : *culprit;
  messages.error(name_spot(blamed), "bad-urdf",
                 fmt::format("urdfdom refuses this {}: {}", blamed.name, printable(why)));
}

}  // namespace freeplay::urdf
