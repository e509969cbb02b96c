// A URDF file, given as a model and in each of the ways that a side-car can ask for.
#include <fmt/format.h>

#include "fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace freeplay::fuzz;
  static const MemoryFile file;
  const std::string text(data, data + size);
  check_model(text, "robot.urdf");
  file.write(text);
  // Every third input takes each way, so that all stay fast and the same input takes the same way again.
  constexpr const char* ways[] = {"plane: xz, loops: two-parents", "plane: yz, repair: inertia, base: floating",
                                  "merge_fixed: true, loops: two-parents, repair: inertia, limits: stop"};
  std::size_t sum = 0;
  for (const char c : text) sum += static_cast<unsigned char>(c);
  check_model(fmt::format("freeplay: 1\nurdf: {{file: {}, {}}}\n", file.path(), ways[sum % 3]), "sidecar.yaml");
  return 0;
}
