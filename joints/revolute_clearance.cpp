#include <algorithm>
#include <cmath>

#include "freeplay/kit/contact_memory.h"
#include "freeplay/kit/contact_phase.h"
#include "freeplay/kit/friction_slopes.h"
#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "revolute_clearance_in_space.h"

namespace freeplay {
namespace play {
namespace {

using namespace planar;

/// Where the journal stands in the bearing, and how it moves.
struct Gap : Approach {
  Gap(const JointInput& in, const Radii& r)
      : e(position(*in.b) - position(*in.a)),
        e_rate(velocity(*in.b) - velocity(*in.a)),
        w_a(angular_velocity(*in.a)),
        w_b(angular_velocity(*in.b)),
        distance(e.norm()) {
    // Loses less than distance - clearance, a difference of nearly equal numbers.
    penetration = (e.squaredNorm() - r.clearance * r.clearance) / (distance + r.clearance);
    if (distance >= 1e-12 * r.clearance) n = e / distance;
    t = turned(n);
    rate = n.dot(e_rate);
    slip = t.dot(e_rate) + (r.known() ? r.journal * w_b - r.bearing * w_a : 0.0);
  }
  Eigen::Vector2d e, e_rate;  // eccentricity [m] and its rate [m/s]
  double w_a, w_b;            // [rad/s]
  double distance;            // |e| [m]
  double slip;                // v_T [m/s]
  Eigen::Vector2d n{1.0, 0.0}, t;
};

constexpr Event pin_contact_events[] = {{"contact_begin", Crossing::rising, 1, event_fields},
                                        {"contact_end", Crossing::falling, 1, event_fields}};
constexpr Channel plane_gap_channels[] = {{"ex", "m"}, {"ey", "m"},    {"delta", "m"},   {"fn", "N"},
                                          {"ft", "N"}, {"power", "W"}, {"contact", "1"}, {"vt", "m/s"}};
constexpr ChannelRole plane_gap_roles[] = {
    ChannelRole::eccentricity_x, ChannelRole::eccentricity_y, ChannelRole::penetration, ChannelRole::normal_force,
    ChannelRole::friction_force, ChannelRole::none,           ChannelRole::in_contact,  ChannelRole::slip_speed};

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
  explicit RevoluteClearance(const Parameters& p) : radii_(read_radii(p)), start_(p) {
    ContactPair pair{radii_.bearing, radii_.journal, radii_.clearance, p.number("clearance.length"), {}, {}};
    pair.bearing_shape = pair.journal_shape = SurfaceShape::cylinder;
    read_materials(p, pair);
    surfaces_ = Surfaces(pair);
    contact_law_ = p.contact_law("clearance.contact", pair);
    friction_law_ = p.friction_law("clearance.friction");
    internal_variables_ = friction_law_.internal_variables();
    if (internal_variables_ > static_cast<int>(most_internal_variables))
      throw BadParameter("clearance.friction", "out-of-range",
                         "this law has more internal variables than the joint keeps");
    memory_ = MemoryRules<most_internal_variables>(friction_law_);
    require_radii(radii_, friction_law_);
    if (p.given("clearance.axial_clearance"))
      throw BadParameter("clearance.axial_clearance", "type-space", "only a spatial model has play along the axis");
    refuse_tilt(p, "only a journal in a spatial model tilts in its bearing");
  }

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::angle;
    layout.planar_coordinate = 1;
    layout.forces_without_coordinate = 1;
    layout.internal_variables = internal_variables_;
    layout.history = slots;
    layout.forces = 1;
    layout.analytic_derivatives = 1;
    layout.clearance = radii_.clearance;
    surfaces_.declare(layout);
    layout.events = pin_contact_events;
    layout.event_roles = begin_and_end;
    layout.kinks = count_kinks(contact_law_, friction_law_);
    layout.channels = plane_gap_channels;
    layout.channel_roles = plane_gap_roles;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    row.value = relative_angle(*in.a, *in.b);
    write_turn(row.jacobian);
  }
  void apply(const JointInput& in, JointForces& out) const override {
    out.potential_rate = 0.0;
    if (flies(in) || !reaches(in)) return;
    const Gap gap(in, radii_);
    const Forces f = forces(in, gap, out.internal_rate);
    const Eigen::Vector2d on_b = -f.normal.normal * gap.n + f.friction.tangential * gap.t;
    for (int i = 0; i < 2; ++i) {
      out.wrench_a[i] = -on_b[i];
      out.wrench_b[i] = on_b[i];
    }
    out.wrench_a[5] = -arm_a(gap) * f.friction.tangential;
    out.wrench_b[5] = arm_b(gap) * f.friction.tangential;
    out.potential = f.normal.potential;
    out.potential_rate = storing_power(contact_law_, gap, f.normal);
    if (internal_variables_ > 0) add_stored(in, out);
    if (!out.derivatives.empty()) differentiate(in, gap, f, out.derivatives);
  }

