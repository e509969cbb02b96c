#include "assembly/structure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

#include <Eigen/Core>
#include <fmt/format.h>

#include "assembly/doubled_loads.h"
#include "assembly/doubled_plays.h"
#include "assembly/force_doubts.h"
#include "assembly/held_still.h"
#include "assembly/idle_turns.h"
#include "assembly/left_free.h"
#include "assembly/play_bypass.h"
#include "assembly/play_gap.h"
#include "assembly/play_rows.h"
#include "assembly/row_space.h"
#include "assembly/short_links.h"
#include "assembly/start_overlap.h"
#include "assembly/weak_springs.h"
#include "base/disjoint_sets.h"
#include "base/index.h"
#include "base/text.h"
#include "component/joint_roles.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;

constexpr double coarse_accuracy = 0.5;     // by a clearance
constexpr double coarse_for_a_model = 0.1;  // by its size
constexpr double deep_start = 1.5;          // eccentricity of a journal, by its clearance
constexpr double deep_by_load = 2.0;        // likewise, where its load presses it into a soft bearing

class Examination {
 public:
  Examination(const System& released, const Evaluation& open, const State& start, const System& closed,
              const Evaluation& shut)
      : model_(released.model()), released_(released), closed_(closed), open_(open), start_(start), shut_(shut) {
    for (const JacobianBlock& block : closed.jacobian().blocks()) blocks_.emplace(block.row, &block);
  }

  Structure run(const std::optional<DeadStart>& dead, const std::optional<UnstableStart>& unstable) {
    if (dead) {
      const Driver& driver = model_.drivers[at(dead->driver)];
      doubt("dead-point", words(*dead, model_), driver.name, driver.location);
    }
    find_loose_ends();
    const auto doubt_element = [&](const char* id, const std::string& message, const JointElement& element) {
      doubt(id, message, element.name, element.location);
    };
    doubt_forces(released_, open_, doubt_element);
    doubt_doubled_loads(model_, [&](const char* id, const std::string& message, const AppliedForce& load) {
      doubt(id, message, load.name, load.location);
    });
    doubt_short_links(model_, doubt_element);
    doubt_overlaps(released_, start_, open_, doubt_element);
    doubt_doubled_plays(closed_, shut_, doubt_element);
    judge_accuracy();
    judge_journals();
    judge_pairs();
    judge_bypasses();
    judge_gears();
    if (closed_.layout().nv() > Structure::most_examined) return std::move(structure_);
    doubt_idle_turns(closed_, shut_, doubt_element);
    doubt_weak_springs(closed_, shut_, doubt_element);
    const MatrixXd open = constraint_matrix(released_.jacobian(), open_);
    judge_plays(open);
    find_undetermined(open);
    if (!dead) {
      doubt_held_still(released_, open,
                       [&](const char* id, const std::string& message, const std::string& name, const Location& place) {
                         doubt(id, message, name, place);
                       });
    }
    if (unstable) judge_balance(*unstable);
    if (!dead) find_left_free();
    return std::move(structure_);
  }

