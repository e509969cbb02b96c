// ParameterScope: the parameters that `$name` may refer to, evaluated in whatever order they need.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/expression.h"
#include "format/document.h"
#include "format/reading.h"

namespace freeplay {

class CheckedValue;

/// Keys (of parameters, presets, templates) that something refers to; the others are worth a warning.
using UsedKeys = std::unordered_set<const Node*>;

/// Parameters of the model or of one instance; names hide those of the outer scope. A parameter in error is `broken`:
/// whoever needs it stays silent, because the mistake has been reported.
class ParameterScope : public Scope {
 public:
  explicit ParameterScope(UsedKeys& used, const ParameterScope* outer = nullptr) : used_(&used), outer_(outer) {}

  /// A parameter with the text `value`, which is read in `reading` and refers to the parameters of `reading.scope`:
  /// this scope or an outer one. `path` names it in messages; `overridden` when `--set` gave the text.
  void add(const std::string& name, const Node& key, const Node& value, std::string path, const Reading& reading,
           bool overridden = false);
  /// A number that is given, such as the number of an instance.
  void add_constant(const std::string& name, double value) { add_constant(name, Quantity{.value = value}); }
  /// One that is known, as of another scope.
  void add_constant(const std::string& name, const Quantity& value);
  /// A parameter whose declaration is in error.
  void add_broken(const std::string& name);

  /// Evaluates all; call once, after the last add(). Reports `cyclic-parameter` and what expressions report.
  void evaluate();

  const Quantity* find(std::string_view name) const override;
  std::vector<std::string> names() const override;
  /// All values of its own; none of them counts as used by that.
  std::vector<std::pair<std::string, Quantity>> values() const;
  bool broken(std::string_view name) const;
  /// The text of `--set` on which the parameter depends, or null.
  const Node* override_of(std::string_view name) const;
  bool declares(std::string_view name) const { return index_.contains(std::string(name)); }

 private:
  enum class State { waiting, open, done, broken };
  struct Entry {
    std::string name;
    const Node* key = nullptr;
    const Node* value = nullptr;
    std::string path;
    const Reading* reading = nullptr;
    const Node* override = nullptr;
    State state = State::waiting;
    Quantity quantity{};
  };

  Entry& append(const std::string& name);
  const Entry* entry(std::string_view name) const;
  std::vector<std::size_t> needs(const Entry& needing) const;
  void evaluate_from(std::size_t first);
  void compute(Entry& computed);
  static bool is_overridden(const Entry& entry) { return entry.override == entry.value; }
  void report_cycle(const std::vector<std::size_t>& path, std::size_t closing);

  UsedKeys* used_;
  const ParameterScope* outer_;
  std::vector<Entry> entries_;
  std::unordered_map<std::string, std::size_t> index_;
};

/// Reports `bad-name` or `reserved-name` at the key of a parameter and returns false.
bool check_parameter_name(const CheckedValue& parameter);

}  // namespace freeplay
