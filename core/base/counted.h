// How many of what, in words: "1 item", "3 items".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace freeplay {

inline std::string counted(std::size_t count, std::string_view thing) {
  return std::to_string(count).append(" ").append(thing).append(count == 1 ? "" : "s");
}

}  // namespace freeplay
