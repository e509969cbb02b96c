// VerifyTable: what `freeplay run --verify` prints besides the run.
#pragma once

#include <string>

#include "results/verification.h"

namespace freeplay {

/// Until when both runs agree, the observed error of each channel, and statistics of both after that.
std::string verify_table(const Verification& verification);

}  // namespace freeplay
