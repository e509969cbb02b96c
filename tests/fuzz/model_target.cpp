// A model file in YAML, from its text to the checked model.
#include "fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  freeplay::fuzz::check_model(std::string(data, data + size), "model.yaml");
  return 0;
}
