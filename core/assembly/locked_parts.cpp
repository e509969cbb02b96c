#include "assembly/locked_parts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "assembly/closed_mechanism.h"
#include "assembly/continuation.h"
#include "assembly/dead_point.h"
#include "assembly/given_poses.h"
#include "assembly/left_free.h"
#include "assembly/row_space.h"
#include "base/disjoint_sets.h"
#include "base/index.h"
#include "base/text.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Steps from position to position, rad or of the size of the model; of the latter ones so many that a cam turns once.
constexpr double second_position = 0.05, further_position = 0.3;
constexpr int further_positions = 21;
constexpr double one_place = 1e-9;  // of the size of the model

constexpr BodyId no_body = -2;

/// Of two places on one body.
double distance(const Marker& here, const Marker& there) {
  return std::hypot(there.position[0] - here.position[0], there.position[1] - here.position[1],
                    there.position[2] - here.position[2]);
}

/// Bodies and ground that are fixed to each other.
class FixedGroups {
 public:
  explicit FixedGroups(const Model& model) : ground_(static_cast<int>(model.bodies.size())), sets_(ground_ + 1) {}
  void unite(BodyId a, BodyId b) { sets_.unite(place(a), place(b)); }
  bool together(BodyId a, BodyId b) { return sets_.together(place(a), place(b)); }

 private:
  int place(BodyId body) const { return body == ground ? ground_ : body; }
  int ground_;
  DisjointSets sets_;
};

