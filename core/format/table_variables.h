// TableVariables: the variables of a formula that a component's parameter table names.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/checked_value.h"

namespace freeplay {

/// Plain words, in the order of their indices.
class TableVariables final : public FormulaVariables {
 public:
  void add(std::string name, const Dimension& dimension) { all_.emplace_back(std::move(name), dimension); }

  std::optional<FormulaVariable> find(std::string_view name) const override {
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (all_[i].first == name)
        return FormulaVariable{static_cast<int>(i), DimensionKind::dimensioned, all_[i].second};
    }
    return std::nullopt;
  }
  bool plain() const override { return true; }
  std::string word() const override { return "variable"; }
  std::string nearest(std::string_view name) const override { return freeplay::nearest(name, names()); }
  std::string known() const override { return "it may hold " + either(names()); }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& [name, dimension] : all_) names.push_back(name);
    return names;
  }

 private:
  std::vector<std::pair<std::string, Dimension>> all_;
};

}  // namespace freeplay
