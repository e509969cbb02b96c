#include "analysis/rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "analysis/clearance_error.h"
#include "analysis/inverse_dynamics.h"
#include "analysis/play_samples.h"
#include "analysis/regular_start.h"
#include "analysis/singularity.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const std::string& input_name(const IdealMechanism& mechanism, int input) {
  return mechanism.model().joints[at(mechanism.platform().inputs[at(input)])].name;
}

int input_count(const IdealMechanism& mechanism) { return static_cast<int>(mechanism.platform().inputs.size()); }

/// Counts angles on from the row before, where rows follow a path.
class Turns {
 public:
  double next(std::size_t column, double angle, bool follows) {
    if (last_.size() <= column) last_.resize(column + 1, nan);
    if (follows && !std::isnan(last_[column])) angle = nearest_turn(angle, last_[column]);
    return last_[column] = angle;
  }

 private:
  std::vector<double> last_;
};

/// The numbers of the pose: as given, or where the frame is then.
FramePose shown_pose(const Station& station, const PostureSolver& solver) {
  FramePose pose;
  pose.fill(nan);
  if (station.reachable) {
    pose = solver.frame(station.posture);
    for (std::size_t i = solver.form().lengths; i < solver.form().size(); ++i) {
      pose[i] = wrapped(pose[i]);
    }
  }
  for (std::size_t i = 0; i < solver.form().size(); ++i) {
    if (station.demand.given[i]) pose[i] = station.demand.pose[i].value;
  }
  return pose;
}

bool follows_path(const Station& station) { return !std::isnan(station.time); }

/// What a thread needs to look at postures.
struct Looker {
  Looker(const IdealMechanism& mechanism, const Components& kept) : solver(mechanism), mapper(mechanism, kept) {}
  const VelocityMap& look(const Station& station) {
    mapper.map(solver.evaluate(station.demand.t, station.posture, term_position), map, station.folded);
    return map;
  }
  PostureSolver solver;
  VelocityMapper mapper;
  VelocityMap map;
};

using Row = std::vector<AnalysisCell>;

/// Zero has no sign.
template <class Values>
void append_all(Row& row, const Values& values) {
  for (const double value : values) row.emplace_back(value + 0.0);
}
void append(Row& row, std::initializer_list<double> values) { append_all(row, values); }
void append_pose(Row& row, const PoseForm& form, const FramePose& pose) {
  append_all(row, std::span(pose).first(form.size()));
}

/// Pose of a row that may follow others on a path.
void append_moving_pose(Row& row, const Station& station, const PostureSolver& solver, Turns& turns) {
  FramePose pose = shown_pose(station, solver);
  for (std::size_t i = solver.form().lengths; i < solver.form().size(); ++i) {
    if (!station.demand.given[i]) pose[i] = turns.next(i, pose[i], follows_path(station));
  }
  append_pose(row, solver.form(), pose);
}

/// The numbers of a pose.
void add_pose_columns(AnalysisTable& table, const PoseForm& form) {
  for (std::size_t i = 0; i < form.size(); ++i) table.add_column(form.words[i], form.is_turn(i) ? "rad" : "m");
}

/// Of a coordinate of an input, or of what is divided by time once or twice.
std::string unit_of(const IdealMechanism& mechanism, int input, const char* by_time = "") {
  return (mechanism.is_angle(input) ? "rad" : "m") + std::string(by_time);
}

/// Coordinate rows of the inputs at a posture: value, speed, acceleration.
void append_inputs(const IdealMechanism& mechanism, const Station& station, PostureSolver& solver, Turns& turns,
                   Row& row) {
  const System& system = mechanism.system();
  const std::size_t width = at(system.layout().body_velocities());
  std::vector<double> v(at(system.layout().nv()), 0.0), a = v;
  const bool moves = follows_path(station);
  const bool known = !moves || (!station.folded && solver.rates(station.demand, station.posture, v, a));
  const Evaluation& e = solver.evaluate_moving(station.demand.t, station.posture, v, term_velocity);
  const Model& model = mechanism.model();
  for (int i = 0; i < input_count(mechanism); ++i) {
    const int j = mechanism.platform().inputs[at(i)];
    const JointElement& joint = model.joints[at(j)];
    double entries[2 * spatial::velocities], acceleration = 0.0;
    system.joints().coordinate_row(j, e, entries, acceleration);
    double speed = 0.0;
    const BodyId bodies[2] = {model.markers[at(joint.marker_a)].body, model.markers[at(joint.marker_b)].body};
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t c = 0; c < width && bodies[k] != ground; ++c) {
        speed += entries[width * k + c] * v[width * at(bodies[k]) + c];
        acceleration += entries[width * k + c] * a[width * at(bodies[k]) + c];
      }
    }
    double value = e.coordinate[at(j)];
    if (mechanism.is_angle(i)) value = turns.next(at(i), principal_angle(value), moves);
    append(row, {value, known ? speed : nan, known ? acceleration : nan});
  }
}

}  // namespace

