// Probe: a hole in its function table.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static abi::JointTable table = abi::joint_table<probe::Idle>;
  table.apply = nullptr;
  static Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  components[0].table = &table;
  return publish(*host, *manifest, "probe", "1", components);
}
