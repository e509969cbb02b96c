#include "model/element_name.h"

#include <fmt/format.h>

namespace freeplay {

std::string written_name(const JointElement& element) {
  return fmt::format("{} '{}'", section_of(element), element.name);
}

}  // namespace freeplay
