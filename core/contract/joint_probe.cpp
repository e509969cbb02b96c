#include "contract/joint_probe.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/angle.h"
#include "component/declared.h"
#include "contract/joint_words.h"

namespace freeplay {
namespace {

/// A struct with marked numbers after it, so that a write past its end is seen.
template <class T>
struct Fenced {
  T inside{};
  GuardMark mark[8];
  bool intact() const {
    return std::all_of(std::begin(mark), std::end(mark), [](const GuardMark& m) { return m.intact(); });
  }
};

constexpr std::size_t how_many(int count) { return static_cast<std::size_t>(std::max(count, 0)); }

}  // namespace

struct JointProbe::Fed {
  Fed(const JointProbe& probe, const JointMoment& given)
      : moment(given), markers(given.markers), z(given.z), h(given.h) {
    in = {moment.t,           &markers.a,      &markers.b,           0.0, 0.0, z.span(), h.span(),
          moment.per_contact, moment.mobility, moment.whole_mobility};
    if (probe.layout_.coordinate == Coordinate::none) return;
    CoordinateRow row{};
    Message message;
    WatchedCall watched(probe.conditions_, "coordinate");
    const bool good = probe.joint_.coordinate(in, row, message);
    watched.end();
    if (!good) return;
    in.coordinate = row.value;
    if (probe.layout_.coordinate == Coordinate::angle) {
      in.coordinate = nearest_turn(in.coordinate, moment.coordinate);
    }
    const Twelve twist = twists(markers);
    for (std::size_t i = 0; i < twist.size(); ++i) in.coordinate_rate += row.jacobian[i] * twist[i];
  }
  bool untouched() const {
    return z.intact() && h.intact() && same_bits(z.numbers(), moment.z) && same_bits(h.numbers(), moment.h) &&
           // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): made of numbers alone, which are compared by bits
           std::memcmp(&markers, &moment.markers, sizeof markers) == 0;
  }
  const JointMoment& moment;
  MarkerPair markers;
  GuardedNumbers z, h;
  double lost = 0.0;
  JointInput in{};
};

JointProbe::JointProbe(const JointRef& joint, Space space, const Conditions& conditions, Findings& findings)
    : joint_(joint), space_(space), conditions_(conditions), findings_(findings) {
  layout_.space = space;
  run("declare", nullptr, [&](Message& m) { return joint_.declare(layout_, m); });
  const std::string fault = declaration_fault(layout_);
  findings_.expect("declares-sanely", fault.empty(), [&] { return fault; });
  if (fault.empty()) return;
  layout_ = JointLayout();  // what follows must not trip over a wrong count
}

template <class Call>
bool JointProbe::run(const char* function, const JointMoment* moment, const Call& call) const {
  Message message;
  WatchedCall watched(conditions_, function);
  const bool good = call(message);
  const long allocated = watched.end();
  const auto where = [&] { return moment == nullptr ? std::string() : " " + words_of(*moment); };
  findings_.expect("answers", good, [&] { return fmt::format("{}() fails{}: {}", function, where(), message.text); });
  const bool may_allocate = std::string_view(function) == "declare" || std::string_view(function) == "initialize";
  if (conditions_.allocations && !may_allocate) {
    findings_.expect("allocation", allocated == 0 || !good,
                     [&] { return fmt::format("{}() allocates{}: {} in one call", function, where(), allocated); });
  }
  return good;
}

bool JointProbe::watch(const char* function, const Fed& fed, std::initializer_list<const GuardedNumbers*> written,
                       bool nan_allowed) const {
  bool all_finite = true;
  findings_.expect("stays-in-span", fed.untouched(), [&] {
    return fmt::format("{}() changes what it may only read, {}", function, words_of(fed.moment));
  });
  for (const GuardedNumbers* numbers : written) {
    findings_.expect("stays-in-span", numbers->intact(), [&] {
      return fmt::format("{}() writes beside the {} numbers it was given, {}", function, numbers->values().size(),
                         words_of(fed.moment));
    });
    if (!nan_allowed) all_finite = expect_finite(function, fed, numbers->numbers()) && all_finite;
  }
  return all_finite;
}

bool JointProbe::expect_finite(const char* function, const Fed& fed, std::span<const double> numbers) const {
  const bool finite = std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
  return findings_.expect("finite", finite, [&] {
    return fmt::format("{}() gives a number that is not finite, {}", function, words_of(fed.moment));
  });
}

void JointProbe::expect_fence(const char* function, bool intact, const JointMoment& moment) const {
  findings_.expect("stays-in-span", intact, [&] {
    return fmt::format("{}() writes past the end of the struct it was given, {}", function, words_of(moment));
  });
}

ProbedRows JointProbe::rows(const JointMoment& moment) const {
  const std::size_t n = how_many(layout_.constraint_rows);
  Fed fed(*this, moment);
  GuardedNumbers phi(n), jacobian(12 * n), nu(n), gamma(n);
  ConstraintRows out{phi.span(), jacobian.span(), nu.span(), gamma.span()};
  if (!run("constrain", &moment, [&](Message& m) { return joint_.constrain(fed.in, out, m); })) return {};
  if (!watch("constrain", fed, {&phi, &jacobian, &nu, &gamma})) return {};
  return {phi.values(), jacobian.values(), nu.values(), gamma.values()};
}

ProbedCoordinate JointProbe::coordinate(const JointMoment& moment) const {
  Fed fed(*this, moment);
  Fenced<CoordinateRow> fenced;
  CoordinateRow& row = fenced.inside;
  if (!run("coordinate", &moment, [&](Message& m) { return joint_.coordinate(fed.in, row, m); })) return {};
  expect_fence("coordinate", fenced.intact(), moment);
  const double pair[] = {row.value, row.bias};
  const bool finite = watch("coordinate", fed, {}) && expect_finite("coordinate", fed, row.jacobian);
  if (!expect_finite("coordinate", fed, pair) || !finite) return {};
  double value = row.value;
  if (layout_.coordinate == Coordinate::angle) {
    value = nearest_turn(value, moment.coordinate);
  }
  return {value, row.bias, std::vector<double>(row.jacobian, row.jacobian + 12)};
}

ProbedForces JointProbe::forces(const JointMoment& moment, bool derivatives) const {
  const std::size_t nz = how_many(layout_.internal_variables);
  Fed fed(*this, moment);
  GuardedNumbers rate(nz), table(derivatives ? (12 + nz) * (24 + nz) : 0);
  Fenced<JointForces> fenced;
  JointForces& out = fenced.inside;
  out.internal_rate = rate.span();
  if (derivatives) out.derivatives = table.span();
  if (!run("apply", &moment, [&](Message& m) { return joint_.apply(fed.in, out, m); })) return {};
  expect_fence("apply", fenced.intact() && out.internal_rate.data == rate.span().data, moment);
  std::vector<double> wrench(12);
  std::ranges::copy(out.wrench_b, std::ranges::copy(out.wrench_a, wrench.begin()).out);
  bool finite = watch("apply", fed, {&rate, &table});
  finite = expect_finite("apply", fed, wrench) && finite;
  if (!expect_finite("apply", fed, {&out.potential, 1}) || !finite) return {};
  return {std::move(wrench), out.potential, rate.values(), table.values(), out.potential_rate};
}

ProbedEvents JointProbe::events(const JointMoment& moment) const {
  const std::size_t count = layout_.events.size;
  Fed fed(*this, moment);
  GuardedNumbers g(count), rate(count);
  if (!run("events", &moment, [&](Message& m) { return joint_.events(fed.in, g.span(), rate.span(), m); })) return {};
  watch("events", fed, {&g, &rate}, true);
  return {g.values(), rate.values()};
}

std::vector<double> JointProbe::observe(const JointMoment& moment) const {
  Fed fed(*this, moment);
  GuardedNumbers channels(layout_.channels.size);
  GuardedNumbers lambda(how_many(layout_.constraint_rows), 1.0);
  if (!run("observe", &moment, [&](Message& m) { return joint_.observe(fed.in, lambda.span(), channels.span(), m); }))
    return {};
  watch("observe", fed, {&channels});
  return channels.values();
}

std::vector<double> JointProbe::contacts(const JointMoment& moment, std::size_t count) const {
  Fed fed(*this, moment);
  const double untouched = GuardMark().number();
  GuardedNumbers numbers(3 * count, untouched);
  if (!run("contacts", &moment, [&](Message& m) { return joint_.contacts(fed.in, numbers.span(), m); })) return {};
  const std::vector<double> values = numbers.values();
  if (same_bits(values, std::vector<double>(values.size(), untouched))) return {};
  watch("contacts", fed, {&numbers});
  return values;
}

double JointProbe::step_limit(const JointMoment& moment) const {
  Fed fed(*this, moment);
  double limit = unbounded;
  if (!run("step_limit", &moment, [&](Message& m) { return joint_.step_limit(fed.in, limit, m); })) return unbounded;
  findings_.expect("step-limit", limit > 0.0, [&] { return fmt::format("step_limit() gives {} s", limit); });
  return limit;
}

double JointProbe::free_distance(const JointMoment& moment) const {
  Fed fed(*this, moment);
  double distance = 0.0;
  if (!run("free_distance", &moment, [&](Message& m) { return joint_.free_distance(fed.in, distance, m); })) return 0.0;
  findings_.expect("free-distance", distance >= 0.0 && std::isfinite(distance),
                   [&] { return fmt::format("free_distance() gives {} m", distance); });
  return std::isfinite(distance) ? distance : 0.0;
}

std::array<double, 3> JointProbe::free_levers(const JointMoment& moment) const {
  Fed fed(*this, moment);
  GuardedNumbers levers(std::vector<double>(3, 0.0));
  std::array<double, 3> out{};
  if (!run("free_levers", &moment, [&](Message& m) { return joint_.free_levers(fed.in, levers.span(), m); }))
    return out;
  watch("free_levers", fed, {&levers});
  const std::vector<double> values = levers.values();
  std::ranges::copy(values, out.begin());
  findings_.expect("free-distance", std::ranges::all_of(values, [](double x) { return x >= 0.0; }), [&] {
    return fmt::format("free_levers() gives {} m, {} m and {} m", values[0], values[1], values[2]);
  });
  return out;
}

double JointProbe::next_corner(double t) const {
  double corner = unbounded;
  run("next_corner", nullptr, [&](Message& m) { return joint_.next_corner(t, corner, m); });
  return corner;
}

bool JointProbe::warns(const JointMoment& moment) const {
  Fed fed(*this, moment);
  const char* text = nullptr;
  run("warning", &moment, [&](Message& m) { return joint_.warning(fed.in, text, m); });
  return text != nullptr;
}

bool JointProbe::place(double coordinate, Pose& b_in_a) const {
  Fenced<Pose> fenced;
  bool can = false;
  run("place", nullptr, [&](Message& m) {
    can = joint_.place(coordinate, fenced.inside, m);
    return can || m.text[0] == '\0';
  });
  expect_fence("place", fenced.intact(), {});
  b_in_a = fenced.inside;
  return can;
}

InitialOffset JointProbe::initial_offset(Span<const double> reaction) const {
  Fenced<InitialOffset> fenced;
  run("initial_offset", nullptr, [&](Message& m) { return joint_.initial_offset(reaction, fenced.inside, m); });
  expect_fence("initial_offset", fenced.intact(), {});
  return fenced.inside;
}

void JointProbe::initialize(JointMoment& moment) const {
  Fed fed(*this, moment);
  GuardedNumbers z(moment.z), h(moment.h);
  Message refusal;
  const auto begin = [&](Message& m) {
    const bool good = joint_.initialize(fed.in, z.span(), h.span(), m);
    refusal = m;
    return good || m.id[0] != '\0';
  };
  if (!run("initialize", &moment, begin) || refusal.id[0] != '\0') return;  // it may refuse a start
  watch("initialize", fed, {&z, &h});
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
  if (!run("begin_step", &accepted, [&](Message& m) { return joint_.begin_step(fed.in, both, dt, h.span(), m); }))
    return;
  watch("begin_step", fed, {&h});
  trial.h = h.values();
}

void JointProbe::add_loss(const char* function, const Fed& fed, JointMoment& moment) const {
  if (expect_finite(function, fed, {&fed.lost, 1})) moment.lost += fed.lost;
}

std::vector<double> JointProbe::on_event(int index, JointMoment& moment) const {
  Fed fed(*this, moment);
  fed.in.dissipated = &fed.lost;
  GuardedNumbers z(moment.z), h(moment.h);
  GuardedNumbers fields(layout_.events[how_many(index)].fields.size, std::numeric_limits<double>::quiet_NaN());
  if (!run("on_event", &moment,
           [&](Message& m) { return joint_.on_event(index, fed.in, z.span(), h.span(), fields.span(), m); })) {
    return {};
  }
  watch("on_event", fed, {&z, &h});
  watch("on_event", fed, {&fields}, true);
  add_loss("on_event", fed, moment);
  moment.z = z.values();
  moment.h = h.values();
  return fields.values();
}

void JointProbe::commit(JointMoment& moment) const {
  Fed fed(*this, moment);
  fed.in.dissipated = &fed.lost;
  GuardedNumbers h(moment.h), lambda(how_many(layout_.constraint_rows), 1.0);
  if (!run("commit", &moment, [&](Message& m) { return joint_.commit(fed.in, lambda.span(), h.span(), m); })) return;
  watch("commit", fed, {&h, &lambda});
  add_loss("commit", fed, moment);
  moment.h = h.values();
}

std::vector<double> JointProbe::all(const JointMoment& moment) const {
  std::vector<double> numbers;
  const auto add = [&numbers](const std::vector<double>& more) {
    numbers.insert(numbers.end(), more.begin(), more.end());
  };
  const ProbedRows r = rows(moment);
  for (const auto* part : {&r.phi, &r.jacobian, &r.nu, &r.gamma}) add(*part);
  if (layout_.coordinate != Coordinate::none) {
    const ProbedCoordinate c = coordinate(moment);
    add({c.value, c.bias});
    add(c.jacobian);
  }
  if (layout_.forces != 0) {
    const ProbedForces f = forces(moment, layout_.analytic_derivatives != 0);
    for (const auto* part : {&f.wrench, &f.z_rate, &f.derivatives}) add(*part);
    add({f.potential});
  }
  const ProbedEvents e = events(moment);
  add(e.g);
  add(e.rate);
  add(observe(moment));
  add({step_limit(moment), free_distance(moment)});
  return numbers;
}

JointMoment JointProbe::start(const MarkerPair& markers, double t) const {
  JointMoment moment{t, markers, 0.0, std::vector<double>(how_many(layout_.internal_variables)),
                     std::vector<double>(how_many(layout_.history))};
  initialize(moment);
  return moment;
}

}  // namespace freeplay
