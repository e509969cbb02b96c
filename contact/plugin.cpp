// The contact and friction laws of the library, one row each.
#include "freeplay/plugin.h"

namespace freeplay {
Component hertz();
Component lankarani_nikravesh();
Component no_friction();
Component ambrosio();
}  // namespace freeplay

FREEPLAY_PLUGIN(contact) {
  using namespace freeplay;
  static const Component components[] = {hertz(), lankarani_nikravesh(), no_friction(), ambrosio()};
  return publish(*host, *manifest, "contact", "0.1.0", components);
}
