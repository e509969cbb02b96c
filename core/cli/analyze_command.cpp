#include "cli/analyze_command.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "analysis/branches.h"
#include "analysis/clearance_error.h"
#include "analysis/mobility.h"
#include "analysis/singularity.h"
#include "analysis/workspace.h"
#include "cli/analysis_rows.h"
#include "cli/analysis_watch.h"
#include "cli/analyze_options.h"
#include "cli/failure.h"
#include "cli/loading.h"
#include "cli/output_file.h"
#include "cli/processors.h"
#include "cli/terminal.h"
#include "drawing/map_drawing.h"
#include "load/load.h"

namespace freeplay {
namespace {

constexpr long most_points = 1'000'000;

/// One analysis of a model that was read.
class AnalyzeJob {
 public:
  AnalyzeJob(LoadedModel& loaded, const AnalyzeOptions& options, AnalysisWatch& watch)
      : loaded_(loaded),
        options_(options),
        watch_(watch),
        mechanism_(*loaded.model, platform(*loaded.model, options)) {}

  AnalysisTable execute() {
    find_freedoms();
    warn_idle_elbow();
    find_stations();
    if (options_.branches) find_branches();
    check_reach();
    check_inputs();
    if (wants("singularity")) check_outputs();
    AnalysisTable table = rows();
    add_summary(table);
    return table;
  }
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// The map of a table over a grid of x and y.
  std::string drawing(const AnalysisTable& table) {
    bool flat = on_grid_ && axes_[0].count > 1 && axes_[1].count > 1;
    for (std::size_t i = 2; i < form().size(); ++i) flat = flat && axes_[i].count == 1;
    if (!flat || must_reach()) {
      throw Error(
          Error::Category::usage, "bad-value",
          "--svg draws a map: workspace, singularity or error on a grid of x and y, with one value of all else");
    }
    const std::string column = wants("error") ? "position" : "condition";
    const auto place = static_cast<std::size_t>(std::ranges::find(table.columns, column) - table.columns.begin());
    PositionMap map;
    map.title = fmt::format("{}: {}", model().name,
                            wants("error") ? "largest position error by clearance" : "condition number");
    for (std::size_t i = 2; i < form().size(); ++i) {
      if (!given_[i] || axes_[i].value(0) == 0.0) continue;
      map.title += fmt::format(", {} {:.6g} {}", form().words[i], axes_[i].value(0), form().is_turn(i) ? "rad" : "m");
    }
    map.quantity = wants("error") ? "position error [um]" : "condition number";
    const double unit = wants("error") ? 1e6 : 1.0;
    for (long i = 0; i < axes_[0].count; ++i) map.x.push_back(axes_[0].value(i));
    for (long j = 0; j < axes_[1].count; ++j) map.y.push_back(axes_[1].value(j));
    for (std::size_t k = 0; k < stations_.size(); ++k) {
      const double value = std::get<double>(table.rows[k][place]);
      map.values.push_back(unit * value);
      const bool good =
          stations_[k].reachable && std::isfinite(value) && (wants("error") || value * singular_limit < 1.0);
      map.points.push_back(!stations_[k].reachable ? MapPoint::unreachable
                           : good                  ? MapPoint::good
                                                   : MapPoint::singular);
    }
    if (!std::ranges::is_sorted(map.x) || !std::ranges::is_sorted(map.y)) {
      throw Error(Error::Category::usage, "bad-value", "--svg needs a grid whose x and y grow");
    }
    map.determinant = determinants(mechanism_, stations_, given_, processor_count(),
                                   watch_.begin("signs of the map", stations_.size()));
    const auto& path = mechanism_.platform().path;
    for (int k = 0; k <= 200 && path[0] && path[1]; ++k) {
      const Settings& settings = model().settings;
      Jet x, y;
      EvaluationFailure failure;
      const double t = settings.start + (settings.end - settings.start) * k / 200.0;
      if (path[0]->evaluate(t, x, failure) && path[1]->evaluate(t, y, failure)) map.path.push_back({x.value, y.value});
    }
    return map_svg(map);
  }

 private:
  static Platform platform(Model& model, const AnalyzeOptions& options) {
    PlatformOverrides overrides;
    if (!options.frame.empty()) overrides.marker = frame_marker(model, options.frame);
    if (!options.elbow.empty()) overrides.elbow = elbow_of(options.elbow);
    return platform_of(model, overrides);
  }

