// Entries of the section `reducers` become what a point of one model computes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/name_pattern.h"
#include "load/channel_check.h"
#include "study/point_reducers.h"
#include "study/summary_unit.h"

namespace freeplay {
namespace {

constexpr double most_samples = 1e7;  // of one section

FormulaVariable variable_of(int index, std::string_view unit) {
  const Dimension dimension = unit.empty() ? dimension::none : parse_unit(unit).dimension;
  return {index, dimension.dimensionless() ? DimensionKind::free : DimensionKind::dimensioned, dimension};
}

/// [NAME] is a channel.
class ChannelVariables final : public FormulaVariables {
 public:
  /// With `any_name`, one that there is not stands for a channel of any unit.
  ChannelVariables(const Channels& channels, bool any_name) : channels_(channels), any_name_(any_name) {}
  /// Has a formula named a channel that there is not?
  bool lacks_some() const { return lacks_some_; }
  std::optional<FormulaVariable> find(std::string_view name) const override {
    const int index = channels_.find(name);
    if (index < 0 && any_name_) {
      lacks_some_ = true;
      return FormulaVariable{0, DimensionKind::free, dimension::none};
    }
    if (index < 0) return std::nullopt;
    return variable_of(index, channels_.all()[static_cast<std::size_t>(index)].unit);
  }
  std::string word() const override { return "channel"; }
  std::string nearest(std::string_view name) const override { return nearest_channel(std::string(name), channels_); }

 private:
  const Channels& channels_;
  bool any_name_;
  mutable bool lacks_some_ = false;
};

/// [NAME] is a column that stands before the one at `end`.
class ColumnVariables final : public FormulaVariables {
 public:
  ColumnVariables(const ReducerColumns& columns, std::size_t end) : columns_(columns), end_(static_cast<int>(end)) {}
  std::optional<FormulaVariable> find(std::string_view name) const override {
    const int index = columns_.find(name);
    if (index < 0 || index >= end_) return std::nullopt;
    return variable_of(index, columns_.all()[static_cast<std::size_t>(index)].unit);
  }
  std::string word() const override { return "reducer above this one:"; }
  std::string nearest(std::string_view name) const override {
    std::vector<std::string> names;
    for (int i = 0; i < end_; ++i) names.push_back(columns_.all()[static_cast<std::size_t>(i)].name);
    return freeplay::nearest(name, names);
  }

