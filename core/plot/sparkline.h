// Sparkline: a channel as forty characters.
#pragma once

#include <string>

#include "results/reader.h"

namespace freeplay::plot {

/// Of a run that is over: at most six lines of errors along paths, efforts of drivers and the largest normal force of a
/// joint with play, as "  leg1.A torque  ▁▂▅█▅▂  -9.8 … 9.7 N*m". Each character is the value that is largest by amount
/// in its part of the time, and its height says where between the range's ends, or zero, it lies; `_.:-=+*#` where
/// there is no `unicode`. Empty where there is no such channel.
std::string sparklines(ResultReader& reader, bool unicode);

}  // namespace freeplay::plot
