// Suggestion: which allowed word a misspelt one probably means.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace freeplay {

/// The word of `allowed` that is nearest to `word`: within edit distance 2 (3 when `word` has 8 or more letters), or
/// one that contains `word`, or one of 3 or more letters that `word` contains. The smallest distance wins, then the
/// order of `allowed`; words that are only contained come last. A word that differs in case alone counts as distance 1.
/// Words that share no letter are never suggested.
std::optional<std::string> suggestion(std::string_view word, const std::vector<std::string>& allowed);

}  // namespace freeplay
