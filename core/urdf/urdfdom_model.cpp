#include "urdf/urdfdom_model.h"

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <string_view>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "base/program_lock.h"
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

bool is_name(std::string_view attribute) {
  return attribute == "name" || attribute == "link" || attribute == "joint" || attribute == "filename";
}

// urdfdom logs words of the file as formats of printf, where a '%' reads or writes memory that is not there. XML knows
// no control characters, so that one can stand for it.
constexpr char percent = '%', masked_percent = '\x01';

std::string unmasked(std::string text) {
  std::ranges::replace(text, masked_percent, percent);
  return text;
}

void unmask(::urdf::Joint& joint) {
  for (std::string* name : {&joint.name, &joint.parent_link_name, &joint.child_link_name}) *name = unmasked(*name);
  if (joint.mimic != nullptr) joint.mimic->joint_name = unmasked(joint.mimic->joint_name);
}

/// As XML reads attributes: every blank is a space; urdfdom takes no others between numbers, and around a single number
/// none.
std::string value_of(const XmlAttribute& attribute) {
  constexpr const char* blanks = " \t\r\n";
  std::string text = attribute.Value();
  if (!is_name(attribute.Name())) {
    const std::size_t begin = text.find_first_not_of(blanks);
    text = begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
  }
  std::ranges::replace_if(
      text, [](char c) { return c == '\t' || c == '\r' || c == '\n'; }, ' ');
  std::ranges::replace(text, percent, masked_percent);
  return text;
}

std::string value_of(const XmlElement* element, const char* name) {
  const XmlAttribute* attribute = element == nullptr ? nullptr : element->FindAttribute(name);
  return attribute == nullptr ? "" : value_of(*attribute);
}

std::string end_of(const XmlElement& joint, const char* side) {
  return value_of(joint.FirstChildElement(side), "link");
}

/// The text of a robot that urdfdom is to read.
class RobotText {
 public:
  explicit RobotText(const XmlAttribute* version = nullptr) : printer_(nullptr, true) {
    open("robot", "robot");
    if (version != nullptr) printer_.PushAttribute("version", value_of(*version).c_str());
  }

  void open(const char* element, const std::string& name) {
    printer_.OpenElement(element, true);
    printer_.PushAttribute("name", name.c_str());
  }
  void close() { printer_.CloseElement(true); }
  void link(const std::string& name) {
    open("link", name);
    close();
  }
  void end(const char* side, const char* link) {
    printer_.OpenElement(side, true);
    printer_.PushAttribute("link", link);
    close();
  }
  void no_limit() {
    printer_.OpenElement("limit", true);
    for (const char* key : {"effort", "velocity"}) printer_.PushAttribute(key, "0");
    close();
  }
  void attribute(const char* name, const std::string& value) { printer_.PushAttribute(name, value.c_str()); }

  /// Without text and comments.
  void element(const XmlElement& source) {
    printer_.OpenElement(source.Name(), true);
    for (const XmlAttribute* at = source.FirstAttribute(); at != nullptr; at = at->Next()) {
      attribute(at->Name(), value_of(*at));
    }
    for (const XmlElement* at = source.FirstChildElement(); at != nullptr; at = at->NextSiblingElement()) element(*at);
    close();
  }
  bool child(const XmlElement& source, const char* name) {
    const XmlElement* found = source.FirstChildElement(name);
    if (found != nullptr) element(*found);
    return found != nullptr;
  }

  /// To be asked for once, at the end.
  const char* text() {
    close();
    return printer_.CStr();
  }

 private:
  tinyxml2::XMLPrinter printer_;
};

struct Answer {
  ::urdf::ModelInterfaceSharedPtr model;  ///< null where it is refused
  std::string refusal;
};

Answer ask(RobotText& robot) {
  const std::lock_guard lock(ProgramLock<Listener>::get());  // who listens to urdfdom is the program's
  Listener listener;
  std::string why = "no reason given";
  try {
    // A model can come back although an error was logged: part of it is then missing.
    auto model = ::urdf::parseURDF(robot.text());
    if (model != nullptr && listener.first().empty()) return {std::move(model), ""};
  } catch (const std::exception& error) {
    why = error.what();
  }
  return {nullptr, unmasked(listener.first().empty() ? why : listener.first())};
}

bool is_judged(const XmlElement& element) {
  return is(element, "link") || is(element, "joint") || is(element, "material");
}

/// An element alone, with links for the ends of a joint and a link where there would be none.
void write_alone(RobotText& robot, const XmlElement& element) {
  if (is(element, "material")) robot.link("link");
  for (const char* side : {"parent", "child"}) {
    const XmlElement* end = is(element, "joint") ? element.FirstChildElement(side) : nullptr;
    if (end != nullptr && end->FindAttribute("link") != nullptr) robot.link(value_of(end, "link"));
  }
  robot.element(element);
}

/// Urdfdom never frees links that hang on each other in a ring. `parents`: of links by their names.
bool has_ring(const std::map<std::string, std::string>& parents) {
  std::map<std::string, const std::string*> seen;  // links, and from which the way up that met them began
  for (const auto& [start, parent] : parents) {
    for (auto at = parents.find(start); at != parents.end(); at = parents.find(at->second)) {
      const auto [known, fresh] = seen.emplace(at->first, &start);
      if (fresh) continue;
      if (known->second == &start) return true;
      break;
    }
  }
  return false;
}

