// JsonDifference: where two JSON values differ.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/json_text.h"

namespace freeplay {

/// The first difference in the order of `then`, as "/joints/pin: 1 recorded, 2 now"; empty where there is none. Members
/// whose place fits one of `left_out` ("/performance", "/*/name") are not looked at.
std::string first_difference(const Json& then, const Json& now, const std::vector<std::string>& left_out);

/// How many numbers such a comparison looks at.
std::size_t count_numbers(const Json& json, const std::vector<std::string>& left_out);

}  // namespace freeplay
