#include "urdf/tree.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay::urdf {
namespace {

class TreeBuilder {
 public:
  TreeBuilder(Robot& robot, const Options& options, Messages& messages)
      : robot_(robot), options_(options), messages_(messages) {}

  void build() {
    robot_.parent_joint.assign(robot_.links.size(), -1);
    find_parents();
    if (robot_.ambiguous) return;
    order_links();
    report_cycles();
    // A second root or parent hides no mistake that is found further on; what hangs on a cycle hangs nowhere.
    if (has_cycle_) return;
    for (const int link : robot_.order) mount(link);
  }

 private:
  const Joint& joint(int index) const { return robot_.joints[at(index)]; }
  const Link& link(int index) const { return robot_.links[at(index)]; }

  void find_parents() {
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      Joint& candidate = robot_.joints[i];
      if (candidate.closes_loop || candidate.child.link == no_link || candidate.parent.link == no_link) continue;
      int& parent = robot_.parent_joint[at(candidate.child.link)];
      if (parent < 0) {
        parent = static_cast<int>(i);
      } else if (options_.two_parents) {
        candidate.closes_loop = true;
      } else {
        messages_.error(candidate.child.spot, "bad-urdf",
                        fmt::format("link '{}' has two parents: it is the child of '{}' (line {}) already",
                                    link(candidate.child.link).name, joint(parent).name, joint(parent).spot.line),
                        {}, "if this joint is to close a loop, say 'loops: two-parents' in a side-car");
      }
    }
  }

  void order_links() {
    std::vector<std::vector<int>> children(robot_.links.size());
    std::vector<int> roots;
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      const int parent = robot_.parent_joint[i];
      (parent < 0 ? roots : children[at(joint(parent).parent.link)]).push_back(static_cast<int>(i));
    }
    reached_.assign(robot_.links.size(), false);
    for (const int root : roots) {
      if (robot_.root == no_link) {
        robot_.root = root;
      } else {
        messages_.error(link(root).spot, "bad-urdf",
                        fmt::format("link '{}' is a second root: no joint connects it with '{}'", link(root).name,
                                    link(robot_.root).name));
      }
      std::vector<int> open = {root};
      while (!open.empty()) {
        const int next = open.back();
        open.pop_back();
        reached_[at(next)] = true;
        robot_.order.push_back(next);
        open.insert(open.end(), children[at(next)].rbegin(), children[at(next)].rend());
      }
    }
  }

  /// What no root reaches hangs on a cycle.
  void report_cycles() {
    std::vector<int> mark(robot_.links.size(), 0);
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      if (reached_[i] || mark[i] != 0) continue;
      const int round = static_cast<int>(i) + 1;
      int here = static_cast<int>(i);
      while (mark[at(here)] == 0) {
        mark[at(here)] = round;
        here = joint(robot_.parent_joint[at(here)]).parent.link;
      }
      if (mark[at(here)] == round) report_cycle(here);
    }
  }

  void report_cycle(int start) {
    has_cycle_ = true;
    std::vector<int> joints;
    for (int here = start; joints.empty() || here != start; here = joint(joints.back()).parent.link) {
      joints.push_back(robot_.parent_joint[at(here)]);
    }
    std::ranges::sort(joints);
    std::string names;
    constexpr std::size_t most = 8;
    for (std::size_t i = 0; i < std::min(joints.size(), most); ++i) {
      names += fmt::format("{}'{}'", i == 0 ? "" : ", ", joint(joints[i]).name);
    }
    if (joints.size() > most) names += fmt::format(" and {} more", joints.size() - most);
    messages_.error(joint(joints.front()).spot, "bad-urdf",
                    fmt::format("the joints {} form a cycle without a root", names));
  }

  // --- bodies ----------------------------------------------------------------------------------------------------

  void mount(int index) {
    if (robot_.mounts.empty()) robot_.mounts.resize(robot_.links.size());
    const Link& here = link(index);
    Mount& mount = robot_.mounts[at(index)];
    const bool names_ground = here.name == "world" || here.name == "ground";
    if (robot_.parent_joint[at(index)] < 0) {
      if (!names_ground && here.has_mass()) mount.body = index;
      if (names_ground && here.has_mass()) messages_.ignore("mass of ground, link", here.name);
      note_massless(here);
      if (options_.floating_base && index == robot_.root && mount.body != index) {
        messages_.warning(here.spot, "urdf-ignored",
                          fmt::format("the robot does not float: its root link '{}' {}", here.name,
                                      names_ground ? "is ground" : "has no mass and is a part of ground"),
                          "'base: floating' needs a root link with mass that is not named 'world' or 'ground'");
      }
      return;
    }
    const Joint& parent = joint(robot_.parent_joint[at(index)]);
    if (!parent.moves() && (!here.has_mass() || options_.merge_fixed)) {
      const Mount& carrier = robot_.mounts[at(parent.parent.link)];
      mount = {carrier.body, carrier.pose * parent.child_pose()};
      if (here.has_mass() && mount.body == world_link) messages_.ignore("mass of ground, link", here.name);
      note_massless(here);
      return;
    }
    mount.body = index;
    if (here.has_mass()) return;
    messages_.error(here.spot, "urdf-massless",
                    fmt::format("link '{}' has no mass, but joint '{}' moves it", here.name, parent.name), {},
                    "a body needs mass; only on a fixed joint a link without mass is a mere frame");
  }

  /// What a link says of its inertia counts for nothing without mass.
  void note_massless(const Link& link) {
    if (!link.has_inertial || link.has_mass()) return;
    if (!link.inertia.isZero(0.0)) messages_.ignore("inertia without mass of link", link.name);
    if (!link.inertial.translation().isZero(0.0)) messages_.ignore("centre of mass without mass of link", link.name);
  }

  Robot& robot_;
  const Options& options_;
  Messages& messages_;
  std::vector<bool> reached_;
  bool has_cycle_ = false;
};

}  // namespace

void build_tree(Robot& robot, const Options& options, Messages& messages) {
  TreeBuilder(robot, options, messages).build();
}

}  // namespace freeplay::urdf
