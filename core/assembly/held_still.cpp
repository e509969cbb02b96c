#include "assembly/held_still.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "assembly/left_free.h"
#include "assembly/row_space.h"
#include "base/index.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

BodyId body_of(const Model& model, int marker) { return model.markers[at(marker)].body; }

/// Bodies that hang on those of a joint without ground between them.
std::vector<BodyId> joined_to(const JointElement& joint, const Model& model) {
  std::vector<BodyId> found;
  const auto reach = [&](BodyId body) {
    if (body == ground || std::ranges::count(found, body) > 0) return;
    found.push_back(body);
  };
  reach(body_of(model, joint.marker_a));
  reach(body_of(model, joint.marker_b));
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const JointElement& other : model.joints) {
      const BodyId a = body_of(model, other.marker_a), b = body_of(model, other.marker_b);
      if (a == found[i]) reach(b);
      if (b == found[i]) reach(a);
    }
  }
  return found;
}

/// Does anything turn the body?
bool is_acted_on(BodyId body, const Model& model) {
  if (has_velocity(model.bodies[at(body)])) return true;
  return std::ranges::any_of(model.forces,
                             [&](const AppliedForce& force) { return body_of(model, force.marker) == body; }) ||
         std::ranges::any_of(model.joints, [&](const JointElement& joint) {
           const bool on_it = body_of(model, joint.marker_a) == body || body_of(model, joint.marker_b) == body;
           return joint.gear < 0 && on_it && (is_force_element(joint) || joint.is_force || joint.start_speed);
         });
}

/// Does nothing move at all, but for spins of single bodies that nothing turns, though a joint between other bodies
/// would, alone, leave them a motion, as no weld does? `motions`: that the rows leave free.
bool stands_still(const System& system, const Eigen::MatrixXd& rows, Eigen::Index motions) {
  const Model& model = system.model();
  const int width = system.layout().body_velocities(), turns = model.space == Space::planar ? 1 : 3;
  std::vector<char> held(model.bodies.size() + 1, 1);  // ground last
  for (BodyId b = 0; b < static_cast<BodyId>(model.bodies.size()); ++b) {
    const Eigen::Index spins = null_space(rows.middleCols(width * b + width - turns, turns)).cols();
    if (spins == 0) continue;
    if (is_acted_on(b, model)) return false;
    motions -= spins;
    held[at(b)] = 0;
  }
  const auto place = [&](int marker) {
    const BodyId body = body_of(model, marker);
    return body == ground ? model.bodies.size() : at(body);
  };
  for (int j = 0; j < static_cast<int>(model.joints.size()) && motions == 0; ++j) {
    const JointElement& joint = model.joints[at(j)];
    const int own = static_cast<int>(system.layout().rows(j).size);
    const bool between_held = held[place(joint.marker_a)] != 0 && held[place(joint.marker_b)] != 0;
    if (joint.gear < 0 && own > 0 && own < width && between_held) return true;
  }
  return false;
}

}  // namespace

void doubt_held_still(
    const System& released, const Eigen::MatrixXd& open,
    const std::function<void(const char*, const std::string&, const std::string&, const Location&)>& doubt) {
  const Model& model = released.model();
  if (std::ranges::any_of(model.drivers, [](const Driver& driver) { return prescribes(driver.kind); })) return;
  const Eigen::MatrixXd free = null_space(open);
  if (model.drivers.empty()) {
    if (!stands_still(released, open, free.cols())) return;
    const Body& body = model.bodies.front();
    doubt("locked",
          "nothing can move: the joints leave the bodies no freedom; leave out what holds them twice, or give a joint "
          "the freedom that it lacks",
          body.name, body.location);
    return;
  }
  const int width = released.layout().body_velocities();
  const auto moves = [&](BodyId b) {
    return b != ground && free.cols() > 0 && free.middleRows(width * b, width).norm() > counts_as_motion;
  };
  for (const Driver& driver : model.drivers) {
    const JointElement& joint = model.joints[at(driver.joint)];
    if (moves(body_of(model, joint.marker_a)) || moves(body_of(model, joint.marker_b))) continue;
    if (std::ranges::any_of(joined_to(joint, model), moves)) {
      doubt("dead-point",
            fmt::format("driver '{}' starts joint '{}' at a dead point: it moves nothing until something else moves "
                        "the mechanism; start beside it",
                        driver.name, joint.name),
            driver.name, driver.location);
      continue;
    }
    doubt("locked",
          fmt::format("driver '{}' moves nothing: the joints let neither body of '{}' move; leave out what holds them "
                      "twice, or correct a length that closes a loop of no freedom",
                      driver.name, joint.name),
          driver.name, driver.location);
  }
}

}  // namespace freeplay
