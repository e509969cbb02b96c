#include "contract/impact_walk.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace freeplay {
namespace {

constexpr double at_once = 1e-6;  // part of a step after which an event that was armed late happens
constexpr int most_in_a_step = 8;

}  // namespace

ImpactWalk::ImpactWalk(const JointProbe& probe, const JointMoment& start, const FreeBody& body, double per_contact)
    : probe_(probe), body_(body), now_(start) {
  for (const std::size_t i : moving_components(probe.space())) {
    if (i >= 6) free_.push_back(i);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    mobility_[4 * i] = whole_mobility_[7 * i] = 1.0 / body.mass;
    whole_mobility_[7 * (i + 3)] = 1.0 / body.inertia;
  }
  now_.per_contact = per_contact;
  now_.mobility = now_.whole_mobility = nullptr;
  const std::vector<double> g = probe_.events(now_).g;
  armed_late_.resize(g.size(), 0);
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (probe_.layout().events[i].crossing == Crossing::rising && g[i] > 0.0) handle(i, now_, now_);
  }
  ahead_ = probe_.events(now_).g;
}

double ImpactWalk::energy() const {
  const Twelve v = twists(now_.markers);
  double sum = 0.0;
  for (std::size_t i = 6; i < 12; ++i) sum += 0.5 * (i < 9 ? body_.mass : body_.inertia) * v[i] * v[i];
  return sum + probe_.forces(now_).potential;
}

Twelve ImpactWalk::acceleration(const JointMoment& at) const {
  const std::vector<double> wrench = probe_.forces(at).wrench;
  Twelve result{};
  for (const std::size_t i : free_) {
    if (i < wrench.size()) result[i] = wrench[i] / (i < 9 ? body_.mass : body_.inertia);
  }
  return result;
}

/// Of b alone, by its mass.
Eigen::VectorXd ImpactWalk::pushed(const JointMoment& at) const {
  const Twelve by = acceleration(at);
  Eigen::VectorXd result(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) result[static_cast<Eigen::Index>(i)] = by[free_[i]];
  return result;
}

// Half of the way, all of the change of speed, half of the way; implicit in the speeds, to first order of their change,
// as friction at a light corner is stiff.
JointMoment ImpactWalk::attempt(double dt) const {
  JointMoment trial = now_;
  const Twelve v = twists(now_.markers);
  probe_.begin_step(now_, acceleration(now_), dt, trial);
  const auto after = [&](const Twelve& speed_of_rest) {
    Twelve by{};
    for (const std::size_t i : free_) by[i] = 0.5 * dt * (v[i] + speed_of_rest[i]);
    return by;
  };
  JointMoment middle = trial;
  middle.t += 0.5 * dt;
  middle.markers = with_twists(moved(now_.markers, after({})), v);
  const Eigen::VectorXd push = pushed(middle);
  Twelve faster = v;
  if (!push.isZero(0.0)) {
    const Eigen::Index n = push.size();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      constexpr double small = 1e-7;  // of speeds of about 1
      Twelve changed = v;
      const std::size_t i = free_[static_cast<std::size_t>(k)];
      const double change = small * std::max(1.0, std::abs(v[i]));
      changed[i] += change;
      JointMoment there = middle;
      there.markers = with_twists(middle.markers, changed);
      matrix.col(k) -= 0.5 * dt / change * (pushed(there) - push);
    }
    const Eigen::VectorXd gain = matrix.partialPivLu().solve(dt * push);
    for (Eigen::Index k = 0; k < n; ++k) faster[free_[static_cast<std::size_t>(k)]] += gain[k];
  }
  trial.t += dt;
  trial.markers = with_twists(moved(now_.markers, after(faster)), faster);
  advance_internal(probe_, trial, dt);
  return trial;
}

bool ImpactWalk::is_past(std::size_t event, double g) const {
  return (probe_.layout().events[event].crossing == Crossing::rising ? g : -g) > 0.0;
}

bool ImpactWalk::passes(const JointMoment& end) const {
  const std::vector<double> g = probe_.events(end).g;
  for (std::size_t i = 0; i < std::min(g.size(), ahead_.size()); ++i) {
    if (std::isnan(ahead_[i]) || !is_past(i, g[i])) continue;
    if (!is_past(i, ahead_[i]) || armed_late_[i] != 0) return true;
  }
  return false;
}

