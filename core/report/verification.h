// Verification: what a second, finer run says about the error of the first.
#pragma once

#include <string>
#include <vector>

#include "report/result_table.h"

namespace freeplay {

/// One channel of both runs.
struct ChannelError {
  std::string name;
  double error = 0.0;                         ///< largest difference while the runs agree
  double rms = 0.0, finer_rms = 0.0;          ///< after that, of each run; NaN when nothing is left
  double largest = 0.0, finer_largest = 0.0;  ///< largest absolute values, likewise
};

struct Verification {
  std::string finer;                   ///< how the second run was made finer
  long steps = 0;                      ///< that it took
  double agreement = 1e-6;             ///< largest difference of body positions that counts as agreement [m]
  double agree_until = 0.0;            ///< [s]
  bool throughout = false;             ///< they agree in every row
  std::vector<ChannelError> channels;  ///< in the order of the columns, without time
};

/// Impacts make motions sensitive: where two runs have parted, their differences say nothing about the error any more,
/// and only statistics can be compared. `positions`: names of the channels that decide; in metres.
Verification verify(const ResultTable& run, const ResultTable& finer, const std::vector<std::string>& positions,
                    double agreement);

}  // namespace freeplay
