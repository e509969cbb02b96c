#include "python/before_forks.h"

#include <exception>

#include "linear/cache_sizes.h"
#include "python/opened_model.h"
#include "results/hdf5_forks.h"

namespace freeplay {
namespace {

// With each way in which YAML writes a word, for the patterns of its reader.
constexpr const char* small_model = R"(---
freeplay: 1  # of the core's own
name: 'forks'
description: >-
  A mass
  that falls
parameters: &all {l: "1\x20m"}
bodies:
  mass:
    mass: 1 kg
    inertia: 1 kg*m^2
gravity: [0, -9.81]
simulation: {end: 1 s, step: 1 s}
...
)";

}  // namespace

void prepare_for_forks() {
  keep_hdf5_whole_at_forks();
  learn_cache_sizes();
  try {
    OpenedModel(OpenRequest{.text = small_model, .file = "forks.yaml", .words = {}, .load = {}, .name = {}}).facts();
  } catch (const std::exception&) {  // what the surroundings do to every model is said of the first that is asked for
  }
}

}  // namespace freeplay
