// OutcomeBytes: what goes through the pipes between a study and its workers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "workers/outcome.h"
#include "workers/worker_pool.h"

namespace freeplay {

/// Appends a message: its length, then its bytes.
void append_message(std::string& out, const StudyTask& task);
void append_message(std::string& out, std::uint64_t point, const StudyOutcome& outcome);

/// Takes the first whole message away from `bytes`, its length not included; false where none is whole.
bool take_message(std::string_view& bytes, std::string_view& message);

StudyTask task_of(std::string_view message);
StudyOutcome outcome_of(std::string_view message, std::uint64_t& point);

}  // namespace freeplay
