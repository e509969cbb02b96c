#include "freeplay/plugin.h"

namespace freeplay {

// In place of sundials_arkode.cpp where SUNDIALS was not found.
Component sundials_arkode() {
  return missing_type(ComponentKind::integrator, "arkode",
                      "it needs SUNDIALS 6: install libsundials-dev, remove the folder build and build again");
}

}  // namespace freeplay
