// Readout: what the reader of a model made of the values and references in the file.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/expression.h"
#include "format/document.h"

namespace freeplay {

/// Names as they are written, and in full.
using NamesInFull = std::vector<std::pair<std::string, std::string>>;

/// Kept for those who write a model without its templates: every value of an instance stands in the template once, but
/// means something else in each instance. Values are kept of instances only, references of the top level, too.
class Readout {
 public:
  struct Instance {
    std::string name;     ///< in full
    const Node* content;  ///< of its template
  };

  void add_instance(std::string name, const Node& content) { instances_.push_back({std::move(name), &content}); }
  const std::vector<Instance>& instances() const { return instances_; }

  /// A constant in SI.
  void note_number(const std::string& instance, const Node& node, double value);
  /// A function of time: its text with the values of its parameters, in SI, and the full names of channels.
  void note_function(const std::string& instance, const Node& node, const Expression& expression, const Scope& scope,
                     const NamesInFull& channels);
  /// A formula of a component: its text with the values of its parameters.
  void note_formula(const std::string& instance, const Node& node, const Scope& scope);
  /// Full names that a reference stands for; several for a pattern. `node` may be a key.
  void note_names(const std::string& instance, const Node& node, std::vector<std::string> names);

  /// What was noted, or null.
  const std::vector<std::string>* find(const std::string& instance, const Node& node) const;

 private:
  std::vector<Instance> instances_;
  std::map<std::pair<std::string, const Node*>, std::vector<std::string>> texts_;
};

}  // namespace freeplay
