#include "analysis/ideal_mechanism.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "analysis/posture.h"
#include "analysis/regular_start.h"
#include "assembly/assembly.h"
#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {

bool is_input(const Platform& platform, int joint) {
  return std::ranges::find(platform.inputs, joint) != platform.inputs.end();
}

/// Of an inverse-kinematics entry all drivers go when one of its joints is an input: they move together.
std::vector<char> drivers_that_stay(const Model& model, const Platform& platform) {
  std::vector<char> stays(model.drivers.size(), 1);
  for (std::size_t d = 0; d < stays.size(); ++d) {
    if (!is_input(platform, model.drivers[d].joint)) continue;
    stays[d] = 0;
    const int kinematics = model.drivers[d].kinematics;
    for (std::size_t other = 0; kinematics >= 0 && other < stays.size(); ++other) {
      if (model.drivers[other].kinematics == kinematics) stays[other] = 0;
    }
  }
  return stays;
}

/// Joints and laws stay owned by the original.
[[gnu::cold]] std::unique_ptr<Model> without_inputs(const Model& model, const Platform& platform) {
  auto out = std::make_unique<Model>();
  out->file = model.file;
  out->name = model.name;
  out->space = model.space;
  out->gravity = model.gravity;
  out->bodies = model.bodies;
  out->markers = model.markers;
  out->joints = model.joints;
  out->gears = model.gears;
  out->forces = model.forces;
  out->force_elements = model.force_elements;
  out->own_gravities = model.own_gravities;
  out->settings = model.settings;
  out->analysis = model.analysis;
  const std::vector<char> stays = drivers_that_stay(model, platform);
  std::map<int, int> entries;  // old number to new
  for (std::size_t d = 0; d < stays.size(); ++d) {
    if (!stays[d]) continue;
    Driver driver = model.drivers[d];
    if (driver.kinematics >= 0) {
      const auto [place, fresh] = entries.emplace(driver.kinematics, static_cast<int>(out->kinematics.size()));
      if (fresh) {
        out->kinematics.push_back(model.kinematics[at(driver.kinematics)]);
        out->kinematics.back().first_driver = static_cast<int>(out->drivers.size());
      }
      driver.kinematics = place->second;
    }
    out->drivers.push_back(std::move(driver));
  }
  return out;
}

