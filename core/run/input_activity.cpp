#include "run/input_activity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/index.h"
#include "model/element_name.h"
#include "model/time_function.h"
#include "system/guard_marks.h"

namespace freeplay {
namespace {

constexpr double fewest_samples = 8.0;  // in a step, besides its ends, its middle and its quarters
constexpr double part_of_form = 0.25;   // as long as a step may be where such a motion has one form for a while
constexpr double slow = 2.0;            // rate times step that every integrator sees
constexpr double slow_load = 0.5;       // of a short load
constexpr double slow_bend = 0.4;       // of a motion whose powers are integrated and whose forces have their peaks
constexpr double coarsest = 0.5;        // of the shortest change: no step up to there goes over one
constexpr double finest = 1.0 / 32.0;   // of it: where a change begins it is taken in parts as small as that
constexpr double hidden_after = 64.0, hidden_before = 8.0, hidden_jump = 16.0;
constexpr int seen_degree = 4;                           // of polynomials that integrators take as they are
constexpr double quick_load = 0.1, quick_motion = 0.01;  // of the run
constexpr double longer = 4.0;                           // the next step to look at, of one that had to be shortened

/// Steps up to there need not be looked at; after one that had to be shortened a change goes on.
double unwatched(double shortest, double most) { return (most < unbounded ? finest : coarsest) * shortest; }

/// Instants in the middle of equal parts.
struct EvenInstants {
  double time, by;
  double operator()() { return std::exchange(time, time + by); }
};
auto even(double apart) {
  return [apart](double t, double dt) {
    const double by = dt / std::max(fewest_samples, std::ceil(dt / apart));
    return EvenInstants{t + 0.5 * by, by};
  };
}

/// The points of a table and the middles between them.
struct TableInstants {
  const TimeTable* table;
  double time, point;
  bool at_point = true;
  double operator()() {
    if (at_point) {
      const double next = table->next_point(point);
      if (!std::isfinite(next)) return next;
      time = 0.5 * (point + next), point = next, at_point = false;
      return time;
    }
    at_point = true;
    return point;
  }
};

}  // namespace

InputActivity::Unit InputActivity::unit_of(DriverKind kind) {
  switch (kind) {
    case DriverKind::force:
      return Unit::force;
    case DriverKind::torque:
      return Unit::torque;
    case DriverKind::position:
      return Unit::length;
    case DriverKind::angle:
      return Unit::angle;
    case DriverKind::velocity:
      break;
  }
  return Unit::other;
}

InputActivity::InputActivity(const System& system, double shortest, double allowed, IdleLoads* idle)
    : system_(system),
      start_(system.model().settings.start),
      end_(system.model().settings.end),
      shortest_(shortest),
      light_(system, allowed),
      idle_(idle),
      short_length_(light_.length()),
      small_angle_(short_length_ / system.size()),
      resolution_(0) {
  const Model& model = system.model();
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const Driver& driver = model.drivers[at(d)];
    const CornerKind sharp = prescribes(driver.kind) ? CornerKind::motion : CornerKind::load;
    const std::optional<ActsOn> on = prescribes(driver.kind) ? std::nullopt : std::optional(acts_on(system, driver));
    if (driver.table) {
      tables_.push_back({&driver.name, driver.table.get(), sharp, unit_of(driver.kind), bends(d), load_on(on)});
    } else if (driver.kinematics < 0) {
      add("driver", driver.name, driver.value, sharp, unit_of(driver.kind), bends(d), on);
    }
    for (const Expression& part : driver.in_time)
      add("driver", driver.name, part, CornerKind::load, Unit::other, 0, on);
  }
  for (const InverseKinematics& entry : model.kinematics) {
    int moved = 0;
    for (int d = entry.first_driver; d < entry.first_driver + entry.driver_count; ++d)
      moved = std::max(moved, bends(d));
    for (const std::optional<Expression>& component : entry.path.functions) {
      if (component) add("driver", entry.name, *component, CornerKind::motion, Unit::other, moved);
    }
    for (const auto& table : entry.path.tables) {
      if (table) tables_.push_back({&entry.name, table.get(), CornerKind::motion, Unit::other, moved});
    }
  }
  for (const AppliedForce& force : model.forces) {
    // What a part of a formula makes of a force is not known.
    const Unit whole = force.kind == ForceKind::force ? Unit::force : Unit::torque;
    const Unit unit = force.by_motion.empty() ? whole : Unit::other;
    const ActsOn on = acts_on(system, force);
    for (const Expression& component : force.in_time)
      add("force", force.name, component, CornerKind::load, unit, 0, on);
  }
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) add_joint(j);
  std::size_t signals = 2;
  for (const TimedJoint& joint : joints_) signals = std::max(signals, joint.signals);
  resolution_ = StepResolution(signals);
}

