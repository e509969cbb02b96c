#include "assembly/dead_point.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "assembly/continuation.h"
#include "assembly/row_stress.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr double lost_rank = 1e-4;    // by singular values of the rows, of what it is beside a dead point
constexpr double nearly_lost = 1e-2;  // the same for a run that ends close to one

// The state of stress without load that is `here` and not beside it.
std::vector<int> joints_in_line(const RowSvd& here, const RowSvd& beside, const ClosedMechanism::Rows& rows,
                                const ClosedMechanism& mechanism) {
  Eigen::VectorXd stress = here.svd.u.col(beside.rank - 1);
  const auto always = beside.svd.u.rightCols(beside.svd.u.cols() - beside.rank);
  stress -= always * (always.transpose() * stress);
  return joints_under(stress, rows, mechanism);
}

bool moves(const Driver& driver) {
  return driver.table || driver.kind == DriverKind::velocity || driver.value.depends_on_time();
}

}  // namespace

std::optional<DeadStart> dead_start(const System& system, const State& start) {
  ClosedMechanism mechanism(system);
  const Model& model = mechanism.model();
  if (mechanism.system.layout().nv() > most_followed_velocities) return std::nullopt;
  mechanism.stand_at(system, start);
  mechanism.position_rows();
  std::vector<int> drivers;
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const Driver& driver = model.drivers[at(d)];
    if (!prescribes(driver.kind) || driver.kinematics >= 0) continue;
    drivers.push_back(d);
    mechanism.held_row[at(mechanism.system.layout().driver_row(d))] = 0;
    mechanism.leads.push_back({driver.joint, mechanism.e.coordinate[at(driver.joint)]});
  }
  if (drivers.empty()) return std::nullopt;
  const ClosedMechanism::Rows rows = mechanism.position_rows();
  if (!mechanism.holds(rows)) return std::nullopt;
  const RowSvd here(rows);
  const Eigen::VectorXd& values = here.svd.sigma;
  if (rows.matrix.rows() <= values.size() && values[values.size() - 1] > lost_rank * values[0]) return std::nullopt;
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const std::vector<ClosedMechanism::Lead> leads = mechanism.leads;
  bool any_way = false;
  for (std::size_t i = 0; i < leads.size(); ++i) {
    for (const double sign : {1.0, -1.0}) {
      mechanism.leads = leads;
      std::swap(mechanism.leads[i], mechanism.leads.back());
      std::ranges::copy(q, mechanism.state.q().begin());
      if (!leave_dead_point(mechanism, sign)) continue;
      any_way = true;
      std::swap(mechanism.leads[i], mechanism.leads.back());
      const RowSvd there(mechanism.position_rows());
      const Eigen::Index last = there.rank - 1;
      if (last < 0 || !(values[last] < lost_rank * there.svd.sigma[last])) continue;
      return DeadStart{drivers[i], false, joints_in_line(here, there, rows, mechanism)};
    }
  }
  // More rows than unknowns lock the mechanism wherever its links stand.
  if (rows.matrix.rows() > values.size()) return std::nullopt;
  const auto moving = std::ranges::find_if(drivers, [&](int d) { return moves(model.drivers[at(d)]); });
  if (any_way || moving == drivers.end()) return std::nullopt;
  return DeadStart{*moving, true, joints_under(here.svd.u.rightCols<1>(), rows, mechanism)};
}

std::optional<SingularPosition> singular_position(const System& system, const State& now) {
  ClosedMechanism mechanism(system);
  const Model& model = mechanism.model();
  if (mechanism.system.layout().nv() > most_followed_velocities) return std::nullopt;
  if (mechanism.state.q().size() != now.q().size()) return std::nullopt;
  mechanism.stand_at(system, now);
  mechanism.state.t() = now.t();
  const ClosedMechanism::Rows rows = mechanism.position_rows();
  // With play there are no rows to lose.
  if (rows.matrix.rows() == 0 || !mechanism.holds(rows)) return std::nullopt;
  const RowSvd here(rows);
  const Eigen::VectorXd& values = here.svd.sigma;
  if (rows.matrix.rows() <= values.size() && values[values.size() - 1] > nearly_lost * values[0]) return std::nullopt;
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    if (model.joints[at(j)].gear >= 0 || mechanism.system.joints().layout(j).coordinate == Coordinate::none) continue;
    for (const double sign : {1.0, -1.0}) {
      std::ranges::copy(q, mechanism.state.q().begin());
      mechanism.evaluate(term_position);
      mechanism.leads = {{j, mechanism.e.coordinate[at(j)]}};
      const bool left = leave_dead_point(mechanism, sign);
      mechanism.leads.clear();
      if (!left) continue;
      const RowSvd there(mechanism.position_rows());
      const Eigen::Index last = there.rank - 1;
      if (last < 0) continue;
      const double part = values[last] / there.svd.sigma[last];
      if (!(part < nearly_lost)) continue;
      return SingularPosition{j, part, joints_in_line(here, there, rows, mechanism)};
    }
  }
  return std::nullopt;
}

std::string words(const SingularPosition& position, const Model& model) {
  const std::string joints = joint_names(position.joints, model);
  return fmt::format(
      "a singular position{}: there its constraints are {:.1g} times as independent as a little beside it, where joint "
      "'{}' has moved, and nothing says which of two ways the mechanism goes on; steps of another length do not change "
      "that: start beside it, or let a driver lead through",
      joints.empty() ? std::string{} : fmt::format(", where {} hold links in line", joints), position.part,
      model.joints[at(position.lead)].name);
}

std::string words(const DeadStart& start, const Model& model) {
  const Driver& driver = model.drivers[at(start.driver)];
  const std::string joints = joint_names(start.joints, model);
  if (start.stuck) {
    return fmt::format(
        "driver '{}' starts joint '{}' at a dead point that it cannot leave either way{}; make a link longer or the "
        "way between its ends shorter, or start elsewhere",
        driver.name, model.joints[at(driver.joint)].name,
        joints.empty() ? std::string{} : fmt::format(": {} hold links in line, with none to spare", joints));
  }
  return fmt::format(
      "driver '{}' starts joint '{}' at a dead point{}: nothing says which of two ways the mechanism goes "
      "on, or it cannot go as it is driven; start beside it, or drive another joint",
      driver.name, model.joints[at(driver.joint)].name,
      joints.empty() ? std::string{} : fmt::format(", where {} hold links in line", joints));
}

std::string joint_names(std::span<const int> joints, const Model& model) {
  constexpr std::size_t most = 6;
  const std::size_t named = joints.size() > most + 1 ? most : joints.size();  // not "and 1 others"
  std::string text;
  for (const int joint : joints.first(named)) {
    text += fmt::format("{}'{}'", text.empty() ? "" : ", ", model.joints[at(joint)].name);
  }
  if (joints.size() > named) text += fmt::format(" and {} others", joints.size() - named);
  if (text.empty()) return text;
  return (joints.size() == 1 ? "joint " : "joints ") + text;
}

}  // namespace freeplay
