#include "format/name_rule.h"

#include "base/text.h"

namespace freeplay {
namespace {

// Not std::isalpha: names must not depend on the locale.
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr std::size_t longest_name = 64;

bool follows_rule(std::string_view word, bool hyphen) {
  if (word.empty() || word.size() > longest_name || !is_letter(word.front())) return false;
  for (const char c : word) {
    if (!is_letter(c) && !is_digit(c) && !(hyphen && c == '-')) return false;
  }
  return true;
}

}  // namespace

bool is_name(std::string_view word) { return follows_rule(word, true) && !is_note(word); }

bool is_foreign_name(std::string_view word) {
  return !word.empty() && word.size() <= longest_name && follows_rule("_" + std::string(word.substr(1)), true) &&
         (word.front() == '-' || is_digit(word.front()) || is_name(word));
}

bool is_parameter_name(std::string_view word) { return follows_rule(word, false); }

std::string name_hint(std::string_view word, const char* rule) {
  if (word.size() <= longest_name) return rule;
  return "a name has at most " + std::to_string(longest_name) + " characters, this one " +
         std::to_string(character_count(word));
}

}  // namespace freeplay
