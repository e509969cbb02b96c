#include "study/value_check.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace freeplay {
namespace {

// What does not depend on the size of numbers.
constexpr std::array ids = {"unknown-name",   "unknown-key",        "unknown-type",     "missing-key",
                            "wrong-type",     "dimension-mismatch", "bad-value",        "conflicting-keys",
                            "bad-expression", "bad-unit",           "time-not-allowed", "wrong-length",
                            "type-space",     "state-not-allowed",  "file-not-found"};

const Diagnostic* fault_in(const ModelProbe::Result& result) {
  const auto found = std::ranges::find_if(
      result.errors, [](const Diagnostic& error) { return std::ranges::find(ids, error.id) != ids.end(); });
  return found == result.errors.end() ? nullptr : &*found;
}

class ValueCheck {
 public:
  ValueCheck(StudyFile& study, std::size_t model, const LoadOptions& options)
      : study_(study), model_(model), probe_(*study.models()[model].document, options) {
    for (const PlannedAxis& axis : study.axes()) kinds_.push_back(axis.kinds());
  }

  /// All axes at once, as long as nothing is wrong; else one by one.
  void check() {
    std::size_t rounds = 0;
    for (const auto& kinds : kinds_) rounds = std::max(rounds, kinds.size());
    for (std::size_t round = 0; round < rounds; ++round) {
      std::vector<PlannedSetting> settings;
      for (std::size_t axis = 0; axis < kinds_.size(); ++axis) add(axis, round, settings);
      if (settings.empty()) continue;
      const ModelProbe::Result result = tried(settings);
      if (result.model) take_inputs(*result.model);
      for (std::size_t axis = 0; axis < kinds_.size() && fault_in(result) != nullptr; ++axis) check_alone(axis, round);
    }
  }

 private:
  // All stand in one folder of copies, where a point finds its own by the name.
  void take_inputs(const Model& model) {
    for (const InputFile& input : model.inputs) {
      if (study_.keep_input(model_, input)) continue;
      study_.section().section.fail_at_key(
          "duplicate-name",
          fmt::format("the points of '{}' read different files that are called '{}': give them names of their own",
                      study_.models()[model_].name, input.name));
    }
  }

  void add(std::size_t number, std::size_t round, std::vector<PlannedSetting>& settings) const {
    const PlannedAxis& axis = study_.axes()[number];
    if (!axis.present[model_] || round >= kinds_[number].size()) return;
    const std::vector<double> middle(study_.draws(), 0.5);
    std::vector<std::string> cells;
    axis.add(kinds_[number][round], middle, settings, cells);
  }

  ModelProbe::Result tried(const std::vector<PlannedSetting>& settings) const {
    TargetTexts set = study_.set_texts();
    for (const PlannedSetting& setting : settings) set.emplace_back(setting.target, setting.value.text);
    return probe_.build(set, nullptr);
  }

  void check_alone(std::size_t number, std::size_t round) const {
    std::vector<PlannedSetting> settings;
    add(number, round, settings);
    if (settings.empty()) return;
    const ModelProbe::Result result = tried(settings);
    const Diagnostic* fault = fault_in(result);
    if (fault == nullptr) return;
    const std::string of_set = "--set ";
    auto at = std::ranges::find_if(settings, [&](const PlannedSetting& one) {
      return fault->location.file == of_set + one.target || result.refused == one.target;
    });
    if (at == settings.end()) at = settings.begin();
    const PlannedAxis& axis = study_.axes()[number];
    const std::uint64_t place = kinds_[number][round];
    const bool several = axis.table() || !axis.source().cases.empty();
    const std::string where =
        axis.table() ? fmt::format("line {} of '{}': ", axis.table()->line(place), axis.source().table->node().text)
                     : "";
    axis.written(at->target, place)
        .fail(fault->id,
              fmt::format("{}'{}' = {}: {}", where, several ? at->target : axis.name(), at->value.text, fault->message),
              fault->suggestion, fault->hint);
  }

  StudyFile& study_;
  std::size_t model_;
  ModelProbe probe_;
  std::vector<std::vector<std::uint64_t>> kinds_;
};

}  // namespace

void check_values(StudyFile& study, const LoadOptions& options) {
  for (std::size_t model = 0; model < study.models().size(); ++model) ValueCheck(study, model, options).check();
}

}  // namespace freeplay
