// Verdict: how far the numbers of a run can be believed, and why not farther.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace freeplay {

enum class Trust { good, doubtful, bad };

/// good, doubtful or bad.
const char* word(Trust trust);

/// One criterion that was not met; docs/trust.md has a section for each id.
struct TrustReason {
  std::string id;         ///< stable word for programs, such as "energy-residual"
  Trust level;            ///< doubtful or bad
  std::string message;    ///< one sentence for people, without a full stop at its end
  std::string element{};  ///< what it is about, such as "joint 'B'"; empty: the whole model
  /// The number that was judged and the limit that it passed, in SI units; NaN where the criterion is none of numbers.
  double value = std::numeric_limits<double>::quiet_NaN(), limit = value;
};

/// The reasons of a run, the worst first, else in the order in which they were added. Without any it is good.
class Verdict {
 public:
  /// A second reason with the same id, element and message is left out.
  [[gnu::cold]] void add(TrustReason reason);
  void add(std::span<const TrustReason> reasons) {
    for (const TrustReason& reason : reasons) add(reason);
  }
  /// Before all others of its level.
  [[gnu::cold]] void lead(TrustReason reason);
  Trust level() const { return reasons_.empty() ? Trust::good : reasons_.front().level; }
  std::span<const TrustReason> reasons() const { return reasons_; }

 private:
  std::vector<TrustReason> reasons_;
};

}  // namespace freeplay
