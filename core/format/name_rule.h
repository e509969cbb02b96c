// NameRule: which words may name things.
#pragma once

#include <string>
#include <string_view>

namespace freeplay {

/// [A-Za-z_][A-Za-z0-9_-]{0,63}, the rule for bodies, joints and everything else but parameters.
bool is_name(std::string_view word);

/// The same for a name that another format declares (Node::foreign): it may begin with a digit or a hyphen.
bool is_foreign_name(std::string_view word);

/// [A-Za-z_][A-Za-z0-9_]{0,63}: a hyphen would be a minus sign in an expression.
bool is_parameter_name(std::string_view word);

/// What to say about a word that is no name: that it is too long, else `rule`.
inline constexpr const char* rule_of_names = "a name has letters, digits, '_' and '-' and begins with a letter or '_'";
std::string name_hint(std::string_view word, const char* rule = rule_of_names);

/// Keys that begin with "x-" belong to the person, not to the format.
inline bool is_note(std::string_view key) { return key.substr(0, 2) == "x-"; }

}  // namespace freeplay