// The accelerations of driven bodies make forces and powers, but no error of an integrator.
int InputActivity::bends(int driver) const {
  if (system_.layout().driver_row(driver) < system_.layout().nc()) return 0;
  return system_.model().drivers[at(driver)].kind == DriverKind::velocity ? 1 : 2;
}

void InputActivity::add(const char* section, const std::string& name, const Expression& expression, CornerKind sharp,
                        Unit unit, int bends, const std::optional<ActsOn>& on) {
  if (!expression.depends_on_time()) return;
  formulas_.push_back({section, &name, &expression, FormulaCourse(expression, start_, end_), sharp, unit, shortest_,
                       bends, load_on(on)});
}

int InputActivity::load_on(const std::optional<ActsOn>& on) const {
  return idle_ != nullptr && on ? idle_->add(*on) : -1;
}

double InputActivity::negligible(Unit unit, double dt) const {
  switch (unit) {
    case Unit::force:
      return light_.force(dt);
    case Unit::torque:
      return light_.torque(dt);
    case Unit::length:
      return short_length_;
    case Unit::angle:
      return small_angle_;
    case Unit::other:
      break;
  }
  return 0.0;
}

void InputActivity::add_joint(int joint) {
  const JointElement& element = system_.model().joints[at(joint)];
  if (element.gear >= 0) return;
  if (element.parameters) {
    for (const auto& [name, value] : element.parameters->values) {
      if (const Expression* written = written_expression(value))
        add(section_of(element), element.name, *written, CornerKind::motion, Unit::other);
    }
  }
  const ActsOn on = acts_on(system_, element);
  for (const Expression& part : element.in_time)
    add(section_of(element), element.name, part, CornerKind::load, Unit::other, 0, on);
  double corner = 0.0;
  Fault fault;
  if (!ask(joint, start_, corner, fault) || corner < unbounded) telling_.push_back({joint});
  const JointLayout& layout = system_.joints().layout(joint);
  const std::size_t rows = at(layout.constraint_rows), internal = at(layout.internal_variables);
  const std::size_t signals = rows + (layout.forces != 0 ? 12 + internal : 0);
  if (signals == 0 || layout.time_scale == unbounded) return;
  joints_.push_back({joint, layout.time_scale > 0.0 ? layout.time_scale : shortest_, signals, load_on(on)});
  rate_.resize(std::max(rate_.size(), internal + guard::marks));
  for (std::vector<double>* numbers : {&phi_, &nu_, &gamma_}) numbers->resize(std::max(numbers->size(), rows));
  jacobian_.resize(std::max(jacobian_.size(), 12 * rows));
}

bool InputActivity::ask(int joint, double t, double& corner, Fault& fault) const {
  corner = unbounded;
  if (system_.joints().handle(joint).next_corner(t, corner, fault.message) && corner > t) return true;
  if (!(corner > t))
    abi::copy_text(fault.message.text, sizeof fault.message.text, "its next corner is not a later time");
  fault.kind = Fault::Kind::plugin;
  fault.joint = joint;
  return false;
}

bool InputActivity::next_corner(double t, double until, double& corner, Fault& fault) {
  if (t >= told_from_ && t < told_ && until <= told_until_) {
    corner = told_;
    return true;
  }
  corner = unbounded;
  for (Formula& formula : formulas_) {
    if (formula.course.has_sides()) corner = std::min(corner, formula.course.next_corner(t, until));
  }
  for (const Table& table : tables_) corner = std::min(corner, table.table->next_kink(t));
  for (const auto& [joint, between] : telling_) {
    double theirs = unbounded;
    if (!ask(joint, t, theirs, fault)) return false;
    corner = std::min(corner, theirs);
  }
  told_from_ = t, told_until_ = corner <= until ? unbounded : until, told_ = corner;
  return true;
}

CornerKind InputActivity::kind_of(double corner, double margin) const {
  const double from = corner - margin, to = corner + margin, before = from - margin;
  CornerKind kind = CornerKind::smooth;
  for (const Formula& formula : formulas_) {
    if (formula.course.near(from, to).sharp) kind = std::max(kind, formula.sharp);
  }
  for (const Table& table : tables_) {
    if (table.table->next_kink(before) <= to) kind = std::max(kind, table.sharp);
  }
  for (const auto& [joint, between] : telling_) {
    double theirs = unbounded;
    Fault fault;
    if (!ask(joint, before, theirs, fault) || theirs <= to) kind = CornerKind::motion;
  }
  return kind;
}

