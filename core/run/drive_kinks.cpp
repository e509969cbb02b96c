#include "run/drive_kinks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace freeplay {

DriveKinks::DriveKinks(const Model& model, Of of) {
  for (const Driver& driver : model.drivers) {
    if (prescribes(driver.kind) != (of == Of::motions)) continue;
    if (driver.table) {
      tables_.push_back(driver.table.get());
    } else if (driver.kinematics < 0) {
      add(driver.value, model.settings);
    }
    for (const Expression& part : driver.in_time) add(part, model.settings);
  }
  if (of == Of::loads) {
    for (const AppliedForce& force : model.forces) {
      for (const Expression& component : force.in_time) add(component, model.settings);
    }
    for (const JointElement& joint : model.joints) {
      for (const Expression& part : joint.in_time) add(part, model.settings);
    }
    return;
  }
  for (const InverseKinematics& entry : model.kinematics) {
    for (const std::optional<Expression>& component : entry.path.functions) {
      if (component) add(*component, model.settings);
    }
    for (const auto& table : entry.path.tables) {
      if (table) tables_.push_back(table.get());
    }
  }
}

void DriveKinks::add(const Expression& expression, const Settings& settings) {
  FormulaCourse course(expression, settings.start, settings.end);
  if (!course.has_sides()) return;
  formulas_.push_back(std::move(course));
  const double beside =
      64.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(settings.start), std::abs(settings.end));
  FormulaCourse end(expression, settings.end - beside, settings.end + beside);
  const double corner = end.next_corner(settings.end - beside, settings.end + beside);
  one_at_end_ = one_at_end_ || (corner < settings.end + beside && end.near(corner, settings.end + beside).sharp);
}

double DriveKinks::next(double t, double until) {
  double kink = std::numeric_limits<double>::infinity();
  for (FormulaCourse& formula : formulas_) {
    double corner = formula.next_corner(t, until);
    while (std::isfinite(corner) && !formula.near(corner, corner).sharp) corner = formula.next_corner(corner, until);
    kink = std::min(kink, corner);
  }
  for (const TimeTable* table : tables_) kink = std::min(kink, table->next_kink(t));
  return kink;
}

}  // namespace freeplay
