#include "run/play_start.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "assembly/bare_start.h"
#include "base/index.h"
#include "base/philox.h"
#include "component/joint_roles.h"
#include "model/whole_mass.h"
#include "run/observer.h"
#include "stage/newton_stage_solver.h"

namespace freeplay {
namespace {

constexpr std::uint64_t stream = 0x706c6179;  // "play": draws of other kinds have other keys
constexpr int most_attempts = 12;
constexpr double least_push = 1e-9;  // of what is asked for: less is rounding

/// Evenly distributed in the unit disc or ball.
Vector3 unit_ball(const RandomWords& words, Space space) {
  const double turn = 2.0 * M_PI * unit_number(words[1]);
  if (space == Space::planar) {
    const double radius = std::sqrt(unit_number(words[0]));
    return {radius * std::cos(turn), radius * std::sin(turn), 0.0};
  }
  const double radius = std::cbrt(unit_number(words[0])), height = 2.0 * unit_number(words[2]) - 1.0;
  const double flat = radius * std::sqrt(1.0 - height * height);
  return {flat * std::cos(turn), flat * std::sin(turn), radius * height};
}

/// By joint, whether it begins in contact; one without a channel of penetration does not.
std::vector<bool> touching(const System& system, const Start& start) {
  const Model& model = system.model();
  const Channels channels(model);
  std::vector<double> row(channels.all().size());
  constexpr unsigned terms = term_position | term_velocity | term_acceleration | term_force | term_coordinate;
  Evaluation e(system);
  Fault fault;
  std::vector<bool> out(model.joints.size(), false);
  if (!system.evaluate(point(start.state), terms, e) ||
      !Observer(system, channels).observe(start.state, e, row, fault)) {
    return out;  // the run will say why
  }
  for (std::size_t j = 0; j < out.size(); ++j) {
    const int column = channels.joints[j].penetration;
    out[j] = model.joints[j].has_play && column >= 0 && row[at(column)] > 0.0;
  }
  return out;
}

/// Along the surface of a contact.
void slide(const Vector3& ball, double reach, double* e) {
  const double length = std::hypot(e[0], e[1], e[2]);
  const double along = (e[0] * ball[0] + e[1] * ball[1] + e[2] * ball[2]) / (length * length);
  double moved[3];
  for (std::size_t i = 0; i < 3; ++i) moved[i] = e[i] + reach * (ball[i] - along * e[i]);
  const double scale = length / std::hypot(moved[0], moved[1], moved[2]);
  for (std::size_t i = 0; i < 3; ++i) e[i] = scale * moved[i];
}

/// Start `number` of a repeated run, as `assembled` puts it together.
[[gnu::cold]] Start moved_start(System& system, std::uint64_t seed, std::uint64_t number,
                                Start (*assembled)(System&, const OffsetChange&)) {
  const Start own = assemble_bare(system);
  const Model& model = system.model();
  const std::vector<bool> rests = touching(system, own);
  std::vector<double> share(model.joints.size(), 1.0);  // of the way from the middle of the play
  const auto move = [&](int joint, InitialOffset& offset) {
    const RandomWords words = philox({number, static_cast<std::uint64_t>(joint), 0, 0}, {seed, stream});
    const Vector3 ball = unit_ball(words, model.space);
    double* const e = offset.position;
    const double reach = moved_in_play * system.joints().layout(joint).clearance;
    if (rests[at(joint)] && std::hypot(e[0], e[1], e[2]) > 0.0) return slide(ball, reach, e);
    for (std::size_t i = 0; i < 3; ++i) e[i] = share[at(joint)] * ((1.0 - moved_in_play) * e[i] + reach * ball[i]);
  };
  std::string still;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    Start start = assembled(system, move);
    const std::vector<bool> touches = touching(system, start);
    still.clear();
    for (std::size_t j = 0; j < touches.size(); ++j) {
      if (!touches[j] || rests[j]) continue;
      still = model.joints[j].name;
      share[j] *= 0.5;
    }
    if (still.empty()) return start;
  }
  throw Error(Error::Category::numerical, "no-free-start",
              fmt::format("joint '{}' is in contact wherever it is put in its play", still));
}

/// The same for a model without play: pushed.
[[gnu::cold]] Start pushed_start(System& system, std::uint64_t seed, std::uint64_t number,
                                 Start (*assembled)(System&, const OffsetChange&)) {
  Start start = assembled(system, {});
  const Model& model = system.model();
  State& state = start.state;
  const std::span<const double> mass = system.inertia().mass();
  const double size = model_size(model), whole = model.settings.end - model.settings.start;
  double twice_energy = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) twice_energy += mass[i] * state.v()[i] * state.v()[i];
  const double speed = std::max(std::sqrt(twice_energy / whole_mass(model).mass), size / whole);
  const std::size_t width = model.space == Space::planar ? 3 : 6, lengths = model.space == Space::planar ? 2 : 3;
  const std::vector<double> before(state.v().begin(), state.v().end());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double most = pushed * speed / (i % width < lengths ? 1.0 : size);
    state.v()[i] += most * (2.0 * unit_number(philox({number, i, 1, 0}, {seed, stream})[0]) - 1.0);
  }
  NewtonStageSolver solver(system, {});
  solver.use_history(state.h());
  StateView view = state.view();
  std::vector<double> internal_rate(state.z().size());
  double change = 0.0;
  if (solver.project_velocity(view) && solver.accelerate(view, {internal_rate.data(), internal_rate.size()})) {
    for (std::size_t i = 0; i < before.size(); ++i) change = std::max(change, std::abs(state.v()[i] - before[i]));
  }
  if (change > least_push * pushed * speed) return start;
  throw Error(Error::Category::numerical, "no-free-start", "joints and drivers leave no body free to be pushed");
}

Start other_start(System& system, std::uint64_t seed, std::uint64_t number,
                  Start (*assembled)(System&, const OffsetChange&)) {
  const bool touches = system.model().clearance_joints() == 0 && can_be_repeated(system.model());
  return touches ? pushed_start(system, seed, number, assembled) : moved_start(system, seed, number, assembled);
}

}  // namespace

StartChange start_change(const Model& model) {
  return model.clearance_joints() > 0 ? StartChange{.moved = moved_in_play} : StartChange{.pushed = pushed};
}

bool can_be_repeated(const Model& model) {
  return std::ranges::any_of(
      model.joints, [](const JointElement& joint) { return joint.has_play || contact_count(joint.layout) > 0; });
}

Start assemble_in_play(System& system, std::uint64_t seed, std::uint64_t number) {
  return number == 0 ? assemble(system) : other_start(system, seed, number, assemble);
}

Start assemble_bare_in_play(System& system, std::uint64_t seed, std::uint64_t number) {
  return number == 0 ? assemble_bare(system) : other_start(system, seed, number, assemble_bare);
}

}  // namespace freeplay
