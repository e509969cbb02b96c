#include "format/doubtful_load.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "format/doubtful_body.h"
#include "format/motion_course.h"
#include "model/whole_mass.h"

namespace freeplay {
namespace {

constexpr std::size_t most_loads = 2000;  // that are looked at

/// Largest amount at the instants of its course; 0 where it has no value.
double largest_of(const Course& course) {
  return course.known ? std::max(std::abs(course.low), std::abs(course.high)) : 0.0;
}

class LoadDoubts {
 public:
  explicit LoadDoubts(const Draft& draft)
      : draft_(draft), all_(whole_mass(draft.model)), size_(model_size(draft.model)) {}

  bool any() const { return all_.mass > 0.0; }

  // What depends on the motion is judged by the run.
  void judge(const Driver& driver) const {
    if (!driver.by_motion.empty()) return;
    const double effort = largest_of(course_of(driver, draft_.model.settings));
    const bool turns = driver.kind == DriverKind::torque;
    if (!is_doubtful(effort, turns)) return;
    const auto entry = map_of("drivers", driver.name);
    if (entry) warn(effort, turns, MapReader(*entry, "driver").find(driver.table ? "table" : "value"));
  }

  void judge(const AppliedForce& force) const {
    if (!force.by_motion.empty()) return;
    double squares = 0.0;
    for (const Expression& part : force.value) {
      const double most = largest_of(course_of(part, draft_.model.settings));
      squares += most * most;
    }
    const bool turns = force.kind == ForceKind::torque;
    if (!is_doubtful(std::sqrt(squares), turns)) return;
    const auto entry = map_of("forces", force.name);
    if (!entry) return;
    MapReader map(*entry, "force");
    map.follow(turns ? "force torque" : "force force");
    warn(std::sqrt(squares), turns, map.find("value"));
  }

 private:
  bool is_doubtful(double amount, bool turns) const {
    return (turns ? all_.by_torque(amount, size_) : all_.by_force(amount)) > most_of_load;
  }

  std::optional<CheckedValue> map_of(const char* section, const std::string& name) const {
    const auto entry = entry_of(draft_, section, name);
    return entry && entry->node().is_map() ? entry : std::nullopt;
  }

  void warn(double amount, bool turns, const std::optional<CheckedValue>& written) const {
    if (!written) return;
    written->warn("doubtful-value",
                  fmt::format("'{}' comes to {:.3g} {} on {:.3g} kg in a mechanism of {:.2g} m, more than any machine "
                              "has: check its numbers and their units",
                              written->path(), amount, turns ? "N m" : "N", all_.mass, size_));
  }

  const Draft& draft_;
  WholeMass all_;
  double size_;
};

}  // namespace

void doubt_loads(const Draft& draft) {
  const LoadDoubts doubts(draft);
  if (!doubts.any()) return;
  const Model& model = draft.model;
  for (std::size_t i = 0; i < std::min(model.drivers.size(), most_loads); ++i) {
    if (model.drivers[i].kinematics < 0 && !prescribes(model.drivers[i].kind)) doubts.judge(model.drivers[i]);
  }
  for (std::size_t i = 0; i < std::min(model.forces.size(), most_loads); ++i) doubts.judge(model.forces[i]);
}

}  // namespace freeplay