namespace {

constexpr std::size_t signals(int bends) { return bends > 0 ? 2 : 1; }
/// Of motions the acceleration is looked at, which shows more than the value.
constexpr double part_of(int bends) { return bends > 0 ? StepResolution::strict : StepResolution::finest; }

/// Fills the value of a formula or table and, if `bends`, that derivative.
template <class Function>
auto look_at(const Function& function, int bends) {
  return [&function, bends](double time, double* out) {
    Jet value;
    EvaluationFailure failure;
    if (!function.evaluate(time, value, failure)) return false;
    out[0] = value.value;
    if (bends > 0) out[1] = bends == 1 ? value.rate : value.acceleration;
    return true;
  };
}

}  // namespace

// An acceleration matters that moves a body by more than its position may err.
auto InputActivity::light(Unit unit, int bends) const {
  return [this, unit, bends](std::size_t c, double dt) {
    if (c == 0) return negligible(unit, dt);
    const bool turns = unit == Unit::angle;
    return bends == 1 ? 0.0 : (turns ? small_angle_ : short_length_) / (dt * dt);
  };
}

double InputActivity::resolved(double t, double dt) {
  if (t >= seen_from_ && t + dt <= seen_to_) return dt;
  for (Formula& formula : formulas_) dt = resolved_formula(formula, t, dt);
  for (Table& table : tables_) dt = resolved_table(table, t, dt);
  seen_from_ = t, seen_to_ = t + dt;
  return dt;
}

double InputActivity::quick(CornerKind sharp) const {
  return (sharp == CornerKind::motion ? quick_motion : quick_load) * (end_ - start_);
}

bool InputActivity::acts_quickly(double t) {
  const auto move_on = [&](Stretch& between, double next) {
    if (t < between.to) return;
    between = {between.to > -unbounded ? between.to : start_, next};
  };
  for (Formula& formula : formulas_) {
    const double longest = quick(formula.sharp);
    if (t < formula.quick_until || formula.course.length_of_change(t, 0, longest) <= longest) return true;
  }
  for (Table& table : tables_) {
    if (t < table.quick_until) return true;
    if (!table.table->is_straight()) continue;
    move_on(table.between, table.table->next_point(t));
    Jet value;
    EvaluationFailure failure;
    if (!(table.between.length() <= quick(table.sharp))) continue;
    if (!table.table->evaluate(t, value, failure) || value.rate != 0.0) return true;
  }
  for (auto& [joint, between] : telling_) {
    double corner = unbounded;
    Fault fault;
    if (t >= between.to && ask(joint, t, corner, fault)) move_on(between, corner);
    if (between.length() <= quick(CornerKind::load)) return true;
  }
  return std::ranges::any_of(joints_, [t](const TimedJoint& timed) { return t < timed.quick_until; });
}

// For powers of 0.1 to 1.8 that begin or end so far from a step these are bounds of what a pair of orders 5 and 4
// hides.
double InputActivity::hidden_error(double t, double dt) const {
  double times = 1.0;
  // What a joint makes of time may jump where it was seen to change.
  if (std::ranges::any_of(joints_, [t](const TimedJoint& timed) { return t < timed.quick_until; })) times = hidden_jump;
  for (const Formula& formula : formulas_) {
    if (formula.sharp == CornerKind::motion || !formula.course.has_sides()) continue;
    const FormulaCourse::Beside beside = formula.course.singular(t);
    if (beside.before < unbounded) times = std::max(times, hidden_after / (1.0 + 25.0 * beside.before / dt));
    if (beside.after < unbounded) {
      times = std::max(times, hidden_before / (1.0 + 16.0 * std::max(0.0, beside.after / dt - 1.0)));
    }
  }
  return times;
}

// A step from t of the length dt had to be shortened: the change is in it. It is none the slower where error control
// alone follows it once steps are short, and what comes once mostly comes again.
template <class Input>
void InputActivity::note_change(Input& input, double t, double dt, CornerKind sharp) const {
  if (dt <= quick(sharp)) input.quick_until = std::max(input.quick_until, t + quick(sharp));
}

