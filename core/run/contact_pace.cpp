#include "run/contact_pace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/index.h"
#include "component/joint_roles.h"
#include "system/joint_derivatives.h"

namespace freeplay {
namespace {

constexpr double nudge = 1e-7;  // of a velocity, for a slope [m/s, rad/s]

/// What the normal force alone damps, of the whole tr(W C). With its slope g by the velocity of b, which is its damping
/// times the unit wrench by which the surfaces press, that is g^T W g by the part of g that is a force by a speed.
double pressing_damping(const JointRef& joint, const JointLayout& layout, JointInput in, const double* mobility) {
  constexpr double all_of_it = std::numeric_limits<double>::infinity();  // nothing is known of friction
  const auto channel_of = [&](ChannelRole role) {
    std::size_t channel = 0;
    while (channel < layout.channels.size && channel_role(layout, channel) != role) ++channel;
    return channel;
  };
  const std::size_t normal = channel_of(ChannelRole::normal_force), friction = channel_of(ChannelRole::friction_force);
  if (normal == layout.channels.size) return all_of_it;
  bool rubs = friction == layout.channels.size;  // nothing is known of it
  const MarkerKinematics second = *in.b;
  std::vector<double> channels(layout.channels.size, 0.0);
  std::array<double, 6> slope{};
  for (std::size_t k = 0; k < slope.size(); ++k) {
    for (const double sense : {1.0, -1.0}) {
      MarkerKinematics moved = second;
      (k < 3 ? moved.velocity[k] : moved.angular_velocity[k - 3]) += sense * nudge;
      in.b = &moved;
      Message message;
      if (!joint.observe(in, {}, {channels.data(), channels.size()}, message)) return all_of_it;
      slope[k] += sense * channels[normal] / (2.0 * nudge);
      rubs = rubs || channels[friction] != 0.0;
    }
  }
  if (!rubs) return all_of_it;
  double sum = 0.0;
  for (std::size_t r = 0; r < slope.size(); ++r) {
    for (std::size_t c = 0; c < slope.size(); ++c) sum += slope[r] * mobility[slope.size() * r + c] * slope[c];
  }
  const double force = std::hypot(slope[0], slope[1], slope[2]);
  if (force > 0.0) return sum / force;
  return sum > 0.0 ? all_of_it : 0.0;  // a moment alone, as of a stop of turns
}

}  // namespace

ContactPaces::ContactPaces(RunContext& run) : run_(run) {
  const std::span<const ForceBlock> blocks = run.system.forces().blocks();
  for (std::size_t f = 0; f < blocks.size(); ++f) {
    const JointLayout& layout = run.system.joints().layout(blocks[f].joint);
    OfJoint contact{.joint = blocks[f].joint, .block = f};
    bool any = false;
    for (std::size_t i = 0; i < layout.events.size; ++i) {
      const bool begins = event_role(layout, i) == EventRole::contact_begin;
      contact.speed_field.push_back(begins ? field_index(layout.events[i], "speed") : -1);
      any = any || begins;
    }
    if (any) contacts_.push_back(std::move(contact));
  }
}

void ContactPaces::note_begins() {
  for (const StepEvents::Happening& event : run_.events.happenings()) {
    const auto contact = std::ranges::find(contacts_, event.joint, &OfJoint::joint);
    const int field = contact == contacts_.end() ? -1 : contact->speed_field[at(event.event)];
    if (field >= 0) contact->speed = run_.events.fields(event)[at(field)];
  }
}

bool ContactPaces::look(OfJoint& contact, ContactPace& pace) {
  const Joints& joints = run_.system.joints();
  const JointLayout& layout = joints.layout(contact.joint);
  Evaluation& e = run_.e_accepted;
  const JointInput in = joints.input(contact.joint, point(run_.accepted), e);
  const std::size_t nz = in.internal.size, columns = 24 + nz, table = (12 + nz) * columns;
  const Span<double> derivatives(e.derivative_space.data(), table);
  std::fill(derivatives.begin(), derivatives.end(), 0.0);
  JointForces out{};
  out.internal_rate = {e.rate_space.data(), nz};
  Message message;
  if (layout.analytic_derivatives != 0) out.derivatives = derivatives;
  if (!joints.handle(contact.joint).apply(in, out, message)) return false;
  if (layout.analytic_derivatives == 0 && !difference_forces({joints.handle(contact.joint), layout, run_.system.size(),
                                                              std::span(e.derivative_space).subspan(table)},
                                                             in, out, {derivatives.begin(), table}, message)) {
    return false;
  }
  double moved[9], whole[36];
  if (!run_.solver.mobility(run_.accepted, contact.joint, moved, whole)) return false;
  double stiffness = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      const double* row = &derivatives[(6 + k) * columns];
      stiffness -= whole[6 * i + k] * row[6 + i];
      pace.damping -= whole[6 * i + k] * row[18 + i];
    }
  }
  pace.joint = contact.joint;
  pace.swing = std::sqrt(std::max(stiffness, 0.0));
  pace.slides = pressing_damping(joints.handle(contact.joint), layout, in, whole) < 0.5 * pace.damping;
  return true;
}

ContactPace ContactPaces::fastest() {
  ContactPace most;
  for (OfJoint& contact : contacts_) {
    ContactPace pace;
    if (run_.e_accepted->acts[contact.block] == 0 || !look(contact, pace)) continue;
    if (pace.damping > most.damping) most = pace;
  }
  return most;
}

std::string ContactPaces::words(const ContactPace& pace) const {
  const ComponentKind kind = pace.slides ? ComponentKind::friction_law : ComponentKind::contact_law;
  const ParameterBlock* block = run_.model.joints[at(pace.joint)].parameters.get();
  std::string law;
  if (block != nullptr) {
    for (const auto& [key, value] : block->values) {
      if (!value.law || value.law->component->kind != kind) continue;
      law = fmt::format("law '{}'", value.law->component->description.name);
    }
  }
  if (pace.slides) return law.empty() ? "its friction" : fmt::format("its friction ({})", law);
  const double speed = std::ranges::find(contacts_, pace.joint, &OfJoint::joint)->speed;
  return fmt::format("its contact ({}{}{})", law, law.empty() ? "" : ", ",
                     speed < 0.0 ? "on from the start" : fmt::format("begun at {:.2g} m/s", speed));
}

}  // namespace freeplay
