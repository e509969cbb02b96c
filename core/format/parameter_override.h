// ParameterOverrides: the texts that `--set` puts in the place of parameters.
#pragma once

#include <deque>
#include <map>
#include <string>

#include "format/build_options.h"
#include "format/document.h"
#include "format/parameter_scope.h"

namespace freeplay {

class ParameterOverrides {
 public:
  /// Throws Error{usage} for a text that does not parse. Makes the texts known to `diagnostics`.
  ParameterOverrides(const BuildOptions& options, Diagnostics& diagnostics);

  /// The new value of a parameter, or null.
  const Node* text_of(const std::string& name) const;

  /// Throws Error{usage} when one of them is not among `parameters`.
  void require_declared(const ParameterScope& parameters) const;

 private:
  std::deque<Document> documents_;
  std::map<std::string, const Node*> nodes_;
};

}  // namespace freeplay