// A motion is looked at for its acceleration as well where no integrator sees that, and a load closely.
double InputActivity::resolved_formula(Formula& formula, double t, double dt) {
  const bool closely = formula.bends > 0 || (is_idle(formula.load) && formula.sharp == CornerKind::load);
  const double rate = formula.course.rate_within(t, t + dt);
  if (formula.bends > 0) {
    if (std::isfinite(rate)) dt = std::min(dt, slow_bend / rate);
    dt = std::min(dt, part_of_form * formula.course.length_of_form(t, formula.bends));
  } else if (formula.sharp == CornerKind::load) {
    // In a single step over a ramp errors may cancel that a pair compares.
    const double length = formula.course.length_of_change(t, seen_degree, quick(formula.sharp));
    if (length < unbounded) dt = std::min(dt, part_of_form * length);
    if (length < unbounded && std::isfinite(rate)) dt = std::min(dt, slow_load / rate);
    if (closely && std::isfinite(rate)) dt = std::min(dt, slow_bend / rate);
  }
  if (rate * dt <= slow) return dt;
  if (dt <= (closely ? finest * formula.shortest : unwatched(formula.shortest, formula.most))) return dt;
  const double wanted = std::min(dt, formula.most), least = finest * formula.shortest;
  const double length = resolution_.resolved(
      t, wanted, least, closely ? unbounded : 0.0, signals(formula.bends), look_at(*formula.expression, formula.bends),
      even(formula.shortest / samples_per_change), light(formula.unit, formula.bends), part_of(formula.bends));
  if (length < wanted || resolution_.saw_bend()) note_change(formula, t, wanted, formula.sharp);
  formula.most = length < dt ? longer * length : unbounded;
  return length;
}

double InputActivity::resolved_table(Table& table, double t, double dt) {
  if (table.table->is_straight()) return dt;
  const double least = table.table->next_point(t) - t;
  if (dt <= least) return dt;
  const auto instants = [&](double from, double) { return TableInstants{table.table, from, from}; };
  const double wanted = std::min(dt, std::max(table.most, least));
  const double length = resolution_.resolved(
      t, wanted, least, is_idle(table.load) && table.sharp == CornerKind::load ? unbounded : 0.0, signals(table.bends),
      look_at(*table.table, table.bends), instants, light(table.unit, table.bends), part_of(table.bends));
  if (length < wanted) note_change(table, t, wanted, table.sharp);
  table.most = length < dt ? longer * length : unbounded;
  return length;
}

bool InputActivity::resolved_by_joints(const Point& here, const Evaluation& e, double t, double& dt, Fault& fault) {
  for (TimedJoint& timed : joints_) {
    if (dt <= unwatched(timed.shortest, timed.varies ? 0.0 : timed.most)) continue;
    bool good = true;
    const bool idle = is_idle(timed.load);
    const JointInput in = system_.joints().input(timed.joint, here, e);
    const auto look = [&](double time, double* out) { return good = signals_of(timed, in, time, out, fault); };
    const std::size_t wrenches = system_.joints().layout(timed.joint).forces != 0 ? 12 : 0;
    const auto light = [&](std::size_t c, double step) {
      return c >= wrenches ? 0.0 : negligible(c % 6 < 3 ? Unit::force : Unit::torque, step);
    };
    const double wanted = std::min(dt, timed.most), least = finest * timed.shortest;
    const double strict_below = idle ? unbounded : coarsest * timed.shortest;
    const double length = resolution_.resolved(t, wanted, least, strict_below, timed.signals, look,
                                               even(timed.shortest / samples_per_change), light,
                                               idle ? StepResolution::finest : StepResolution::strict);
    if (!good) return false;
    if (length < wanted) note_change(timed, t, wanted, CornerKind::load);
    timed.varies = timed.varies || length < wanted || resolution_.saw_change();
    if (length < dt || here.t == t) timed.most = length < dt ? longer * length : unbounded;
    dt = length;
  }
  return true;
}

// Wrenches, rates of internal variables and residuals of the rows, at another time than the input's.
bool InputActivity::signals_of(const TimedJoint& timed, JointInput in, double t, double* out, Fault& fault) {
  const JointLayout& layout = system_.joints().layout(timed.joint);
  const JointRef& joint = system_.joints().handle(timed.joint);
  in.t = t;
  bool good = true;
  if (layout.forces != 0) {
    JointForces forces{};
    const Span<double> rate(rate_.data(), at(layout.internal_variables));
    std::ranges::fill(rate, 0.0);
    forces.internal_rate = rate;
    good = joint.apply(in, forces, fault.message);
    out = std::copy_n(forces.wrench_a, 6, out);
    out = std::copy_n(forces.wrench_b, 6, out);
    out = std::copy(rate.begin(), rate.end(), out);
  }
  if (const std::size_t rows = at(layout.constraint_rows); good && rows > 0) {
    const auto zeroed = [](std::vector<double>& numbers, std::size_t count) {
      std::fill_n(numbers.begin(), count, 0.0);
      return Span<double>(numbers.data(), count);
    };
    ConstraintRows made{zeroed(phi_, rows), zeroed(jacobian_, 12 * rows), zeroed(nu_, rows), zeroed(gamma_, rows)};
    good = joint.constrain(in, made, fault.message);
    std::copy_n(phi_.begin(), rows, out);
  }
  if (good) return true;
  fault.kind = Fault::Kind::plugin;
  fault.joint = timed.joint;
  return false;
}

}  // namespace freeplay
