// Rules of contacts, one at a time, where they begin: forces before and after their events, and what events report.
#include <algorithm>
#include <cmath>
#include <string_view>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "component/joint_roles.h"
#include "contract/contact_poses.h"
#include "contract/joint_contract.h"
#include "contract/joint_words.h"
#include "freeplay/eigen.h"

namespace freeplay {
namespace {

using namespace trial;

constexpr double unit_mass = 1.0;      // what feels a contact in on_event() [kg]
constexpr double unit_inertia = 1e-4;  // [kg m^2]

class ContactCheck {
 public:
  ContactCheck(const JointProbe& probe, const ContactPose& pose, RandomNumbers& random, Findings& findings)
      : probe_(probe), pose_(pose), findings_(findings), depth_(shallow * pose.way), t_(random.between(0.5, 1.0)) {
    for (std::size_t i = 0; i < 3; ++i) {
      mobility_[4 * i] = whole_[7 * i] = 1.0 / unit_mass;
      whole_[7 * (i + 3)] = 1.0 / unit_inertia;
    }
    for (const std::size_t i : moving_components(probe.space())) {
      if (i >= 6) any_[i] = random.between(-0.5, 0.5) * (i < 9 ? 1.0 : approach / std::max(pose.lever(), pose.way));
    }
  }

  void run() {
    push_ = pose_.push(forces(on(depth_, approach)));
    check_force_of_contact();
    check_force_before_event();
    check_force_of_prediction();
    check_beginning();
    check_pull();
    check_start();
    check_fields();
    check_others();
    check_numbers(apart(depth_), -depth_);
    check_numbers(on(depth_, approach), depth_);
  }

 private:
  template <class Words>
  void expect(const char* rule, bool held, const JointMoment& moment, Words&& words) {
    findings_.expect(rule, held,
                     [&] { return fmt::format("{}: {}, {}", contact_word(probe_, pose_), words(), words_of(moment)); });
  }
  std::vector<double> forces(const JointMoment& moment) const { return probe_.forces(moment).wrench; }
  static double size(const std::vector<double>& wrench) {
    return wrench.size() < 12 ? 0.0 : Eigen::Map<const Eigen::Vector3d>(&wrench[6]).norm();
  }
  MarkerPair markers(double depth, double rate) const {
    return with_twists(pose_.at(depth), pose_.closing(any_, rate));
  }
  MarkerPair still(double depth) const { return with_twists(pose_.at(depth), {}); }

  /// In flight, apart by `depth`, as a run that ends its steps at events has it.
  JointMoment apart(double depth) const {
    JointMoment moment = probe_.start(markers(-depth, approach), t_);
    moment.per_contact = per_contact;
    return moment;
  }
  void handle(int event, JointMoment& moment) const {
    moment.mobility = mobility_.data();
    if (probe_.layout().wants_whole_mobility != 0) moment.whole_mobility = whole_.data();
    probe_.on_event(event, moment);
    moment.mobility = moment.whole_mobility = nullptr;
  }
  /// A contact that began at its zero with the rate `approach`, and that has come to `depth` since.
  JointMoment on(double depth, double rate) const {
    JointMoment moment = apart(depth_);
    moment.markers = markers(1e-9 * depth_, approach);
    handle(pose_.begin, moment);
    moment.markers = markers(depth, rate);
    return moment;
  }

  void check_force_of_contact() {
    const JointMoment there = on(depth_, approach);
    expect("contact-acts", push_ > 0.0, there,
           [&] { return fmt::format("after its begin event, {:.3g} m deep, it pushes with {:.6g} N", depth_, push_); });
  }

  // An attempt that passes the event is thrown away; what it feels until then must be smooth.
  void check_force_before_event() {
    JointMoment past = apart(depth_);
    const double before = size(forces(past));
    past.markers = markers(depth_, approach);
    const double after = size(forces(past));
    expect("located", after <= before + 1e-2 * std::abs(push_), past, [&] {
      return fmt::format("{:.3g} m past an event that is not handled yet the force is {:.6g} N, where per_contact = 20",
                         depth_, after);
    });
    const ProbedEvents events = probe_.events(past);
    const auto i = static_cast<std::size_t>(pose_.begin);
    expect("located", i < events.g.size() && events.g[i] > 0.0, past, [&] {
      return fmt::format("its function is {:.6g} when the contact is {:.3g} m deep and its event not handled yet",
                         i < events.g.size() ? events.g[i] : 0.0, depth_);
    });
  }