std::string play_name(const IdealMechanism& mechanism, const Play& play) {
  return "joint." + mechanism.model().joints[at(play.joint)].name + play.part;
}

std::string station_words(const PoseForm& form, const Station& station) {
  if (follows_path(station)) return fmt::format("t = {:.9g} s", station.time);
  std::string text;
  for (std::size_t i = 0; i < form.size(); ++i) {
    if (!station.demand.given[i]) continue;
    text += fmt::format("{}{} = {:.9g}", text.empty() ? "" : ", ", form.words[i], station.demand.pose[i].value);
  }
  return text.empty() ? "these inputs" : text;
}

AnalysisTable ik_rows(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                      const std::vector<int>& branch_of, const Tick& tick) {
  AnalysisTable table;
  table.add_column("time", "s");
  add_pose_columns(table, mechanism.form());
  for (int i = 0; i < input_count(mechanism); ++i) {
    const std::string prefix = "joint." + input_name(mechanism, i);
    table.add_column(prefix + (mechanism.is_angle(i) ? ".angle" : ".position"), unit_of(mechanism, i));
    table.add_column(prefix + ".speed", unit_of(mechanism, i, "/s"));
    table.add_column(prefix + ".acceleration", unit_of(mechanism, i, "/s^2"));
  }
  if (!branch_of.empty()) table.add_column("branch", "1");
  PostureSolver solver(mechanism);
  Turns turns, frame_turns;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    tick(1);
    const Station& station = stations[k];
    Row row;
    append(row, {station.time});
    append_moving_pose(row, station, solver, frame_turns);
    append_inputs(mechanism, station, solver, turns, row);
    if (!branch_of.empty()) row.emplace_back(static_cast<double>(branch_of[k]));
    table.rows.push_back(std::move(row));
  }
  return table;
}

AnalysisTable workspace_rows(IdealMechanism& mechanism, const std::vector<Station>& stations, const Components& given,
                             int threads, const Tick& tick) {
  AnalysisTable table;
  add_pose_columns(table, mechanism.form());
  for (const char* name : {"reachable", "legs", "condition"}) table.add_column(name, "1");
  table.rows.resize(stations.size());
  const Posture start = mechanism.closed_form() ? Posture{} : regular_start(mechanism, given);
  in_parallel(stations.size(), threads, tick, [&](int, std::size_t first, std::size_t last) {
    Looker looker(mechanism, given);
    for (std::size_t i = first; i < last; ++i) {
      tick(1);
      const Station& station = stations[i];
      const FramePose pose = shown_pose(station, looker.solver);
      double legs = input_count(mechanism), condition = nan;
      if (station.reachable && turns_whole(mechanism.form(), given)) {
        condition = singularity_of(looker.look(station), mechanism.length()).condition;
      } else if (!station.reachable) {
        Unreachable why;
        legs = looker.solver.legs_in_reach(station.demand, start, why);
      }
      append_pose(table.rows[i], mechanism.form(), pose);
      append(table.rows[i], {station.reachable ? 1.0 : 0.0, legs, condition});
    }
  });
  return table;
}