  bool wants(const char* kind) const { return options_.kind == kind; }
  /// Unreachable poses are errors.
  bool must_reach() const { return wants("ik") || wants("inverse-dynamics"); }
  const Model& model() const { return *loaded_.model; }
  const PoseForm& form() const { return mechanism_.form(); }
  const AnalysisSection& section() const { return loaded_.model->analysis; }

  // Legs in closed form leave the platform all three.
  void find_freedoms() {
    if (mechanism_.closed_form()) return;
    PostureSolver solver(mechanism_);
    mobility_ = general_mobility(solver, model().settings.start, mechanism_.start());
    freedoms_ = mobility_->general.platform;
    check_inputs();
  }

  void check_inputs() {
    if (!mobility_) {
      const auto reached = std::ranges::find(stations_, true, &Station::reachable);
      if (reached == stations_.end()) return;
      PostureSolver solver(mechanism_);
      mobility_ = general_mobility(solver, model().settings.start, reached->posture);
    }
    const int left = mobility_->general.held;
    if (mobility_->general.platform_held == 0 && (left == 0 || !wants("inverse-dynamics"))) return;
    throw Error(Error::Category::input, "ik-underdetermined",
                fmt::format("fewer drivers than freedoms: with all {} inputs held the mechanism still has {} freedom{}",
                            mechanism_.platform().inputs.size(), left, left == 1 ? "" : "s"),
                section().joints_location.value_or(mechanism_.platform().location));
  }

  /// Changes of single angles in space are no changes of a rotation vector.
  void check_outputs() const {
    int turns = 0;
    std::vector<const char*> words;
    for (std::size_t i = 0; i < form().size(); ++i) {
      if (given_[i]) words.push_back(form().words[i]);
      if (given_[i] && form().is_turn(i)) ++turns;
    }
    if (turns == 0 || turns == static_cast<int>(form().size() - form().lengths)) return;
    throw Error(
        Error::Category::input, "type-space",
        fmt::format("singularities in space are looked for with all angles as outputs or with none, not with {}",
                    enumeration(words)),
        {model().file, 0, 0});
  }

  /// Working modes are those of a crank and a coupler on pins below the frame.
  void warn_idle_elbow() {
    const bool option = !options_.elbow.empty();
    if (!option && !section().elbow_location) return;
    if (option && (!options_.input.empty() || options_.branches)) {
      warnings_.push_back(
          fmt::format("--elbow chooses nothing with {} [elbow-ignored]",
                      options_.branches ? "--branches: every mode is shown" : "--input: the start tells the assembly"));
      return;
    }
    std::vector<std::string> idle;
    for (const int j : mechanism_.platform().inputs) {
      if (find_leg_chain(mechanism_.model(), j, mechanism_.platform().marker)) continue;
      idle.push_back(fmt::format("'{}'", model().joints[static_cast<std::size_t>(j)].name));
    }
    if (idle.empty()) return;
    warnings_.push_back(
        fmt::format("{}: no crank and coupler on pins lead from {} to the platform: the start tells {} "
                    "working mode{} [elbow-ignored]",
                    option ? "--elbow" : "'analysis.elbow'", fmt::join(idle, ", "), idle.size() == 1 ? "its" : "their",
                    idle.size() == 1 ? "" : "s"));
  }

  void find_stations() {
    const int ways = (options_.pose.empty() ? 0 : 1) + (options_.grid.empty() ? 0 : 1) +
                     (options_.time.empty() ? 0 : 1) + (options_.input.empty() ? 0 : 1);
    if (ways > 1) {
      throw Error(Error::Category::usage, "bad-value", "--pose, --grid, --time and --input exclude each other");
    }
    if (!options_.pose.empty()) return stations_at_poses();
    if (!options_.input.empty()) return stations_at_inputs();
    if (!options_.time.empty()) return stations_on_path(times_of(options_.time));
    if (!options_.grid.empty() || !must_reach()) return stations_on_grid();
    const Settings& settings = model().settings;
    stations_on_path(section().time.value_or(GridValues{{}, settings.start, settings.end, 101, false}));
  }

