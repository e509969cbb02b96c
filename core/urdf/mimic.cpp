#include "urdf/mimic.h"

#include <unordered_map>

#include <fmt/format.h>

namespace freeplay::urdf {
namespace {

class MimicResolver {
 public:
  MimicResolver(Robot& robot, Messages& messages) : robot_(robot), messages_(messages) {}

  void resolve() {
    std::unordered_map<std::string, int> index;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      index.emplace(robot_.joints[i].name, static_cast<int>(i));
      names.push_back(robot_.joints[i].name);
    }
    for (Joint& joint : robot_.joints) {
      if (joint.mimic) find_leader(joint, index, names);
    }
    report_cycles();
  }

 private:
  void find_leader(Joint& joint, const std::unordered_map<std::string, int>& index,
                   const std::vector<std::string>& names) {
    Mimic& mimic = *joint.mimic;
    const auto has_coordinate = [](const Joint& j) {
      return j.type == JointType::revolute || j.type == JointType::prismatic;
    };
    const auto found = index.find(mimic.joint);
    if (found == index.end()) {
      messages_.error(mimic.spot, "bad-urdf",
                      fmt::format("joint '{}' is to mimic '{}', an unknown joint", joint.name, mimic.joint),
                      messages_.suggest(mimic.joint, names));
      return;
    }
    mimic.index = found->second;
    for (const Joint* one : {&joint, &robot_.joints[static_cast<std::size_t>(mimic.index)]}) {
      if (has_coordinate(*one)) continue;
      messages_.error(mimic.spot, "bad-urdf",
                      fmt::format("mimic needs joints with a coordinate; '{}' has none", one->name));
    }
  }

  /// Reports every joint of a cycle of followers; each joint is passed once.
  void report_cycles() {
    std::vector<int> round(robot_.joints.size(), 0);
    const auto leader = [&](int joint) {
      const auto& mimic = robot_.joints[static_cast<std::size_t>(joint)].mimic;
      return mimic ? mimic->index : -1;
    };
    for (int start = 0; start < static_cast<int>(robot_.joints.size()); ++start) {
      int at = start;
      while (at >= 0 && round[static_cast<std::size_t>(at)] == 0) {
        round[static_cast<std::size_t>(at)] = start + 1;
        at = leader(at);
      }
      if (at < 0 || round[static_cast<std::size_t>(at)] != start + 1) continue;
      const bool alone = leader(at) == at;
      for (int member = at;;) {
        const Joint& joint = robot_.joints[static_cast<std::size_t>(member)];
        messages_.error(joint.mimic->spot, "bad-urdf",
                        fmt::format("mimic: joint '{}' follows itself{}", joint.name, alone ? "" : " in a cycle"));
        member = leader(member);
        if (member == at) break;
      }
    }
  }

  Robot& robot_;
  Messages& messages_;
};

}  // namespace

void resolve_mimics(Robot& robot, Messages& messages) { MimicResolver(robot, messages).resolve(); }

}  // namespace freeplay::urdf