 private:
  bool doubt(const char* id, const std::string& message, const std::string& name, const Location& location) {
    if (structure_.doubts.size() >= Structure::most_doubts) return false;
    std::string own = name;
    if (is_part_of_entry(name, location)) own.erase(own.rfind('.'));
    own.erase(0, own.rfind('.') + 1);  // instances declare it without their name
    structure_.doubts.push_back({id, message, location, std::max(character_count(own), 1)});
    return true;
  }
  // Entries of several joints, as of the pins of a cross, name them by a word after their own.
  bool is_part_of_entry(std::string_view name, const Location& location) const {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos) return false;
    const std::string_view entry = name.substr(0, dot + 1);
    return std::ranges::any_of(model_.joints, [&](const JointElement& other) {
      return other.name != name && other.name.starts_with(entry) &&
             other.name.find('.', dot + 1) == std::string::npos &&
             std::tie(other.location.file, other.location.line, other.location.column) ==
                 std::tie(location.file, location.line, location.column);
    });
  }

  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }

  // --- what hangs on what ----------------------------------------------------------------------------------------

  /// Bodies that nothing ties to the others and on which nothing acts.
  void find_loose_ends() {
    const int bodies = static_cast<int>(model_.bodies.size());
    DisjointSets groups(bodies + 1);  // the last is ground
    const auto place = [&](BodyId body) { return body == ground ? bodies : body; };
    std::vector<char> acted(at(bodies + 1), 0);
    for (const JointElement& joint : model_.joints) {
      if (joint.gear >= 0) continue;
      const int a = place(body_of(joint.marker_a)), b = place(body_of(joint.marker_b));
      groups.unite(a, b);
      acted[at(a)] = acted[at(b)] = 1;
    }
    for (const AppliedForce& force : model_.forces) acted[at(place(body_of(force.marker)))] = 1;
    int held = 0;
    for (int i = 0; i < bodies; ++i) held += groups.together(i, bodies) ? 1 : 0;
    flies_ = held == 0;
    if (flies_ && bodies > 0 && falls_alone()) {
      doubt("not-connected",
            "no joint or force ties any body to ground, so that all of them fall: connect one, or give a velocity",
            model_.bodies[0].name, model_.bodies[0].location);
    }
    if (flies_) return;
    for (int i = 0; i < bodies; ++i) {
      const Body& body = model_.bodies[at(i)];
      if (acted[at(i)] || has_velocity(body)) continue;
      doubt("not-connected",
            fmt::format("no joint or force holds body '{}', which {}: connect it, or delete it", body.name,
                        body.gravity == Vector3{} ? "stays where it is" : "falls freely"),
            body.name, body.location);
    }
    std::vector<int> islands(at(bodies));
    for (int i = 0; i < bodies; ++i) islands[at(i)] = groups.together(i, bodies) ? -1 : groups.root(i);
    find_islands(std::move(islands));
  }

  bool falls_alone() const {
    const auto falls = [](const Body& body) { return body.gravity != Vector3{} && !has_velocity(body); };
    return model_.forces.empty() && model_.drivers.empty() && !is_robot() && std::ranges::all_of(model_.bodies, falls);
  }

  /// A robot file by itself, which cannot say what acts.
  bool is_robot() const { return model_.text.find('<') == model_.text.find_first_not_of(" \t\r\n"); }

  /// Bodies that hang together by joints alone, which nothing moves and nothing ties to ground. `island`: of each body;
  /// -1: none.
  void find_islands(std::vector<int> island) {
    const auto leave_out = [&](BodyId body) {
      if (body != ground) std::ranges::replace(island, island[at(body)], -1);
    };
    for (const AppliedForce& force : model_.forces) leave_out(body_of(force.marker));
    for (const JointElement& joint : model_.joints) {
      if (joint.gear < 0 && (is_force_element(joint) || joint.start_speed)) leave_out(body_of(joint.marker_a));
    }
    for (const Driver& driver : model_.drivers) leave_out(body_of(model_.joints[at(driver.joint)].marker_a));
    for (std::size_t i = 0; i < island.size(); ++i) {
      if (has_velocity(model_.bodies[i])) leave_out(static_cast<BodyId>(i));
    }
    std::map<int, std::vector<const Body*>> parts;
    for (std::size_t i = 0; i < island.size(); ++i) {
      if (island[i] >= 0) parts[island[i]].push_back(&model_.bodies[i]);
    }
    for (const auto& part : parts) {
      const std::vector<const Body*>& bodies = part.second;
      if (bodies.size() < 2) continue;
      for (const Body* body : bodies) islands_.insert(body->name);
      const bool falls = std::ranges::any_of(bodies, [](const Body* body) { return body->gravity != Vector3{}; });
      doubt("not-connected",
            fmt::format("no joint or force ties '{}' and '{}'{} to the others, which {}: connect them, or delete them",
                        bodies[0]->name, bodies[1]->name,
                        bodies.size() > 2 ? fmt::format(" and {} more", bodies.size() - 2) : "",
                        falls ? "fall freely" : "stay where they are"),
            bodies[0]->name, bodies[0]->location);
    }
  }

  bool accuracy_says_nothing() const { return model_.settings.accuracy > coarse_for_a_model * released_.size(); }

  /// An accuracy that a whole mechanism goes into.
  void judge_accuracy() {
    if (!accuracy_says_nothing()) return;
    Location place = model_.settings.accuracy_location;
    if (place.file.empty()) place.file = model_.file;  // of an option
    doubt("doubtful-value",
          fmt::format("the accuracy of {:.3g} m says nothing of a mechanism of {:.2g} m: ask for a thousandth of it or "
                      "less, and write its unit, as in '1 um'",
                      model_.settings.accuracy, released_.size()),
          "", place);
  }

  /// Journals that start in the wall of their bearings, and an accuracy that does not see them move.
  void judge_journals() {
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      const double play = joint.layout.clearance;
      if (!joint.has_play || !(play > 0.0)) continue;
      if (model_.settings.accuracy > coarse_accuracy * play && !accuracy_says_nothing()) {
        doubt("doubtful-value",
              fmt::format("the accuracy of {:.3g} m is coarse against the clearance of joint '{}', {:.3g} m: ask for a "
                          "tenth of it or less",
                          model_.settings.accuracy, joint.name, play),
              joint.name, joint.location);
      }
      const MarkerKinematics &a = open_.markers[at(joint.marker_a)], &b = open_.markers[at(joint.marker_b)];
      Eigen::Vector3d apart = play_gap(joint, model_.space, a, b);
      // The axis of a pin in space, z of the first marker, does not count.
      const bool slide = plays_between_walls(joint.layout);
      const bool pin = model_.space == Space::spatial && joint.ideal_layout().coordinate == Coordinate::angle;
      const Eigen::Vector3d axis(a.rotation[2], a.rotation[5], a.rotation[8]);
      if (pin) apart -= axis.dot(apart) * axis;
      const double eccentricity = apart.norm();
      const bool loaded = starts_by_its_load(joint);
      if (eccentricity <= (loaded ? deep_by_load : deep_start) * play) {
        if (!loaded) judge_depth(j);  // what its load does is judged by the run
        continue;
      }
      doubt("doubtful-clearance",
            fmt::format("the {} of joint '{}' starts {:.3g} m from the {}, {:.3g} m deep in its wall, as the clearance "
                        "is {:.3g} m: check {} and the clearance",
                        slide ? "slider" : "journal", joint.name, eccentricity,
                        slide ? "middle of its guide" : "centre of its bearing", eccentricity - play, play,
                        loaded ? "the load, the stiffness of the contact" : "'initial'"),
            joint.name, joint.location);
    }
  }

  /// The same of what stands in the middle: past the end of its slot, or tilted.
  void judge_depth(int j) {
    const JointElement& joint = model_.joints[at(j)];
    for (std::size_t channel = 0; channel < joint.layout.channels.size; ++channel) {
      if (channel_role(joint.layout, channel) != ChannelRole::penetration) continue;
      std::vector<double> values(joint.layout.channels.size, 0.0);
      Message message;
      const JointInput in = released_.joints().input(j, point(start_), open_);
      if (!joint.joint.observe(in, {}, {values.data(), values.size()}, message)) return;  // the run will say why
      const double depth = values[channel], play = joint.layout.clearance;
      if (!(depth > (deep_start - 1.0) * play)) return;
      doubt(
          "doubtful-clearance",
          fmt::format("joint '{}' starts {:.3g} m deep in its wall, as the clearance is {:.3g} m: check 'initial', the "
                      "poses of its bodies and the clearance",
                      joint.name, depth, play),
          joint.name, joint.location);
      return;
    }
  }

  /// The same two joints geared twice.
  void judge_gears() {
    for (std::size_t k = 1; k < model_.gears.size(); ++k) {
      for (std::size_t i = 0; i < k; ++i) {
        const Gear &one = model_.gears[i], &other = model_.gears[k];
        if (std::minmax(one.first, one.second) != std::minmax(other.first, other.second)) continue;
        const JointElement& joint = model_.joints[at(other.joint)];
        doubt(
            "duplicate-joint",
            fmt::format("gear '{}' couples the same two joints as '{}': how they share the torque is arbitrary; delete "
                        "one of them",
                        joint.name, model_.joints[at(one.joint)].name),
            joint.name, joint.location);
        break;
      }
    }
  }

  /// Rows of a joint of the closed mechanism in the columns of two bodies.
  MatrixXd rows_of(int joint, const std::pair<BodyId, BodyId>& bodies) const {
    const Slice slice = closed_.layout().rows(joint);
    const int width = closed_.layout().body_velocities();
    MatrixXd rows = MatrixXd::Zero(slice.size, 2 * width);
    for (auto [found, end] = blocks_.equal_range(slice.offset); found != end; ++found) {
      const JacobianBlock& block = *found->second;
      const int column = block.body == bodies.first ? 0 : width;
      for (int r = 0; r < block.rows; ++r) {
        for (int c = 0; c < width; ++c) rows(r, column + c) = shut_.jacobian[at(block.offset + r * width + c)];
      }
    }
    return rows;
  }

  void judge_pairs() {
    std::map<std::pair<BodyId, BodyId>, std::vector<int>> pairs;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (model_.joints[at(j)].has_play || model_.joints[at(j)].gear >= 0 || closed_.layout().rows(j).size == 0)
        continue;
      pairs[std::minmax(body_of(model_.joints[at(j)].marker_a), body_of(model_.joints[at(j)].marker_b))].push_back(j);
    }
    for (const auto& [bodies, joints] : pairs) {
      for (std::size_t k = 1; k < joints.size(); ++k) {
        for (std::size_t i = 0; i < k; ++i) {
          if (judge_pair(joints[i], joints[k], bodies)) break;
        }
      }
    }
  }

  /// True after a message.
  bool judge_pair(int first, int second, const std::pair<BodyId, BodyId>& bodies) {
    const MatrixXd a = rows_of(first, bodies), b = rows_of(second, bodies);
    const int both = rank_of(stacked(a, b)), rank_a = rank_of(a), rank_b = rank_of(b);
    const JointElement& one = model_.joints[at(first)];
    const JointElement& other = model_.joints[at(second)];
    if (both > rank_a && both > rank_b) return false;
    const JointElement& idle = both == rank_a ? other : one;
    const JointElement& holder = both == rank_a ? one : other;
    return doubt("duplicate-joint",
                 fmt::format("joint '{}' holds nothing that '{}' does not hold between the same two bodies: how they "
                             "share the force is arbitrary; delete one of them, or let it hold what it was meant for",
                             idle.name, holder.name),
                 idle.name, idle.location);
  }

  void judge_bypasses() {
    for (const PlayBypass& found : play_bypasses(closed_, shut_)) {
      const bool one = found.by.size() == 1;
      const char* much = found.whole             ? "without play"
                         : found.directions == 1 ? "without play in one of its directions"
                                                 : "without play in some of its directions";
      bypass(found.joint,
             fmt::format("{}, which hold{} {} {}", joint_names(found.by, model_), one ? "s" : "",
                         found.direct ? "the same two bodies" : "what is fixed to the same two bodies", much),
             !one          ? "delete one of them, or give all of them clearance"
             : found.whole ? "delete one of the two joints, or give both clearance"
                           : "delete one of the two joints");
    }
  }

  void bypass(int joint, const std::string& by, const std::string& remedy) {
    bypassed_.push_back(joint);
    const JointElement& loose = model_.joints[at(joint)];
    doubt("play-bypassed", fmt::format("the play of joint '{}' is bypassed by {}: {}", loose.name, by, remedy),
          loose.name, loose.location);
  }

  // --- the whole mechanism ---------------------------------------------------------------------------------------

  /// A play in which no motion of the running model can move its pin.
  void judge_plays(const MatrixXd& open) {
    if (model_.clearance_joints() == 0) return;
    const MatrixXd free = null_space(open);
    const MatrixXd shut = constraint_matrix(closed_.jacobian(), shut_);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (!model_.joints[at(j)].has_play || std::ranges::count(bypassed_, j) > 0) continue;
      const Slice slice = closed_.layout().rows(j);
      const MatrixXd rows = shut.middleRows(slice.offset, slice.size);
      if (slice.size == 0 || (rows * free).norm() > counts_as_motion * rows.norm()) continue;
      bypass(j, "the other joints and drivers, which let it move nowhere",
             "it stays where it starts; give clearance to another joint of its loop, or leave out a constraint");
    }
  }

  /// Joints that take part in a state of stress without load.
  void find_undetermined(const MatrixXd& open) {
    const MatrixXd stresses = null_space(open.transpose());
    if (stresses.cols() == 0) return;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const Slice slice = released_.layout().rows(j);
      if (slice.size > 0 && stresses.middleRows(slice.offset, slice.size).norm() > counts_as_motion) {
        structure_.undetermined.push_back(model_.joints[at(j)].name);
      }
    }
  }

  /// A start from which rounding decides where the mechanism goes, if it goes. A dead point has said so already.
  void judge_balance(const UnstableStart& unstable) {
    const auto same = [](const StructureDoubt& doubt) { return doubt.id == std::string_view("dead-point"); };
    if (std::ranges::any_of(structure_.doubts, same)) return;
    const Body& body = model_.bodies[at(unstable.body)];
    doubt("unstable-start", fmt::format("'{}' {}", body.name, words_of(unstable)), body.name, body.location);
  }

  void find_left_free() {
    if (model_.drivers.empty()) return;
    const LeftFree found = left_free(closed_, shut_);
    structure_.free_motions = found.motions;
    for (const BodyId b : found.bodies) structure_.left_free.push_back(model_.bodies[at(b)].name);
    if (found.doubt.empty() || flies_) return;
    const auto said = [&](const std::string& name) { return islands_.contains(name); };
    if (!structure_.left_free.empty() && std::ranges::all_of(structure_.left_free, said)) return;
    const Body& first = model_.bodies[at(found.doubtful)];
    doubt("left-free", found.doubt, first.name, first.location);
  }

  const Model& model_;
  const System& released_;
  const System& closed_;
  const Evaluation& open_;
  const State& start_;
  const Evaluation& shut_;
  std::multimap<int, const JacobianBlock*> blocks_;  // of the closed system, by their first row
  std::vector<int> bypassed_;
  std::set<std::string> islands_{};  // bodies that nothing ties to the others
  bool flies_ = false;               // as a whole: nothing ties it to ground
  Structure structure_;
};

}  // namespace

Structure examine_structure(const System& released, const Evaluation& at_start, const State& start,
                            const System& closed, const Evaluation& closed_at_start,
                            const std::optional<DeadStart>& dead, const std::optional<UnstableStart>& unstable) {
  return Examination(released, at_start, start, closed, closed_at_start).run(dead, unstable);
}

}  // namespace freeplay
