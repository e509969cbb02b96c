#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "freeplay/plugin.h"
#include "planar_marker.h"

namespace freeplay {
namespace {

using namespace planar;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Radii [m] of the journal and of its bearing. Those that the file leaves open are NaN; the clearance is known.
struct Radii {
  double bearing, journal, clearance;
  bool known() const { return !std::isnan(bearing); }
};

/// Reads two of three, all three that agree to 1e-9 of the clearance, or the clearance alone. Throws BadParameter.
Radii read_radii(const Parameters& p) {
  Radii r{p.number("clearance.bearing_radius"), p.number("clearance.journal_radius"),
          p.number("clearance.radial_clearance")};
  const bool bearing = !std::isnan(r.bearing), journal = !std::isnan(r.journal), gap = !std::isnan(r.clearance);
  if (!gap && !(bearing && journal))
    throw BadParameter("clearance", "missing-key",
                       "give two of 'bearing_radius', 'journal_radius' and 'radial_clearance'");
  if (bearing && journal && !(r.journal < r.bearing))
    throw BadParameter("clearance.journal_radius", "out-of-range", "'journal_radius' must be below 'bearing_radius'");
  if (bearing && journal && gap && !(std::abs(r.bearing - r.journal - r.clearance) <= 1e-9 * r.clearance))
    throw BadParameter("clearance.radial_clearance", "conflicting-keys",
                       "'radial_clearance' is not 'bearing_radius' minus 'journal_radius'");
  if (bearing && gap && !(r.clearance < r.bearing))
    throw BadParameter("clearance.radial_clearance", "out-of-range",
                       "'radial_clearance' must be below 'bearing_radius'");
  // All three come from the two that keep the difference exact.
  if (!gap) r.clearance = r.bearing - r.journal;
  if (gap && bearing) r.journal = r.bearing - r.clearance;
  if (gap && !bearing && journal) r.bearing = r.journal + r.clearance;
  if (!bearing && !journal) r.bearing = r.journal = not_a_number;
  return r;
}

/// One block {E, nu}. Throws BadParameter when one of the two is missing.
Material read_material(const Parameters& p, const char* block, const char* modulus, const char* ratio) {
  const Material m{p.number(modulus), p.number(ratio)};
  if (std::isnan(m.youngs_modulus) != std::isnan(m.poisson_ratio))
    throw BadParameter(block, "missing-key", std::isnan(m.youngs_modulus) ? "'nu' without 'E'" : "'E' without 'nu'");
  return m;
}

/// Materials of both sides into `pair`: one for both, or one for each, or none (NaN). Throws BadParameter.
void read_materials(const Parameters& p, ContactPair& pair) {
  const Material both = read_material(p, "clearance.material", "clearance.material.E", "clearance.material.nu");
  pair.bearing =
      read_material(p, "clearance.material.bearing", "clearance.material.bearing.E", "clearance.material.bearing.nu");
  pair.journal =
      read_material(p, "clearance.material.journal", "clearance.material.journal.E", "clearance.material.journal.nu");
  const bool bearing = !std::isnan(pair.bearing.youngs_modulus), journal = !std::isnan(pair.journal.youngs_modulus);
  if (!std::isnan(both.youngs_modulus)) {
    if (bearing || journal)
      throw BadParameter("clearance.material", "conflicting-keys",
                         "give 'E' and 'nu' for both sides, or 'bearing' and 'journal'");
    pair.bearing = pair.journal = both;
  } else if (bearing != journal) {
    throw BadParameter("clearance.material", "missing-key", bearing ? "'journal' is missing" : "'bearing' is missing");
  }
}

/// Where the journal stands in the bearing, and how it moves.
struct Gap {
  Gap(const JointInput& in, const Radii& r)
      : e(position(*in.b) - position(*in.a)),
        e_rate(velocity(*in.b) - velocity(*in.a)),
        w_a(angular_velocity(*in.a)),
        w_b(angular_velocity(*in.b)),
        distance(e.norm()),
        // Loses less than distance - clearance, a difference of nearly equal numbers.
        penetration((e.squaredNorm() - r.clearance * r.clearance) / (distance + r.clearance)) {
    if (distance >= 1e-12 * r.clearance) n = e / distance;
    t = turned(n);
    rate = n.dot(e_rate);
    slip = t.dot(e_rate) + (r.known() ? r.journal * w_b - r.bearing * w_a : 0.0);
  }
  Eigen::Vector2d e, e_rate;  // eccentricity [m] and its rate [m/s]
  double w_a, w_b;            // [rad/s]
  double distance;            // |e| [m]
  double penetration;         // delta [m]
  double rate, slip;          // delta', v_T [m/s]
  Eigen::Vector2d n{1.0, 0.0}, t;
};

/// The joint's numbers in `history`.
enum Slot : std::size_t {
  phase,            ///< flight, contact or on_from_start
  approach_speed,   ///< v_0 of the present contact, 0: elastic part only [m/s]
  predicted,        ///< v_0 of a contact that begins in this step, 0: none [m/s]
  step_end,         ///< time at which an event counts as located at the end of the step [s]
  begin_time,       ///< of the present contact [s]
  max_force,        ///< of the present contact [N]
  max_penetration,  ///< of the present contact [m]
  steps,            ///< accepted steps of the present contact
  impact_time,      ///< how long the present contact lasts if it is an impact, 0: not known [s]
  slots
};

/// Values of `phase`. `on_from_start` is a contact that nobody has been told of: its begin event is still armed.
constexpr double flight = 0.0, contact = 1.0, on_from_start = 2.0;

/// v_0 is at least this [m/s]; laws divide by it.
constexpr double smallest_approach_speed = 1e-6;

/// Internal variables that a friction law may have here: derivatives are made on the stack.
constexpr std::size_t most_internal_variables = 8;

constexpr Channel event_fields[] = {
    {"speed", "m/s"}, {"tangential_speed", "m/s"}, {"direction", "rad"}, {"duration", "s"},
    {"max_fn", "N"},  {"max_delta", "m"},          {"steps", "1"}};
constexpr Event contact_events[] = {{"contact_begin", Crossing::rising, 1, event_fields},
                                    {"contact_end", Crossing::falling, 1, event_fields}};
constexpr Channel gap_channels[] = {{"ex", "m"}, {"ey", "m"},    {"delta", "m"},  {"fn", "N"},
                                    {"ft", "N"}, {"power", "W"}, {"contact", "1"}};

/// Pin with play, in the plane: the journal (radius R_J, marker b) floats in the bearing (radius R_B, marker a) and
/// touches it by a contact law and a friction law. No constraint rows. With origins P [m], angular velocities w
/// [rad/s], radial clearance c = R_B - R_J:
///
///   e = P_b - P_a      n = e/|e|    t = n turned by +90 degrees
///   delta = |e| - c = (e.e - c^2)/(|e| + c)    delta' = n.e'    v_T = t.e' + R_J w_b - R_B w_a
///   F_b = -F_N n + F_T t,  F_a = -F_b          for delta > 0, else zero; zero, too, for |e| < 1e-12 c
///
/// Both forces act at one point C = P_a + (R_B + delta/2) n = P_b + (R_J - delta/2) n, half-way between the two
/// surfaces, so that the pair has neither a resultant nor a moment. F_N comes from the contact law with the approach
/// speed v_0 = delta' at the instant the contact began, at least 1e-6 m/s, or 0 (elastic part only) for a contact that
/// is on at the start; v_0 is history and lasts until delta <= 0. Where steps end at events v_0 is the rate
/// there; else a contact that begins inside a step takes v_0 from the motion predicted with the accelerations at the
/// start of the step. Where only c is known, radii count as zero in
/// v_T and C: the law of friction is then inert and F_N passes through both origins. Flores and Ambrosio 2004, Comput
/// Struct 82; Lankarani and Nikravesh 1990.
class RevoluteClearance final : public Joint {
 public:
  explicit RevoluteClearance(const Parameters& p) : radii_(read_radii(p)) {
    ContactPair pair{radii_.bearing, radii_.journal, radii_.clearance, p.number("clearance.length"), {}, {}};
    read_materials(p, pair);
    contact_law_ = p.contact_law("clearance.contact", pair);
    friction_law_ = p.friction_law("clearance.friction");
    internal_variables_ = friction_law_.internal_variables();
    if (internal_variables_ > static_cast<int>(most_internal_variables))
      throw BadParameter("clearance.friction", "out-of-range",
                         "this law has more internal variables than the joint keeps");
    if (!radii_.known() && !friction_is_inert())
      throw BadParameter("clearance", "missing-key", "friction needs 'bearing_radius' or 'journal_radius'");
    read_start(p);
  }

  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::angle;
    layout.forces_without_coordinate = 1;
    layout.internal_variables = internal_variables_;
    layout.history = slots;
    layout.forces = 1;
    layout.analytic_derivatives = 1;
    layout.clearance = radii_.clearance;
    layout.events = contact_events;
    layout.channels = gap_channels;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    row.value = relative_angle(*in.a, *in.b);
    write_turn(row.jacobian);
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const Gap gap(in, radii_);
    out.potential_rate = 0.0;
    if (!touches(in, gap)) return;
    const Forces f = forces(in, gap, out.internal_rate);
    const Eigen::Vector2d on_b = -f.normal.normal * gap.n + f.friction.tangential * gap.t;
    for (int i = 0; i < 2; ++i) {
      out.wrench_a[i] = -on_b[i];
      out.wrench_b[i] = on_b[i];
    }
    out.wrench_a[5] = -arm_a(gap) * f.friction.tangential;
    out.wrench_b[5] = arm_b(gap) * f.friction.tangential;
    out.potential = f.normal.potential;
    const bool told = !std::isnan(f.normal.elastic);
    out.potential_rate =
        gap.rate * (told ? f.normal.elastic : contact_law_.evaluate({gap.penetration, 0.0, 0.0}).normal);
    if (!out.derivatives.empty()) differentiate(in, gap, f, out.derivatives);
  }

