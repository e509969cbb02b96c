// Rules of impacts: a free body is thrown against each contact, as in runs that end their steps at events and as in
// runs of one step size.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "component/joint_roles.h"
#include "contract/contact_poses.h"
#include "contract/impact_walk.h"
#include "contract/joint_contract.h"
#include "contract/joint_words.h"

namespace freeplay {
namespace {

using namespace trial;

constexpr double apart_before = 0.35;  // of the depth: how far apart the body starts
/// Of the steps that are asked for. A body of the mass m that a force K delta^n stops d deep, from the speed v, leaves
/// after
///
///   T = (d/v) 2 sqrt(pi) Gamma(1 + p)/Gamma(1/2 + p),   p = 1/(n + 1)
///
/// which is pi d/v for n = 1, 2.94 d/v for n = 3/2, and nears 2 d/v as n grows; damping makes it longer. So a joint
/// that takes any of these for its own law is right to 2/pi. One that takes a mass M in place of m finds (M/m)^p as
/// much: a body that turns as lightly as here has m = M/51, and a spring (p = 1/2) or a ball on a plane (p = 2/5) would
/// give it 0.14 or 0.21 of its steps.
constexpr double fewest_steps = per_contact * 2.0 / std::numbers::pi;
constexpr int finer = 8;        // parts of a step, where energy is gained
constexpr double light = 0.02;  // square of the body's radius of gyration by that of the contact's lever

struct Impact {
  double energy = 0.0, most_energy = 0.0, end_energy = 0.0;  ///< [J]
  double deepest = 0.0, largest_push = 0.0;                  ///< [m], [N]
  double limit = unbounded;                                  ///< step_limit() after the begin [s]
  double begin_time = 0.0, end_time = 0.0, end_rate = 0.0;
  int begins = 0, ends = 0, others = 0;  ///< of this contact; begins of others
  std::vector<double> end_fields;
  bool sound = true, storms = false;
  JointMoment last;
};

class ImpactCheck {
 public:
  ImpactCheck(const JointProbe& probe, const ContactPose& pose, RandomNumbers& random, Findings& findings)
      : probe_(probe), pose_(pose), findings_(findings), depth_(shallow * pose.way) {
    const double arm = pose.lever();
    radius_ = std::max(std::sqrt(light) * arm, 0.1 * pose.way);
    for (const std::size_t i : moving_components(probe.space())) {
      if (i >= 6) any_[i] = random.between(-0.3, 0.3) / (i < 9 ? 1.0 : std::max(arm, pose.way));
    }
  }

  void run() {
    if (!choose_body()) return;
    const Impact located = impact(thrown(approach), per_contact), fixed = impact(thrown(approach), 0.0);
    judge(located, per_contact, approach);
    judge(fixed, 0.0, approach);
    if (!located.sound || !fixed.sound) return;
    judge_steps(located);
    if (located.ends == 1 && fixed.ends == 1) judge_modes(located, fixed);
    // Once more, slower, with what the first impact has left.
    JointMoment again = thrown(0.3 * approach);
    again.z = located.last.z;
    again.h = located.last.h;
    again.t = located.last.t;
    if (located.ends == 1) {
      Impact second = impact(again, per_contact);
      second.others += located.others;  // which may still be on
      judge(second, per_contact, 0.3 * approach);
    }
    JointMoment inside = probe_.start(with_twists(pose_.at(0.3 * depth_), pose_.closing(any_, 0.5 * approach)), 1.0);
    judge(impact(inside, per_contact), per_contact, 0.0);
  }

 private:
  template <class Words>
  void expect(const char* rule, bool held, const JointMoment& moment, Words&& words) {
    findings_.expect(rule, held, [&] {
      return fmt::format("{}: {}; a body of {:.3g} kg and {:.3g} kg m^2, {}", contact_word(probe_, pose_), words(),
                         body_.mass, body_.inertia, words_of(moment));
    });
  }
  JointMoment thrown(double speed) const {
    return probe_.start(with_twists(pose_.at(-apart_before * depth_), pose_.closing(any_, speed)), 1.0);
  }

