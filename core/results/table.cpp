#include "results/table.h"

#include <algorithm>

namespace freeplay {

int ResultTable::find(std::string_view name) const {
  const auto hit = std::ranges::find(names, name);
  return hit == names.end() ? -1 : static_cast<int>(hit - names.begin());
}

}  // namespace freeplay
