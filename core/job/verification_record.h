// VerificationRecord: what `--verify` found, as a sentence and for summary.json.
#pragma once

#include <string>

#include "base/json_text.h"
#include "results/verification.h"

namespace freeplay {

/// How far the runs agree, and what to make of it: one sentence without a full stop.
std::string agreement_text(const Verification& verification);

/// The object `verification` of summary.json.
Json verification_json(const Verification& verification);

}  // namespace freeplay
