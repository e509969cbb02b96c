#include "analysis/requested_stations.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/branches.h"
#include "analysis/rows.h"
#include "base/error.h"
#include "base/index.h"
#include "model/leg.h"

namespace freeplay {
namespace {

constexpr long most_points = 1'000'000;

}  // namespace

RequestedStations::RequestedStations(IdealMechanism& mechanism, const AnalysisRequest& request, const TickOf& tick_of)
    : mechanism_(mechanism), request_(request), tick_of_(tick_of) {
  find_freedoms();
  warn_idle_elbow();
  if (request.kind == AnalysisKind::workspace) ways_ = joint_ways(model());
  find();
  if (request.branches) find_branches();
  leave_out_ends();
  check_reach();
  check_inputs();
  if (request.kind == AnalysisKind::singularity || request.kind == AnalysisKind::workspace) check_outputs();
}

// Legs in closed form leave the platform all three.
void RequestedStations::find_freedoms() {
  if (mechanism_.closed_form()) return;
  PostureSolver solver(mechanism_);
  mobility_ = general_mobility(solver, model().settings.start, mechanism_.start());
  freedoms_ = mobility_->general.platform;
  check_inputs();
}

void RequestedStations::check_inputs() {
  if (!mobility_) {
    const auto reached = std::ranges::find(stations_, true, &Station::reachable);
    if (reached == stations_.end()) return;
    PostureSolver solver(mechanism_);
    mobility_ = general_mobility(solver, model().settings.start, reached->posture);
  }
  const int left = mobility_->general.held;
  if (mobility_->general.platform_held == 0 && (left == 0 || request_.kind != AnalysisKind::inverse_dynamics)) return;
  throw Error(Error::Category::input, "ik-underdetermined",
              fmt::format("fewer drivers than freedoms: with all {} inputs held the mechanism still has {} freedom{}",
                          mechanism_.platform().inputs.size(), left, left == 1 ? "" : "s"),
              section().joints_location.value_or(mechanism_.platform().location));
}

void RequestedStations::check_outputs() {
  if (turns_whole(form(), given_)) return;
  std::vector<const char*> words;
  for (std::size_t i = 0; i < form().size(); ++i) {
    if (given_[i]) words.push_back(form().words[i]);
  }
  if (request_.kind == AnalysisKind::workspace) {
    warnings_.push_back(
        fmt::format("the condition is known with all angles as outputs or with none, not with {}: it is empty",
                    enumeration(words)));
    return;
  }
  throw Error(Error::Category::input, "type-space",
              fmt::format("singularities in space are looked for with all angles as outputs or with none, not with {}",
                          enumeration(words)),
              {model().file, 0, 0});
}

/// Working modes are those of a crank and a coupler on pins below the frame.
void RequestedStations::warn_idle_elbow() {
  const bool option = request_.chooses_elbow;
  if (!option && !section().elbow_location) return;
  if (option && (!request_.inputs.empty() || request_.branches)) {
    warnings_.push_back(
        fmt::format("--elbow chooses nothing with {} [elbow-ignored]",
                    request_.branches ? "--branches: every mode is shown" : "--input: the start decides the assembly"));
    return;
  }
  std::vector<std::string> idle;
  for (const int j : mechanism_.platform().inputs) {
    if (find_leg_chain(mechanism_.model(), j, mechanism_.platform().marker)) continue;
    idle.push_back(fmt::format("'{}'", model().joints[static_cast<std::size_t>(j)].name));
  }
  if (idle.empty()) return;
  warnings_.push_back(
      fmt::format("{}: no crank and coupler on pins lead from {} to the platform: the start decides {} "
                  "working mode{} [elbow-ignored]",
                  option ? "--elbow" : "'analysis.elbow'", fmt::join(idle, ", "), idle.size() == 1 ? "its" : "their",
                  idle.size() == 1 ? "" : "s"));
}

void RequestedStations::find() {
  if (!request_.poses.empty()) return at_poses();
  if (!request_.inputs.empty()) return at_inputs();
  if (request_.times) return on_path(*request_.times);
  if (request_.asks_for_grid() || !request_.must_reach()) return on_axes();
  const Settings& settings = model().settings;
  on_path(section().time.value_or(GridValues{{}, settings.start, settings.end, 101, false}));
}

/// Postures beyond the end of a joint's way are out of reach.
void RequestedStations::leave_out_ends() {
  if (ways_.empty()) return;
  PostureSolver solver(mechanism_);
  for (Station& station : stations_) {
    if (station.reachable) {
      station.reachable = within_ways(ways_, solver, station.demand.t, station.posture, station.why);
    }
  }
}

void RequestedStations::at_poses() {
  std::vector<Demand> demands;
  for (const AnalysisRequest::Pose& asked : request_.poses) {
    const PoseWords& pose = asked.pose;
    Demand demand;
    demand.t = model().settings.start;
    demand.given = components_to_give(form(), freedoms_, pose.given, asked.words, {});
    for (std::size_t i = 0; i < form().size(); ++i) {
      demand.pose[i] = Jet::constant(pose.given[i] ? pose.value[i] : 0.0);
    }
    demands.push_back(demand);
  }
  given_ = demands.front().given;
  for (const Demand& demand : demands) {
    if (demand.given == given_) continue;
    throw Error(Error::Category::usage, "bad-value", "every --pose must give the same of " + enumeration(form().words));
  }
  stations_ = at_demands(mechanism_, demands, tick_of_("poses found", demands.size()));
}

void RequestedStations::at_inputs() {
  std::vector<Demand> demands;
  for (const AnalysisRequest::Inputs& asked : request_.inputs) {
    Demand demand;
    demand.t = model().settings.start;
    demand.inputs = asked.values;
    const auto held = std::ranges::count_if(demand.inputs, [](const Jet& jet) { return !std::isnan(jet.value); });
    const int needed = mobility_ ? mobility_->general.freedoms - mobility_->general.held : freedoms_;
    if (held < needed) {
      throw Error(Error::Category::usage, "bad-value",
                  fmt::format("--input {} gives {} input{}, but the mechanism has {} freedom{}", asked.words, held,
                              held == 1 ? "" : "s", needed, needed == 1 ? "" : "s"));
    }
    demands.push_back(demand);
  }
  given_ = default_components();
  stations_ = at_demands(mechanism_, demands, tick_of_("poses found", demands.size()));
}

void RequestedStations::on_path(const GridValues& times) {
  if (times.count > most_points) throw Error(Error::Category::usage, "too-large", "at most 10^6 instants");
  const Platform& platform = mechanism_.platform();
  if (platform.has_path()) {
    given_ = platform.path_components();
    const Components needed =
        components_to_give(form(), freedoms_, given_, "the path", section().path_location.value_or(platform.location));
    if (needed != given_) {
      throw Error(Error::Category::input, "ik-underdetermined",
                  fmt::format("the path gives no angle, but the mechanism leaves its frame {} freedoms", freedoms_),
                  section().path_location.value_or(platform.location));
    }
  } else {
    given_ = default_components();
  }
  stations_ = along_path(mechanism_, times, tick_of_("poses found", static_cast<std::size_t>(times.count)));
}

void RequestedStations::on_axes() {
  std::array<std::optional<GridValues>, most_components> axes = section().grid;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (request_.grid[i]) axes[i] = request_.grid[i];
  }
  Components written{};
  for (std::size_t i = 0; i < form().size(); ++i) written[i] = axes[i].has_value();
  if (count(written) == 0 && model().space == Space::spatial) {
    throw Error(Error::Category::usage, "missing-argument", "no poses are known", {},
                "--pose, --grid x=FROM:TO:COUNT, --time or --input, or 'grid' in the section 'analysis'");
  }
  if (count(written) == 0) {
    throw Error(Error::Category::input, "missing-key", "no poses are known: 'analysis' needs 'grid'",
                {model().file, 0, 0}, "or --grid x=FROM:TO:COUNT, --pose, --time or --input");
  }
  const bool from_options = request_.asks_for_grid();
  const Location in_file = section().grid_location.value_or(Location{model().file, 0, 0});
  given_ = components_to_give(form(), freedoms_, written, "the grid", from_options ? Location{} : in_file);
  double points = 1.0;
  for (std::size_t i = 0; i < form().size(); ++i) {
    axes_[i] = axes[i].value_or(GridValues::one(0.0));
    points *= static_cast<double>(axes_[i].count);
  }
  if (points > static_cast<double>(most_points)) {
    throw Error(from_options ? Error::Category::usage : Error::Category::input, "too-large",
                "the grid of an analysis has at most 10^6 points", from_options ? Location{} : in_file);
  }
  stations_ = on_grid(mechanism_, std::span(axes_).first(form().size()), given_, request_.threads,
                      tick_of_("poses found", static_cast<std::size_t>(points)), ways_);
  on_grid_ = true;
}