/// What the file says of a joint; NaN where it does not.
double parameter(const JointElement& joint, const char* name) {
  if (!joint.has_play || joint.parameters == nullptr) return std::numeric_limits<double>::quiet_NaN();
  const auto found = joint.parameters->values.find(name);
  return found != joint.parameters->values.end() ? found->second.number : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

IdealMechanism::IdealMechanism(const Model& model, Platform platform)
    : original_(model),
      platform_(std::move(platform)),
      model_(without_inputs(model, platform_)),
      system_(std::make_unique<System>(*model_, Variant::closed)),
      body_(model_->markers[at(platform_.marker)].body) {
  find_plays();
  find_parts();
  find_legs();
  find_lengths();
  const bool gears_keep_start = std::ranges::any_of(model_->gears, [](const Gear& gear) { return !gear.offset; });
  closed_form_ = !gears_keep_start && model_->drivers.empty() &&
                 std::ranges::all_of(parts_, [](const Limb& part) { return part.leg.has_value(); });
  if (!closed_form_) assemble_start();
}

bool IdealMechanism::is_angle(int input) const {
  return model_->joints[at(platform_.inputs[at(input)])].ideal_layout().coordinate == Coordinate::angle;
}

void IdealMechanism::find_plays() {
  for (int j = 0; j < static_cast<int>(model_->joints.size()); ++j) {
    const JointElement& joint = model_->joints[at(j)];
    double radius = joint.has_play ? joint.layout.clearance : 0.0;
    for (const auto& [named, given] : model_->analysis.clearance) {
      if (named == j) radius = given;
    }
    if (radius > 0.0 && joint.ideal_layout().constraint_rows > 0 && joint.gear < 0) add_play(j, radius);
  }
}

void IdealMechanism::add_play(int joint, double radius) {
  const auto add = [&](double size, std::initializer_list<std::array<double, 6>> twists, const char* part) {
    const Play play{joint, size, static_cast<int>(twists.size()), part[0] != 0, twists, part, play_numbers()};
    if (size > 0.0) plays_.push_back(play);
  };
  const JointLayout& layout = model_->joints[at(joint)].layout;
  if (model_->joints[at(joint)].has_play && !layout.play_bounds.empty() && layout.clearance > 0.0) {
    BoundedPlay bounded = bounded_play(layout.play_bounds, layout.clearance);
    const int size = static_cast<int>(bounded.twist.size());
    plays_.push_back({joint, radius, size, true, std::move(bounded.twist), "", play_numbers(),
                      std::make_shared<const PlayHull>(std::move(bounded.hull))});
    return;
  }
  const double length = parameter(model_->joints[at(joint)], "clearance.length");
  const bool slide = plays_between_walls(model_->joints[at(joint)].layout);
  if (model_->space == Space::planar && slide && length > 0.0) {
    // Both ends of the slider are free across the guide, each by itself.
    const double tilt = 1.0 / length;
    add(radius, {{0.0, 0.5, 0.0, 0.0, 0.0, tilt}}, ".front");
    add(radius, {{0.0, 0.5, 0.0, 0.0, 0.0, -tilt}}, ".rear");
  } else if (model_->space == Space::planar) {
    add(radius, {{1.0}, {0.0, 1.0}}, "");
  } else if (!(length > 0.0)) {
    add(radius, {{1.0}, {0.0, 1.0}, {0.0, 0.0, 1.0}}, "");
  } else {
    // Axis: z of the first marker.
    const double axial = parameter(model_->joints[at(joint)], "clearance.axial_clearance"), tilt = 1.0 / length;
    add(radius, {{0.5, 0.0, 0.0, 0.0, tilt, 0.0}, {0.0, 0.5, 0.0, -tilt, 0.0, 0.0}}, ".upper");
    add(radius, {{0.5, 0.0, 0.0, 0.0, -tilt, 0.0}, {0.0, 0.5, 0.0, tilt, 0.0, 0.0}}, ".lower");
    add(std::isnan(axial) ? radius : axial, {{0.0, 0.0, 1.0}}, ".axial");
  }
}

// Whether it holds bodies together: by rows, a driver or an input.
bool IdealMechanism::ties(int j) const {
  return system_->layout().rows(j).size > 0 || is_input(platform_, j) ||
         std::ranges::any_of(model_->drivers,
                             [&](const Driver& driver) { return driver.joint == j && prescribes(driver.kind); });
}

// Those of a joint, or of both joints of a gear, without the platform and ground.
std::vector<BodyId> IdealMechanism::bodies_of(int j) const {
  std::vector<BodyId> out;
  const JointElement& joint = model_->joints[at(j)];
  std::vector<int> joints{j};
  if (joint.gear >= 0) joints = {model_->gears[at(joint.gear)].first, model_->gears[at(joint.gear)].second};
  for (const int one : joints) {
    for (const int m : {model_->joints[at(one)].marker_a, model_->joints[at(one)].marker_b}) {
      if (const BodyId b = model_->markers[at(m)].body; b != ground && b != body_) out.push_back(b);
    }
  }
  return out;
}

void IdealMechanism::find_parts() {
  const int bodies = static_cast<int>(model_->bodies.size());
  DisjointSets tied(bodies);
  const int joints = static_cast<int>(model_->joints.size());
  for (int j = 0; j < joints; ++j) {
    if (!ties(j)) continue;
    const std::vector<BodyId> all = bodies_of(j);
    for (const BodyId b : all) tied.unite(b, all[0]);
  }
  std::map<int, std::size_t> part_of;  // by root
  for (int b = 0; b < bodies; ++b) {
    if (b == body_) continue;
    const auto [place, fresh] = part_of.emplace(tied.root(b), parts_.size());
    if (fresh) parts_.emplace_back();
    parts_[place->second].bodies.push_back(b);
  }
  std::vector<std::size_t> part_of_joint(at(joints));
  for (int j = 0; j < joints; ++j) {
    if (!ties(j)) continue;
    const std::vector<BodyId> all = bodies_of(j);
    if (all.empty()) parts_.emplace_back();
    Limb& part = all.empty() ? parts_.back() : parts_[part_of.at(tied.root(all[0]))];
    part_of_joint[at(j)] = static_cast<std::size_t>(&part - parts_.data());
    const Slice rows = system_->layout().rows(j);
    for (int r = 0; r < rows.size; ++r) part.rows.push_back(rows.offset + r);
    for (std::size_t p = 0; p < plays_.size(); ++p) {
      if (plays_[p].joint == j) part.plays.push_back(static_cast<int>(p));
    }
  }
  for (int d = 0; d < static_cast<int>(model_->drivers.size()); ++d) {
    const int row = system_->layout().driver_row(d);
    if (row >= 0) parts_[part_of_joint[at(model_->drivers[at(d)].joint)]].rows.push_back(row);
  }
  for (int i = 0; i < static_cast<int>(platform_.inputs.size()); ++i) {
    parts_[part_of_joint[at(platform_.inputs[at(i)])]].inputs.push_back(i);
  }
  // Legs in the order of their inputs, what has none after them.
  const auto first_input = [](const Limb& part) {
    return part.inputs.empty() ? std::numeric_limits<int>::max() : part.inputs.front();
  };
  std::ranges::stable_sort(parts_, {}, first_input);
}

void IdealMechanism::find_legs() {
  for (Limb& part : parts_) {
    if (part.inputs.size() != 1 || part.bodies.size() != 2 || part.rows.size() != 6) continue;
    std::optional<Leg> leg = find_leg(*model_, platform_.inputs[at(part.inputs[0])], platform_.marker);
    if (!leg) continue;
    leg->elbow = platform_.elbow[at(part.inputs[0])];
    part.leg = std::move(leg);
  }
}

void IdealMechanism::find_lengths() {
  const auto marker = [&](int m) -> const Marker& { return model_->markers[at(m)]; };
  const auto distance = [&](int a, int b) {
    const Vector3 &p = marker(a).position, &q = marker(b).position;
    return std::hypot(std::hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
  };
  // Farthest joint of a body from a marker on it; `next_only`: the only other joint, where there is one.
  const auto farthest = [&](int from, int except) {
    double most = 0.0;
    for (int j = 0; j < static_cast<int>(model_->joints.size()); ++j) {
      if (j == except || system_->layout().rows(j).size == 0 || model_->joints[at(j)].gear >= 0) continue;
      for (const int m : {model_->joints[at(j)].marker_a, model_->joints[at(j)].marker_b}) {
        if (marker(m).body == marker(from).body) most = std::max(most, distance(m, from));
      }
    }
    return most;
  };
  length_ = farthest(platform_.marker, -1);
  if (!(length_ > 0.0)) length_ = system_->size();
  for (int i = 0; i < static_cast<int>(platform_.inputs.size()); ++i) {
    const int j = platform_.inputs[at(i)];
    const JointElement& joint = model_->joints[at(j)];
    const int driven = marker(joint.marker_b).body != ground ? joint.marker_b : joint.marker_a;
    double crank = is_angle(i) ? farthest(driven, j) : 1.0;
    if (!(crank > 0.0)) crank = length_;
    cranks_.push_back(crank);
  }
}

const Posture& IdealMechanism::start() {
  if (!start_) assemble_start();
  return *start_;
}

std::vector<Jet> IdealMechanism::driven_inputs(double t) {
  start();
  std::vector<TimeValue> motion(original_.drivers.size());
  MotionFault fault;
  if (!released_->motions().evaluate(t, {motion.data(), motion.size()}, fault)) {
    throw Error(Error::Category::numerical, fault.id, fault.text);
  }
  std::vector<Jet> out;
  for (const int j : platform_.inputs) {
    std::size_t d = 0;
    while (d < motion.size() && !(original_.drivers[d].joint == j && prescribes(original_.drivers[d].kind))) ++d;
    if (d == motion.size()) {
      throw Error(Error::Category::input, "missing-key",
                  fmt::format("no path is known: 'analysis' needs 'path', for no driver prescribes joint '{}' either",
                              original_.joints[at(j)].name),
                  platform_.location);
    }
    out.push_back({motion[d].value, motion[d].rate, motion[d].acceleration});
  }
  return out;
}

void IdealMechanism::assemble_start() {
  released_ = std::make_unique<System>(original_);
  System& released = *released_;
  const Start assembled = assemble(released);
  Posture posture;
  posture.q.assign(assembled.state.q().begin(), assembled.state.q().end());
  posture.h.assign(at(system_->layout().nh()), 0.0);
  State state(system_->layout(), 0);
  state.t() = model_->settings.start;
  std::ranges::copy(posture.q, state.q().begin());
  for (int j = 0; j < static_cast<int>(model_->joints.size()); ++j) {
    const int here = system_->layout().turn(j), there = released.layout().turn(j);
    if (here >= 0 && there >= 0) posture.h[at(here)] = assembled.state.h()[at(there)];
  }
  std::ranges::copy(posture.h, state.h().begin());
  Evaluation e(*system_);
  if (!system_->evaluate(point(state), term_coordinate, e)) {
    throw Error(Error::Category::plugin, "plugin-failed", e.fault.message.text);
  }
  for (std::size_t g = 0; g < model_->gears.size(); ++g) {
    const Gear& gear = model_->gears[g];
    if (gear.offset) continue;
    system_->set_gear_offset(static_cast<int>(g),
                             e.coordinate[at(gear.second)] - gear.ratio * e.coordinate[at(gear.first)]);
  }
  for (int d = 0; d < static_cast<int>(model_->drivers.size()); ++d) {
    const Driver& driver = model_->drivers[at(d)];
    if (driver.kind == DriverKind::velocity) system_->motions().set_start(d, e.coordinate[at(driver.joint)]);
  }
  close_joints(*this, model_->settings.start, posture);
  start_ = std::move(posture);
}

}  // namespace freeplay
