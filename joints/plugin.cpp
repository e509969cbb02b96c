// The joints of the library, one row each.
#include "freeplay/plugin.h"

namespace freeplay {
Component revolute();
Component prismatic();
Component fixed();
Component revolute_clearance();
}  // namespace freeplay

FREEPLAY_PLUGIN(joints) {
  using namespace freeplay;
  static const Component components[] = {revolute(), prismatic(), fixed(), revolute_clearance()};
  return publish(*host, *manifest, "joints", "0.1.0", components);
}