/// The components of the path or the grid. Where neither says which are meant: the first that the mechanism can be
/// given, with a word where that matters.
Components RequestedStations::default_components() {
  const Components path = mechanism_.platform().path_components();
  const int wanted = std::min(freedoms_, form().freedoms());
  if (count(path) == wanted) return path;
  Components grid{};
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = section().grid[i].has_value();
  if (count(grid) == wanted) return grid;
  Components first{};
  for (int i = 0; i < wanted; ++i) first[static_cast<std::size_t>(i)] = true;
  if (wanted < form().freedoms() &&
      (request_.kind == AnalysisKind::workspace || request_.kind == AnalysisKind::singularity)) {
    warnings_.push_back(fmt::format("no path or grid of 'analysis' gives the outputs: {} {} taken",
                                    enumeration(form().words.first(static_cast<std::size_t>(wanted))),
                                    wanted > 1 ? "are" : "is"));
  }
  return first;
}

void RequestedStations::check_reach() {
  const auto reached = std::ranges::count(stations_, true, &Station::reachable);
  if (request_.must_reach() || !request_.inputs.empty()) {
    for (const Station& station : stations_) {
      if (station.reachable) continue;
      throw Error(Error::Category::numerical, "ik-unreachable",
                  fmt::format("{}: {}", station_words(form(), station), station.why.text(mechanism_)));
    }
  }
  if (on_grid_ && reached == 0) warnings_.push_back("no point of the grid can be reached");
  if (on_grid_) return;
  for (const Station& station : stations_) {
    if (!station.reachable) warnings_.push_back(station_words(form(), station) + ": " + station.why.text(mechanism_));
  }
}

/// Each station becomes one for every posture that it has, reached from the start or not.
void RequestedStations::find_branches() {
  if (request_.kind != AnalysisKind::inverse_kinematics || (request_.poses.empty() && request_.inputs.empty())) {
    throw Error(Error::Category::usage, "bad-value", "--branches is for ik with --pose or --input");
  }
  std::vector<Station> all;
  const Tick tick = tick_of_("sets of branches found", stations_.size());
  for (const Station& station : stations_) {
    int number = 0;
    for (Posture& posture : all_postures(mechanism_, station.demand, tick)) {
      all.push_back(station);
      all.back().posture = std::move(posture);
      all.back().reachable = true;
      branch_of_.push_back(++number);
    }
    if (number > 0) continue;
    all.push_back(station);
    branch_of_.push_back(0);
  }
  stations_ = std::move(all);
}

}  // namespace freeplay
