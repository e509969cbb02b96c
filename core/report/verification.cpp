#include "report/verification.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/comparison.h"

namespace freeplay {
namespace {

struct Moments {
  double squares = 0.0, largest = 0.0;
  std::size_t count = 0;

  void add(double x) {
    if (std::isnan(x)) return;
    squares += x * x;
    largest = std::max(largest, std::abs(x));
    ++count;
  }
  double rms() const {
    return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : std::numeric_limits<double>::quiet_NaN();
  }
  double maximum() const { return count > 0 ? largest : std::numeric_limits<double>::quiet_NaN(); }
};

}  // namespace

Verification verify(const ResultTable& run, const ResultTable& finer, const std::vector<std::string>& positions,
                    double agreement) {
  Verification result;
  result.agreement = agreement;
  result.agree_until = agree_until(run, finer, positions, agreement);
  const std::size_t rows = std::min(run.time().size(), finer.time().size());
  result.throughout = rows > 0 && result.agree_until >= run.time().back();
  for (std::size_t c = 1; c < run.names.size(); ++c) {
    ChannelError channel{.name = run.names[c]};
    Moments coarse, fine;
    for (std::size_t r = 0; r < rows; ++r) {
      const double x = run.values[c][r], y = finer.values[c][r];
      if (run.time()[r] > result.agree_until) {
        coarse.add(x);
        fine.add(y);
      } else if (std::abs(x - y) > channel.error) {
        channel.error = std::abs(x - y);
      }
    }
    channel.rms = coarse.rms();
    channel.finer_rms = fine.rms();
    channel.largest = coarse.maximum();
    channel.finer_largest = fine.maximum();
    result.channels.push_back(std::move(channel));
  }
  return result;
}

}  // namespace freeplay
