// Simulation: what is saved of a run, and how it goes on.
#include <string>

#include "run/simulation_impl.h"

namespace freeplay {

// Lists everything that outlives a step but for what follows from the model and its start. `between` may keep memory of
// the integrator; evaluations hold what the next ones compare themselves with.
template <class Self, class Archive>
void Simulation::Impl::exchange(Self& self, Archive& archive) {
  archive(self.accepted, self.between, self.system, self.e_accepted, self.e_trial);
  if (self.own_between) archive(*self.own_between);
  archive(self.solver, self.control, self.energy, self.events, self.storm, self.resting, self.kinks, self.leg);
  archive(self.statistics, self.watch, self.peaks, self.speed_jumps, self.warning_values);
  archive(self.row, self.row_is_known, self.next_row, self.torn_from, self.explained_energy, self.corner_kind);
  archive(self.angle_then, self.turns_are_due, self.ended_inside, self.ended_abruptly);
  archive.list(self.first_forces);
  auto& outcome = self.outcome;
  archive(outcome.smallest_step, outcome.largest_step, outcome.steps, outcome.rejected, outcome.rows, outcome.events);
}

// Of a run from this start: what its states have in common with those of others that they may go on in.
Archive Simulation::Impl::features() const {
  Archive out;
  ArchiveWriter write(out);
  const Layout& layout = system.layout();
  write(layout.nq(), layout.nv(), layout.nc(), layout.all_rows(), layout.nz(), layout.nh(), flows, adaptive);
  write(std::string(settings.integrator_parameters.component->description.name), first_start.state);
  return out;
}

RunState Simulation::Impl::save() const {
  RunState out{.time = accepted.t(), .steps = outcome.steps, .rows = outcome.rows, .features = features()};
  ArchiveWriter write(out.numbers);
  write(inputs.has_value());
  if (inputs) write(*inputs);
  for (const Warning& warning : joint_warnings) {
    write(warning.text != nullptr, std::string(warning.text != nullptr ? warning.text : ""), warning.time);
  }
  exchange(*this, write);
  return out;
}

void Simulation::Impl::restore(const RunState& state) {
  ArchiveReader::require(state.features == features());
  ArchiveReader read(state.numbers);
  bool has_inputs = false;
  read(has_inputs);
  if (!has_inputs) inputs.reset();
  ArchiveReader::require(has_inputs == inputs.has_value());
  if (inputs) read(*inputs);
  warning_texts.resize(joint_warnings.size());
  for (std::size_t j = 0; j < joint_warnings.size(); ++j) {
    bool warned = false;
    read(warned, warning_texts[j], joint_warnings[j].time);
    joint_warnings[j].text = warned ? warning_texts[j].c_str() : nullptr;
  }
  exchange(*this, read);
  read.finish();
  outcome.time = accepted.t();
  resumed = true;
}

}  // namespace freeplay