  // In steps of one size a contact begins inside of a step, which integrates its force before the event is handled.
  void check_force_of_prediction() {
    JointMoment before = apart(depth_);
    before.per_contact = 0.0;
    JointMoment inside = before;
    probe_.begin_step(before, {}, 4.0 * depth_ / approach, inside);
    inside.markers = markers(depth_, approach);
    const double push = pose_.push(forces(inside));
    expect("prediction", std::abs(push - push_) <= 0.02 * std::abs(push_), inside, [&] {
      return fmt::format(
          "in a step of fixed size in which it begins it pushes with {:.6g} N, after its event with {:.6g} N", push,
          push_);
    });
  }

  // The elastic force starts from zero.
  void check_beginning() {
    JointMoment moment = on(depth_, approach);
    moment.markers = still(depth_);
    const double deep = size(forces(moment));
    moment.markers = still(1e-7 * depth_);
    const double first = size(forces(moment));
    expect("force-jump", first <= 1e-4 * deep, moment, [&] {
      return fmt::format("at rest it is {:.6g} N at {:.3g} m and still {:.6g} N at {:.3g} m", deep, depth_, first,
                         1e-7 * depth_);
    });
  }

  void check_pull() {
    for (const double leaving : {0.5, 1.0, 3.0}) {
      const JointMoment moment = on(depth_, -leaving * approach);
      const std::vector<double> wrench = forces(moment);
      const double push = pose_.push(wrench);
      expect("no-tension", push >= -1e-9 * size(wrench), moment,
             [&] { return fmt::format("when it opens it pulls with {:.6g} N", -push); });
    }
  }

  // Without an approach there is no damping that counts by its speed.
  void check_start() {
    for (const double steps : {0.0, per_contact}) {
      JointMoment moment = probe_.start(still(depth_), t_);
      moment.per_contact = steps;
      const std::vector<double> g = probe_.events(moment).g;
      for (std::size_t i = 0; i < g.size(); ++i) {
        if (probe_.layout().events[i].crossing == Crossing::rising && g[i] > 0.0)
          probe_.on_event(static_cast<int>(i), moment);
      }
      const double rest = pose_.push(forces(moment));
      expect("starts-in-contact", rest > 0.0, moment, [&] {
        return fmt::format("{:.3g} m deep at the start of a run it pushes with {:.6g} N, per_contact = {}", depth_,
                           rest, steps);
      });
      moment.markers = with_twists(still(depth_), pose_.closing({}, 0.01 * approach));
      const double pressed = pose_.push(forces(moment));
      expect("starts-in-contact", pressed <= 3.0 * std::abs(rest), moment, [&] {
        return fmt::format(
            "{:.3g} m deep at the start of a run it pushes with {:.6g} N at rest and with {:.6g} N when it closes with "
            "0.01 m/s, per_contact = {}",
            depth_, rest, pressed, steps);
      });
    }
  }

  void check_fields() {
    JointMoment moment = apart(depth_);
    moment.markers = markers(1e-9 * depth_, approach);
    const auto begin = static_cast<std::size_t>(pose_.begin);
    const int speed = field_index(probe_.layout().events[begin], "speed");
    if (speed < 0) return;
    moment.mobility = mobility_.data();
    if (probe_.layout().wants_whole_mobility != 0) moment.whole_mobility = whole_.data();
    const std::vector<double> fields = probe_.on_event(pose_.begin, moment);
    if (fields.empty()) return;
    const double reported = fields[static_cast<std::size_t>(speed)];
    expect("event-fields", std::isnan(reported) || std::abs(reported - approach) <= 1e-6 * approach, moment, [&] {
      return fmt::format("its begin reports the speed {:.9g} m/s where its function grows at {:.9g} m/s", reported,
                         approach);
    });
  }

