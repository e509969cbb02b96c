#include "study/plan.h"

#include <utility>

#include "base/sha256.h"
#include "study/idle_axes.h"
#include "study/point_source.h"
#include "study/value_check.h"

namespace freeplay {
namespace {

constexpr std::size_t hash_digits = 24;

std::unique_ptr<const Draws> draws_of(const StudyFile& file) {
  if (file.draws() == 0) return nullptr;
  const StudySample& sample = *file.section().sample;
  return std::make_unique<const Draws>(static_cast<SampleMethod>(sample.method), sample.seed, sample.points,
                                       file.draws());
}

bool within_sobol(const StudyFile& file) {
  const auto& sample = file.section().sample;
  if (!sample || sample->method != StudySample::Method::sobol || file.draws() <= most_sobol_axes) return true;
  file.section().section.fail_at_key(
      "too-large",
      "there are " + std::to_string(file.draws()) + " random numbers in a sample; Sobol's have at most 1000 axes", {},
      "method: latin-hypercube");
  return false;
}

}  // namespace

// A mistake in the axes leaves those of the reducers to be found.
std::unique_ptr<StudyPlan> StudyPlan::read(const std::string& file, const StudyPlanOptions& options,
                                           Diagnostics& diagnostics) {
  std::unique_ptr<StudyFile> read =
      StudyFile::read(file, {options.kept, options.look}, options.set, options.load, diagnostics);
  if (!read) return nullptr;
  std::unique_ptr<StudyPlan> plan(new StudyPlan(std::move(read)));
  if (!diagnostics.has_errors() && within_sobol(*plan->file_)) plan->lay_out(options, diagnostics);
  if (!diagnostics.has_errors()) return plan;
  if (plan->has_models()) PointRunner(point_source(*plan->file_), options.load, diagnostics);
  return nullptr;
}

void StudyPlan::lay_out(const StudyPlanOptions& options, Diagnostics& diagnostics) {
  layout_ = std::make_unique<const StudyLayout>(section(), file_->axes(), models().size(), options.many_points);
  draws_ = draws_of(*file_);
  if (diagnostics.has_errors() || !has_models()) return;
  check_values(*file_, options.load);
  if (!diagnostics.has_errors()) doubt_idle_axes(*file_, options.load);
}

StudyPlan::StudyPlan(std::unique_ptr<StudyFile> file) : file_(std::move(file)) {
  for (const PlannedAxis& axis : file_->axes()) {
    columns_.insert(columns_.end(), axis.columns().begin(), axis.columns().end());
  }
}

std::vector<StudySetting> StudyPlan::set() const {
  std::vector<StudySetting> set;
  for (const PlannedSetting& setting : file_->set()) set.push_back({setting.target, setting.value.text});
  return set;
}

PlacedPoint StudyPlan::settings_of(std::uint64_t index, std::vector<PlannedSetting>& settings,
                                   std::vector<std::string>& cells) const {
  PlacedPoint placed = layout_->at(index);
  std::vector<double> numbers(file_->draws());
  if (draws_) draws_->fill(placed.sample, numbers);
  settings = file_->set();
  const std::vector<PlannedAxis>& axes = file_->axes();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (placed.places[i]) {
      axes[i].add(*placed.places[i], numbers, settings, cells);
    } else {
      cells.resize(cells.size() + axes[i].columns().size());
    }
  }
  return placed;
}

StudyPoint StudyPlan::point(std::uint64_t index) const {
  StudyPoint point;
  std::vector<PlannedSetting> settings;
  const PlacedPoint placed = settings_of(index, settings, point.cells);
  point.index = index;
  point.hash = hash(index);
  point.model = placed.model;
  for (PlannedSetting& setting : settings) {
    point.settings.push_back({std::move(setting.target), std::move(setting.value.text)});
  }
  point.sample = placed.sample;
  if (chained()) point.direction = placed.down ? "down" : "up";
  return point;
}

std::string StudyPlan::own_hash(std::uint64_t index, const std::string& before) const {
  std::vector<PlannedSetting> settings;
  std::vector<std::string> cells;
  const PlacedPoint placed = settings_of(index, settings, cells);
  std::string text = "freeplay-point 1\nmodel " + models()[placed.model].sha256 + "\n";
  for (const PlannedSetting& setting : settings) text += setting.target + "=" + setting.value.shown + "\n";
  if (!before.empty()) text += "after " + before + "\n";
  return sha256(text).substr(0, hash_digits);
}

std::string StudyPlan::hash(std::uint64_t index) const {
  if (!chained()) return own_hash(index, "");
  const UnitPlace at = place_of(index);
  if (at.unit != hashed_unit_) hashes_.clear();
  hashed_unit_ = at.unit;
  while (hashes_.size() <= at.place) {
    hashes_.push_back(own_hash(unit_point(at.unit, hashes_.size()), hashes_.empty() ? std::string() : hashes_.back()));
  }
  return hashes_[at.place];
}

}  // namespace freeplay