 private:
  const ReducerColumns& columns_;
  int end_;
};

std::string unit_of(const Expression& formula) {
  return formula.kind() == DimensionKind::dimensioned ? si_unit(formula.dimension()) : "1";
}

/// A quantity of the dimension, or of any.
double quantity_of(const CheckedValue& value, const std::optional<Dimension>& dimension, const Range& range = {}) {
  if (dimension) return value.quantity(*dimension, range).value_or(0.0);
  const auto quantity = value.any_quantity();
  return quantity ? quantity->value : 0.0;
}

}  // namespace

PointReducers::PointReducers(std::span<const ReducerEntry> entries, ReducerColumns& columns, const Model& model,
                             const Channels& channels, Lacking lacking)
    : entries_(entries),
      columns_(columns),
      model_(model),
      channels_(channels),
      lacking_(lacking),
      values_(columns.all().size(), std::numeric_limits<double>::quiet_NaN()),
      samples_(columns.samples().size()) {
  for (std::size_t i = 0; i < entries.size(); ++i) bind(entries[i], i);
  if (!of_events_.empty()) {
    events_.emplace(model, event_layout_, [this](std::span<const double> numbers) { take_event(numbers); });
    sinks_.push_back(&*events_);
  }
  renew_next();
}

void PointReducers::bind(const ReducerEntry& entry, std::size_t index) {
  switch (entry.source) {
    case ReducerEntry::Source::channel:
    case ReducerEntry::Source::value:
      return bind_course(entry, index);
    case ReducerEntry::Source::events:
      return bind_events(entry, index);
    case ReducerEntry::Source::of:
      return bind_of(entry, index);
    case ReducerEntry::Source::column:
      if (entry.reduction)
        of_columns_.push_back({columns_.first(index), &entry, Reduced(rule_of(entry, std::nullopt))});
      return;
    case ReducerEntry::Source::summary:
      needs_summary_ = true;
      columns_.set_unit(columns_.first(index), summary_unit(entry.text(), model_, channels_));
      return;
    case ReducerEntry::Source::set:
      return;
  }
}

int PointReducers::channel_of(const CheckedValue& name) const {
  const std::string& text = name.node().text;
  const int channel = channels_.find(text);
  if (channel < 0 && lacking_ == Lacking::mistake)
    name.fail("unknown-name", fmt::format("there is no channel '{}'", text), nearest_channel(text, channels_));
  return channel;
}

std::optional<PointReducers::Course> PointReducers::course_of(const ReducerEntry& entry, std::string& unit) const {
  if (entry.source == ReducerEntry::Source::channel) {
    const int channel = channel_of(entry.subject);
    if (channel < 0) return std::nullopt;
    unit = channels_.all()[static_cast<std::size_t>(channel)].unit;
    if (unit.empty()) unit = "1";
    return Course{.channel = channel};
  }
  const ChannelVariables variables(channels_, lacking_ == Lacking::no_value);
  auto formula = entry.subject.formula(variables);
  if (!formula || variables.lacks_some()) return std::nullopt;
  unit = unit_of(*formula);
  return Course{.formula = std::move(formula)};
}

void PointReducers::bind_course(const ReducerEntry& entry, std::size_t index) {
  std::string unit;
  auto course = course_of(entry, unit);
  if (!course) return;
  const std::size_t column = columns_.first(index);
  const bool any = course->formula && course->formula->kind() != DimensionKind::dimensioned;
  if (entry.section) {
    columns_.set_sample_unit(columns_.list(index), unit);
    return bind_section(entry, index, std::move(*course));
  }
  if (!entry.reduction) return;
  columns_.set_unit(column, has_unit_of_values(*entry.reduction) ? unit : "1");
  const auto dimension = any ? std::nullopt : std::optional<Dimension>(parse_unit(unit).dimension);
  timed_.push_back({column, std::move(*course), window_of(entry), Reduced(rule_of(entry, dimension))});
}

void PointReducers::bind_section(const ReducerEntry& entry, std::size_t index, Course course) {
  Section section{.column = columns_.first(index),
                  .list = columns_.list(index),
                  .course = std::move(course),
                  .window = window_of(entry)};
  if (entry.channel && entry.crosses) {
    const int channel = channel_of(*entry.channel);
    if (channel < 0) return;
    const std::string_view unit = channels_.all()[static_cast<std::size_t>(channel)].unit;
    const Dimension dimension = unit.empty() ? dimension::none : parse_unit(unit).dimension;
    passing_.push_back(sections_.size());
    passages_.push_back({channel, quantity_of(*entry.crosses, dimension), entry.up, entry.down});
  } else if (entry.every) {
    const double phase = entry.phase ? quantity_of(*entry.phase, dimension::time) : 0.0;
    const double every = quantity_of(*entry.every, dimension::time, positive);
    if (!(every > 0.0)) return;
    if (model_.settings.end - model_.settings.start > most_samples * every) {
      entry.every->fail("too-large",
                        fmt::format("a section has at most 10^7 values, and from {:g} s to {:g} s there are more",
                                    model_.settings.start, model_.settings.end));
      return;
    }
    const double begin = model_.settings.start + phase, from = std::max(section.window.from, model_.settings.start);
    section.begin = begin;
    section.every = every;
    section.turns = std::max(0.0, std::ceil((from - begin) / every - 1e-9));
    section.next = begin + section.turns * every;
  }
  sections_.push_back(std::move(section));
}

void PointReducers::bind_events(const ReducerEntry& entry, std::size_t index) {
  if (!entry.reduction) return;
  if (event_layout_.events.empty()) add_event_columns(model_, event_layout_);
  OfEvents of{columns_.first(index),
              std::vector<char>(model_.joints.size(), 0),
              -1.0,
              -1,
              -std::numeric_limits<double>::infinity(),
              window_of(entry),
              Reduced(rule_of(entry, std::nullopt))};
  const std::string pattern = entry.text();
  std::vector<std::string> names;
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    if (model_.joints[j].layout.events.size == 0) continue;
    names.push_back(model_.joints[j].name);
    of.joints[j] = matches(pattern, names.back()) ? 1 : 0;
  }
  if (std::ranges::find(of.joints, 1) == of.joints.end()) {
    if (is_pattern(pattern)) of_events_.push_back(std::move(of));  // of no joint there are no events
    if (lacking_ == Lacking::mistake && !is_pattern(pattern)) refuse_events(entry, names);
    return;
  }
  const auto kind = std::ranges::find(event_layout_.kinds, entry.kind);
  if (kind == event_layout_.kinds.end()) {
    entry.subject.fail("unknown-name", fmt::format("there is no kind of event '{}'", entry.kind),
                       nearest(entry.kind, event_layout_.kinds));
  }
  of.kind = static_cast<double>(kind - event_layout_.kinds.begin());
  std::string unit = "1";
  if (!entry.field.empty()) {
    std::vector<std::string> fields;
    for (std::size_t c = 3; c < event_layout_.events.size(); ++c) fields.push_back(event_layout_.events[c].name);
    const auto field = std::ranges::find(fields, entry.field);
    if (field == fields.end()) {
      entry.subject.fail("unknown-name", fmt::format("events have no column '{}'", entry.field),
                         nearest(entry.field, fields));
      return;
    }
    of.field = static_cast<int>(3 + (field - fields.begin()));
    unit = event_layout_.events[static_cast<std::size_t>(of.field)].unit;
    if (entry.above) of.above = quantity_of(*entry.above, parse_unit(unit).dimension);
  }
  columns_.set_unit(columns_.first(index), has_unit_of_values(*entry.reduction) ? unit : "1");
  of_events_.push_back(std::move(of));
}