class Stills {
 public:
  Stills(const System& system, const State& start) : mechanism_(system), model_(mechanism_.model()) {
    mechanism_.stand_at(system, start);
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const int row = mechanism_.system.layout().driver_row(d);
      if (row >= 0) mechanism_.held_row[at(row)] = 0;
    }
    mechanism_.converge();  // journals stood off in their bearings
  }

  /// With all joints of its loop.
  struct Locked {
    int guide = 0;
    std::vector<int> loop;
  };
  /// Two pins at one place of one body, whose other bodies pins between these keep from moving against each other.
  struct Folded {
    std::pair<int, int> pins;
    BodyId body = ground;
    std::vector<BodyId> as_one;
    std::vector<int> held_by;
  };
  struct Found {
    std::vector<Locked> guides;
    std::vector<BodyId> bodies;
    std::vector<Folded> folded;
    bool any() const { return !guides.empty() || !bodies.empty() || !folded.empty(); }
    void keep_those_of(const Found& other) {
      std::erase_if(
          guides, [&](const Locked& one) { return std::ranges::count(other.guides, one.guide, &Locked::guide) == 0; });
      std::erase_if(bodies, [&](BodyId one) { return std::ranges::count(other.bodies, one) == 0; });
      std::erase_if(folded,
                    [&](const Folded& one) { return std::ranges::count(other.folded, one.pins, &Folded::pins) == 0; });
    }
  };
  Found find() {
    Found found = here();
    if (motions_.cols() > 0) along_ = first_way();
    for (int k = 0; k <= further_positions && found.any() && motions_.cols() > 0; ++k) {
      if (!move_on(k == 0 ? second_position : further_position)) return k == 0 ? Found{} : found;
      found.keep_those_of(here());
    }
    return found;
  }
  bool moves() const { return motions_.cols() > 0; }

 private:
  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }
  bool is_guide(int j) const { return model_.joints[at(j)].ideal_layout().coordinate == Coordinate::position; }

  /// The row of a joint's coordinate in the columns of all bodies.
  VectorXd coordinate_row(int j) const {
    const JointElement& joint = model_.joints[at(j)];
    const int width = mechanism_.system.layout().body_velocities();
    double row[12] = {}, bias = 0.0;
    mechanism_.system.joints().coordinate_row(j, mechanism_.e, row, bias);
    VectorXd all = VectorXd::Zero(mechanism_.system.layout().nv());
    const BodyId bodies[2] = {body_of(joint.marker_a), body_of(joint.marker_b)};
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < width && bodies[k] != ground; ++c) all[width * bodies[k] + c] += row[width * k + c];
    }
    return all;
  }

  /// As drivers move the mechanism, so that a cam turns; without them by all motions at once.
  VectorXd first_way() const {
    VectorXd way = VectorXd::Zero(motions_.rows());
    for (const Driver& driver : model_.drivers) {
      const bool has_row = model_.joints[at(driver.joint)].gear < 0 &&
                           model_.joints[at(driver.joint)].ideal_layout().coordinate != Coordinate::none;
      if (has_row) way += motions_ * (motions_.transpose() * coordinate_row(driver.joint));
    }
    if (way.norm() > counts_as_motion) return way;
    for (Eigen::Index c = 0; c < motions_.cols(); ++c) {
      const double share = static_cast<double>(c + 1) * 0.6180339887498949;
      way += (0.5 + share - std::floor(share)) * motions_.col(c);
    }
    return way;
  }

  /// Joints with one freedom that no motion moves, and joints with none.
  bool stands_still(int j) const {
    const System& system = mechanism_.system;
    const JointElement& joint = model_.joints[at(j)];
    const int width = system.layout().body_velocities(), rows = system.layout().rows(j).size;
    if (is_force_element(joint) || joint.gear >= 0 || rows < width - 1) return false;
    if (rows == width || motions_.cols() == 0) return true;
    if (joint.ideal_layout().coordinate == Coordinate::none) return false;
    const VectorXd row = coordinate_row(j);
    return (motions_.transpose() * row).norm() <= counts_as_motion * row.norm();
  }

  Found here() {
    const ClosedMechanism::Rows rows = mechanism_.position_rows();
    const Eigen::Index columns = mechanism_.system.layout().nv();
    motions_ = rows.matrix.rows() > 0 ? null_space(MatrixXd(rows.matrix)) : MatrixXd::Identity(columns, columns);
    std::vector<int> still;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (stands_still(j)) still.push_back(j);
    }
    Found found{{}, still_bodies(), folded_links(still)};
    for (const int j : still) {
      if (!is_guide(j)) continue;
      FixedGroups without(model_);
      for (const int other : still) {
        if (other != j) without.unite(bodies_of(other).first, bodies_of(other).second);
      }
      const auto [a, b] = bodies_of(j);
      if (!without.together(a, b)) continue;
      Locked one{j, {}};
      for (const int other : still) {
        if (without.together(bodies_of(other).first, a) && without.together(bodies_of(other).second, a))
          one.loop.push_back(other);
      }
      found.guides.push_back(std::move(one));
    }
    return found;
  }

  std::pair<BodyId, BodyId> bodies_of(int j) const {
    return {body_of(model_.joints[at(j)].marker_a), body_of(model_.joints[at(j)].marker_b)};
  }

  /// Chains of moving bodies that pins which stand still make one, held at both ends by pins at one place.
  std::vector<Folded> folded_links(const std::vector<int>& still) const {
    std::vector<Folded> found;
    if (std::ranges::none_of(still, [&](int j) { return is_pin(j); })) return found;
    FixedGroups groups(model_);
    for (const int j : still) groups.unite(bodies_of(j).first, bodies_of(j).second);
    const int joints = static_cast<int>(model_.joints.size());
    for (int j = 0; j < joints; ++j) {
      for (int k = j + 1; k < joints && is_pin(j); ++k) {
        const BodyId body = shared_place(j, k);
        if (body == no_body || !is_pin(k)) continue;
        const BodyId a = other_body(j, body), b = other_body(k, body);
        if (a == b || groups.together(a, ground) || groups.together(a, body) || !groups.together(a, b)) continue;
        Folded one{{j, k}, body, {}, {}};
        for (BodyId member = 0; member < static_cast<BodyId>(model_.bodies.size()); ++member) {
          if (groups.together(member, a)) one.as_one.push_back(member);
        }
        std::ranges::copy_if(still, std::back_inserter(one.held_by),
                             [&](int held) { return is_pin(held) && groups.together(bodies_of(held).first, a); });
        found.push_back(std::move(one));
      }
    }
    return found;
  }

  bool is_pin(int j) const {
    const JointElement& joint = model_.joints[at(j)];
    return joint.gear < 0 && !is_force_element(joint) && joint.ideal_layout().coordinate == Coordinate::angle;
  }
  BodyId other_body(int j, BodyId body) const {
    const auto [a, b] = bodies_of(j);
    return a == body ? b : a;
  }
  /// The body on which both joints stand at one place, or no_body.
  BodyId shared_place(int j, int k) const {
    for (const int one : {model_.joints[at(j)].marker_a, model_.joints[at(j)].marker_b}) {
      for (const int two : {model_.joints[at(k)].marker_a, model_.joints[at(k)].marker_b}) {
        const Marker &here = model_.markers[at(one)], &there = model_.markers[at(two)];
        if (here.body == there.body && distance(here, there) <= one_place * mechanism_.system.size()) return here.body;
      }
    }
    return no_body;
  }

  /// Bodies that no motion moves, but for those that joints without a freedom fix to ground.
  std::vector<BodyId> still_bodies() const {
    const int width = mechanism_.system.layout().body_velocities();
    FixedGroups fixed(model_);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (mechanism_.system.layout().rows(j).size == width) fixed.unite(bodies_of(j).first, bodies_of(j).second);
    }
    std::vector<BodyId> found;
    for (BodyId b = 0; b < static_cast<BodyId>(model_.bodies.size()); ++b) {
      if (fixed.together(b, ground)) continue;
      if (motions_.cols() > 0 && motions_.middleRows(width * b, width).norm() <= counts_as_motion) found.push_back(b);
    }
    return found;
  }

  /// Along the motions at once, and from position to position in the same direction.
  bool move_on(double far) {
    const VectorXd ahead = motions_ * (motions_.transpose() * along_);
    const std::vector<double> q(mechanism_.state.q().begin(), mechanism_.state.q().end());
    std::vector<double> increment(at(static_cast<int>(ahead.size())));
    for (const double sign : {1.0, -1.0}) {
      double most = 0.0;
      for (int i = 0; i < static_cast<int>(increment.size()); ++i) {
        increment[at(i)] = ahead[i];
        const bool turn = mechanism_.system.coordinates().is_turn(i);
        most = std::max(most, std::abs(ahead[i]) / (turn ? 1.0 : mechanism_.system.size()));
      }
      if (!(most > 0.0)) return false;
      for (double& part : increment) part *= sign * far / most;
      mechanism_.system.coordinates().retract(q, increment, mechanism_.state.q());
      if (mechanism_.holds(mechanism_.converge())) {
        along_ = sign * ahead;
        return true;
      }
      std::ranges::copy(q, mechanism_.state.q().begin());
    }
    return false;
  }

  ClosedMechanism mechanism_;
  const Model& model_;
  MatrixXd motions_;
  VectorXd along_;
};

