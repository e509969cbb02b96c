// What a test prints of findings.
#pragma once

#include <string>

#include "contract/finding.h"

namespace freeplay::test {

inline std::string broken_rules(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings.all()) {
    if (!finding.held) text += finding.rule + ": " + finding.detail + "\n";
  }
  return text.empty() ? "no rule is broken" : text;
}

}  // namespace freeplay::test
