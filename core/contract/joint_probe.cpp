#include "contract/joint_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace freeplay {
namespace {

constexpr std::size_t at(int count) { return static_cast<std::size_t>(std::max(count, 0)); }

}  // namespace

struct JointProbe::Fed {
  Fed(const JointProbe& probe, const JointMoment& moment) : markers(moment.markers), z(moment.z), h(moment.h) {
    in = {moment.t, &markers.a, &markers.b, 0.0, 0.0, z.span(), h.span()};
    if (probe.layout_.coordinate == Coordinate::none) return;
    CoordinateRow row{};
    Message message;
    if (!probe.joint_.coordinate(in, row, message)) return;
    in.coordinate = row.value;
    if (probe.layout_.coordinate == Coordinate::angle) {
      in.coordinate += 2.0 * M_PI * std::round((moment.coordinate - row.value) / (2.0 * M_PI));
    }
    const Twelve twist = twists(markers);
    for (std::size_t i = 0; i < twist.size(); ++i) in.coordinate_rate += row.jacobian[i] * twist[i];
  }
  MarkerPair markers;
  GuardedNumbers z, h;
  JointInput in{};
};

JointProbe::JointProbe(const JointRef& joint, Space space, const Conditions& conditions, Findings& findings)
    : joint_(joint), space_(space), conditions_(conditions), findings_(findings) {
  layout_.space = space;
  run("declare", [&](Message& m) { return joint_.declare(layout_, m); });
  const bool sane = layout_.constraint_rows >= 0 && layout_.constraint_rows <= (space == Space::planar ? 3 : 6) &&
                    layout_.internal_variables >= 0 && layout_.history >= 0 && layout_.clearance >= 0.0;
  findings_.expect("declares-sanely", sane, [&] {
    return fmt::format("{} rows, {} internal variables, {} history numbers, clearance {} m", layout_.constraint_rows,
                       layout_.internal_variables, layout_.history, layout_.clearance);
  });
  // What follows must not trip over a negative count.
  layout_.constraint_rows = std::clamp(layout_.constraint_rows, 0, 6);
}

bool JointProbe::run(const char* function, const Call& call) const {
  Message message;
  const long before = conditions_.allocations ? conditions_.allocations() : 0;
  const bool good = call(message);
  const long after = conditions_.allocations ? conditions_.allocations() : 0;
  findings_.expect("answers", good, [&] { return fmt::format("{}() fails: {}", function, message.text); });
  const bool may_allocate = std::string_view(function) == "declare" || std::string_view(function) == "initialize";
  if (conditions_.allocations && !may_allocate) {
    findings_.expect("allocation", after == before,
                     [&] { return fmt::format("{}() allocates {} times", function, after - before); });
  }
  return good;
}

void JointProbe::watch(const char* function, std::initializer_list<const GuardedNumbers*> written,
                       bool nan_allowed) const {
  for (const GuardedNumbers* numbers : written) {
    findings_.expect("stays-in-span", numbers->intact(),
                     [&] { return fmt::format("{}() writes beside the numbers it was given", function); });
    if (nan_allowed) continue;
    const std::vector<double> values = numbers->values();
    const bool finite = std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
    findings_.expect("finite", finite, [&] { return fmt::format("{}() gives a number that is not finite", function); });
  }
}

RowValues JointProbe::rows(const JointMoment& moment) const {
  const std::size_t n = at(layout_.constraint_rows);
  Fed fed(*this, moment);
  GuardedNumbers phi(n), jacobian(12 * n), nu(n), gamma(n);
  ConstraintRows out{phi.span(), jacobian.span(), nu.span(), gamma.span()};
  if (!run("constrain", [&](Message& m) { return joint_.constrain(fed.in, out, m); })) return {};
  watch("constrain", {&phi, &jacobian, &nu, &gamma, &fed.z, &fed.h});
  return {phi.values(), jacobian.values(), nu.values(), gamma.values()};
}

CoordinateValues JointProbe::coordinate(const JointMoment& moment) const {
  Fed fed(*this, moment);
  CoordinateRow row{};
  if (!run("coordinate", [&](Message& m) { return joint_.coordinate(fed.in, row, m); })) return {};
  const GuardedNumbers numbers(std::vector<double>(row.jacobian, row.jacobian + 12)),
      pair(std::vector<double>{row.value, row.bias});
  watch("coordinate", {&numbers, &pair, &fed.z, &fed.h});
  double value = row.value;
  if (layout_.coordinate == Coordinate::angle) {
    value += 2.0 * M_PI * std::round((moment.coordinate - value) / (2.0 * M_PI));
  }
  return {value, row.bias, numbers.values()};
}