  void stations_at_poses() {
    std::vector<Demand> demands;
    for (const std::string& text : options_.pose) {
      const PoseWords words = pose_of(form(), text);
      Demand demand;
      demand.t = model().settings.start;
      demand.given = components_to_give(form(), freedoms_, words.given, fmt::format("--pose {}", text), {});
      for (std::size_t i = 0; i < form().size(); ++i) {
        demand.pose[i] = Jet::constant(words.given[i] ? words.value[i] : 0.0);
      }
      demands.push_back(demand);
    }
    given_ = demands.front().given;
    for (const Demand& demand : demands) {
      if (demand.given == given_) continue;
      throw Error(Error::Category::usage, "bad-value",
                  "every --pose must give the same of " + enumeration(form().words));
    }
    stations_ = at_demands(mechanism_, demands, watch_.begin("poses found", demands.size()));
  }

  void stations_at_inputs() {
    std::vector<Demand> demands;
    for (const std::string& text : options_.input) {
      Demand demand;
      demand.t = model().settings.start;
      demand.inputs = inputs_of(text, model(), mechanism_.platform().inputs);
      const auto held = std::ranges::count_if(demand.inputs, [](const Jet& jet) { return !std::isnan(jet.value); });
      const int needed = mobility_ ? mobility_->general.freedoms - mobility_->general.held : freedoms_;
      if (held < needed) {
        throw Error(Error::Category::usage, "bad-value",
                    fmt::format("--input {} gives {} inputs, but the mechanism has {} freedoms", text, held, needed));
      }
      demands.push_back(demand);
    }
    given_ = default_components();
    stations_ = at_demands(mechanism_, demands, watch_.begin("poses found", demands.size()));
  }

  void stations_on_path(const GridValues& times) {
    if (times.count > most_points) throw Error(Error::Category::usage, "too-large", "at most 10^6 instants");
    const Platform& platform = mechanism_.platform();
    if (platform.has_path()) {
      given_ = platform.path_components();
      const Components needed = components_to_give(form(), freedoms_, given_, "the path",
                                                   section().path_location.value_or(platform.location));
      if (needed != given_) {
        throw Error(Error::Category::input, "ik-underdetermined",
                    "the path gives no angle, but the mechanism leaves its frame 3 freedoms",
                    section().path_location.value_or(platform.location));
      }
    } else {
      given_ = default_components();
    }
    stations_ = along_path(mechanism_, times, watch_.begin("poses found", static_cast<std::size_t>(times.count)));
  }

  void stations_on_grid() {
    std::array<std::optional<GridValues>, most_components> axes;
    std::ranges::copy(section().grid, axes.begin());
    Components set{};
    for (const std::string& text : options_.grid) {
      const auto [a, values] = grid_axis_of(form(), text);
      if (set[a])
        throw Error(Error::Category::usage, "bad-value", fmt::format("--grid {}: this axis is given twice", text));
      set[a] = true;
      axes[a] = values;
    }
    Components written{};
    for (std::size_t i = 0; i < form().size(); ++i) written[i] = axes[i].has_value();
    if (count(written) == 0 && model().space == Space::spatial) {
      throw Error(Error::Category::usage, "missing-argument", "no poses are known", {},
                  "--pose, --grid x=FROM:TO:COUNT, --time or --input");
    }
    if (count(written) == 0) {
      throw Error(Error::Category::input, "missing-key", "no poses are known: 'analysis' needs 'grid'",
                  {model().file, 0, 0}, "or --grid x=FROM:TO:COUNT, --pose, --time or --input");
    }
    const bool from_options = !options_.grid.empty();
    given_ = components_to_give(form(), freedoms_, written, "the grid",
                                from_options ? Location{} : Location{model().file, 0, 0});
    double points = 1.0;
    for (std::size_t i = 0; i < form().size(); ++i) {
      axes_[i] = axes[i].value_or(GridValues::one(0.0));
      points *= static_cast<double>(axes_[i].count);
    }
    if (points > static_cast<double>(most_points)) {
      throw Error(from_options ? Error::Category::usage : Error::Category::input, "too-large",
                  "the grid of an analysis has at most 10^6 points",
                  from_options ? Location{} : Location{model().file, 0, 0});
    }
    stations_ = on_grid(mechanism_, std::span(axes_).first(form().size()), given_, processor_count(),
                        watch_.begin("poses found", static_cast<std::size_t>(points)));
    on_grid_ = true;
  }

