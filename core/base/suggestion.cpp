#include "base/suggestion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "base/text.h"

namespace freeplay {
namespace {

// Longer "words" are hostile input, not slips of the pen; their distance would cost quadratic time.
constexpr std::size_t longest_word = 128;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same_but_for_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

/// Levenshtein distance of words of at most longest_word bytes: insertions, deletions and replacements of one byte.
/// Anything above `limit` where it is larger than that.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit) {
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > limit) return limit + 1;
  std::array<std::size_t, longest_word + 1> row;
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0], least = i;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
      least = std::min(least, row[j]);
    }
    if (least > limit) return least;
  }
  return row[b.size()];
}

constexpr std::size_t contains_it = 100, is_contained = 101, unrelated = std::numeric_limits<std::size_t>::max();

/// Edit distance when it is small enough to be a slip, else a rank after all distances.
std::size_t rank(std::string_view word, std::string_view candidate) {
  if (candidate.size() > longest_word) return unrelated;
  if (same_but_for_case(word, candidate)) return word == candidate ? 0 : 1;
  const std::size_t limit = word.size() >= 8 ? 3 : 2;
  const std::size_t distance = edit_distance(word, candidate, limit);
  // A distance as large as the word means that every letter was replaced.
  const int letters = std::max(character_count(word), character_count(candidate));
  if (distance <= limit && distance < static_cast<std::size_t>(letters)) return distance;
  if (candidate.find(word) != std::string_view::npos) return contains_it;
  if (candidate.size() >= 3 && word.find(candidate) != std::string_view::npos) return is_contained;
  return unrelated;
}

}  // namespace

std::optional<std::string> suggestion(std::string_view word, const std::vector<std::string>& allowed) {
  if (word.empty() || word.size() > longest_word) return std::nullopt;
  const std::string* best = nullptr;
  std::size_t best_rank = unrelated;
  for (const std::string& candidate : allowed) {
    const std::size_t candidate_rank = rank(word, candidate);
    if (candidate_rank < best_rank) {
      best = &candidate;
      best_rank = candidate_rank;
    }
  }
  return best ? std::optional(*best) : std::nullopt;
}

}  // namespace freeplay