  void initialize(const JointInput& in, Span<double> internal, Span<double> history) const override {
    std::fill(internal.begin(), internal.end(), 0.0);
    reset(history);
    if (Gap(in, radii_).penetration > 0.0) {
      history[phase] = on_from_start;
      history[begin_time] = in.t;
    }
  }
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double dt,
                  Span<double> history) const override {
    // A little inside, so that rounding of t + dt does not matter.
    history[step_end] = in.t + dt * (1.0 - 1e-9);
    const bool foresee = history[phase] == flight && in.per_contact == 0.0;
    history[predicted] = foresee ? predict(Gap(in, radii_), acc, dt) : 0.0;
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const Gap gap(in, radii_);
    g[0] = in.history[phase] != contact ? gap.penetration : not_a_number;
    g[1] = in.history[phase] != flight ? gap.penetration : not_a_number;
    rate[0] = rate[1] = gap.rate;
  }
  void on_event(int index, const JointInput& in, Span<double> internal, Span<double> history,
                Span<double> fields) const override {
    const Gap gap(in, radii_);
    std::fill(fields.begin(), fields.end(), not_a_number);
    fields[1] = gap.slip;
    fields[2] = std::atan2(gap.e.y(), gap.e.x());
    if (index == 0) {
      begin(in.t, gap.rate, in.t >= history[step_end], history);
      // The speed that the law uses: where the crossing lies inside the step, the motion behind it feels the contact.
      const bool exact = history[approach_speed] == 0.0 || in.per_contact > 0.0;
      fields[0] = exact ? std::max(gap.rate, 0.0) : history[approach_speed];
      if (in.mobility != nullptr) history[impact_time] = impact_duration(gap, in.mobility);
      return;
    }
    fields[0] = std::max(-gap.rate, 0.0);
    fields[3] = in.t - history[begin_time];
    fields[4] = history[max_force];
    fields[5] = history[max_penetration];
    fields[6] = history[steps] + 1.0;  // the step in which it ends
    std::fill(internal.begin(), internal.end(), 0.0);
    reset(history);
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const Gap gap(in, radii_);
    // Crossings that no event told, because delta stood at its zero to rounding when the step began.
    if (history[phase] == flight && gap.penetration > 0.0 && gap.rate > 0.0) begin(in.t, gap.rate, false, history);
    if (history[phase] != flight && gap.penetration <= 0.0 && gap.rate <= 0.0) reset(history);
    history[predicted] = 0.0;
    if (history[phase] == flight) return;
    // A contact that began at the very end of the step has not taken it.
    if (in.t > history[begin_time]) history[steps] += 1.0;
    if (!touches(in, gap)) return;
    const double force = contact_law_.evaluate({gap.penetration, gap.rate, history[approach_speed]}).normal;
    history[max_force] = std::max(history[max_force], force);
    history[max_penetration] = std::max(history[max_penetration], gap.penetration);
  }

  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    const Gap gap(in, radii_);
    double normal = 0.0, tangential = 0.0;
    if (touches(in, gap)) {
      double unused[most_internal_variables];
      const Forces f = forces(in, gap, {unused, static_cast<std::size_t>(internal_variables_)});
      normal = f.normal.normal;
      tangential = f.friction.tangential;
    }
    // Slip at the common point C, where both forces act; v_T is that of the two surfaces.
    const double slip_at_c = gap.slip - 0.5 * gap.penetration * (gap.w_a + gap.w_b);
    const double power = -normal * gap.rate + tangential * slip_at_c;
    const double values[] = {
        gap.e.x(), gap.e.y(), gap.penetration, normal, tangential, power, in.history[phase] == flight ? 0.0 : 1.0};
    std::copy(std::begin(values), std::end(values), channels.begin());
  }
  /// An impact: its duration over the steps that it should take; after twice its duration it is a lasting contact. In
  /// flight: the journal moves by no more than the clearance.
  double step_limit(const JointInput& in) const override {
    if (in.history[phase] == flight) {
      const double speed = Gap(in, radii_).e_rate.norm();
      return speed > 0.0 ? radii_.clearance / speed : unbounded;
    }
    const double duration = in.history[impact_time];
    const bool impact = duration > 0.0 && in.t - in.history[begin_time] < 2.0 * duration;
    return impact ? duration / std::max(in.per_contact, 1.0) : unbounded;
  }
  const char* warning(const JointInput& in) const override {
    const Gap gap(in, radii_);
    if (in.history[phase] == flight || !touches(in, gap)) return nullptr;
    return contact_law_.outside_range({gap.penetration, gap.rate, in.history[approach_speed]});
  }
  void initial_offset(Span<const double> reaction, InitialOffset& out) const override {
    out = start_;
    if (!loaded_) return;
    const Eigen::Vector2d force(reaction[0], reaction[1]);
    const double size = force.norm();
    if (size < 1e-12) return;
    // The bearing pushes the journal along -n.
    const double distance = radii_.clearance + resting_penetration(size);
    for (int i = 0; i < 2; ++i) out.position[i] = -distance * force[i] / size;
  }

 private:
  struct Forces {
    ContactForce normal;
    FrictionForce friction;
  };

  /// Forces that do not depend on slip: tried at an ordinary and at a very high speed, with a unit normal force.
  bool friction_is_inert() const {
    if (internal_variables_ != 0) return false;
    for (const double slip : {1.0, 1e6})
      if (friction_law_.evaluate({1.0, slip, {}}, {}).tangential != 0.0) return false;
    return true;
  }
  void read_start(const Parameters& p) {
    const int word = p.word("clearance.initial");
    loaded_ = word == 1;
    if (word >= 0) return;
    const auto eccentricity = p.vector("clearance.initial.eccentricity"),
               velocity = p.vector("clearance.initial.velocity");
    std::copy(eccentricity.begin(), eccentricity.end(), start_.position);
    std::copy(velocity.begin(), velocity.end(), start_.velocity);
  }

  /// Where steps end at events a flight lasts until its event: an attempt that passes it stays smooth.
  static bool touches(const JointInput& in, const Gap& gap) {
    return gap.penetration > 0.0 && (in.per_contact == 0.0 || in.history[phase] != flight);
  }
  double radius_a() const { return radii_.known() ? radii_.bearing : 0.0; }
  double radius_b() const { return radii_.known() ? radii_.journal : 0.0; }
  /// Distances of C from the origins of a and b, along n.
  double arm_a(const Gap& gap) const { return radius_a() + 0.5 * gap.penetration; }
  double arm_b(const Gap& gap) const { return radius_b() - 0.5 * gap.penetration; }

  /// Forces at delta > 0. In flight the contact begins in this very step: v_0 is the predicted one or, without
  /// prediction, that of the state itself.
  Forces forces(const JointInput& in, const Gap& gap, Span<double> internal_rate) const {
    Forces f{};
    if (in.history[phase] != flight) {
      f.normal = contact_law_.evaluate({gap.penetration, gap.rate, in.history[approach_speed]});
    } else if (in.history[predicted] > 0.0) {
      f.normal = contact_law_.evaluate({gap.penetration, gap.rate, in.history[predicted]});
    } else {
      f.normal = unpredicted(gap);
    }
    f.friction = friction_law_.evaluate({f.normal.normal, gap.slip, in.internal}, internal_rate);
    return f;
  }

  /// v_0 is the rate itself, which adds dF/dv_0 to dF/ddelta'; laws do not give it, so the sum is differenced.
  ContactForce unpredicted(const Gap& gap) const {
    const double v0 = std::max(gap.rate, smallest_approach_speed);
    ContactForce f = contact_law_.evaluate({gap.penetration, gap.rate, v0});
    if (gap.rate <= smallest_approach_speed) return f;
    const double step = std::min(1e-6 * gap.rate, gap.rate - smallest_approach_speed);
    const auto at = [&](double v) { return contact_law_.evaluate({gap.penetration, v, v}).normal; };
    f.d_rate = (at(gap.rate + step) - at(gap.rate - step)) / (2.0 * step);
    return f;
  }

  /// Smallest root s in (0, dt] of delta + delta' s + delta'' s^2/2, with
  /// delta'' = n.e'' + (e'.e' - delta'^2)/|e|; returns v_0 = delta' + delta'' s, 0 without a root.
  double predict(const Gap& gap, const MarkerAccelerations& acc, double dt) const {
    if (gap.distance < 1e-12 * radii_.clearance) return 0.0;
    if (gap.penetration >= 0.0) return gap.rate > 0.0 ? std::max(gap.rate, smallest_approach_speed) : 0.0;
    const Eigen::Vector2d e_second(acc.b[0] - acc.a[0], acc.b[1] - acc.a[1]);
    const double second = gap.n.dot(e_second) + (gap.e_rate.squaredNorm() - gap.rate * gap.rate) / gap.distance;
    const double discriminant = gap.rate * gap.rate - 2.0 * second * gap.penetration;
    if (discriminant < 0.0) return 0.0;
    // From flight, delta < 0, the first root is that of growing delta; each form of it keeps its digits.
    const double root = std::sqrt(discriminant);
    double s = unbounded;
    if (gap.rate >= 0.0) s = -2.0 * gap.penetration / (gap.rate + root);
    if (gap.rate < 0.0 && second > 0.0) s = (root - gap.rate) / second;
    if (!(s <= dt)) return 0.0;
    // Near the centre the parabola is poor; the speed of approach never exceeds the speed.
    const double speed = (gap.e_rate + s * e_second).norm();
    return std::max(std::min(gap.rate + second * s, speed), smallest_approach_speed);
  }

  /// A contact begins at time t with the rate `rate`. What is on from the start keeps v_0 = 0 and its time.
  /// Where the step ends at the crossing (`located`) the rate is exact; else the forces have used the prediction.
  static void begin(double t, double rate, bool located, Span<double> history) {
    const bool told_late = history[phase] == on_from_start;
    history[phase] = contact;
    if (told_late) return;
    const bool keep = history[predicted] > 0.0 && !located;
    history[approach_speed] = keep ? history[predicted] : std::max(rate, smallest_approach_speed);
    history[begin_time] = t;
    history[max_force] = history[max_penetration] = history[steps] = 0.0;
  }
  /// Flight; the end of the present step stays known.
  static void reset(Span<double> history) {
    const double end = history[step_end];
    std::fill(history.begin(), history.end(), 0.0);
    history[step_end] = end;
  }

  /// About 3 d/v_0 for an impact that ends at the greatest penetration d: 2.94 for F ~ delta^1.5, pi for a spring. d
  /// is where the law stores m v_0^2/2; 1/m = n^T W n with the mobility W.
  double impact_duration(const Gap& gap, const double* mobility) const {
    double inverse_mass = 0.0;
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k) inverse_mass += gap.n[i] * mobility[3 * i + k] * gap.n[k];
    const double speed = std::max(gap.rate, smallest_approach_speed), energy = 0.5 * speed * speed / inverse_mass;
    if (!(inverse_mass > 0.0)) return 0.0;
    // A law may refuse a penetration; the impact has not asked for it yet.
    const auto stored = [this](double d) {
      try {
        return contact_law_.evaluate({d, 0.0, 0.0}).potential;
      } catch (const std::exception&) {
        return unbounded;
      }
    };
    double low = 0.0, high = 1e-6 * radii_.clearance;
    for (int i = 0; i < 60 && stored(high) < energy; ++i) low = high, high *= 2.0;
    for (int i = 0; i < 10; ++i) (stored(0.5 * (low + high)) < energy ? low : high) = 0.5 * (low + high);
    return 2.9 * low / speed;
  }

  /// Penetration at which static contact carries `force` [N]: bisection with Newton steps where they stay inside.
  double resting_penetration(double force) const {
    const auto at = [this](double penetration) { return contact_law_.evaluate({penetration, 0.0, 0.0}); };
    double low = 0.0, high = 1e-6 * radii_.clearance;
    for (int i = 0; i < 60 && !(at(high).normal >= force); ++i) {
      low = high;
      high *= 2.0;
    }
    if (!(at(high).normal >= force)) throw std::runtime_error("the contact law cannot carry the load of the start");
    double x = high;
    for (int i = 0; i < 200 && high - low > 4e-16 * high; ++i) {
      const ContactForce f = at(x);
      if (f.normal == force) break;
      (f.normal < force ? low : high) = x;
      const double newton = x - (f.normal - force) / f.d_penetration;
      const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
      if (std::abs(next - x) <= 2e-16 * x) break;
      x = next;
    }
    return x;
  }

  /// Derivatives by (e_x, e_y, e'_x, e'_y, w_a, w_b); the origins of the markers are the centres, so that turning a
  /// marker changes nothing.
  using Gradient = Eigen::Matrix<double, 1, 6>;

  void differentiate(const JointInput& in, const Gap& gap, const Forces& f, Span<double> derivatives) const {
    Gradient penetration = Gradient::Zero(), rate = Gradient::Zero(), slip = Gradient::Zero(),
             along_t = Gradient::Zero();
    // dn = t (t.de)/|e| and dt = -n (t.de)/|e|
    along_t.segment<2>(0) = gap.t.transpose() / gap.distance;
    penetration.segment<2>(0) = gap.n.transpose();
    rate = gap.t.dot(gap.e_rate) * along_t;
    rate.segment<2>(2) = gap.n.transpose();
    slip = -gap.rate * along_t;
    slip.segment<2>(2) = gap.t.transpose();
    slip[4] = -radius_a();
    slip[5] = radius_b();

    const double tangential = f.friction.tangential;
    const Gradient normal_force = f.normal.d_penetration * penetration + f.normal.d_rate * rate;
    const Gradient friction = f.friction.d_normal * normal_force + f.friction.d_slip * slip;
    const int size = 24 + internal_variables_;
    for (int i = 0; i < 2; ++i) {
      const Gradient force =
          -gap.n[i] * (normal_force + tangential * along_t) + gap.t[i] * (friction - f.normal.normal * along_t);
      scatter(-force, derivatives.data + i * size);
      scatter(force, derivatives.data + (6 + i) * size);
    }
    scatter(-arm_a(gap) * friction - 0.5 * tangential * penetration, derivatives.data + 5 * size);
    scatter(arm_b(gap) * friction - 0.5 * tangential * penetration, derivatives.data + 11 * size);
    if (internal_variables_ > 0) differentiate_internal(in, gap, f, normal_force, slip, derivatives);
  }

  /// Columns of the joint: a displacement of b adds to e, one of a is taken from it.
  static void scatter(const Gradient& g, double* row) {
    for (int i = 0; i < 2; ++i) {
      row[i] = -g[i];
      row[6 + i] = g[i];
      row[12 + i] = -g[2 + i];
      row[18 + i] = g[2 + i];
    }
    row[17] = g[4];
    row[23] = g[5];
  }

  /// Friction laws give no derivatives of z' nor by z: those are central differences.
  void differentiate_internal(const JointInput& in, const Gap& gap, const Forces& f, const Gradient& normal_force,
                              const Gradient& slip, Span<double> derivatives) const {
    const std::size_t n = static_cast<std::size_t>(internal_variables_), size = 24 + n;
    double z[most_internal_variables], high[most_internal_variables], low[most_internal_variables];
    std::copy(in.internal.begin(), in.internal.end(), z);
    FrictionState state{f.normal.normal, gap.slip, {z, n}};
    const auto step_of = [](double x, double scale) { return 1e-5 * std::max(std::abs(x), scale); };

    const auto by = [&](double& x, double scale) {
      const double middle = x, step = step_of(x, scale);
      x = middle + step;
      const double above = friction_law_.evaluate(state, {high, n}).tangential;
      x = middle - step;
      const double below = friction_law_.evaluate(state, {low, n}).tangential;
      x = middle;
      for (std::size_t i = 0; i < n; ++i) high[i] = (high[i] - low[i]) / (2.0 * step);
      return (above - below) / (2.0 * step);
    };
    by(state.normal_force, 1.0);
    Gradient rows[most_internal_variables];
    for (std::size_t i = 0; i < n; ++i) rows[i] = high[i] * normal_force;
    by(state.slip_speed, 1e-3);
    for (std::size_t i = 0; i < n; ++i) scatter(rows[i] + high[i] * slip, derivatives.data + (12 + i) * size);
    for (std::size_t k = 0; k < n; ++k) {
      const double tangential = by(z[k], 1e-6);
      const std::size_t column = 24 + k;
      for (std::size_t i = 0; i < 2; ++i) {
        derivatives[i * size + column] = -tangential * gap.t[static_cast<int>(i)];
        derivatives[(6 + i) * size + column] = tangential * gap.t[static_cast<int>(i)];
      }
      derivatives[5 * size + column] = -arm_a(gap) * tangential;
      derivatives[11 * size + column] = arm_b(gap) * tangential;
      for (std::size_t i = 0; i < n; ++i) derivatives[(12 + i) * size + column] = high[i];
    }
  }

  Radii radii_;
  ContactLawRef contact_law_;
  FrictionLawRef friction_law_;
  int internal_variables_ = 0;
  bool loaded_ = false;
  InitialOffset start_{};
};

