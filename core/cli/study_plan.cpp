#include <algorithm>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "base/processors.h"
#include "base/text.h"
#include "cli/progress_line.h"
#include "cli/study_probe.h"
#include "cli/study_views.h"
#include "cli/terminal.h"

namespace freeplay {
namespace {

constexpr double longest_plan_probe = 10.0;  // [s]
constexpr std::size_t bytes_of_number = 20, bytes_of_row = 60;

/// Of a row in a segment: those of the points that were tried, else about, without samples.
std::size_t row_bytes(const OpenStudy& study, const std::optional<PointSeconds>& seconds) {
  if (seconds) return static_cast<std::size_t>(seconds->row_bytes);
  return bytes_of_row + bytes_of_number * (study.layout().columns.size() + 3);
}

void print_points(const OpenStudy& study, const StudyOptions& options) {
  const StudyPlan& plan = study.plan();
  std::string text = "index,hash";
  if (plan.has_model_column()) text += ",model";
  for (const AxisColumn& column : plan.axis_columns()) text += "," + column.name;
  if (plan.has_direction_column()) text += ",direction";
  if (plan.has_sample_column()) text += ",sample";
  text += "\n";
  PointRanges ranges{{0, plan.points() - 1}};
  if (options.only) ranges = point_ranges("--only", *options.only, plan.points());
  constexpr std::size_t piece = 1 << 16;
  for (const auto& range : ranges) {
    for (std::uint64_t index = range.first; index <= range.second; ++index) {
      const StudyPoint point = plan.point(index);
      text += fmt::format("{},{}", index, point.hash);
      if (plan.has_model_column()) text += "," + plan.models()[point.model].name;
      for (const std::string& cell : point.cells) text += "," + cell;
      if (plan.has_direction_column()) text += "," + point.direction;
      if (plan.has_sample_column()) text += fmt::format(",{}", point.sample);
      text += "\n";
      if (text.size() < piece) continue;
      print_data(text);
      text.clear();
    }
  }
  print_data(text);
}

Json plan_json(const OpenStudy& study, const std::optional<PointSeconds>& seconds) {
  Json axes = Json::array();
  for (const AxisColumn& column : study.plan().axis_columns()) {
    axes.push_back({{"name", column.name}, {"unit", column.unit}});
  }
  Json columns = Json::array();
  for (const StudyColumn& column : study.columns().table) columns.push_back(column.name);
  const Json times =
      seconds ? Json{{"mean", seconds->mean}, {"min", seconds->min}, {"max", seconds->max}} : Json(nullptr);
  return {{"name", study.plan().name()},           {"study", study.plan().identity()},
          {"points", study.plan().points()},       {"axes", axes},
          {"columns", std::move(columns)},         {"seconds_per_point", times},
          {"row_bytes", row_bytes(study, seconds)}};
}

std::string size_text(double bytes) {
  const char* units[] = {"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 1000.0 && unit + 1 < std::size(units)) bytes /= 1000.0, ++unit;
  return fmt::format("{:.3g} {}", bytes, units[unit]);
}

std::string plan_text(const OpenStudy& study, bool probed, const std::optional<PointSeconds>& seconds) {
  const StudyPlan& plan = study.plan();
  const auto points = static_cast<double>(plan.points());
  std::string text = fmt::format("{}: {} points\n", plan.name(), plan.points());
  for (const StudyModel& model : plan.models()) text += fmt::format("  model      {}  {}\n", model.name, model.file);
  for (const AxisColumn& column : plan.axis_columns()) {
    text += fmt::format("  axis       {}{}\n", column.name,
                        column.unit.empty() || column.unit == "1" ? "" : " [" + column.unit + "]");
  }
  if (plan.has_sample_column()) text += fmt::format("  samples    {} of each combination\n", plan.samples());
  for (const StudyColumn& column : study.layout().columns) {
    text += fmt::format("  column     {}{}\n", column.name,
                        column.unit.empty() || column.unit == "1" ? "" : " [" + column.unit + "]");
  }
  text += fmt::format("  disk       {}\n", size_text(points * static_cast<double>(row_bytes(study, seconds)) * 2.0));
  if (!seconds) {
    if (probed) text += fmt::format("  a point    longer than {:g} s: --probe 0 tries none\n", longest_plan_probe);
    return text;
  }
  const int here = processor_count();
  return text + fmt::format("  a point    {:.3g} s ({:.3g} to {:.3g})\n  time       {} on one core, {} on {} here\n",
                            seconds->mean, seconds->min, seconds->max, clock_text(seconds->mean * points),
                            clock_text(seconds->mean * points / here), here);
}

}  // namespace

int study_plan(const StudyOptions& options, const CommonOptions& common) {
  constexpr long usual = 8;
  const StudyInFolder opened = open_in_folder(only_study(options, "plan", "FILE or DIR"), options, common);
  if (!opened.study) return opened.exit_code;
  OpenStudy& study = *opened.study;
  if (options.list_points) {
    print_points(study, options);
    return 0;
  }
  const long probe = options.probe.empty() ? usual : whole_number("--probe", options.probe, 0);
  const auto seconds = probe_points(study, static_cast<std::uint64_t>(probe), longest_plan_probe);
  common.json ? print_json(plan_json(study, seconds)) : print(plan_text(study, probe > 0, seconds));
  return 0;
}

}  // namespace freeplay