/// Does a driver or a start speed move the bodies that hang together with those of a joint other than by ground?
bool is_moved(const Model& model, const JointElement& joint) {
  const auto body_of = [&](int marker) { return model.markers[at(marker)].body; };
  DisjointSets groups(static_cast<int>(model.bodies.size()));
  for (const JointElement& other : model.joints) {
    const BodyId a = body_of(other.marker_a), b = body_of(other.marker_b);
    if (other.gear < 0 && !is_force_element(other) && a != ground && b != ground) groups.unite(a, b);
  }
  const auto ends = [&](const JointElement& one) { return std::pair(body_of(one.marker_a), body_of(one.marker_b)); };
  const auto together = [&](BodyId body) {
    const auto [a, b] = ends(joint);
    return body != ground && ((a != ground && groups.together(body, a)) || (b != ground && groups.together(body, b)));
  };
  const auto touches = [&](const JointElement& one) {
    return one.gear < 0 && (together(ends(one).first) || together(ends(one).second));
  };
  for (const Driver& driver : model.drivers) {
    if (touches(model.joints[at(driver.joint)])) return true;
  }
  for (const JointElement& one : model.joints) {
    if (one.start_speed && one.start_speed->value != 0.0 && touches(one)) return true;
  }
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (has_velocity(model.bodies[at(b)]) && together(b)) return true;
  }
  return false;
}

/// Joints, not springs or gears, that hold a body.
std::vector<int> joints_of(BodyId body, const Model& model) {
  std::vector<int> found;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[at(j)];
    if (is_force_element(joint) || joint.gear >= 0) continue;
    if (model.markers[at(joint.marker_a)].body == body || model.markers[at(joint.marker_b)].body == body)
      found.push_back(j);
  }
  return found;
}

/// A pin of the body that stands on a body that does move, at the very place of another of its pins.
bool stands_at_a_pivot(BodyId body, const std::vector<BodyId>& still, const System& system) {
  const Model& model = system.model();
  const auto is_pin = [](const JointElement& joint) { return joint.ideal_layout().coordinate == Coordinate::angle; };
  for (const int j : joints_of(body, model)) {
    const JointElement& joint = model.joints[at(j)];
    if (!is_pin(joint)) continue;
    for (const int marker : {joint.marker_a, joint.marker_b}) {
      const Marker& here = model.markers[at(marker)];
      if (here.body == ground || std::ranges::count(still, here.body) > 0) continue;
      for (const int other : joints_of(here.body, model)) {
        const JointElement& one = model.joints[at(other)];
        const Marker& a = model.markers[at(one.marker_a)];
        const Marker& there = a.body == here.body ? a : model.markers[at(one.marker_b)];
        if (other != j && is_pin(one) && distance(here, there) <= one_place * system.size()) return true;
      }
    }
  }
  return false;
}

bool is_far_off(BodyId body, const GivenPoses& given, std::span<const double> q, const System& system) {
  return given.shift(body, q) > GivenPoses::far_part * system.size() ||
         std::abs(given.turn(body, q)) > GivenPoses::far_turn;
}