constexpr Parameter length(const char* name, const char* summary) {
  return {
      .name = name, .unit = "m", .default_value = optional, .minimum = 0.0, .open = Open::minimum, .summary = summary};
}
constexpr Parameter modulus(const char* name, const char* summary) {
  return {
      .name = name, .unit = "Pa", .default_value = optional, .minimum = 0.0, .open = Open::minimum, .summary = summary};
}
constexpr Parameter poisson(const char* name, const char* summary) {
  return {.name = name,
          .default_value = optional,
          .minimum = 0.0,
          .maximum = 0.5,
          .open = Open::maximum,
          .summary = summary};
}

constexpr Parameter parameters[] = {
    length("clearance.bearing_radius", "Inner radius of the ring on the first body."),
    length("clearance.journal_radius", "Radius of the pin on the second body."),
    length("clearance.radial_clearance", "Bearing minus journal radius."),
    length("clearance.length", "Axial length of the contact, for laws that need it."),
    modulus("clearance.material.E", "Young's modulus of both sides."),
    poisson("clearance.material.nu", "Poisson's ratio of both sides."),
    modulus("clearance.material.bearing.E", "Young's modulus of the bearing."),
    poisson("clearance.material.bearing.nu", "Poisson's ratio of the bearing."),
    modulus("clearance.material.journal.E", "Young's modulus of the journal."),
    poisson("clearance.material.journal.nu", "Poisson's ratio of the journal."),
    {.name = "clearance.contact",
     .kind = ParameterKind::contact_law,
     .default_value = required,
     .summary = "Law of the normal force."},
    {.name = "clearance.friction",
     .kind = ParameterKind::friction_law,
     .default_value = optional,
     .summary = "Law of the tangential force."},
    {.name = "clearance.initial",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "centered|loaded",
     .summary = "Start of the journal: in the middle, resting where static contact carries the load, or a map."},
    {.name = "clearance.initial.eccentricity",
     .kind = ParameterKind::vector,
     .unit = "m",
     .default_value = optional,
     .summary = "Journal centre minus bearing centre at the start, global axes."},
    {.name = "clearance.initial.velocity",
     .kind = ParameterKind::vector,
     .unit = "m/s",
     .default_value = optional,
     .summary = "Velocity of the journal centre relative to the bearing centre at the start, global axes."},
};

}  // namespace

Component revolute_clearance() {
  return joint<RevoluteClearance>(
      {.name = "revolute-clearance",
       .space = Space::planar,
       .summary = "Pin with play: the journal floats in the bearing and touches it by a contact law.",
       .formula =
           "e = P_b - P_a, n = e/|e|, t = n turned by +90 deg; delta = |e| - c, delta' = n.e', v_T = t.e' + R_J w_b "
           "- R_B w_a; force on the journal -F_N n + F_T t for delta > 0, at the middle of the two surface points.",
       .validity = "Clearance small against the radii; one contact point, rigid rings apart from it.",
       .references =
           "Flores and Ambrosio 2004, Comput Struct 82, 1359-1369; Lankarani and Nikravesh 1990, J Mech Des 112, "
           "369-376",
       .parameters = parameters,
       .ideal = "revolute",
       .block = "clearance",
       .first_end = "bearing",
       .second_end = "journal"});
}

}  // namespace freeplay
