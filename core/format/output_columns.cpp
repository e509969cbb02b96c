#include "format/output_columns.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "format/map_reader.h"
#include "format/name_rule.h"
#include "model/channel.h"

namespace freeplay {
namespace {

/// The columns of a model by name; those that a formula names are counted from 0.
class ColumnNames final : public FormulaVariables {
 public:
  explicit ColumnNames(const Channels& channels) {
    for (const ChannelInfo& channel : channels.all()) all_.emplace(channel.name, channel.unit);
  }

  std::optional<FormulaVariable> find(std::string_view name) const override {
    const auto channel = all_.find(std::string(name));
    if (channel == all_.end()) return std::nullopt;
    auto place = std::ranges::find(named_, name);
    if (place == named_.end()) place = named_.insert(place, std::string(name));
    const Dimension dimension = channel->second.empty() ? dimension::none : parse_unit(channel->second).dimension;
    return FormulaVariable{static_cast<int>(place - named_.begin()), DimensionKind::dimensioned, dimension};
  }
  std::string word() const override { return "channel"; }
  std::string nearest(std::string_view name) const override {
    std::vector<std::string> names;
    for (const auto& [channel, unit] : all_) names.push_back(channel);
    std::ranges::sort(names);
    return freeplay::nearest(name, names);
  }
  /// Those that were named since the last call.
  std::vector<std::string> take() const { return std::exchange(named_, {}); }

 private:
  std::unordered_map<std::string, std::string_view> all_;
  mutable std::vector<std::string> named_;
};

}  // namespace

void read_output_columns(const CheckedValue& value, Model& model) {
  if (!value.node().is_map()) return value.wrong_type("a map from names to formulas");
  const Channels channels(model, true);
  const ColumnNames names(channels);
  for (const CheckedValue& entry : entries_of(value)) {
    if (!is_name(entry.key())) {
      entry.fail_at_key("bad-name", "'" + entry.key() + "' is not a valid name", {}, name_hint(entry.key()));
      continue;
    }
    std::optional<Expression> formula = entry.formula(names);
    std::vector<std::string> named = names.take();
    if (!formula) continue;
    const bool dimensioned = formula->kind() == DimensionKind::dimensioned;
    model.settings.columns.push_back({"output." + entry.key(), entry.node().text,
                                      dimensioned ? si_unit(formula->dimension()) : "1", std::move(*formula),
                                      std::move(named)});
  }
}

}  // namespace freeplay
