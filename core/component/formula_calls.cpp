#include "component/formula_calls.h"

namespace freeplay {
namespace {
constinit thread_local FormulaCalls* listening = nullptr;
}  // namespace

FormulaCalls::FormulaCalls(std::span<Watched> watched) : watched_(watched), before_(listening) {
  for (Watched& one : watched_) one.called = false;
  listening = this;
}

FormulaCalls::~FormulaCalls() { listening = before_; }

void FormulaCalls::note(const void* formula, Span<const double> variables) noexcept {
  if (listening == nullptr) return;
  const auto found = std::ranges::find(listening->watched_, formula, &Watched::formula);
  if (found == listening->watched_.end() || variables.size > found->variables.size()) return;
  std::ranges::copy(variables, found->variables.begin());
  found->count = variables.size;
  found->called = true;
}

}  // namespace freeplay