/// The first element that is refused by itself, materials before those that may use them; null when there is none.
const XmlElement* find_culprit(const XmlElement& root, std::string& why) {
  constexpr int too_many = 2000;
  int children = 0;
  for (const XmlElement* child = root.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (++children > too_many) return nullptr;
  }
  std::vector<const XmlElement*> materials;
  for (const bool material : {true, false}) {
    for (const XmlElement* child = root.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
      if (!is_judged(*child) || is(*child, "material") != material) continue;
      RobotText robot(root.FindAttribute("version"));
      if (!material) {
        for (const XmlElement* one : materials) robot.element(*one);
      }
      write_alone(robot, *child);
      const std::string own = ask(robot).refusal;
      if (!own.empty()) {
        why = own;
        return child;
      }
      if (material) materials.push_back(child);
    }
  }
  return nullptr;
}

void report(const XmlElement& blamed, const std::string& why, Messages& messages) {
  messages.error(name_spot(blamed), "bad-urdf",
                 fmt::format("urdfdom refuses this {}: {}", blamed.Name(), printable(why)));
}

}  // namespace

UrdfdomModel::UrdfdomModel(const XmlElement& root) : root_(root) {
  RobotText robot(root.FindAttribute("version"));
  std::map<std::string, std::string> parents;
  for (const XmlElement* child = root.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (!is_judged(*child)) continue;
    const XmlElement* end = is(*child, "joint") ? child->FirstChildElement("child") : nullptr;
    const bool names_child = end != nullptr && end->FindAttribute("link") != nullptr;
    if (names_child && !parents.emplace(value_of(end, "link"), end_of(*child, "parent")).second) {
      second_parents_.insert(child);
    } else {
      robot.element(*child);
    }
  }
  if (has_ring(parents)) return;  // an error that is reported elsewhere
  Answer answer = ask(robot);
  whole_ = std::move(answer.model);
  if (whole_ != nullptr) {
    for (auto& [key, link] : whole_->links_) link->name = unmasked(link->name);
    for (auto& [key, joint] : whole_->joints_) unmask(*joint);
  }
  refusal_ = std::move(answer.refusal);
}

bool UrdfdomModel::may_ask_again() {
  constexpr std::size_t too_many = 20'000;
  return whole_ != nullptr || ++asked_again_ <= too_many;
}

::urdf::LinkConstSharedPtr UrdfdomModel::link(const XmlElement& element, bool has_mistakes) {
  if (whole_ != nullptr && !has_mistakes) return whole_->getLink(value_of(&element, "name"));
  ::urdf::LinkSharedPtr link;
  if (may_ask_again()) {
    RobotText robot;
    robot.open("link", "link");
    robot.child(element, "inertial");
    robot.close();
    if (const auto model = ask(robot).model) model->getLink("link", link);
  }
  if (link == nullptr) link = std::make_shared<::urdf::Link>();
  link->name = unmasked(value_of(&element, "name"));
  return link;
}

::urdf::JointConstSharedPtr UrdfdomModel::joint(const XmlElement& element, bool has_mistakes) {
  const bool in_whole = whole_ != nullptr && !second_parents_.contains(&element);
  if (in_whole && !has_mistakes) return whole_->getJoint(value_of(&element, "name"));
  ::urdf::JointSharedPtr joint;
  if (may_ask_again()) {
    RobotText robot;
    robot.link("parent");
    robot.link("child");
    robot.open("joint", "joint");
    const std::string type = value_of(&element, "type");
    constexpr const char* types[] = {"revolute", "continuous", "prismatic", "floating", "planar"};
    robot.attribute("type", std::ranges::find(types, type) == std::end(types) ? "fixed" : type);
    robot.end("parent", "parent");
    robot.end("child", "child");
    for (const char* name : {"origin", "axis", "dynamics", "mimic"}) robot.child(element, name);
    if (!robot.child(element, "limit")) {
      robot.no_limit();  // where one is missing, which is an error by then, the rest of the joint is wanted even so
    }
    robot.close();
    if (const auto model = ask(robot).model) joint = model->joints_.at("joint");
  }
  if (joint == nullptr) joint = std::make_shared<::urdf::Joint>();
  joint->name = value_of(&element, "name");
  joint->parent_link_name = end_of(element, "parent");
  joint->child_link_name = end_of(element, "child");
  unmask(*joint);
  return joint;
}

void UrdfdomModel::report_refusal(Messages& messages) const {
  for (const XmlElement* joint = root_.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    if (!second_parents_.contains(joint)) continue;
    RobotText robot(root_.FindAttribute("version"));
    write_alone(robot, *joint);
    const std::string why = ask(robot).refusal;
    if (!why.empty()) return report(*joint, why, messages);
  }
  if (whole_ != nullptr) return;
  // What is refused of a robot with one bare link is the fault of its start tag.
  if (const XmlAttribute* version = root_.FindAttribute("version")) {
    RobotText robot(version);
    robot.link("link");
    const std::string why = ask(robot).refusal;
    if (!why.empty()) {
      messages.error(spot_of(root_, *version), "bad-urdf",
                     fmt::format("urdfdom refuses the version of the robot: {}", printable(why)));
      return;
    }
  }
  std::string why = refusal_;
  const XmlElement* culprit = find_culprit(root_, why);
  report(culprit == nullptr ? root_ : *culprit, why, messages);
}

}  // namespace freeplay::urdf
