// NamePattern: names with `*` that stand for several.
#pragma once

#include <string_view>

namespace freeplay {

inline bool is_pattern(std::string_view word) { return word.find('*') != std::string_view::npos; }

/// Does `name` match `pattern`, in which `*` stands for any run of characters, dots included?
bool matches(std::string_view pattern, std::string_view name);

}  // namespace freeplay
