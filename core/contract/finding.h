// Finding: one rule of a contract, and whether a component keeps it.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace freeplay {

/// `rule` is a kebab-case word such as "jacobian"; `detail` says where and by how much the rule was broken.
struct Finding {
  std::string rule;
  bool held = true;
  std::string detail;
};

using FindingSink = std::function<void(const Finding&)>;

/// What a suite found: one entry per rule that was examined, in order. Of a broken rule the first case is kept.
class Findings {
 public:
  /// `sink` receives a rule when it is examined first and when it is first found broken.
  explicit Findings(FindingSink sink = {}) : sink_(std::move(sink)) {}

  /// Notes one case of a rule; `detail` is called where the rule is broken for the first time, and returns text.
  template <class Detail>
  bool expect(std::string_view rule, bool held, Detail&& detail) {
    Finding& finding = of(rule);
    if (!held && finding.held) {
      finding.held = false;
      finding.detail = detail();
      if (sink_) sink_(finding);
    }
    return held;
  }

  /// Takes over what another suite found; `where` is put before its details.
  void merge(const Findings& other, const std::string& where) {
    for (const Finding& theirs : other.all_) {
      expect(theirs.rule, theirs.held, [&] { return where.empty() ? theirs.detail : where + ": " + theirs.detail; });
    }
  }

  const std::vector<Finding>& all() const { return all_; }
  bool held() const {
    return std::all_of(all_.begin(), all_.end(), [](const Finding& finding) { return finding.held; });
  }
  /// Is `rule` among those that were broken?
  bool broken(const std::string& rule) const {
    return std::any_of(all_.begin(), all_.end(), [&](const Finding& f) { return f.rule == rule && !f.held; });
  }

 private:
  Finding& of(std::string_view rule) {
    for (Finding& finding : all_) {
      if (finding.rule == rule) return finding;
    }
    Finding& fresh = all_.emplace_back(Finding{std::string(rule), true, {}});
    if (sink_) sink_(fresh);
    return fresh;
  }
  std::vector<Finding> all_;
  FindingSink sink_;
};

}  // namespace freeplay