  /// The components of the path or the grid. Where nobody says which are meant: the first that the mechanism can be
  /// given, with a word where that matters.
  Components default_components() {
    const Components path = mechanism_.platform().path_components();
    const int wanted = std::min(freedoms_, form().freedoms());
    if (count(path) == wanted) return path;
    Components grid{};
    for (std::size_t i = 0; i < section().grid.size(); ++i) grid[i] = section().grid[i].has_value();
    if (count(grid) == wanted) return grid;
    Components first{};
    for (int i = 0; i < wanted; ++i) first[static_cast<std::size_t>(i)] = true;
    if (wanted < form().freedoms() && (wants("workspace") || wants("singularity"))) {
      warnings_.push_back(fmt::format("no path or grid of 'analysis' tells the outputs: {} {} taken",
                                      enumeration(form().words.first(static_cast<std::size_t>(wanted))),
                                      wanted > 1 ? "are" : "is"));
    }
    return first;
  }

  void check_reach() {
    const auto reached = std::ranges::count(stations_, true, &Station::reachable);
    if (must_reach() || !options_.input.empty()) {
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
  void find_branches() {
    if (!wants("ik") || (options_.pose.empty() && options_.input.empty())) {
      throw Error(Error::Category::usage, "bad-value", "--branches is for ik with --pose or --input");
    }
    std::vector<Station> all;
    const Tick tick = watch_.begin("sets of branches found", stations_.size());
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

  AnalysisTable rows() {
    const int threads = processor_count();
    const Tick tick = watch_.begin("poses analysed", stations_.size());
    if (wants("ik")) return ik_rows(mechanism_, stations_, branch_of_, tick);
    if (wants("workspace")) return workspace(threads, tick);
    if (wants("singularity")) return singularity_rows(mechanism_, stations_, given_, threads, tick);
    if (wants("error")) {
      ErrorColumns columns;
      columns.sensitivity = options_.sensitivity;
      if (!options_.samples.empty()) columns.samples = whole_number("--samples", options_.samples, 1);
      if (!options_.seed.empty()) columns.seed = static_cast<std::uint64_t>(whole_number("--seed", options_.seed, 0));
      if (!options_.distribution.empty()) columns.law = play_law_of(options_.distribution);
      if (mechanism_.plays().empty() && mechanism_.input_error() == 0.0) {
        warnings_.push_back("no joint has clearance and no input errs: all errors are 0");
      }
      return error_rows(mechanism_, stations_, columns, threads, warnings_, tick);
    }
    const double preload = options_.preload.empty() ? 0.0 : preload_of(options_.preload);
    return inverse_dynamics_rows(mechanism_, stations_, preload, tick);
  }

  AnalysisTable workspace(int threads, const Tick& tick) {
    AnalysisTable table = workspace_rows(mechanism_, stations_, given_, threads, tick);
    if (!on_grid_ || !given_[0] || !given_[1] || axes_[2].count != 1) return table;
    const WorkspaceShape shape = workspace_shape(mechanism_, stations_, {axes_[0], axes_[1], axes_[2]},
                                                 watch_.begin("edges searched", stations_.size()));
    table.summary["area"] = shape.area;
    table.summary["regions"] = shape.regions;
    table.summary["holes"] = shape.holes;
    table.summary["boundary"] = shape.boundary;
    return table;
  }

  /// What stands behind the worst position error, where one pose was asked for.
  Json causes() {
    PostureSolver solver(mechanism_);
    VelocityMapper mapper(mechanism_, form().all());
    VelocityMap map;
    const Station& station = stations_.front();
    mapper.map(solver.evaluate(station.demand.t, station.posture, term_position), map);
    const auto error = clearance_error(mechanism_, map);
    if (!error) return nullptr;
    const Eigen::VectorXd& worst = error->exact.worst;
    Json shares = Json::object();
    std::size_t k = 0;
    for (const Play& play : mechanism_.plays()) {
      shares[play_name(mechanism_, play)] = json_number(play.radius * error->sensitivity[k++]);
    }
    for (const int j : mechanism_.platform().inputs) {
      const double share = mechanism_.input_error() * error->sensitivity[k++];
      if (share > 0.0) shares["driver." + model().joints[static_cast<std::size_t>(j)].name] = json_number(share);
    }
    Json displacement = Json::array();
    for (const double change : worst) displacement.push_back(json_number(change));
    // An angle in the plane, a unit vector in space.
    Json direction = json_number(std::atan2(worst[1], worst[0]));
    if (form().lengths == 3) {
      direction = Json::array();
      for (const double part : worst.head<3>().normalized()) direction.push_back(json_number(part));
    }
    return {{"displacement", std::move(displacement)}, {"direction", direction}, {"share", std::move(shares)}};
  }

  /// A torque where all inputs turn, a force where all slide; either where they differ.
  double preload_of(const std::string& text) const {
    int turning = 0;
    const int inputs = static_cast<int>(mechanism_.platform().inputs.size());
    for (int i = 0; i < inputs; ++i) turning += mechanism_.is_angle(i) ? 1 : 0;
    if (turning == 0) return signed_quantity("--preload", text, dimension::force);
    if (turning == inputs) return signed_quantity("--preload", text, dimension::torque);
    try {
      return signed_quantity("--preload", text, dimension::torque);
    } catch (const Error&) {
      return signed_quantity("--preload", text, dimension::force);
    }
  }

  void add_summary(AnalysisTable& table) {
    Json names = Json::array();
    for (const int j : mechanism_.platform().inputs) names.push_back(model().joints[static_cast<std::size_t>(j)].name);
    Json own = {{"frame", model().markers[static_cast<std::size_t>(mechanism_.platform().marker)].name},
                {"inputs", std::move(names)},
                {"length", mechanism_.length()}};
    if (mobility_) {
      own["freedoms"] = mobility_->general.freedoms;
      own["redundant_inputs"] = mobility_->general.redundant_inputs;
      own["redundant_constraints"] = mobility_->general.redundant_rows;
      own["special_configuration"] = mobility_->special();
    }
    if (wants("workspace") || wants("singularity")) {
      own["outputs"] = Json::array();
      for (std::size_t i = 0; i < form().size(); ++i) {
        if (given_[i]) own["outputs"].push_back(form().words[i]);
      }
    }
    own["points"] = stations_.size();
    own["reachable"] = std::ranges::count(stations_, true, &Station::reachable);
    if (wants("error") && stations_.size() == 1 && stations_.front().reachable) own["worst"] = causes();
    own.update(table.summary);
    table.summary = std::move(own);
  }

  LoadedModel& loaded_;
  const AnalyzeOptions& options_;
  AnalysisWatch& watch_;
  IdealMechanism mechanism_;
  std::optional<GeneralMobility> mobility_;
  int freedoms_ = 3;  // of the platform
  Components given_{true, true, true};
  std::vector<Station> stations_;
  std::vector<int> branch_of_;
  std::array<GridValues, most_components> axes_;
  bool on_grid_ = false;
  std::vector<std::string> warnings_;
};

/// Options that the kind has no use for.
void refuse_idle_options(const AnalyzeOptions& options) {
  const auto only = [&](bool given, const char* option, const char* kind) {
    if (!given || options.kind == kind) return;
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("{} is for {}, not for {}", option, kind, options.kind));
  };
  only(options.sensitivity, "--sensitivity", "error");
  only(!options.samples.empty(), "--samples", "error");
  only(!options.seed.empty(), "--seed", "error");
  only(!options.distribution.empty(), "--distribution", "error");
  only(!options.preload.empty(), "--preload", "inverse-dynamics");
  only(options.branches, "--branches", "ik");
  for (const auto& [text, option] : {std::pair{&options.seed, "--seed"}, {&options.distribution, "--distribution"}}) {
    if (text->empty() || !options.samples.empty()) continue;
    throw Error(Error::Category::usage, "bad-value", fmt::format("{} is given without --samples", option), {},
                "--samples N draws random play");
  }
}

int analyze(const AnalyzeOptions& options, const CommonOptions& common) {
  if (options.kind.empty() || options.model.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "analyze needs a kind and a model file", {},
                "freeplay analyze ik|workspace|singularity|error|inverse-dynamics MODEL");
  }
  require_word("kind of analysis", options.kind, {"ik", "workspace", "singularity", "error", "inverse-dynamics"});
  LoadedModel loaded = load_model(options.model, build_options(options.build), loading(common));
  if (!loaded.model) return report_failure(loaded.diagnostics, loaded.exit_code, common);
  refuse_idle_options(options);
  if (options.kind == "workspace") require_planar(loaded, "analyze workspace");
  if (options.branches) require_planar(loaded, "--branches");
  if (!options.elbow.empty()) require_planar(loaded, "--elbow");
  AnalysisTable table;
  std::vector<std::string> warnings;
  std::string drawing;
  try {
    AnalysisWatch watch(stderr_is_terminal() && !common.quiet);
    AnalyzeJob job(loaded, options, watch);
    table = job.execute();
    warnings = job.warnings();
    if (!options.svg.empty()) drawing = job.drawing(table);
  } catch (const Interrupted&) {
    Diagnostic diagnostic;
    diagnostic.id = "interrupted";
    diagnostic.message = "interrupted, nothing was written";
    diagnostic.location = {options.model, 0, 0};
    loaded.diagnostics.add(std::move(diagnostic));
    return report_failure(loaded.diagnostics, 130, common);
  } catch (const Error& error) {
    if (error.category() != Error::Category::input && error.category() != Error::Category::plugin) throw;
    Diagnostic diagnostic = as_diagnostic(error);
    if (error.location().file.empty() && loaded.document) diagnostic.location = {loaded.document->file_name(), 0, 0};
    loaded.diagnostics.add(std::move(diagnostic));
    return report_failure(loaded.diagnostics, error.exit_code(), common);
  }
  print_messages(loaded.diagnostics.format(common.max_errors), common.no_color);
  for (const std::string& warning : warnings) {
    print_messages(fmt::format("{}: warning: {}\n", options.model, warning), common.no_color);
  }
  if (!options.svg.empty()) write_output(options.svg, drawing);
  if (!options.out.empty() || !common.json) write_output(options.out, table.csv());
  if (common.json) print_json(table.json(options.kind));
  return 0;
}

}  // namespace

Command add_analyze_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "analyze", "Kinematics, errors by clearance and drive forces of a platform");
  const auto options = std::make_shared<AnalyzeOptions>();
  add_option(*app, "KIND", options->kind, "ik, workspace, singularity, error or inverse-dynamics");
  add_option(*app, "MODEL", options->model, "Model file");
  add_option(*app, "--frame", options->frame, "The platform: BODY or BODY/FRAME", "FRAME");
  add_repeatable(*app, "--pose", options->pose,
                 "Pose: x,y,angle or x=5cm,y=0 (in space x,y,z,roll,pitch,yaw); repeatable", "POSE");
  add_repeatable(*app, "--grid", options->grid, "Poses on a grid: x=FROM:TO:COUNT (also y and so on); repeatable",
                 "GRID");
  add_option(*app, "--time", options->time, "Instants on the path: FROM:TO:COUNT", "TIMES");
  add_repeatable(*app, "--input", options->input, "Coordinates of driven joints: JOINT=VALUE,...; repeatable",
                 "INPUTS");
  add_option(*app, "--elbow", options->elbow, "Working modes of the legs: 1 or -1, or a list", "S[,S...]");
  add_flag(*app, "--sensitivity", options->sensitivity, "error: sensitivity to the clearance of each joint");
  add_option(*app, "--samples", options->samples, "error: columns of N samples of random play", "N");
  add_option(*app, "--seed", options->seed, "Of the samples (0)", "S");
  add_option(*app, "--distribution", options->distribution, "Of the samples: uniform (default), rim or normal[:SIGMA]",
             "LAW");
  add_flag(*app, "--branches", options->branches, "ik: all working modes of a --pose, all assemblies of an --input");
  add_option(*app, "--preload", options->preload, "inverse-dynamics: inner tension of redundant drivers", "VALUE");
  add_file_option(*app, "--out", options->out, "Write the CSV into a file instead of stdout", "FILE");
  add_file_option(*app, "--svg", options->svg, "Draw the map of a grid of x and y into a file", "FILE");
  add_model_options(*app, options->build);
  add_common_options(*app, common);
  return {app, [options, &common] { return analyze(*options, common); }};
}

}  // namespace freeplay
