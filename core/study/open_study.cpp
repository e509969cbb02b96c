#include "study/open_study.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <span>

#include <fmt/format.h>

#include "base/arithmetic.h"
#include "base/sha256.h"
#include "base/unit.h"
#include "base/version.h"
#include "study/document_json.h"
#include "study/point_source.h"

namespace freeplay {
namespace {

/// Reports reducers whose columns are called as those of axes. Those of a set have the name of the reducer before a
/// dot.
void check_names(const StudyPlan& plan, std::span<const StudyColumn> columns, Diagnostics& diagnostics) {
  if (plan.section().reducers == nullptr) return;
  for (const Node::Entry& entry : plan.section().reducers->entries) {
    const std::string& name = entry.key->text;
    const auto clashes = [&](const StudyColumn& column) {
      return (column.name == name || column.name.starts_with(name + ".")) &&
             std::ranges::find(plan.axis_columns(), column.name, &AxisColumn::name) != plan.axis_columns().end();
    };
    if (std::ranges::none_of(columns, clashes)) continue;
    diagnostics.error(
        entry.key->location(), static_cast<int>(name.size()), "duplicate-name",
        fmt::format("an axis has a column of the reducer '{}', too: one of them needs another name", name));
  }
}

/// The half width of an interval is in the unit of its reducer.
void check_width(const StudyStop& stop, const std::string& unit) {
  if (!stop.width) return;
  const Dimension dimension = unit.empty() || unit == "1" ? dimension::none : parse_unit(unit).dimension;
  stop.width->quantity(dimension);
}

}  // namespace

std::unique_ptr<OpenStudy> OpenStudy::open(const std::string& file, const StudyPlanOptions& options,
                                           Diagnostics& diagnostics) {
  std::unique_ptr<OpenStudy> study(new OpenStudy);
  study->plan_ = StudyPlan::read(file, options, diagnostics);
  if (!study->plan_) return nullptr;
  if (study->plan_->has_models()) {
    study->runner_ = std::make_unique<PointRunner>(point_source(study->plan_->file()), options.load, diagnostics);
    study->columns_ = {study->runner_->columns(), study->runner_->sample_columns()};
  } else {
    study->columns_ = StudyFolder(std::filesystem::path(file).parent_path()).columns();
  }
  if (diagnostics.has_errors()) return nullptr;
  study->work_ = std::make_unique<PlannedWork>(*study->plan_, study->runner_.get());
  study->layout_ = row_layout(*study->plan_, study->columns_);
  const auto& stop = study->plan_->section().stop;
  if (stop && study->stop_column() == study->layout_.columns.size()) {
    study->plan_->section().section.fail("unknown-name",
                                         "`stop` looks at the reducer '" + stop->reducer + "', which there is not");
    return nullptr;
  }
  check_names(*study->plan_, study->layout_.columns, diagnostics);
  if (stop) check_width(*stop, study->layout_.columns[study->stop_column()].unit);
  if (diagnostics.has_errors()) return nullptr;
  return study;
}

StudyMark OpenStudy::mark() const {
  std::string program = sha256_of_file("/proc/self/exe");
  std::set<std::string> plugins;  // wherever they lie
  for (const std::string& file : runner_->plugin_files()) plugins.insert(sha256_of_file(file));
  for (const std::string& digits : plugins) program += "\n" + digits;
  const auto text_of = [](const Node* node) { return node == nullptr ? std::string() : document_json(*node); };
  std::string columns = text_of(plan_->section().reducers) + "\n" + text_of(plan_->section().analysis);
  for (const StudyColumn& column : layout_.columns) columns += "\n" + column.name;
  return {plan_->identity(), program_version, sha256(program), arithmetic_fingerprint(), sha256(columns)};
}

std::size_t OpenStudy::stop_column() const {
  if (!plan_->section().stop) return 0;
  const auto found = std::ranges::find(layout_.columns, plan_->section().stop->reducer, &StudyColumn::name);
  return static_cast<std::size_t>(found - layout_.columns.begin());
}

std::optional<StopRule> OpenStudy::stop_rule() const {
  const auto& stop = plan_->section().stop;
  if (!stop) return std::nullopt;
  const StopOptions options{.reducer = stop->reducer,
                            .percentile = stop->percentile.value_or(-1.0),
                            .confidence = stop->confidence,
                            .half_width = stop->half_width,
                            .relative = stop->relative,
                            .min_points = stop->min_points,
                            .block = stop->block};
  return StopRule(options, plan_->points() / plan_->samples(), plan_->samples());
}

}  // namespace freeplay
