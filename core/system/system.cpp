#include "system/system.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "model/whole_mass.h"

namespace freeplay {
namespace {

std::vector<planar::DrivenBody> bodies_driven(const Model& model, Variant variant, Unknowns unknowns) {
  if (variant != Variant::released || unknowns != Unknowns::free_bodies) return {};
  return planar::driven_bodies(model);
}

}  // namespace

System::System(const Model& model, Variant variant, Unknowns unknowns)
    : model_(model),
      variant_(variant),
      size_(model_size(model)),
      motions_(std::make_shared<Motions>(model)),
      coordinates_(model),
      driven_bodies_(bodies_driven(model, variant, unknowns)),
      layout_(model, variant, driven_bodies_),
      inertia_(model, layout_, coordinates_),
      markers_(model, layout_, coordinates_),
      joints_(model, variant, layout_, markers_),
      constraints_(model, layout_, markers_, joints_, *motions_),
      driven_(driven_bodies_, layout_, markers_, joints_, constraints_, inertia_, *motions_),
      forces_(model, layout_, markers_, joints_, inertia_, size_) {}

void System::take_start_of(const System& other) {
  motions_->take_starts_of(*other.motions_);
  constraints_.take_gear_offsets(other.constraints_);
}

void System::begin_at(const System& whole, const State& start, State& own) {
  share_motions(whole);
  take_start_of(whole);
  const std::size_t coordinates = at(layout_.body_coordinates()), velocities = at(layout_.body_velocities());
  own.t() = start.t();
  for (std::size_t place = 0; place < at(layout_.free_bodies()); ++place) {
    const std::size_t body = at(layout_.body_at(static_cast<int>(place)));
    std::copy_n(&start.q()[coordinates * body], coordinates, &own.q()[coordinates * place]);
    std::copy_n(&start.v()[velocities * body], velocities, &own.v()[velocities * place]);
    std::copy_n(&start.a()[velocities * body], velocities, &own.a()[velocities * place]);
  }
  const auto take_rows = [&](Slice to, Slice from) {
    for (int i = 0; i < to.size; ++i) own.lambda()[at(to.offset + i)] = start.lambda()[at(from.offset + i)];
  };
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    take_rows(layout_.rows(j), whole.layout_.rows(j));
  }
  for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
    if (layout_.driver_row(d) >= 0) take_rows({layout_.driver_row(d), 1}, {whole.layout_.driver_row(d), 1});
  }
  std::copy_n(start.z().begin(), layout_.nz(), own.z().begin());
  std::ranges::copy(start.h(), own.h().begin());
  if (driven_.empty()) return;
  Evaluation e(*this);
  if (!e.bring_to(own.t(), *motions_, e.fault.motion)) return;  // the run will meet it
  driven_.count_turns(start.q(), point(own), e);
}

// Inline, as what is called once in every step is elsewhere: a step of few bodies feels the call.
[[gnu::always_inline]] inline bool System::fill(const Point& point, unsigned terms, unsigned kept,
                                                Evaluation& e) const {
  e.fault.kind = Fault::Kind::none;
  const bool still = kept != 0;
  markers_.move(point, still, e);
  joints_.shift(e);
  const bool moves = !driven_.empty() || (terms & (term_position | term_force)) != 0;
  if (moves && !model_.drivers.empty() && !e.bring_to(point.t, *motions_, e.fault.motion)) {
    e.fault.kind = Fault::Kind::motion;
    return false;
  }
  if (!driven_.empty() && e.driven_time != point.t) driven_.place(point, e);
  if (!joints_.evaluate_coordinates(point, terms, e)) return false;
  if ((terms & (term_force | term_event)) != 0 && !forces_.applied().set_functions(point, e)) return false;
  if ((terms & term_position) != 0 && !constraints_.evaluate(point, terms & ~kept, still, e)) return false;
  return (terms & term_force) == 0 || forces_.evaluate(point, (terms & term_derivative) != 0, e);
}

bool System::evaluate(const Point& point, unsigned terms, KeptEvaluation& known, KeptEvaluation& out) const {
  constexpr unsigned of_joints = term_coordinate | term_event | term_turn;
  if (!known->is_at(point, terms & ~of_joints)) {
    return evaluate(point, terms, static_cast<Evaluation&>(out));
  }
  swap(out, known);
  if ((terms & of_joints) == 0) return true;
  return joints_.evaluate_coordinates(point, terms & of_joints, out) &&
         ((terms & term_event) == 0 || forces_.applied().set_functions(point, out));
}

bool System::evaluate(const Point& point, unsigned terms, Evaluation& e) const {
  const Profile::Timer timer(e.profile(), Phase::assembly);
  // At the end of a step velocities are projected where everything else stays.
  const bool all_placed = driven_.empty() || e.driven_time == point.t;
  unsigned kept = 0;
  if (all_placed && e.has_rows_at(point)) {
    // nu depends on time and coordinates alone; rows that are made one by one are made anew.
    kept = e.filled & (term_position | (constraints_.all_declared() ? term_velocity : 0u));
  }
  e.filled = 0;
  if (!fill(point, terms, kept, e)) return false;
  e.filled = terms;
  e.time = point.t;
  std::copy_n(point.z.begin(), e.z.size(), e.z.begin());  // the integrator may carry integrals after them
  std::copy_n(point.h.begin(), e.h.size(), e.h.begin());
  return true;
}

void System::complete_rates(unsigned terms, Evaluation& e) const {
  constraints_.fill_rates(terms & ~e.filled, e);
  e.filled |= terms;
}

}  // namespace freeplay
