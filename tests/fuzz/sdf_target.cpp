// An SDFormat file, given as a model and in each of the ways that a side-car can ask for.
#include "fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  freeplay::fuzz::check_robot(std::string(data, data + size), "robot.sdf");
  return 0;
}
