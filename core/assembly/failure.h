// Why a mechanism cannot be put together.
#pragma once

#include "assembly/closed_mechanism.h"

namespace freeplay {

/// Throws Error{input} for a mechanism whose position `rows` do not hold: "ik-unreachable" for a path that it cannot
/// follow, else "assembly-failed" with what stays open most, and where it would close. The state is lost.
[[noreturn]] void throw_open(ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows);

}  // namespace freeplay
