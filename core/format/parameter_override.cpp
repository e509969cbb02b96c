#include "format/parameter_override.h"

#include "base/error.h"
#include "format/checked_value.h"
#include "format/path_override.h"

namespace freeplay {
namespace {

/// Every name exists and is one: a text that does not compile here is not an expression at all.
class AnyScope : public Scope {
 public:
  const Quantity* find(std::string_view) const override { return &one_; }
  std::vector<std::string> names() const override { return {}; }

 private:
  Quantity one_{1.0, DimensionKind::free, {}};
};

bool is_about_form(const std::string& id) { return id == "bad-expression" || id == "bad-unit" || id == "bad-number"; }

}  // namespace

ParameterOverrides::ParameterOverrides(const BuildOptions& options, Diagnostics& diagnostics) {
  for (const auto& [name, text] : options.set) {
    if (PathOverrides::is_path(name, text)) continue;
    const std::string file = "--set " + name;
    try {
      Expression::compile(text, AnyScope(), true);
    } catch (const ExpressionError& error) {
      if (is_about_form(error.id)) {
        throw Error(Error::Category::usage, "usage", file + "='" + text + "': " + error.message, {}, error.hint);
      }
    }
    documents_.push_back(Document::scalar(file, text));
    diagnostics.add_source(file, text);
    nodes_[name] = &documents_.back().root();
  }
}

const Node* ParameterOverrides::text_of(const std::string& name) const {
  const auto found = nodes_.find(name);
  return found == nodes_.end() ? nullptr : found->second;
}

void ParameterOverrides::require_declared(const ParameterScope& parameters) const {
  for (const auto& [name, node] : nodes_) {
    if (parameters.declares(name)) continue;
    const std::string suggested = nearest(name, parameters.names());
    throw Error(Error::Category::usage, "usage", "--set " + name + ": the model has no parameter of this name", {},
                suggested.empty() ? "" : "did you mean '" + suggested + "'?");
  }
}

}  // namespace freeplay