/// Of bodies that cannot move: the first that is far from the pose that the file gives, else one with a loose joint, or
/// one that hangs on the pivot of what moves.
BodyId suspect(const std::vector<BodyId>& bodies, const GivenPoses& given, std::span<const double> q,
               const System& system) {
  const auto is_far = [&](BodyId b) { return is_far_off(b, given, q, system); };
  const auto is_loose = [&](BodyId b) {
    return std::ranges::any_of(joints_of(b, system.model()),
                               [&](int j) { return system.model().joints[at(j)].has_play; });
  };
  const auto on_pivot = [&](BodyId b) { return stands_at_a_pivot(b, bodies, system); };
  for (const std::function<bool(BodyId)>& wrong : {std::function<bool(BodyId)>(is_far), {is_loose}, {on_pivot}}) {
    const auto found = std::ranges::find_if(bodies, wrong);
    if (found != bodies.end()) return *found;
  }
  return ground;
}

void doubt_bodies(const System& system, std::span<const double> q, const std::vector<BodyId>& bodies,
                  Structure& structure) {
  const Model& model = system.model();
  const BodyId first = suspect(bodies, GivenPoses(system), q, system);
  if (first == ground || structure.doubts.size() >= Structure::most_doubts) return;
  std::vector<int> joints;
  std::vector<std::string> names;
  for (const BodyId b : bodies) {
    names.push_back(fmt::format("'{}'", model.bodies[at(b)].name));
    for (const int j : joints_of(b, model)) {
      if (std::ranges::count(joints, j) == 0) joints.push_back(j);
    }
  }
  const Body& body = model.bodies[at(first)];
  structure.doubts.push_back(
      {"locked",
       fmt::format(
           "{} {} cannot move, though the mechanism can: {} hold {}; check at which frames they stand, and their axes",
           names.size() == 1 ? "body" : "bodies", fmt::join(names, ", "), joint_names(joints, model),
           names.size() == 1 ? "it" : "them"),
       body.location, std::max(character_count(body.name), 1)});
}

/// Where a pin with play is among those that hold the bodies together, or one of these has not kept its given pose:
/// other ones may be a truss.
void doubt_folded(const System& system, std::span<const double> q, const Stills::Folded& one, Structure& structure) {
  const Model& model = system.model();
  const GivenPoses given(system);
  const bool is_loose = std::ranges::any_of(one.held_by, [&](int j) { return model.joints[at(j)].has_play; });
  const auto is_far = [&](BodyId b) { return is_far_off(b, given, q, system); };
  if ((!is_loose && std::ranges::none_of(one.as_one, is_far)) || structure.doubts.size() >= Structure::most_doubts)
    return;
  std::vector<std::string> names;
  for (const BodyId b : one.as_one) names.push_back(fmt::format("'{}'", model.bodies[at(b)].name));
  const JointElement &first = model.joints[at(one.pins.first)], &second = model.joints[at(one.pins.second)];
  structure.doubts.push_back(
      {"same-frame",
       fmt::format("joints '{}' and '{}' hold '{}' at one place, so that {} move as one body: is one of them meant at "
                   "another frame",
                   first.name, second.name, one.body == ground ? "ground" : model.bodies[at(one.body)].name,
                   fmt::join(names, ", ")),
       second.location, std::max(character_count(second.name.substr(second.name.rfind('.') + 1)), 1)});
}

}  // namespace

void doubt_locked(const System& system, const State& start, Structure& structure) {
  const Model& model = system.model();
  if (static_cast<int>(model.bodies.size()) * (model.space == Space::planar ? 3 : 6) > most_followed_velocities) return;
  Stills stills(system, start);
  Stills::Found found = stills.find();
  for (const Stills::Locked& one : found.guides) {
    const JointElement& guide = model.joints[at(one.guide)];
    if (!is_moved(model, guide) || structure.doubts.size() >= Structure::most_doubts) continue;
    for (const int j : one.loop) {
      for (const int marker : {model.joints[at(j)].marker_a, model.joints[at(j)].marker_b})
        std::erase(found.bodies, model.markers[at(marker)].body);
    }
    const std::string own = guide.name.substr(guide.name.rfind('.') + 1);
    std::vector<int> others = one.loop;
    std::erase(others, one.guide);
    structure.doubts.push_back(
        {"locked",
         fmt::format("joint '{}' cannot move: with {} it closes a loop in which nothing can{}; let it stand on another "
                     "body, or turn its axis",
                     guide.name, joint_names(others, model), stills.moves() ? "" : " (the mechanism has no freedom)"),
         guide.location, std::max(character_count(own), 1)});
  }
  doubt_bodies(system, start.q(), found.bodies, structure);
  for (const Stills::Folded& one : found.folded) doubt_folded(system, start.q(), one, structure);
}

}  // namespace freeplay