  // An event of one contact changes no other.
  void check_others() {
    const JointMoment alone = on(depth_, approach);
    for (std::size_t i = 0; i < probe_.layout().events.size; ++i) {
      const auto event = static_cast<int>(i);
      if (event == pose_.begin || event == pose_.end || event_role(probe_.layout(), i) == EventRole::none) continue;
      JointMoment handled = alone;
      handle(event, handled);
      // The other one is apart here, whatever event was handled.
      const std::vector<double> before = forces(alone), after = forces(handled);
      double off = 0.0;
      for (std::size_t k = 0; k < std::min(before.size(), after.size()); ++k)
        off = std::max(off, std::abs(after[k] - before[k]));
      expect("contacts-apart", off <= 1e-9 * size(before), alone, [&] {
        return fmt::format("its force of {:.6g} N changes by {:.6g} N when '{}' is handled", size(before), off,
                           probe_.layout().events[i].name);
      });
    }
  }

  // Channels and contacts() against the event functions and the wrenches.
  void check_numbers(const JointMoment& moment, double depth) {
    const JointLayout& layout = probe_.layout();
    const std::vector<double> channels = probe_.observe(moment);
    double normal = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const ChannelRole role = channel_role(layout, i);
      if (role == ChannelRole::normal_force) normal = channels[i];
      const double touching = depth > 0.0 ? 1.0 : 0.0;
      if (role == ChannelRole::in_contact)
        expect("roles", channels[i] == touching, moment,
               [&] { return fmt::format("'{}' is {} and not {}", layout.channels[i].name, channels[i], touching); });
    }
    // A joint may count some of its contacts in its channels, as a bearing does without its shoulders.
    const bool counted = normal > 0.0;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (channel_role(layout, i) == ChannelRole::penetration && (counted || depth < 0.0))
        expect("roles", counted ? std::abs(channels[i] - depth) <= 0.5 * depth_ : channels[i] < 0.0, moment, [&] {
          return fmt::format("'{}' is {:.6g} m where the event function is {:.6g} m", layout.channels[i].name,
                             channels[i], depth);
        });
    }
    const std::vector<double> numbers = probe_.contacts(moment, contact_count(layout));
    const ProbedForces f = probe_.forces(moment);
    if (numbers.empty() || f.wrench.empty()) return;
    double sum = 0.0, lost = 0.0, power = 0.0, terms = 0.0;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      sum += numbers[i];
      lost += numbers[i + 2];
    }
    if (counted)
      expect("contact-numbers", std::abs(sum - normal) <= 1e-9 * std::abs(normal), moment,
             [&] { return fmt::format("contacts() gives {:.9g} N in all and the channel {:.9g} N", sum, normal); });
    const Twelve v = twists(moment.markers);
    for (std::size_t i = 0; i < v.size(); ++i) {
      power += f.wrench[i] * v[i];
      terms += std::abs(f.wrench[i] * v[i]);
    }
    // The speed of the surfaces and that of the point of action differ by a penetration times an angular velocity.
    double force = 0.0, turning = 0.0;
    for (const std::size_t i : {0u, 1u, 2u}) {
      force += std::abs(f.wrench[6 + i]);
      turning += std::abs(v[3 + i]) + std::abs(v[9 + i]);
    }
    const double least = force * std::max(depth, 0.0) * turning + 1e-6 * terms;
    if (!std::isnan(f.potential_rate))
      expect("contact-numbers", std::abs(lost + power + f.potential_rate) <= least, moment, [&] {
        return fmt::format("contacts() loses {:.9g} W and the forces {:.9g} W", lost, -power - f.potential_rate);
      });
  }

  const JointProbe& probe_;
  const ContactPose& pose_;
  Findings& findings_;
  double depth_, t_, push_ = 0.0;
  Twelve any_{};
  std::array<double, 9> mobility_{};
  std::array<double, 36> whole_{};
};

