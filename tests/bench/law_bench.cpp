// One evaluation of each contact law, through the table that a joint calls.
#include <stdexcept>

#include <benchmark/benchmark.h>

#include "bench_model.h"
#include "contract/sample_parameters.h"

namespace freeplay::bench {
namespace {

void law(benchmark::State& state, const Component& component, const Registry& registry) {
  const ParameterSamples samples = sample_parameters(component, registry);
  if (samples.accepted.empty()) return state.SkipWithError(samples.refusal.c_str());
  Instances instances;
  CreationFault fault;
  const ContactLawRef law = instances.create_contact_law(*samples.accepted.front().block, sample_contact_pair(), fault);
  ContactState at{1e-7, 0.02, 0.05};
  for (auto _ : state) {
    at.penetration += 1e-16;
    benchmark::DoNotOptimize(law.evaluate(at).normal);
  }
}

const int law_kernels = [] {
  const Registry& registry = test::builtin_types();
  for (const std::string& name : registry.names(ComponentKind::contact_law)) {
    const Component& component = *registry.find(ComponentKind::contact_law, name);
    benchmark::RegisterBenchmark(("contact/" + name).c_str(),
                                 [&](benchmark::State& s) { law(s, component, registry); });
  }
  return 0;
}();

}  // namespace
}  // namespace freeplay::bench
