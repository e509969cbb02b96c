#include "study/planned_axis.h"

#include <algorithm>
#include <set>

#include "study/distribution.h"

namespace freeplay {
namespace {

constexpr std::size_t most_kinds = 1000;  // of words that are tried one by one

std::uint64_t size_of(const StudyAxis& axis, const std::optional<DesignTable>& table) {
  if (axis.grid) return static_cast<std::uint64_t>(axis.grid->count);
  if (!axis.list.empty()) return axis.list.size();
  if (!axis.cases.empty()) return axis.cases.size();
  return table ? table->rows() : std::max<std::size_t>(1, axis.fits.size());
}

}  // namespace

PlannedAxis::PlannedAxis(const StudyAxis& source, std::string name, std::string target,
                         std::optional<DesignTable> table, std::size_t first_draw)
    : source_(&source),
      name_(std::move(name)),
      target_(std::move(target)),
      table_(std::move(table)),
      first_draw_(first_draw),
      size_(size_of(source, table_)),
      clearances_(source.fits.begin(), source.fits.end()) {
  if (table_) {
    for (std::size_t i = 0; i < table_->targets().size(); ++i) {
      columns_.push_back({table_->targets()[i], "", table_->words(i)});
    }
    return;
  }
  const bool words = !source.list.empty() || !source.cases.empty() || chooses_fit();
  const bool random = source.random() && !chooses_fit();
  columns_.push_back({name_, source.dimension && !words ? si_unit(*source.dimension) : "", words, random});
}

std::vector<std::string> PlannedAxis::targets() const {
  if (table_) return table_->targets();
  if (chooses_fit()) return {};
  if (source_->cases.empty()) return {target_};
  std::vector<std::string> all;
  for (const StudyCase& one : source_->cases) {
    for (const TargetValue& value : one.values) {
      if (std::ranges::find(all, value.target) == all.end()) all.push_back(value.target);
    }
  }
  return all;
}

AxisValue PlannedAxis::value(std::uint64_t place, std::span<const double> draws) const {
  if (source_->grid) return AxisValue::of(source_->grid->value(static_cast<long>(place)), source_->dimension);
  if (!source_->list.empty()) return AxisValue::of(source_->list[place].node());
  if (source_->distribution) {
    return AxisValue::of(quantile(*source_->distribution, draws[first_draw_]), source_->dimension);
  }
  return AxisValue::of(clearances_[place].at(draws[first_draw_], draws[first_draw_ + 1]), source_->dimension);
}

void PlannedAxis::add(std::uint64_t place, std::span<const double> draws, std::vector<PlannedSetting>& settings,
                      std::vector<std::string>& cells) const {
  if (table_) {
    for (std::size_t i = 0; i < table_->targets().size(); ++i) {
      settings.push_back({table_->targets()[i], table_->value(place, i)});
      cells.push_back(settings.back().value.cell());
    }
  } else if (!source_->cases.empty()) {
    const StudyCase& one = source_->cases[place];
    for (const TargetValue& value : one.values) settings.push_back({value.target, AxisValue::of(value.value.node())});
    cells.push_back(one.name);
  } else if (chooses_fit()) {
    cells.push_back(source_->fits[place].code);
  } else {
    settings.push_back({target_, value(place, draws)});
    cells.push_back(settings.back().value.cell());
  }
}

// Quantities of one dimension differ in no more than a number.
std::vector<std::uint64_t> PlannedAxis::kinds() const {
  std::vector<std::uint64_t> kinds;
  if (!source_->cases.empty()) {
    for (std::uint64_t i = 0; i < size_; ++i) kinds.push_back(i);
  } else if (!source_->list.empty() || table_) {
    std::set<std::vector<std::string>> seen;
    std::vector<PlannedSetting> settings;
    std::vector<std::string> cells;
    for (std::uint64_t i = 0; i < size_ && seen.size() < most_kinds; ++i) {
      settings.clear();
      add(i, {}, settings, cells);
      std::vector<std::string> kind;
      for (const PlannedSetting& setting : settings) {
        const auto quantity = constant_quantity(setting.value.text);
        const bool dimensioned = quantity && quantity->kind == DimensionKind::dimensioned;
        kind.push_back(!quantity ? setting.value.text : dimensioned ? si_unit(quantity->dimension) : "1");
      }
      if (seen.insert(std::move(kind)).second) kinds.push_back(i);
      cells.clear();
    }
  } else {
    kinds.push_back(0);
  }
  return kinds;
}

const CheckedValue& PlannedAxis::written(const std::string& target, std::optional<std::uint64_t> place) const {
  if (place && !source_->list.empty()) return source_->list[*place];
  for (std::size_t i = 0; i < source_->cases.size(); ++i) {
    const auto& values = source_->cases[i].values;
    const auto found = std::ranges::find(values, target, &TargetValue::target);
    if (found != values.end() && (!place || *place == i)) return found->value;
  }
  return source_->entry;
}

}  // namespace freeplay
