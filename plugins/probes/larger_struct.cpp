// Probe: knows a struct that is larger than the host's.
#include <algorithm>
#include <iterator>

#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  publish(*host, *manifest, "probe", "1", components);
  static std::uint32_t sizes[std::size(struct_sizes)];
  std::copy(std::begin(struct_sizes), std::end(struct_sizes), sizes);
  sizes[9] += 8;
  manifest->struct_sizes = {sizes, std::size(sizes)};
  return Status::ok;
}
