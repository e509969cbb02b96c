#include "run/context.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/index.h"
#include "component/declared.h"
#include "run/requirements.h"

namespace freeplay {
namespace {
// `flows`: integrals that the host would like to be carried along; taken by integrators that can.
IntegratorLayout declare(const System& system, int flows) {
  const Layout& layout = system.layout();
  const auto ask = [&](int more) {
    IntegratorLayout out;
    out.sizes = {layout.nq(), layout.nv(), layout.nc(), layout.nz() + more};
    Message message;
    const bool good = system.model().settings.integrator.declare(out, message);
    const std::string fault = good ? declaration_fault(out) : message.text;
    if (!good || !fault.empty()) {
      throw Error(Error::Category::plugin, "plugin-failed",
                  fmt::format("{} failed: {}", integrator_words(system.model()), fault));
    }
    return out;
  };
  const IntegratorLayout plain = ask(0);
  return plain.explicit_stages != 0 ? ask(flows) : plain;
}

}  // namespace

std::string integrator_words(const Model& model) {
  return "the integrator of " + model.instances.words_of(*model.settings.integrator_parameters.component);
}

int error_power(const IntegratorLayout& layout) {
  return layout.error_order > 0 ? layout.error_order : layout.order + 1;
}

double local_tolerance(const System& system) {
  const Settings& settings = system.model().settings;
  if (settings.accuracy > 0.0) return accuracy_per_step * settings.accuracy;
  double unit = system.size();
  for (int j = 0; j < static_cast<int>(system.model().joints.size()); ++j) {
    const double clearance = system.joints().layout(j).clearance;
    if (clearance > 0.0) unit = std::min(unit, clearance);
  }
  return settings.tolerance * unit;
}

RunContext::RunContext(std::shared_ptr<const RunEquations> all_equations, const Channels& all_channels)
    : equations(std::move(all_equations)),
      system(equations->system()),
      model(system.model()),
      settings(model.settings),
      channels(all_channels),
      energy(system),
      integrator_layout(declare(system, energy.flows())),
      adaptive(settings.adaptive || integrator_layout.always_adaptive != 0),
      flows(integrator_layout.explicit_stages != 0 ? energy.flows() : 0),
      solver(
          system,
          {.tolerance = integrator_layout.newton_tolerance, .max_iterations = integrator_layout.newton_max_iterations},
          &evaluations),
      accepted(system.layout(), integrator_layout.memory, flows),
      trial(system.layout(), integrator_layout.memory, flows),
      between(system.layout(), integrator_layout.memory, flows),
      e_accepted(system, &evaluations),
      e_trial(system, &evaluations),
      own_between(adaptive ? std::optional<KeptEvaluation>(std::in_place, system, &evaluations) : std::nullopt),
      e_between(own_between ? *own_between : solver.evaluation()),
      events(system, evaluations, adaptive, between, e_between),
      sleeping(system.joints(), system.forces(), evaluations),
      kinks(model),
      path_edges(system),
      idle_loads(system),
      watch(system, all_channels, adaptive),
      inner(at(system.layout().nv()), at(system.layout().nz() + flows)),
      z_rate(at(system.layout().nz() + flows)) {
  if (adaptive) {
    allowed = local_tolerance(system);
    events.allow(allowed);
    require_attainable_accuracy(system);
    // An accuracy is kept per second; a tolerance is relative in velocity, too.
    solver.control_error(allowed, allowed, settings.accuracy > 0.0 ? 0.0 : settings.tolerance);
    evaluations.per_contact = settings.per_contact;
  }
  if (flows > 0) solver.integrate_flows(energy);
  accepted.assign_motion(equations->first_state());
}

Archive RunContext::features() const {
  Archive out;
  ArchiveWriter write(out);
  const Layout& layout = system.layout();
  write(layout.nq(), layout.nv(), layout.nc(), layout.all_rows(), layout.nz(), layout.nh(), flows, adaptive);
  write(std::string(settings.integrator_parameters.component->description.name), equations->start().state);
  return out;
}

void require_sound_integrator(const System& system) { declare(system, EnergyAccount(system).flows()); }

void require_attainable_accuracy(const System& system) {
  const Settings& settings = system.model().settings;
  const double tolerance = local_tolerance(system), smallest = 8.0 * rounding * system.size();
  if (tolerance >= smallest || !(settings.adaptive || settings.accuracy > 0.0)) return;
  throw Error(Error::Category::input, "out-of-range",
              fmt::format("a step may err by {:.3g} m, but positions of a model of {:.3g} m are rounded to {:.3g} m",
                          tolerance, system.size(), smallest),
              settings.accuracy_location, "ask for less accuracy");
}

}  // namespace freeplay
