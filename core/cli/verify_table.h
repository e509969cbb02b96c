// VerifyTable: what `freeplay run --verify` prints besides the run.
#pragma once

#include <string>

#include "base/json_text.h"
#include "results/verification.h"

namespace freeplay {

/// Until when both runs agree, the observed error of each channel, and statistics of both after that.
std::string verify_table(const Verification& verification);

/// How far the runs agree, and what to make of it: one sentence without a full stop.
std::string agreement_text(const Verification& verification);

/// The object `verification` of summary.json.
Json verification_json(const Verification& verification);

}  // namespace freeplay