AnalysisTable singularity_rows(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                               const Components& given, int threads, const Tick& tick) {
  AnalysisTable table;
  add_pose_columns(table, mechanism.form());
  for (const char* name : {"reachable", "sigma_min", "sigma_max", "condition", "inverse_min", "kind"}) {
    table.add_column(name, "1");
  }
  table.rows.resize(stations.size());
  in_parallel(stations.size(), threads, tick, [&](int, std::size_t first, std::size_t last) {
    Looker looker(mechanism, given);
    for (std::size_t i = first; i < last; ++i) {
      tick(1);
      const Station& station = stations[i];
      const FramePose pose = shown_pose(station, looker.solver);
      Row& row = table.rows[i];
      append_pose(row, mechanism.form(), pose);
      append(row, {station.reachable ? 1.0 : 0.0});
      if (!station.reachable) {
        append(row, {nan, nan, nan, nan, nan});
        continue;
      }
      const Singularity s = singularity_of(looker.look(station), mechanism.length());
      append(row, {s.sigma_min, s.sigma_max, s.condition, s.inverse_min});
      row.emplace_back(word(s.kind));
    }
  });
  return table;
}

std::vector<double> determinants(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                                 const Components& given, int threads, const Tick& tick) {
  if (static_cast<int>(mechanism.platform().inputs.size()) != count(given)) return {};
  std::vector<double> out(stations.size(), nan);
  in_parallel(stations.size(), threads, tick, [&](int, std::size_t first, std::size_t last) {
    Looker looker(mechanism, given);
    for (std::size_t i = first; i < last; ++i) {
      tick(1);
      if (!stations[i].reachable) continue;
      const VelocityMap& map = looker.look(stations[i]);
      if (map.a.rows() == map.a.cols()) out[i] = map.a.determinant();
    }
  });
  return out;
}

namespace {

/// In the plane the turn is one of the changes.
bool has_several_turns(const PoseForm& form) { return form.size() > form.lengths + 1; }

void add_error_columns(AnalysisTable& table, const IdealMechanism& mechanism, const ErrorColumns& of) {
  const PoseForm& form = mechanism.form();
  add_pose_columns(table, form);
  table.add_column("reachable", "1");
  for (const std::string prefix : {"", "ls_"}) {
    for (std::size_t i = 0; i < form.size(); ++i) {
      table.add_column(prefix + form.changes[i], form.is_turn(i) ? "rad" : "m");
    }
    table.add_column(prefix + "position", "m");
    if (has_several_turns(form)) table.add_column(prefix + "dangle", "rad");
  }
  if (of.sensitivity) {
    for (const Play& play : mechanism.plays()) table.add_column(play_name(mechanism, play) + ".sensitivity", "1");
    for (int i = 0; i < input_count(mechanism); ++i) {
      table.add_column("driver." + input_name(mechanism, i) + ".sensitivity", mechanism.is_angle(i) ? "m/rad" : "1");
    }
  }
  if (of.samples > 0) {
    for (const std::string name : {"rms_position", "rms_dangle", "max_position", "max_dangle"}) {
      table.add_column("sample_" + name, name.ends_with("dangle") ? "rad" : "m");
    }
  }
}

}  // namespace

AnalysisTable error_rows(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                         const ErrorColumns& columns, int threads, std::vector<std::string>& warnings,
                         const Tick& tick) {
  AnalysisTable table;
  const PoseForm& form = mechanism.form();
  add_error_columns(table, mechanism, columns);
  table.rows.resize(stations.size());
  std::vector<char> singular(stations.size(), 0), unclosed = singular;
  in_parallel(stations.size(), threads, tick, [&](int, std::size_t first, std::size_t last) {
    Looker looker(mechanism, form.all());
    for (std::size_t i = first; i < last; ++i) {
      tick(1);
      const Station& station = stations[i];
      const FramePose pose = shown_pose(station, looker.solver);
      Row& row = table.rows[i];
      append_pose(row, mechanism.form(), pose);
      append(row, {station.reachable ? 1.0 : 0.0});
      std::optional<ClearanceError> error;
      if (station.reachable) error = clearance_error(mechanism, looker.look(station));
      singular[i] = station.reachable && !error;
      if (!error) {
        row.resize(table.columns.size(), nan);
        continue;
      }
      for (const WorstCase* bound : {&error->exact, &error->least_squares}) {
        append_all(row, std::span(bound->change).first(form.size()));
        append(row, {bound->position});
        if (has_several_turns(form)) append(row, {bound->dangle});
      }
      if (columns.sensitivity) append_all(row, error->sensitivity);
      if (columns.samples > 0) {
        // Every row draws its own numbers, whichever thread it falls to.
        const auto s = sample_play(mechanism, looker.map, columns.samples, columns.seed + 0x9E3779B97F4A7C15u * i,
                                   columns.law, tick);
        unclosed[i] = !s;
        if (s) append(row, {s->rms_position, s->rms_dangle, s->max_position, s->max_dangle});
        row.resize(table.columns.size(), nan);
      }
    }
  });
  const auto warn = [&](const std::vector<char>& marked, const char* what) {
    const auto count = std::ranges::count(marked, 1);
    if (count == 0) return;
    const auto first = static_cast<std::size_t>(std::ranges::find(marked, 1) - marked.begin());
    warnings.push_back(fmt::format("{}: {}{}", station_words(mechanism.form(), stations[first]), what,
                                   count > 1 ? fmt::format(" (and {} more)", count - 1) : ""));
  };
  warn(singular, "singular: the platform moves while its inputs are held, its error has no bound");
  warn(unclosed, "the mechanism does not close with every pin on its rim, there are no samples");
  return table;
}

