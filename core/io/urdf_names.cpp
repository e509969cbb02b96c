#include "io/urdf_names.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace freeplay::urdf {

std::string model_name(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size();) {
    const char c = name[i];
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    out += plain ? c : '_';
    i += std::max<std::size_t>(1, character_bytes(name, i));
  }
  if (out.starts_with("x-")) out[1] = '_';
  return out;
}

std::string NameGiver::give(const std::string& name, const Spot& spot) {
  const std::string given = model_name(name);
  if (given != name)
    messages_.warning(spot, "urdf-renamed", fmt::format("the {} '{}' is called '{}' here", kind_, name, given));
  const auto [known, fresh] = lines_.emplace(given, spot.line);
  if (!fresh) {
    messages_.error(spot, "duplicate-name",
                    fmt::format("there is a {} '{}' already, from line {}", kind_, given, known->second));
  }
  return given;
}

}  // namespace freeplay::urdf
