#include "urdf/names.h"

#include <algorithm>
#include <unordered_set>

#include <fmt/format.h>

#include "base/text.h"
#include "format/name_rule.h"

namespace freeplay::urdf {

std::string model_name(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size();) {
    const char c = name[i];
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    out += plain ? c : '_';
    i += std::max<std::size_t>(1, character_bytes(name, i));
  }
  if (out.starts_with("x-")) out[1] = '_';
  return out;
}

std::string NameGiver::give(const std::string& name, const Spot& spot) {
  const std::string given = model_name(name);
  if (!given.empty() && !is_foreign_name(given)) {
    messages_.error(spot, "bad-name", fmt::format("'{}' is too long for the name of a {}", given, kind_), {},
                    "64 characters at most");
  }
  if (given != name)
    messages_.warning(spot, "urdf-renamed", fmt::format("the {} '{}' is called '{}' here", kind_, name, given));
  const auto [known, fresh] = lines_.emplace(given, spot.line);
  if (!fresh) {
    messages_.error(spot, "duplicate-name",
                    fmt::format("there is a {} '{}' already, from line {}", kind_, given, known->second));
  }
  return given;
}

std::string NameGiver::give_other(std::string name, const Spot& spot) {
  while (lines_.contains(name)) name += '_';
  lines_.emplace(name, spot.line);
  messages_.warning(spot, "urdf-renamed", fmt::format("a {} that is not ground is called '{}' here", kind_, name));
  return name;
}

Names::Names(const Robot& robot, Messages& messages)
    : links_("link", messages), joints_("joint", messages), messages_(messages) {
  std::unordered_set<std::string> known;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const Link& link = robot.links[i];
    const bool twice = !known.insert(link.name).second;
    links.push_back(twice ? model_name(link.name) : links_.give(link.name, link.spot));
    // Without mounts the robot has errors already; what is a body and what a mere frame is then not known.
    if (robot.mounts.empty()) continue;
    if (robot.mounts[i].body == static_cast<int>(i)) {
      if (links.back() == "ground") links.back() = links_.give_other("ground_", link.spot);
    } else {
      refuse_own_frame("link", links.back(), link.spot);
    }
  }
  known.clear();
  for (const Joint& joint : robot.joints) {
    const bool twice = !known.insert(joint.name).second;
    joints.push_back(twice ? model_name(joint.name) : joints_.give(joint.name, joint.spot));
    if (joint.type == JointType::floating) continue;
    const int child = joint.child.link;
    const bool carries_body =
        child >= 0 && !robot.mounts.empty() && robot.mounts[static_cast<std::size_t>(child)].body == child;
    if (joint.closes_loop || joint.moves() || carries_body) refuse_own_frame("joint", joints.back(), joint.spot);
  }
}

std::string Names::add_joint(const std::string& name, const Spot& spot) { return joints_.give(name, spot); }

std::string Names::fresh_frame(std::string name) const {
  while (std::ranges::find(links, name) != links.end() || std::ranges::find(joints, name) != joints.end()) name += '_';
  return name;
}

void Names::refuse_own_frame(const char* kind, const std::string& name, const Spot& spot) {
  if (name != "origin" && name != "com") return;
  messages_.error(
      spot, "reserved-name",
      fmt::format("the {} '{}' needs a frame of its name, but every body has its own frame '{}'", kind, name, name));
}

}  // namespace freeplay::urdf
