#include "study/idle_axes.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/token.h"
#include "convert/model_json.h"
#include "study/document_json.h"

namespace freeplay {
namespace {

constexpr std::size_t most_tried = 100;  // axes

/// Builds a model of the study with values of axes.
class AxisTrial {
 public:
  AxisTrial(const StudyFile& study, std::size_t model, const LoadOptions& options)
      : study_(study), model_(model), probe_(*study.models()[model].document, options) {}

  /// Whether two values of the axis make one model where the other axes have their first values, or their last ones.
  bool is_idle(std::size_t axis, bool last) {
    const std::optional<Made>& before = made_at(last);
    if (!before || cells(axis, last) == cells(axis, !last)) return false;
    const std::optional<Made> after = made_with(last, axis);
    return after && after->text == before->text && !reads_changed(after->text, before->parameters, after->parameters);
  }

 private:
  using Parameters = std::vector<std::pair<std::string, Quantity>>;
  struct Made {
    std::string text;
    Parameters parameters;
  };

  /// A function of time says which parameters it has, not their values: has one of these changed? Those of templates
  /// are not known here and may have.
  static bool reads_changed(const std::string& text, const Parameters& before, const Parameters& after) {
    for (std::size_t at = text.find('$'); at != std::string::npos; at = text.find('$', at + 1)) {
      const std::string name = text.substr(at + 1, word_end(text, at + 1) - at - 1);
      const auto value = [&](const Parameters& all) {
        const auto found = std::ranges::find(all, name, &Parameters::value_type::first);
        return found == all.end() ? std::nullopt : std::optional(found->second.value);
      };
      const auto was = value(before), is = value(after);
      if (!was || !is || *was != *is) return true;
    }
    return false;
  }

  /// Those of one end of the axis, or of one part of a random one.
  std::vector<std::string> cells(std::size_t axis, bool last) const {
    std::vector<PlannedSetting> settings;
    std::vector<std::string> cells;
    add(axis, last, settings, cells);
    return cells;
  }

  void add(std::size_t axis, bool last, std::vector<PlannedSetting>& settings, std::vector<std::string>& cells) const {
    const PlannedAxis& one = study_.axes()[axis];
    const std::vector<double> draws(study_.draws(), last ? 0.75 : 0.25);
    if (one.present[model_]) one.add(last ? one.size() - 1 : 0, draws, settings, cells);
  }

  /// All axes at one end, but for `turned` at the other; with `star` that one alone is set.
  std::optional<Made> made_with(bool last, std::optional<std::size_t> turned) const {
    std::vector<PlannedSetting> settings;
    std::vector<std::string> cells;
    const bool star = study_.section().combine == StudySection::Combine::star;
    for (std::size_t axis = 0; axis < study_.axes().size(); ++axis) {
      if (axis == turned) add(axis, !last, settings, cells);
      if (axis != turned && !star) add(axis, last, settings, cells);
    }
    TargetTexts set = study_.set_texts();
    for (const PlannedSetting& setting : settings) set.emplace_back(setting.target, setting.value.text);
    const ModelProbe::Result built = probe_.build(set, nullptr);
    if (!built.model) return std::nullopt;
    Json json = model_json(*built.model);
    for (const std::string& closed : built.model->ideal) json["joints"][closed].erase("clearance");
    return Made{json.dump(), built.model->parameters};
  }

  const std::optional<Made>& made_at(bool last) {
    auto& made = made_[last ? 1 : 0];
    if (!made) made = made_with(last, std::nullopt);
    return made;
  }

  const StudyFile& study_;
  std::size_t model_;
  ModelProbe probe_;
  std::optional<Made> made_[2];
};

/// Must the axis change the model at all?
bool is_expected_to_act(const StudyFile& study, const PlannedAxis& axis) {
  const StudySection& section = study.section();
  if (section.warm_start && &section.axes[section.warm_start->axis] == &axis.source()) return false;
  if (axis.chooses_fit() || !axis.source().list.empty()) return false;
  std::string readers;
  for (const Node* node : {section.reducers, section.analysis}) readers += node == nullptr ? "" : document_json(*node);
  return std::ranges::none_of(axis.targets(), [&](const std::string& target) {
    return target == "repeat" || readers.find("$" + target) != std::string::npos;
  });
}

}  // namespace

void doubt_idle_axes(const StudyFile& study, const LoadOptions& options) {
  if (study.section().analysis != nullptr) return;  // it also reads the section `analysis`
  std::vector<AxisTrial> trials;
  for (std::size_t model = 0; model < study.models().size(); ++model) trials.emplace_back(study, model, options);
  for (std::size_t axis = 0; axis < std::min(study.axes().size(), most_tried); ++axis) {
    const PlannedAxis& one = study.axes()[axis];
    if (!is_expected_to_act(study, one)) continue;
    std::size_t idle = 0, there = 0;
    for (std::size_t model = 0; model < trials.size(); ++model) {
      if (!one.present[model]) continue;
      ++there;
      if (trials[model].is_idle(axis, false) && trials[model].is_idle(axis, true)) ++idle;
    }
    if (there == 0 || idle < there) continue;
    const char* why =
        study.set().empty() ? "" : "; `set`, --set or --ideal have put something else in the place of what it sets";
    one.source().entry.warn_at_key(
        "unused", fmt::format("'{}' changes nothing: the model is the same at all its values{}", one.name(), why));
  }
}

}  // namespace freeplay
