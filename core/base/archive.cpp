#include "base/archive.h"

#include "base/error.h"
#include "base/same_bits.h"

namespace freeplay {

bool operator==(const Archive& a, const Archive& b) { return same_bits(a.reals, b.reals) && a.integers == b.integers; }

void ArchiveReader::require(bool good) {
  if (good) return;
  throw Error(Error::Category::input, "state-mismatch",
              "the state of the run does not fit this model: it is that of another one, or damaged");
}

}  // namespace freeplay
