// Part: a piece of the file that declares elements: the top level, or one instance of a template.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "format/checked_value.h"

namespace freeplay {

struct Part {
  std::string prefix{};  ///< of every declared name: "" or "leg1."
  std::map<std::string, CheckedValue, std::less<>> sections{};

  /// The section, or nothing when it is not there or empty.
  std::optional<CheckedValue> section(std::string_view name) const {
    const auto found = sections.find(name);
    return found == sections.end() ? std::nullopt : std::optional<CheckedValue>(found->second);
  }
  /// The full name of something declared here.
  std::string full(const std::string& name) const { return prefix + name; }
};

}  // namespace freeplay
