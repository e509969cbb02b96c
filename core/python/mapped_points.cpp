#include "python/mapped_points.h"

#include <algorithm>
#include <utility>

#include "python/refusal.h"
#include "study/axis_value.h"
#include "study/planned_work.h"
#include "study/point_source.h"
#include "yaml/document.h"

namespace freeplay {
namespace {

constexpr int exit_input = 3;

/// Without what a point sets itself.
BuildOptions common_options(const OpenRequest& request) {
  BuildOptions build = build_options(request.words);
  build.set.clear();
  build.without_study = true;
  return build;
}

}  // namespace

MappedPoints::MappedPoints(std::shared_ptr<const OpenedModel> model, const std::string& reducers,
                           const std::vector<std::string>& targets, const std::vector<std::vector<std::string>>& points)
    : model_(std::move(model)), options_{model_->request().load} {
  const BuildOptions build = build_options(model_->request().words);
  source_.models = {&model_->document()};
  source_.build = common_options(model_->request());
  for (const auto& pair : build.set) source_.set.push_back({pair.first, pair.second});
  read_reducers(reducers);
  for (const std::string& target : targets) keys_.push_back({target, model_->unit_of(target), false});
  for (const std::vector<std::string>& texts : points) {
    StudyPoint point{.index = cells_.size(), .hash = {}, .settings = source_.set, .cells = {}, .direction = {}};
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const AxisValue value = AxisValue::of(texts[i]);
      point.cells.push_back(value.cell());
      if (!texts[i].empty()) point.settings.push_back({keys_[i].name, value.text});
    }
    cells_.push_back(point.cells);
    units_.push_back({std::move(point)});
  }
  check();
}

MappedPoints::MappedPoints(const OpenRequest& request, const std::string& reducers) : options_{request.load} {
  Diagnostics diagnostics;
  StudyPlanOptions options{.load = options_};
  for (const auto& [target, text] : build_options(request.words).set) options.set.emplace_back(target, text);
  plan_ = StudyPlan::read(request.file, options, diagnostics);
  if (!plan_) throw Refusal(diagnostics, exit_input);
  source_ = point_source(plan_->file());
  source_.build = common_options(request);
  if (!reducers.empty()) read_reducers(reducers);
  add_plan();
  check();
}

void MappedPoints::add_plan() {
  if (plan_->section().stop) {
    throw Error(Error::Category::usage, "not-in-this-release", "map() of a study with `stop`: not in this release");
  }
  Diagnostics ignored;
  const PointRunner runner(source_, options_, ignored);
  const MergePlan merge = merge_plan(*plan_, {runner.columns(), runner.sample_columns()});
  start_cell_ = merge.start_cell.value_or(0);
  for (const KeyColumn& key : merge.keys) keys_.push_back({key.name, key.unit, key.words});
  for (std::uint64_t index = 0; index < plan_->points(); ++index) merge.cells(index, cells_.emplace_back());
  for (std::uint64_t unit = 0; unit < plan_->units(); ++unit) {
    PointUnit& points = units_.emplace_back();
    for (std::uint64_t place = 0; place < plan_->unit_size(unit); ++place) {
      points.push_back(plan_->point(plan_->unit_point(unit, place)));
    }
  }
}

void MappedPoints::read_reducers(const std::string& text) {
  Diagnostics diagnostics;
  reducers_ = parse_yaml(text, "<reduce>", diagnostics);
  if (!reducers_ || diagnostics.has_errors()) throw Refusal(diagnostics, exit_input);
  source_.reducers = &reducers_->root();
}

// What is wrong with the reducers or with the whole; the columns.
void MappedPoints::check() {
  Diagnostics diagnostics;
  if (reducers_) diagnostics.add_source("<reduce>", reducers_->text());
  const PointRunner runner(source_, options_, diagnostics);
  if (diagnostics.has_errors()) throw Refusal(diagnostics, exit_input);
  if (model_ && !units_.empty()) runner.try_settings(units_.front().front());
  columns_ = runner.columns();
  for (const StudyColumn& column : columns_) {
    if (std::ranges::find(keys_, column.name, &Column::name) == keys_.end()) continue;
    throw Error(Error::Category::usage, "duplicate-name",
                "a point sets '" + column.name + "', and a reducer is called so, too: it needs another name");
  }
}

bool MappedPoints::run(int workers, const std::function<bool(std::size_t)>& beat) {
  bool whole = true;
  outcomes_ = run_in_threads(source_, options_, units_, points(), workers,
                             [&](std::size_t done) { return whole = whole && beat(done); });
  if (!source_.chained) return whole;
  for (std::size_t i = 0; i < points(); ++i) {
    if (outcomes_[i]) cells_[i][start_cell_] = outcomes_[i]->start;
  }
  return whole;
}

}  // namespace freeplay