  /// A body that the contact stops about `depth_` deep: what it stores there is the energy of the approach.
  bool choose_body() {
    JointMoment deep = thrown(approach);
    deep.per_contact = per_contact;
    deep.markers = with_twists(pose_.at(1e-9 * depth_), pose_.closing(any_, approach));
    probe_.on_event(pose_.begin, deep);
    deep.markers = with_twists(pose_.at(depth_), {});
    const ProbedForces f = probe_.forces(deep);
    const double stored = f.potential > 0.0 ? f.potential : 0.4 * depth_ * pose_.push(f.wrench);
    if (!(stored > 0.0)) return false;  // contact-acts reports it
    double inverse = 0.0;               // of the mass at the contact, for a body of 1 kg
    for (std::size_t i = 0; i < 6; ++i) {
      inverse += pose_.by_twist[i] * pose_.by_twist[i] / (i < 3 ? 1.0 : radius_ * radius_);
    }
    body_.mass = 2.0 * stored * inverse / (approach * approach);
    body_.inertia = body_.mass * radius_ * radius_;
    return true;
  }

  /// Of what gains energy only the part counts that shorter steps leave: friction at a light corner is stiff.
  Impact impact(const JointMoment& start, double steps) const {
    const Impact found = follow(start, steps, 1);
    return found.storms || !gains(found) ? found : follow(start, steps, finer);
  }
  static bool gains(const Impact& i) { return !(i.most_energy <= 1.02 * i.energy); }

  Impact follow(const JointMoment& start, double steps, int parts) const {
    const double duration = 3.0 * depth_ / approach, dt = duration / ((steps > 0.0 ? 60.0 : 120.0) * parts);
    ImpactWalk walk(probe_, start, body_, steps);
    Impact result;
    result.energy = result.most_energy = walk.energy();
    std::size_t known = 0;
    const auto note_events = [&] {
      for (; known < walk.handled().size(); ++known) {
        const ImpactWalk::Handled& event = walk.handled()[known];
        if (event.index == pose_.begin) {
          ++result.begins;
          result.begin_time = event.t;
          result.limit = probe_.step_limit(walk.now());
        } else if (event.index == pose_.end) {
          ++result.ends;
          result.end_time = event.t;
          result.end_rate = event.rate;
          result.end_fields = event.fields;
        } else if (event_role(probe_.layout(), static_cast<std::size_t>(event.index)) == EventRole::contact_begin) {
          ++result.others;
        }
      }
    };
    note_events();
    for (int i = 0; i < 720 * parts && result.ends == 0 && result.deepest < 20.0 * depth_; ++i) {
      result.sound = walk.step(dt);
      note_events();
      if (!result.sound) break;
      const double energy = walk.energy();
      result.most_energy = std::max(result.most_energy, energy);
      result.end_energy = energy;
      result.largest_push = std::max(result.largest_push, pose_.push(walk.wrench()));
      result.deepest = std::max(result.deepest, depth_of(walk.now()));
      if (depth_of(walk.now()) < -2.0 * apart_before * depth_) break;
    }
    result.storms = walk.storms();
    result.last = walk.now();
    return result;
  }
  /// By the shift along the normal and the turn, for as small ones as an impact has.
  double depth_of(const JointMoment& moment) const {
    JointMoment fresh = probe_.start(moment.markers, moment.t);
    const std::vector<double> g = probe_.events(fresh).g;
    const auto i = static_cast<std::size_t>(pose_.begin);
    return i < g.size() && !std::isnan(g[i]) ? g[i] : 0.0;
  }

