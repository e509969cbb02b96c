// DefaultArithmetic: rounding and denormals as a program has them at its start, whatever the caller has set.
#pragma once

#include <cfenv>

namespace freeplay {

/// For the calling thread and those that it starts meanwhile; the caller's setting is there again afterwards.
class DefaultArithmetic {
 public:
  DefaultArithmetic() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultArithmetic() { std::fesetenv(&before_); }
  DefaultArithmetic(const DefaultArithmetic&) = delete;
  DefaultArithmetic& operator=(const DefaultArithmetic&) = delete;

 private:
  std::fenv_t before_;
};

}  // namespace freeplay
