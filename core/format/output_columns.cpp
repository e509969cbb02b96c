#include "format/output_columns.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "format/map_reader.h"
#include "format/name_rule.h"
#include "model/channel.h"

namespace freeplay {
namespace {

/// Reads the formulas in the order in which they need each other.
class ColumnReader final : public FormulaVariables {
 public:
  explicit ColumnReader(const Channels& channels) {
    for (const ChannelInfo& channel : channels.all()) all_.emplace(channel.name, channel.unit);
  }
  void add(const CheckedValue& section) {
    for (const CheckedValue& entry : entries_of(section)) {
      if (is_name(entry.key())) {
        add(prefix + entry.key(), entry);
      } else {
        entry.fail_at_key("bad-name", "'" + entry.key() + "' is not a valid name", {}, name_hint(entry.key()));
      }
    }
  }
  void add(const std::string& name, const CheckedValue& formula) {
    if (by_name_.emplace(name, entries_.size()).second) {
      entries_.push_back({formula, OutputColumn{name, formula.node().text, {}}});
    } else {
      formula.fail("duplicate-name", "'" + name + "' is the column of this condition, and another one in 'columns'");
    }
  }

  std::vector<OutputColumn> read() {
    std::vector<OutputColumn> good;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (entries_[i].state == State::waiting) compile(i);
    }
    for (Entry& entry : entries_) {
      if (entry.state == State::done) good.push_back(std::move(entry.column));
    }
    return good;
  }

  std::optional<FormulaVariable> find(std::string_view name) const override {
    const auto channel = all_.find(std::string(name));
    if (channel != all_.end()) {
      return variable(name, channel->second.empty() ? dimension::none : parse_unit(channel->second).dimension,
                      DimensionKind::dimensioned);
    }
    const auto other = by_name_.find(std::string(name));
    if (other == by_name_.end()) return std::nullopt;
    const Entry& entry = entries_[other->second];
    if (entry.state == State::waiting) compile(other->second);
    if (entry.state == State::open) return std::nullopt;
    if (entry.state == State::broken) return variable(name, dimension::none, DimensionKind::free);
    return variable(name, entry.column.formula.dimension(), entry.column.formula.kind());
  }
  std::string word() const override { return "channel"; }
  std::string nearest(std::string_view name) const override {
    std::vector<std::string> names;
    for (const auto& [channel, unit] : all_) names.push_back(channel);
    for (const auto& [column, place] : by_name_) names.push_back(column);
    std::ranges::sort(names);
    return freeplay::nearest(name, names);
  }
  std::string known() const override {
    return "it may hold t, parameters and the columns of 'freeplay list channels'; frames have columns where 'frames' "
           "of "
           "'output' lists them";
  }
  /// A column that needs itself.
  std::optional<Refusal> refusal(std::string_view name) const override {
    const auto other = by_name_.find(std::string(name));
    if (other == by_name_.end()) return std::nullopt;
    std::string chain;
    for (auto i = std::ranges::find(open_, other->second); i != open_.end(); ++i)
      chain += entries_[*i].column.name + " -> ";
    return Refusal{"algebraic-loop", "'" + std::string(name) + "' is defined by itself: " + chain + std::string(name),
                   "one of these formulas must do without the others"};
  }

 private:
  enum class State { waiting, open, done, broken };
  struct Entry {
    CheckedValue value;
    OutputColumn column;
    State state = State::waiting;
  };
  static constexpr const char* prefix = "output.";

  /// Called again from within, by names of other columns.
  void compile(std::size_t place) const {
    Entry& entry = entries_[place];
    entry.state = State::open;
    open_.push_back(place);
    std::vector<std::string> outer = std::exchange(named_, {});
    std::optional<Expression> formula = open_.size() > deepest ? refuse_depth(entry.value) : entry.value.formula(*this);
    entry.column.channels = std::exchange(named_, std::move(outer));
    open_.pop_back();
    entry.state = formula ? State::done : State::broken;
    if (!formula) return;
    const bool dimensioned = formula->kind() == DimensionKind::dimensioned;
    entry.column.unit = dimensioned ? si_unit(formula->dimension()) : "1";
    entry.column.formula = std::move(*formula);
  }
  static std::optional<Expression> refuse_depth(const CheckedValue& value) {
    value.fail("too-large", fmt::format("more than {} columns need each other in a row", deepest));
    return std::nullopt;
  }
  /// Those that a formula names are counted from 0.
  FormulaVariable variable(std::string_view name, const Dimension& dimension, DimensionKind kind) const {
    auto place = std::ranges::find(named_, name);
    if (place == named_.end()) place = named_.insert(place, std::string(name));
    return {static_cast<int>(place - named_.begin()), kind == DimensionKind::plain ? DimensionKind::free : kind,
            dimension};
  }

  static constexpr std::size_t deepest = 100;
  std::unordered_map<std::string, std::string_view> all_;
  std::unordered_map<std::string, std::size_t> by_name_;
  mutable std::vector<Entry> entries_;
  mutable std::vector<std::size_t> open_;   ///< being read, each for the one before
  mutable std::vector<std::string> named_;  ///< by the formula that is being read
};

}  // namespace

void read_output_columns(const std::optional<CheckedValue>& columns,
                         const std::vector<std::pair<std::string, CheckedValue>>& formulas, Model& model) {
  if (columns && !columns->node().is_map()) return columns->wrong_type("a map from names to formulas");
  const Channels channels(model, true);
  ColumnReader reader(channels);
  if (columns) reader.add(*columns);
  for (const auto& [name, formula] : formulas) reader.add(name, formula);
  model.settings.columns = reader.read();
}

}  // namespace freeplay