  void judge(const Impact& i, double steps, double speed) {
    const char* how = steps > 0.0 ? "where steps end at events" : "in steps of one size";
    expect("event-storm", !i.storms, i.last, [&] { return fmt::format("its events do not end {}", how); });
    if (i.storms) return;
    expect("impact-energy", i.sound && !gains(i), i.last, [&] {
      return fmt::format("of {:.6g} J before the impact there are {:.6g} J in it {}", i.energy, i.most_energy, how);
    });
    expect("contact-acts", i.deepest < 20.0 * depth_, i.last, [&] {
      return fmt::format("a body that its force stops at {:.3g} m goes {:.3g} m deep {}", depth_, i.deepest, how);
    });
    if (!i.sound || i.deepest >= 20.0 * depth_) return;
    const bool left = depth_of(i.last) < 0.0;
    expect("impact-events", i.begins == 1 && (pose_.end < 0 || i.ends == (left ? 1 : 0)), i.last, [&] {
      return fmt::format("an impact of {:.3g} m/s reports {} begins and {} ends {}", speed, i.begins, i.ends, how);
    });
    if (i.begins == 1 && i.ends == 1) judge_fields(i, steps);
  }

  void judge_fields(const Impact& i, double steps) {
    const Event& end = probe_.layout().events[static_cast<std::size_t>(pose_.end)];
    const auto field = [&](const char* name) {
      const int at = field_index(end, name);
      return at < 0 || i.end_fields.empty() ? std::numeric_limits<double>::quiet_NaN()
                                            : i.end_fields[static_cast<std::size_t>(at)];
    };
    const double lasted = i.end_time - i.begin_time, reported = field("duration"), force = field("max_fn");
    expect("event-fields", std::isnan(reported) || std::abs(reported - lasted) <= 0.05 * lasted, i.last, [&] {
      return fmt::format("its end reports the duration {:.6g} s of an impact of {:.6g} s", reported, lasted);
    });
    if (steps > 0.0 && i.others == 0)  // else it was not alone in what is felt
      expect("event-fields", std::isnan(force) || std::abs(force - i.largest_push) <= 0.2 * i.largest_push, i.last,
             [&] {
               return fmt::format("its end reports the largest force {:.6g} N where {:.6g} N were the most", force,
                                  i.largest_push);
             });
  }

  /// Where friction at a light body is stiff both ways err by their steps: what the shorter ones leave counts.
  void judge_modes(Impact located, Impact fixed) {
    const auto off = [&] { return std::abs(located.end_energy - fixed.end_energy); };
    const auto agree = [&] { return off() <= 0.03 * located.energy; };
    for (const int parts : {finer, finer * finer}) {
      if (agree()) break;
      located = follow(thrown(approach), per_contact, parts);
      fixed = follow(thrown(approach), 0.0, parts);
    }
    expect("impact-modes", agree(), thrown(approach), [&] {
      return fmt::format(
          "an impact keeps {:.4g} of the energy where steps end at events and {:.4g} in steps of one size",
          located.end_energy / located.energy, fixed.end_energy / fixed.energy);
    });
  }

  // An impact that asks for too few steps is not resolved; one that asks for far too many does not come to its end. How
  // long one lasts that damping stops is not asked.
  void judge_steps(const Impact& i) {
    if (i.begins != 1 || i.ends != 1 || !(i.limit < unbounded) || -i.end_rate < 0.4 * approach) return;
    const double lasted = i.end_time - i.begin_time, taken = lasted / i.limit;
    expect("impact-steps", taken >= fewest_steps && taken <= 1e4, i.last, [&] {
      return fmt::format(
          "an impact of {:.3g} s has a step_limit() of {:.3g} s, which makes {:.3g} steps where {} are "
          "asked for",
          lasted, i.limit, taken, per_contact);
    });
  }

  const JointProbe& probe_;
  const ContactPose& pose_;
  Findings& findings_;
  double depth_, radius_ = 1.0;
  Twelve any_{};
  FreeBody body_;
};

}  // namespace

void check_impacts(const JointProbe& probe, const std::vector<ContactPose>& poses, RandomNumbers& random,
                   Findings& findings) {
  std::vector<std::size_t> done;
  for (const ContactPose& pose : poses) {
    if (std::ranges::find(done, pose.contact) != done.end()) continue;
    done.push_back(pose.contact);
    ImpactCheck(probe, pose, random, findings).run();
  }
}

}  // namespace freeplay
