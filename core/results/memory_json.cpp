#include "results/memory_json.h"

namespace freeplay {

Json memory_json(const Model& model, const std::vector<JointMemory>& memory) {
  Json part = Json::object();
  for (std::size_t j = 0; j < memory.size(); ++j) {
    const auto& [internal, history] = memory[j];
    if (internal.empty() && history.empty()) continue;
    append(part, model.joints[j].name, {{"internal", internal}, {"history", history}});
  }
  return part;
}

}  // namespace freeplay