/// At rest, along a way on which further contacts close: where one does, or the force changes most, it may have a kink
/// and no jump.
class WayCheck {
 public:
  WayCheck(const JointProbe& probe, const ContactPose& pose, RandomNumbers& random)
      : probe_(probe), start_(probe.start(with_twists(pose.at(-shallow * pose.way), {}), 1.0)) {
    for (std::size_t i = 0; i < probe.layout().events.size; ++i) {
      if (event_role(probe.layout(), i) == EventRole::contact_begin) probe.on_event(static_cast<int>(i), start_);
    }
    constexpr double largest_tilt = 0.1;  // [rad]
    const double size = 1.5 * pose.way, turn = std::min(size / std::max(pose.lever(), pose.way), largest_tilt);
    Twelve way{};
    for (const std::size_t i : moving_components(probe.space())) {
      if (i >= 6) way[i] = random.between(-1.0, 1.0) * (i < 9 ? size : turn);
    }
    way_ = pose.closing(way, 4.0 * shallow * pose.way);
    Twelve deep = pose.closing({}, 2.0 * shallow * pose.way);
    there_ = start_;
    there_.markers = moved(start_.markers, deep);
    least_ = 1e-3 * size_of(probe.forces(there_).wrench);
  }

  void run(const ContactPose& pose, Findings& findings) {
    constexpr int points = 48;
    constexpr double deepest_part = 0.4;  // of the play: laws of lines end at half of it
    double most = 0.0, steepest = 0.0;
    for (int i = 0; i < points; ++i) {
      const double low = static_cast<double>(i) / points, high = static_cast<double>(i + 1) / points;
      if (deepest(high) > deepest_part * pose.way) break;
      if (signs(low) != signs(high)) judge(pose, low, high, true, findings);
      if (const double step = apart(wrench(low), wrench(high)); step > most) most = step, steepest = low;
    }
    judge(pose, steepest, steepest + 1.0 / points, false, findings);
  }

 private:
  JointMoment& at(double s) {
    Twelve by = way_;
    for (double& x : by) x *= s;
    there_.markers = moved(start_.markers, by);
    return there_;
  }
  std::vector<double> wrench(double s) { return probe_.forces(at(s)).wrench; }
  /// As contacts that have not begun see it.
  double deepest(double s) {
    const JointMoment fresh = probe_.start(at(s).markers, there_.t);
    const std::vector<double> g = probe_.events(fresh).g;
    double most = 0.0;
    for (std::size_t i = 0; i < g.size(); ++i) {
      if (event_role(probe_.layout(), i) == EventRole::contact_begin && g[i] > most) most = g[i];
    }
    return most;
  }
  std::vector<bool> signs(double s) {
    std::vector<bool> result;
    for (const double g : probe_.events(at(s)).g) result.push_back(g > 0.0);
    return result;
  }
  static double apart(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 6; i < std::min({a.size(), b.size(), std::size_t{9}}); ++i) sum += std::abs(a[i] - b[i]);
    return sum;
  }
  static double size_of(const std::vector<double>& wrench) { return apart(wrench, std::vector<double>(12, 0.0)); }

  void judge(const ContactPose& pose, double low, double high, bool by_signs, Findings& findings) {
    constexpr int halvings = 32;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (low + high);
      const bool before = by_signs ? signs(low) != signs(middle)
                                   : apart(wrench(low), wrench(middle)) > apart(wrench(middle), wrench(high));
      (before ? high : low) = middle;
    }
    const std::vector<double> here = wrench(low), beyond = wrench(high);
    const double jump = apart(here, beyond), size = std::max({size_of(here), size_of(beyond), least_});
    findings.expect("force-jump", jump <= 1e-3 * size, [&] {
      return fmt::format("{}: at rest, with all contacts begun, the force jumps by {:.6g} N of {:.6g} N, {}",
                         contact_word(probe_, pose), jump, size, words_of(at(high)));
    });
  }

  const JointProbe& probe_;
  JointMoment start_, there_;
  Twelve way_{};
  double least_ = 0.0;
};

}  // namespace

void check_contacts(const JointProbe& probe, const std::vector<ContactPose>& poses, RandomNumbers& random,
                    Findings& findings) {
  for (const ContactPose& pose : poses) {
    ContactCheck(probe, pose, random, findings).run();
    for (int i = 0; i < 3; ++i) WayCheck(probe, pose, random).run(pose, findings);
  }
}

}  // namespace freeplay