/// What a gear passes where its second joint turns.
std::span<const char* const> moments_of(const JointElement& joint, bool planar) {
  static constexpr const char *in_plane[] = {"torque"}, *in_space[] = {"tx", "ty", "tz"};
  if (joint.gear < 0) return {};
  return planar ? std::span<const char* const>(in_plane) : in_space;
}

AnalysisTable inverse_dynamics_rows(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                                    double preload, const Tick& tick) {
  AnalysisTable table;
  table.add_column("time", "s");
  add_pose_columns(table, mechanism.form());
  for (int i = 0; i < input_count(mechanism); ++i) {
    const bool turns = mechanism.is_angle(i);
    table.add_column("driver." + input_name(mechanism, i) + (turns ? ".torque" : ".force"), turns ? "N*m" : "N");
  }
  std::vector<std::size_t> shown;
  const bool planar = mechanism.model().space == Space::planar;
  for (std::size_t j = 0; j < mechanism.model().joints.size(); ++j) {
    const JointElement& joint = mechanism.model().joints[j];
    if (joint.is_force) continue;
    shown.push_back(j);
    const std::string prefix = "joint." + joint.name + ".";
    for (const std::string word : mechanism.form().forces) {
      table.add_column(prefix + word, word.front() == 'f' ? "N" : "N*m");
    }
    for (const char* word : moments_of(joint, planar)) table.add_column(prefix + word, "N*m");
  }
  PostureSolver solver(mechanism);
  InverseDynamics dynamics(solver);
  Turns turns;
  for (const Station& station : stations) {
    tick(1);
    std::vector<double> v(at(mechanism.system().layout().nv()), 0.0), a = v;
    if (follows_path(station) && (station.folded || !solver.rates(station.demand, station.posture, v, a))) {
      throw Error(Error::Category::numerical, "singular",
                  fmt::format("{}: a singular pose, speeds and accelerations have no value",
                              station_words(mechanism.form(), station)));
    }
    Efforts efforts;
    switch (dynamics.solve(station.demand.t, station.posture, v, a, preload, efforts)) {
      case InverseDynamics::Found::yes:
        break;
      case InverseDynamics::Found::unbalanced:
        throw Error(Error::Category::numerical, "singular",
                    fmt::format("{}: a singular pose, the inputs cannot hold the platform",
                                station_words(mechanism.form(), station)));
      case InverseDynamics::Found::no_preload:
        throw Error(Error::Category::usage, "bad-value",
                    "--preload: no driver is redundant, so there is no inner tension to choose");
      case InverseDynamics::Found::many_preloads:
        throw Error(Error::Category::usage, "bad-value",
                    "--preload: several drivers are redundant, one value does not determine the inner tension");
    }
    Row row;
    append(row, {station.time});
    append_moving_pose(row, station, solver, turns);
    append_all(row, efforts.input);
    for (const std::size_t j : shown) {
      const std::span wrench(efforts.wrench[j]);
      append_all(row, wrench.first(mechanism.form().forces.size()));
      append_all(row, wrench.last(moments_of(mechanism.model().joints[j], planar).size()));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace freeplay
