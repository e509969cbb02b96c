// FormulaCalls: with which variables components ask for their formulas.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "freeplay/plugin.h"

namespace freeplay {

/// While it lives, the last call in this thread of each formula that is watched is noted.
class FormulaCalls {
 public:
  struct Watched {
    const void* formula;  ///< as it is served
    bool called = false;
    std::size_t count = 0;  ///< of its variables
    std::array<double, Formula::most_variables> variables{};
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.called, self.count, self.variables);
    }
  };
  explicit FormulaCalls(std::span<Watched> watched);
  ~FormulaCalls();
  FormulaCalls(const FormulaCalls&) = delete;
  FormulaCalls& operator=(const FormulaCalls&) = delete;

  /// For those who serve formulas.
  static void note(const void* formula, Span<const double> variables) noexcept;

 private:
  std::span<Watched> watched_;
  FormulaCalls* before_;
};

}  // namespace freeplay
