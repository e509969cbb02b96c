#include "base/processors.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

#include <sched.h>

#include "base/processor_quota.h"

namespace freeplay {
namespace {
constexpr int most = 256;
}  // namespace

int processor_count() {
  if (const char* text = std::getenv("FREEPLAY_THREADS")) {
    const int count = std::atoi(text);
    if (count > 0) return std::min(count, most);
  }
  cpu_set_t mine;
  const int allowed = ::sched_getaffinity(0, sizeof mine, &mine) == 0 ? CPU_COUNT(&mine) : 0;
  const int there = allowed > 0 ? allowed : static_cast<int>(std::thread::hardware_concurrency());
  return static_cast<int>(std::clamp(std::min<double>(there, std::ceil(processor_quota())), 1.0, double{most}));
}

}  // namespace freeplay
