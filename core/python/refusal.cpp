#include "python/refusal.h"

#include "base/message_json.h"

namespace freeplay {
namespace {

Diagnostics alone(const Error& error) {
  Diagnostics diagnostics;
  diagnostics.add(as_diagnostic(error));
  return diagnostics;
}

}  // namespace

Refusal::Refusal(const Diagnostics& diagnostics, int exit_code)
    : exit_code_(exit_code), text_(diagnostics.format(0)), messages_(messages_json(diagnostics, 0)) {}

Refusal::Refusal(const Error& error) : Refusal(alone(error), error.exit_code()) {}

}  // namespace freeplay