ForceValues JointProbe::forces(const JointMoment& moment, bool derivatives) const {
  const std::size_t nz = at(layout_.internal_variables);
  Fed fed(*this, moment);
  GuardedNumbers rate(nz), table(derivatives ? (12 + nz) * (24 + nz) : 0);
  JointForces out{};
  out.internal_rate = rate.span();
  if (derivatives) out.derivatives = table.span();
  if (!run("apply", [&](Message& m) { return joint_.apply(fed.in, out, m); })) return {};
  std::vector<double> wrench(out.wrench_a, out.wrench_a + 6);
  wrench.insert(wrench.end(), out.wrench_b, out.wrench_b + 6);
  const GuardedNumbers given(wrench), potential(std::vector<double>{out.potential});
  watch("apply", {&rate, &table, &given, &potential, &fed.z, &fed.h});
  return {wrench, out.potential, rate.values(), table.values()};
}

EventValues JointProbe::events(const JointMoment& moment) const {
  const std::size_t count = layout_.events.size;
  Fed fed(*this, moment);
  GuardedNumbers g(count), rate(count);
  if (!run("events", [&](Message& m) { return joint_.events(fed.in, g.span(), rate.span(), m); })) return {};
  watch("events", {&g, &rate}, true);
  return {g.values(), rate.values()};
}

std::vector<double> JointProbe::observe(const JointMoment& moment) const {
  Fed fed(*this, moment);
  GuardedNumbers channels(layout_.channels.size);
  GuardedNumbers lambda(at(layout_.constraint_rows), 1.0);
  if (!run("observe", [&](Message& m) { return joint_.observe(fed.in, lambda.span(), channels.span(), m); })) return {};
  watch("observe", {&channels, &fed.z, &fed.h});
  return channels.values();
}

double JointProbe::step_limit(const JointMoment& moment) const {
  Fed fed(*this, moment);
  double limit = unbounded;
  if (!run("step_limit", [&](Message& m) { return joint_.step_limit(fed.in, limit, m); })) return unbounded;
  findings_.expect("step-limit", limit > 0.0, [&] { return fmt::format("step_limit() gives {} s", limit); });
  return limit;
}

void JointProbe::initialize(JointMoment& moment) const {
  Fed fed(*this, moment);
  GuardedNumbers z(moment.z), h(moment.h);
  if (!run("initialize", [&](Message& m) { return joint_.initialize(fed.in, z.span(), h.span(), m); })) return;
  watch("initialize", {&z, &h});
  moment.z = z.values();
  moment.h = h.values();
}

void JointProbe::begin_step(const JointMoment& accepted, const Twelve& acceleration, double dt,
                            JointMoment& trial) const {
  Fed fed(*this, accepted);
  MarkerAccelerations both{};
  std::copy_n(acceleration.begin(), 6, both.a);
  std::copy_n(acceleration.begin() + 6, 6, both.b);
  GuardedNumbers h(trial.h);
  if (!run("begin_step", [&](Message& m) { return joint_.begin_step(fed.in, both, dt, h.span(), m); })) return;
  watch("begin_step", {&h});
  trial.h = h.values();
}

std::vector<double> JointProbe::on_event(int index, JointMoment& moment) const {
  Fed fed(*this, moment);
  GuardedNumbers z(moment.z), h(moment.h);
  GuardedNumbers fields(layout_.events[at(index)].fields.size, std::numeric_limits<double>::quiet_NaN());
  if (!run("on_event",
           [&](Message& m) { return joint_.on_event(index, fed.in, z.span(), h.span(), fields.span(), m); })) {
    return {};
  }
  watch("on_event", {&z, &h});
  watch("on_event", {&fields}, true);
  moment.z = z.values();
  moment.h = h.values();
  return fields.values();
}

void JointProbe::commit(JointMoment& moment) const {
  Fed fed(*this, moment);
  GuardedNumbers h(moment.h), lambda(at(layout_.constraint_rows), 1.0);
  if (!run("commit", [&](Message& m) { return joint_.commit(fed.in, lambda.span(), h.span(), m); })) return;
  watch("commit", {&h, &lambda});
  moment.h = h.values();
}

std::vector<double> JointProbe::all(const JointMoment& moment) const {
  std::vector<double> numbers;
  const auto add = [&numbers](const std::vector<double>& more) {
    numbers.insert(numbers.end(), more.begin(), more.end());
  };
  const RowValues r = rows(moment);
  for (const auto* part : {&r.phi, &r.jacobian, &r.nu, &r.gamma}) add(*part);
  if (layout_.coordinate != Coordinate::none) {
    const CoordinateValues c = coordinate(moment);
    add({c.value, c.bias});
    add(c.jacobian);
  }
  if (layout_.forces != 0) {
    const ForceValues f = forces(moment, layout_.analytic_derivatives != 0);
    for (const auto* part : {&f.wrench, &f.z_rate, &f.derivatives}) add(*part);
    add({f.potential});
  }
  const EventValues e = events(moment);
  add(e.g);
  add(e.rate);
  add(observe(moment));
  add({step_limit(moment)});
  return numbers;
}

JointMoment JointProbe::start(const MarkerPair& markers, double t) const {
  JointMoment moment{t, markers, 0.0, std::vector<double>(at(layout_.internal_variables)),
                     std::vector<double>(at(layout_.history))};
  initialize(moment);
  return moment;
}

}  // namespace freeplay