  void initialize(const JointInput& in, Span<double> internal, Span<double> history) const override {
    std::copy_n(memory_.start, internal.size, internal.begin());
    start(in.t, Gap(in, radii_), history);
  }
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double dt,
                  Span<double> history) const override {
    if (play::begin_step(in, dt, history) && may_reach(in, acc, dt)) {
      history[predicted] = predict(Gap(in, radii_), acc, dt);
    }
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    write_events(in, Gap(in, radii_), g, rate);
  }
  void on_event(int index, const JointInput& in, Span<double> internal, Span<double> history,
                Span<double> fields) const override {
    const Gap gap(in, radii_);
    if (index == 0) {
      tell_begin(in, gap, history, fields);
      if (in.mobility != nullptr) {
        history[impact_time] =
            impact_duration(contact_law_, gap, radii_.clearance, inverse_mass(gap, in.mobility), 1.0);
      }
    } else {
      tell_end(in, gap, history, fields);
      forget(in, internal);
    }
    fields[1] = gap.slip;
    fields[2] = std::atan2(gap.e.y(), gap.e.x());
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    if (history[phase] == flight && !reaches(in)) return stay_in_flight(history);
    play::commit(in, Gap(in, radii_), contact_law_, 1.0, history);
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
        gap.e.x(), gap.e.y(), gap.penetration, normal, tangential, power, in.history[phase] == flight ? 0.0 : 1.0,
        gap.slip};
    std::copy(std::begin(values), std::end(values), channels.begin());
  }
  /// In flight the journal moves by no more than the clearance.
  double step_limit(const JointInput& in) const override {
    if (in.history[phase] == flight) {
      const double speed = Gap(in, radii_).e_rate.norm();
      return speed > 0.0 ? radii_.clearance / speed : unbounded;
    }
    return impact_step(in);
  }
  double free_distance(const JointInput& in) const override {
    if (in.history[phase] != flight) return 0.0;
    return std::max(0.0, radii_.clearance - (position(*in.b) - position(*in.a)).norm());
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    if (in.history[phase] == flight || !reaches(in)) return;
    const Gap gap(in, radii_);
    write_kinks(contact_law_, friction_law_, gap, gap.slip, in, g);
  }
  const char* warning(const JointInput& in) const override {
    if (in.history[phase] == flight || !reaches(in)) return nullptr;
    const Gap gap(in, radii_);
    return contact_law_.outside_range({gap.penetration, gap.rate, in.history[approach_speed]});
  }
  void initial_offset(Span<const double> reaction, InitialOffset& out) const override {
    out = start_.offset;
    if (!start_.loaded) return;
    const Eigen::Vector2d force(reaction[0], reaction[1]);
    const double size = force.norm();
    if (size < 1e-12) return;
    // The bearing pushes the journal along -n.
    const double distance = radii_.clearance + resting_penetration(contact_law_, radii_.clearance, size);
    for (int i = 0; i < 2; ++i) out.position[i] = -distance * force[i] / size;
  }

 private:
  struct Forces {
    ContactForce normal;
    FrictionForce friction;
  };

  /// Whether delta > 0, without the roots and quotients of a Gap: most journals fly most of the time.
  bool reaches(const JointInput& in) const {
    return (position(*in.b) - position(*in.a)).squaredNorm() > radii_.clearance * radii_.clearance;
  }
  /// Whether the journal can get to the bearing in a time dt with these accelerations: lengths are never more than
  /// the sums of their parts.
  bool may_reach(const JointInput& in, const MarkerAccelerations& acc, double dt) const {
    const auto length = [](const Eigen::Vector2d& x) { return std::abs(x.x()) + std::abs(x.y()); };
    const double way = dt * length(velocity(*in.b) - velocity(*in.a)) +
                       0.5 * dt * dt * length({acc.b[0] - acc.a[0], acc.b[1] - acc.a[1]});
    const double left = radii_.clearance - way;
    return !(left > 0.0 && (position(*in.b) - position(*in.a)).squaredNorm() < left * left);
  }
  void add_stored(const JointInput& in, JointForces& out) const {
    double slopes[most_internal_variables];
    out.potential += friction_law_.stored(in.internal, {slopes, in.internal.size});
    for (std::size_t k = 0; k < in.internal.size; ++k) out.potential_rate += slopes[k] * out.internal_rate[k];
  }
  /// The contact ends: what its memory stored is lost, and what it forgets is at its start again.
  void forget(const JointInput& in, Span<double> internal) const {
    double unused[most_internal_variables];
    if (in.dissipated != nullptr && internal.size > 0)
      *in.dissipated += friction_law_.stored(internal, {unused, internal.size});
    for (std::size_t k = 0; k < internal.size; ++k)
      if (memory_.forgets(k)) internal[k] = memory_.start[k];
  }
  double radius_a() const { return radii_.known() ? radii_.bearing : 0.0; }
  double radius_b() const { return radii_.known() ? radii_.journal : 0.0; }
  /// Distances of C from the origins of a and b, along n.
  double arm_a(const Gap& gap) const { return radius_a() + 0.5 * gap.penetration; }
  double arm_b(const Gap& gap) const { return radius_b() - 0.5 * gap.penetration; }

  /// Forces at delta > 0.
  Forces forces(const JointInput& in, const Gap& gap, Span<double> internal_rate) const {
    Forces f{};
    f.normal = normal_force(contact_law_, gap, in);
    f.friction = friction_law_.evaluate({f.normal.normal, gap.slip, in.internal}, internal_rate);
    return f;
  }

  /// Smallest root s in (0, dt] of delta + delta' s + delta'' s^2/2, with
  /// delta'' = n.e'' + (e'.e' - delta'^2)/|e|; returns v_0 = delta' + delta'' s, 0 without a root.
  double predict(const Gap& gap, const MarkerAccelerations& acc, double dt) const {
    if (gap.distance < 1e-12 * radii_.clearance) return 0.0;
    const Eigen::Vector2d e_second(acc.b[0] - acc.a[0], acc.b[1] - acc.a[1]);
    const double second = gap.n.dot(e_second) + (gap.e_rate.squaredNorm() - gap.rate * gap.rate) / gap.distance;
    return predicted_speed(gap, second, dt, [&](double s) { return (gap.e_rate + s * e_second).norm(); });
  }

  /// 1/m = n^T W n with the mobility W.
  static double inverse_mass(const Gap& gap, const double* mobility) {
    double sum = 0.0;
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k) sum += gap.n[i] * mobility[3 * i + k] * gap.n[k];
    return sum;
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

  void differentiate_internal(const JointInput& in, const Gap& gap, const Forces& f, const Gradient& normal_force,
                              const Gradient& slip, Span<double> derivatives) const {
    const std::size_t n = static_cast<std::size_t>(internal_variables_), size = 24 + n;
    FrictionSlopes slopes(friction_law_, f.normal.normal, gap.slip, in.internal);
    const double* const rate_by = slopes.rates();
    slopes.by_normal_force();
    Gradient rows[most_internal_variables];
    for (std::size_t i = 0; i < n; ++i) rows[i] = rate_by[i] * normal_force;
    slopes.by_slip();
    for (std::size_t i = 0; i < n; ++i) scatter(rows[i] + rate_by[i] * slip, derivatives.data + (12 + i) * size);
    for (std::size_t k = 0; k < n; ++k) {
      const double tangential = slopes.by_variable(k);
      const std::size_t column = 24 + k;
      for (std::size_t i = 0; i < 2; ++i) {
        derivatives[i * size + column] = -tangential * gap.t[static_cast<int>(i)];
        derivatives[(6 + i) * size + column] = tangential * gap.t[static_cast<int>(i)];
      }
      derivatives[5 * size + column] = -arm_a(gap) * tangential;
      derivatives[11 * size + column] = arm_b(gap) * tangential;
      for (std::size_t i = 0; i < n; ++i) derivatives[(12 + i) * size + column] = rate_by[i];
    }
  }

  Radii radii_;
  Surfaces surfaces_;
  ContactLawRef contact_law_;
  FrictionLawRef friction_law_;
  int internal_variables_ = 0;
  MemoryRules<most_internal_variables> memory_;
  Start start_;
};

