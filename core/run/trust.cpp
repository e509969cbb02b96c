#include "run/trust.h"

#include <algorithm>
#include <tuple>

namespace freeplay {

const char* word(Trust trust) {
  switch (trust) {
    case Trust::good:
      return "good";
    case Trust::doubtful:
      return "doubtful";
    case Trust::bad:
      break;
  }
  return "bad";
}

void Verdict::add(TrustReason reason) {
  const auto same = [&](const TrustReason& other) {
    return std::tie(other.id, other.element, other.message) == std::tie(reason.id, reason.element, reason.message);
  };
  if (reason.level == Trust::good || std::ranges::any_of(reasons_, same)) return;
  const auto place = std::ranges::find_if(reasons_, [&](const TrustReason& r) { return r.level < reason.level; });
  reasons_.insert(place, std::move(reason));
}

void Verdict::lead(TrustReason reason) {
  const auto place = std::ranges::find_if(reasons_, [&](const TrustReason& r) { return r.level <= reason.level; });
  reasons_.insert(place, std::move(reason));
}

}  // namespace freeplay
