#include "results/json_difference.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/name_pattern.h"

namespace freeplay {
namespace {

bool is_left_out(const std::string& place, const std::vector<std::string>& left_out) {
  return std::ranges::any_of(left_out, [&](const std::string& pattern) { return matches(pattern, place); });
}

std::string words_for(const Json& value) {
  constexpr std::size_t enough = 40;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= enough ? text : text.substr(0, enough) + "...";
}

std::string differ(const std::string& place, const Json& then, const Json& now) {
  if (then.is_string() && now.is_string()) {
    const std::string &a = then.get_ref<const std::string&>(), &b = now.get_ref<const std::string&>();
    const auto at = static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
    if (at > 20) return fmt::format("{}: from character {} on another text", place, at);
  }
  return fmt::format("{}: {} recorded, {} now", place, words_for(then), words_for(now));
}

class JsonDifference {
 public:
  explicit JsonDifference(const std::vector<std::string>& left_out) : left_out_(left_out) {}

  std::string first(const Json& then, const Json& now, const std::string& place) const {
    if (is_left_out(place, left_out_)) return {};
    if (then.is_object() && now.is_object()) return of_objects(then, now, place);
    if (then.is_array() && now.is_array() && then.size() == now.size()) {
      for (std::size_t i = 0; i < then.size(); ++i) {
        if (std::string found = first(then[i], now[i], fmt::format("{}/{}", place, i)); !found.empty()) return found;
      }
      return {};
    }
    return then == now ? std::string() : differ(place, then, now);
  }

 private:
  std::string of_objects(const Json& then, const Json& now, const std::string& place) const {
    for (const auto& [name, value] : then.items()) {
      const std::string inside = place + "/" + name;
      const auto other = now.find(name);
      if (other == now.end() && !is_left_out(inside, left_out_)) {
        return fmt::format("{}: {} recorded, nothing now", inside, words_for(value));
      }
      if (other == now.end()) continue;
      if (std::string found = first(value, *other, inside); !found.empty()) return found;
    }
    for (const auto& [name, value] : now.items()) {
      const std::string inside = place + "/" + name;
      if (then.contains(name) || is_left_out(inside, left_out_)) continue;
      return fmt::format("{}: nothing recorded, {} now", inside, words_for(value));
    }
    return {};
  }

  const std::vector<std::string>& left_out_;
};

std::size_t numbers_in(const Json& json, const std::string& place, const std::vector<std::string>& left_out) {
  if (is_left_out(place, left_out)) return 0;
  if (json.is_number()) return 1;
  std::size_t count = 0;
  if (json.is_structured()) {
    for (const auto& [name, value] : json.items()) count += numbers_in(value, place + "/" + name, left_out);
  }
  return count;
}

}  // namespace

std::string first_difference(const Json& then, const Json& now, const std::vector<std::string>& left_out) {
  return JsonDifference(left_out).first(then, now, "");
}

std::size_t count_numbers(const Json& json, const std::vector<std::string>& left_out) {
  return numbers_in(json, "", left_out);
}

}  // namespace freeplay
