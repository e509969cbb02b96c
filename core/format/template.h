// Template: pieces of mechanism, and the instances that repeat them.
#pragma once

#include <deque>
#include <memory>

#include "format/draft.h"
#include "format/parameter_scope.h"

namespace freeplay {

/// What the values of instances refer to while the model is built.
struct InstanceStorage {
  std::deque<ParameterScope> scopes;
  std::deque<Reading> readings;
};

/// Adds a part for each instance to `draft.parts`. The sections belong to the top level; `templates` may be missing.
void expand_instances(Draft& draft, const std::optional<CheckedValue>& templates, const CheckedValue& instances,
                      UsedKeys& used, InstanceStorage& storage);

/// Adds a part for what an instance of `content` without values would be: its required parameters are taken for broken,
/// so that what depends on them stays silent.
void expand_alone(Draft& draft, const CheckedValue& content, UsedKeys& used, InstanceStorage& storage);

/// Reports bad names of templates.
void check_templates(const CheckedValue& templates);

}  // namespace freeplay
