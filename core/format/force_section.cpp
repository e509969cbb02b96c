#include "format/force_section.h"

#include <algorithm>
#include <utility>

#include "base/name_pattern.h"
#include "format/joint_section.h"
#include "format/motion_names.h"

namespace freeplay {
namespace {

/// Reads one entry of `forces`.
class ForceEntry {
 public:
  ForceEntry(Draft& draft, const Part& part, const CheckedValue& entry)
      : draft_(draft), part_(part), entry_(entry), map_(entry, "force") {}

  void read() {
    const auto type = map_.require("type");
    const auto word = type ? type->string() : std::nullopt;
    if (!word) return;
    const bool applied = *word == "force" || *word == "torque" || *word == "gravity";
    if (!applied) return add_force_joint(draft_, part_, entry_);
    map_.follow("force " + *word);
    if (*word == "force") {
      read_force();
    } else if (*word == "torque") {
      read_torque();
    } else {
      read_gravity();
    }
    map_.finish();
  }

 private:
  void read_force() {
    const auto at = map_.require("at");
    const auto value = map_.require("value");
    const auto axes = map_.find("axes");
    AppliedForce force = named(ForceKind::force);
    const auto word = axes ? axes->word({"global", "frame"}) : std::optional<int>(0);
    const auto marker = at ? draft_.marker(*at, part_) : std::nullopt;
    const auto items = value ? value->list(value->in_space() ? 3 : 2) : std::nullopt;
    bool good = marker && word && items;
    if (items) {
      for (const CheckedValue& item : *items) good = append(item, dimension::force, force) && good;
    }
    if (!good) return;
    if (draft_.model.markers[static_cast<std::size_t>(*marker)].body == ground) warn_of_ground(*at, "a force");
    force.marker = *marker;
    force.frame_axes = *word == 1;
    add(std::move(force));
  }

  void read_torque() {
    const auto on = map_.require("on");
    const auto value = map_.require("value");
    AppliedForce torque = named(ForceKind::torque);
    const std::optional<BodyId> body = on ? draft_.body(*on, part_) : std::nullopt;
    bool good = value.has_value();
    if (value && value->in_space()) {
      const auto items = value->list(3);
      good = items.has_value();
      for (std::size_t i = 0; items && i < 3; ++i) good = append((*items)[i], dimension::torque, torque) && good;
    } else if (value) {
      good = append(*value, dimension::torque, torque);
    }
    if (!good || !body) return;
    if (*body == ground) warn_of_ground(*on, "a torque");
    torque.marker = draft_.marker(draft_.body_name(*body) + (*body == ground ? "/origin" : "/com"));
    add(std::move(torque));
  }

  static void warn_of_ground(const CheckedValue& value, const std::string& what) {
    value.warn("unused", what + " on ground moves nothing");
  }

  void add(AppliedForce force) {
    if (std::ranges::any_of(force.value, &Expression::depends_on_variables)) {
      for (const Expression& value : force.value) force.by_motion.formulas.emplace_back(value);
    }
    draft_.model.force_elements.push_back({static_cast<int>(draft_.model.forces.size()), -1});
    draft_.model.forces.push_back(std::move(force));
  }

  void read_gravity() {
    const auto on = map_.require("on");
    const auto value = map_.require("value");
    const auto acceleration = value ? value->vector(dimension::acceleration) : std::nullopt;
    const auto items = on ? on->list() : std::nullopt;
    if (!items) return;
    OwnGravity own{part_.full(entry_.key()), {}, acceleration.value_or(Vector3{}), draft_.model.force_elements.size()};
    for (const CheckedValue& item : *items) {
      for (const BodyId body : bodies(item)) {
        if (body == ground) warn_of_ground(item, "gravity");
        if (body == ground || !claim(body, own.name, item)) continue;
        draft_.model.bodies[static_cast<std::size_t>(body)].gravity = own.value;
        own.bodies.push_back(body);
      }
    }
    draft_.model.own_gravities.push_back(std::move(own));
  }

  /// True the first time. Order has no meaning, so of two entries for one body neither could win.
  bool claim(BodyId body, const std::string& name, const CheckedValue& item) {
    const auto [owner, fresh] = draft_.own_gravity.try_emplace(body, name);
    if (!fresh && owner->second != name) {
      item.fail("duplicate-name",
                "body '" + draft_.body_name(body) + "' has its gravity from '" + owner->second + "' already");
    }
    return fresh;
  }

  std::vector<BodyId> bodies(const CheckedValue& item) const {
    const auto name = item.reference();
    if (!name) return {};
    if (!is_pattern(*name)) {
      const std::optional<BodyId> body = draft_.body(item, part_);
      return body ? std::vector<BodyId>{*body} : std::vector<BodyId>{};
    }
    const std::vector<int> found = matching(draft_, draft_.bodies, item, *name, part_);
    if (found.empty() && !draft_.excused(*name)) {
      item.fail("unknown-name", "no body matches the pattern '" + *name + "'");
    }
    std::vector<std::string> full;
    for (const BodyId body : found) full.push_back(draft_.body_name(body));
    item.note_names(std::move(full));
    return found;
  }

  bool append(const CheckedValue& value, const Dimension& dimension, AppliedForce& force) const {
    const MotionNames names(draft_, part_, force.by_motion.channels);
    std::optional<Expression> expression = value.time_function(dimension, 0, &names);
    if (expression) {
      for (Expression& part : expression->time_parts()) force.in_time.push_back(std::move(part));
      force.value.push_back(std::move(*expression));
      force.text.push_back(value.node().text);
    }
    return expression.has_value();
  }

  AppliedForce named(ForceKind kind) const {
    AppliedForce force;
    force.name = part_.full(entry_.key());
    force.location = entry_.key_location();
    force.kind = kind;
    return force;
  }

  Draft& draft_;
  const Part& part_;
  const CheckedValue& entry_;
  MapReader map_;
};

}  // namespace

void add_forces(Draft& draft, const Part& part) {
  const auto section = part.section("forces");
  if (!section) return;
  for (const CheckedValue& entry : entries_of(*section)) {
    Draft::check_name(entry);
    draft.forces.add(part.full(entry.key()));
    const int errors = draft.diagnostics.errors();
    const std::size_t elements = draft.model.force_elements.size();
    ForceEntry(draft, part, entry).read();
    if (draft.diagnostics.errors() == errors && draft.model.force_elements.size() > elements) continue;
    draft.unsure_columns.push_back("force." + part.full(entry.key()) + ".");
  }
}

}  // namespace freeplay