void PointReducers::refuse_events(const ReducerEntry& entry, const std::vector<std::string>& names) const {
  const std::string name = entry.text();
  if (std::ranges::find(model_.joints, name, &JointElement::name) != model_.joints.end()) {
    entry.subject.fail("unknown-name", fmt::format("joint '{}' has no events: nothing in it touches", name),
                       nearest(name, names));
  } else {
    entry.subject.fail("unknown-name", fmt::format("there is no joint '{}'", name), nearest(name, names));
  }
}

void PointReducers::bind_of(const ReducerEntry& entry, std::size_t index) {
  auto formula = entry.subject.formula(ColumnVariables(columns_, columns_.first(index)));
  if (!formula) return;
  columns_.set_unit(columns_.first(index), unit_of(*formula));
  of_others_.push_back({columns_.first(index), std::move(*formula)});
}

ReductionRule PointReducers::rule_of(const ReducerEntry& entry, const std::optional<Dimension>& dimension) const {
  ReductionRule rule{.kind = *entry.reduction};
  if (entry.p) rule.p = quantity_of(*entry.p, dimension::none, {.minimum = 0.0, .maximum = 100.0});
  if (entry.source == ReducerEntry::Source::events) return rule;
  rule.above = !entry.below.has_value();
  if (entry.above) rule.bound = quantity_of(*entry.above, dimension);
  if (entry.below) rule.bound = quantity_of(*entry.below, dimension);
  return rule;
}

PointReducers::Window PointReducers::window_of(const ReducerEntry& entry) const {
  const Settings& settings = model_.settings;
  Window window{.from = settings.start + settings.discard};
  if (entry.from) window.from = quantity_of(*entry.from, dimension::time);
  if (entry.until) window.until = quantity_of(*entry.until, dimension::time);
  const auto fixed = [](const std::optional<CheckedValue>& time) {
    return time && time->node().text.find('$') == std::string::npos;
  };
  if (fixed(entry.from) && fixed(entry.until) && window.until < window.from && lacking_ == Lacking::mistake) {
    entry.until->fail("out-of-range",
                      fmt::format("the time ends at {:g} s, before it begins at {:g} s", window.until, window.from));
  }
  if (fixed(entry.from) && window.from > settings.end && lacking_ == Lacking::mistake) {
    entry.from->warn("no-statistics",
                     fmt::format("the time begins at {:g} s, but at the values of the file the run ends at {:g} s: "
                                 "where it does, the column is empty",
                                 window.from, settings.end));
  }
  return window;
}

}  // namespace freeplay
