#include "system/driven_bodies.h"

#include <algorithm>
#include <optional>

#include "base/index.h"

namespace freeplay::planar {
namespace {

/// Rows of one joint, gear or driver, and the bodies in them.
struct Rows {
  int joint = -1, driver = -1;  // -1 and -1: a gear
  int count = 0;
  std::vector<BodyId> bodies;
};

std::vector<Rows> rows_of(const Model& model) {
  std::vector<Rows> all;
  const auto touch = [&](Rows& rows, int joint) {
    const JointElement& element = model.joints[at(joint)];
    for (const int marker : {element.marker_a, element.marker_b}) {
      const BodyId body = model.markers[at(marker)].body;
      if (body != ground && std::ranges::count(rows.bodies, body) == 0) rows.bodies.push_back(body);
    }
  };
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& element = model.joints[at(j)];
    if (element.gear >= 0 || element.layout.constraint_rows == 0) continue;
    touch(all.emplace_back(Rows{j, -1, element.layout.constraint_rows, {}}), j);
  }
  for (const Gear& gear : model.gears) {
    if (model.joints[at(gear.joint)].layout.constraint_rows == 0) continue;  // its teeth have play
    Rows& rows = all.emplace_back(Rows{-1, -1, 1, {}});
    touch(rows, gear.first);
    touch(rows, gear.second);
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const Driver& driver = model.drivers[at(d)];
    if (prescribes(driver.kind)) touch(all.emplace_back(Rows{driver.joint, d, 1, {}}), driver.joint);
  }
  return all;
}

bool declares(const JointLayout& layout, PlanarRow first, PlanarRow second) {
  const Span<const PlanarRow> rows = layout.planar_rows;
  return rows.size == 2 && ((rows[0] == first && rows[1] == second) || (rows[0] == second && rows[1] == first));
}

// A pin or a slide with its driver, or a weld.
std::optional<DrivenBody> held_by(const Model& model, BodyId body, const std::vector<const Rows*>& own) {
  if (own.empty() || own.size() > 2 || own[0]->joint < 0 || own[0]->driver >= 0) return {};
  const JointElement& joint = model.joints[at(own[0]->joint)];
  const JointLayout& layout = joint.layout;
  const bool second = model.markers[at(joint.marker_b)].body == body;
  if (second && model.markers[at(joint.marker_a)].body == body) return {};
  DrivenBody found{body, own[0]->joint, -1, second};
  if (own.size() == 1) {
    if (declares(layout, PlanarRow::origins, PlanarRow::turn)) return found;
    return {};
  }
  if (own[1]->driver < 0 || own[1]->joint != own[0]->joint || layout.planar_coordinate == 0) return {};
  found.driver = own[1]->driver;
  const bool pin = layout.planar_rows.size == 1 && layout.planar_rows[0] == PlanarRow::origins &&
                   layout.coordinate == Coordinate::angle;
  const bool slide = declares(layout, PlanarRow::across, PlanarRow::turn) && layout.coordinate == Coordinate::position;
  if (pin || slide) return found;
  return {};
}

}  // namespace

std::vector<DrivenBody> driven_bodies(const Model& model) {
  std::vector<DrivenBody> found;
  if (model.space != Space::planar) return found;
  const std::vector<Rows> all = rows_of(model);
  std::vector<std::vector<const Rows*>> rows_at(model.bodies.size());
  std::vector<int> open(all.size());  // bodies that are not known
  for (std::size_t i = 0; i < all.size(); ++i) {
    open[i] = static_cast<int>(all[i].bodies.size());
    for (const BodyId body : all[i].bodies) rows_at[at(body)].push_back(&all[i]);
  }
  std::vector<char> known(model.bodies.size(), 0);
  std::vector<BodyId> look;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) look.push_back(b);
  for (std::size_t next = 0; next < look.size(); ++next) {
    const BodyId body = look[next];
    if (known[at(body)] != 0) continue;
    std::vector<const Rows*> own;
    for (const Rows* rows : rows_at[at(body)]) {
      if (open[static_cast<std::size_t>(rows - all.data())] == 1) own.push_back(rows);
    }
    const std::optional<DrivenBody> held = held_by(model, body, own);
    if (!held) continue;
    known[at(body)] = 1;
    found.push_back(*held);
    for (const Rows* rows : rows_at[at(body)]) {
      if (--open[static_cast<std::size_t>(rows - all.data())] != 1) continue;
      for (const BodyId other : rows->bodies) {
        if (known[at(other)] == 0) look.push_back(other);
      }
    }
  }
  return found;
}

}  // namespace freeplay::planar
