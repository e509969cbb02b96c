#include "assembly/doubled_loads.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

#include <fmt/format.h>

namespace freeplay {
namespace {

constexpr int looks = 32;  // parts of a run at whose ends values are compared

/// What comes before the name in its template: parameters have the same values there.
std::string_view scope_of(std::string_view name) { return name.substr(0, name.rfind('.') + 1); }

/// The same text is the same function, but for parameters of other templates that it may name.
bool same_values(const AppliedForce& one, const AppliedForce& other, const Settings& settings) {
  if (one.by_motion.empty() != other.by_motion.empty()) return false;
  if (!one.by_motion.empty()) {
    if (scope_of(one.name) == scope_of(other.name)) return true;
    return std::ranges::none_of(one.text, [](const std::string& text) { return text.find('$') != std::string::npos; });
  }
  for (int i = 0; i <= looks; ++i) {
    const double t = settings.start + (settings.end - settings.start) * i / looks;
    for (std::size_t k = 0; k < one.value.size(); ++k) {
      Jet a, b;
      EvaluationFailure failure;
      if (!one.value[k].evaluate(t, a, failure) || !other.value[k].evaluate(t, b, failure)) return false;
      if (a.value != b.value) return false;
    }
  }
  return true;
}

/// Zero is what a load has while another model, or a caller, gives it none.
bool does_anything(const AppliedForce& force) {
  return !force.by_motion.empty() || std::ranges::any_of(force.value, [](const Expression& value) {
    return value.depends_on_time() || value.depends_on_variables() || value.constant().value != 0.0;
  });
}

}  // namespace

void doubt_doubled_loads(const Model& model,
                         const std::function<void(const char*, const std::string&, const AppliedForce&)>& doubt) {
  std::map<std::tuple<ForceKind, int, bool, std::vector<std::string>>, std::vector<const AppliedForce*>> alike;
  for (const AppliedForce& force : model.forces) {
    if (!does_anything(force)) continue;
    auto& others = alike[{force.kind, force.marker, force.frame_axes, force.text}];
    const auto same = std::ranges::find_if(
        others, [&](const AppliedForce* other) { return same_values(*other, force, model.settings); });
    if (same == others.end()) {
      others.push_back(&force);
      continue;
    }
    doubt(
        "duplicate-force",
        fmt::format("'{}' is the same {} at the same place as '{}', so that both act as one twice as large: delete one "
                    "of them, or write its value into the other",
                    force.name, force.kind == ForceKind::force ? "force" : "torque", (*same)->name),
        force);
  }
}

}  // namespace freeplay