constexpr auto revolute_clearance_parameters =
    joined(radius_rows, bearing_length_rows, law_rows, start_rows, tilt_start_rows);

}  // namespace
}  // namespace play

Component revolute_clearance() {
  using namespace play;
  return joint<RevoluteClearance>(
      {.name = "revolute-clearance",
       .space = Space::both,
       .summary = "Pin with play: the journal floats in the bearing and touches it by a contact law.",
       .formula =
           "e = P_b - P_a, n = e/|e|, t = n turned by +90 deg; delta = |e| - c, delta' = n.e', v_T = t.e' + R_J w_b "
           "- R_B w_a; force on the journal -F_N n + F_T t for delta > 0, at the middle of the two surface points. In "
           "space "
           "this at both end planes z_a = +-length/2 of the bearing, with half of the force at each, and shoulders "
           "that "
           "touch beyond the axial clearance.",
       .validity = "Clearance small against the radii; one contact point, rigid rings apart from it.",
       .references =
           "Flores and Ambrosio 2004, Comput Struct 82, 1359-1369; Lankarani and Nikravesh 1990, J Mech Des 112, "
           "369-376",
       .parameters = {revolute_clearance_parameters.data(), revolute_clearance_parameters.size()},
       .ideal = "revolute",
       .block = "clearance",
       .first_end = "bearing",
       .second_end = "journal",
       .axis = MarkerAxis::z,
       .in_space = revolute_clearance_in_space()});
}

}  // namespace freeplay