double ImpactWalk::length_to_event(double dt) const {
  double low = 0.0, high = dt;
  for (int i = 0; i < 44; ++i) {
    const double between = 0.5 * (low + high);
    (passes(attempt(between)) ? high : low) = between;
  }
  return high;
}

void ImpactWalk::handle(std::size_t event, const JointMoment& here, JointMoment& state) {
  const ProbedEvents functions = probe_.events(here);
  const bool begins = probe_.layout().events[event].crossing == Crossing::rising;
  JointMoment there = here;
  if (begins || here.per_contact > 0.0) {
    there.mobility = mobility_.data();
    if (probe_.layout().wants_whole_mobility != 0) there.whole_mobility = whole_mobility_.data();
  }
  there.z = state.z;
  there.h = state.h;
  const std::vector<double> fields = probe_.on_event(static_cast<int>(event), there);
  state.z = there.z;
  state.h = there.h;
  handled_.push_back({static_cast<int>(event), here.t, functions.g[event], functions.rate[event], fields});
}

// What one event makes possible does not happen at the same instant.
void ImpactWalk::handle_at_end(JointMoment& trial) {
  const std::vector<double> before = probe_.events(trial).g;
  for (std::size_t i = 0; i < std::min(before.size(), ahead_.size()); ++i) {
    if (std::isnan(ahead_[i]) || !is_past(i, before[i]) || (is_past(i, ahead_[i]) && armed_late_[i] == 0)) continue;
    const std::vector<double> now = probe_.events(trial).g;
    if (i < now.size() && is_past(i, now[i])) handle(i, trial, trial);
  }
  const std::vector<double> after = probe_.events(trial).g;
  for (std::size_t i = 0; i < after.size(); ++i) armed_late_[i] = std::isnan(before[i]) && is_past(i, after[i]) ? 1 : 0;
}

void ImpactWalk::handle_inside(JointMoment& trial) {
  std::vector<char> handled(ahead_.size(), 0);
  for (int round = 0; round < most_in_a_step; ++round) {
    JointMoment before = now_;
    before.z = trial.z;
    before.h = trial.h;
    const std::vector<double> g0 = probe_.events(before).g, g1 = probe_.events(trial).g;
    std::size_t next = g0.size();
    double earliest = 2.0;
    for (std::size_t i = 0; i < std::min(g0.size(), g1.size()); ++i) {
      if (std::isnan(g0[i]) || std::isnan(g1[i]) || !is_past(i, g1[i])) continue;
      const bool late = std::isnan(ahead_[i]) && handled[i] == 0;
      if (is_past(i, g0[i]) && !late) continue;
      const double part = late && is_past(i, g0[i]) ? 0.0 : g0[i] / (g0[i] - g1[i]);
      if (part < earliest) earliest = part, next = i;
    }
    if (next == g0.size()) return;
    handled[next] = 1;
    JointMoment there = trial;
    const double time = earliest * (trial.t - now_.t);
    const Twelve v0 = twists(now_.markers), v1 = twists(trial.markers);
    Twelve by{}, twist = v0;
    for (std::size_t i = 6; i < 12; ++i) {
      twist[i] += earliest * (v1[i] - v0[i]);
      by[i] = 0.5 * time * (v0[i] + twist[i]);
    }
    there.t = now_.t + time;
    there.markers = with_twists(moved(now_.markers, by), twist);
    handle(next, there, trial);
  }
}

bool ImpactWalk::step(double dt) {
  const bool located = now_.per_contact > 0.0;
  if (std::ranges::any_of(armed_late_, [](char late) { return late != 0; })) dt *= at_once;
  JointMoment trial = attempt(dt);
  if (located && passes(trial)) trial = attempt(length_to_event(dt));
  if (located) {
    handle_at_end(trial);
  } else {
    handle_inside(trial);
  }
  probe_.commit(trial);
  now_ = trial;
  ahead_ = probe_.events(now_).g;
  return !storms() && std::isfinite(energy());
}

}  // namespace freeplay
