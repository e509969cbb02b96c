// ChildProcess: work that is done in a copy of this program, so that it may crash, hang or leave without harm.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "contract/call_note.h"

namespace freeplay {

/// How a child ended and what is left of it.
struct ChildEnd {
  enum class How {
    finished,  ///< the work came to its end
    exited,    ///< something ended the process with `code` before that
    crashed,   ///< by the signal `code`; `finished_first` says whether the work had come to its end
    stuck,     ///< the time was up, and the last noted call did not return for a while
    late       ///< the time was up
  };
  How how = How::finished;
  int code = 0;
  bool finished_first = false;
  std::string report;   ///< what the work reported, also before a crash
  std::string printed;  ///< what came to its stdout and stderr
};

class ChildProcess {
 public:
  /// Passes lines to the parent. They arrive even if the child crashes next.
  using Report = std::function<void(std::string_view line)>;
  /// How the child leaves when its work is done: at once, or as any program does, with the static destructors of what
  /// it has loaded.
  enum class Leave { at_once, as_usual };
  using Work = std::function<Leave(const Report&, CallNote&)>;

  /// Starts `work` in a child without stdin, whose output is kept, with at most 4 GiB of memory and 16 MiB to print. It
  /// dies with this program. Throws Error{file} "no-process" when none can be made.
  explicit ChildProcess(const Work& work);
  /// Kills what is left of it, with all that it started.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Waits until all have ended, at most `seconds`; then kills the rest. Children that still note calls and have not
  /// had so much processor time get up to five times as long: what else a machine does is not their fault. Ctrl-C kills
  /// all and ends the program (130).
  static void wait(const std::vector<std::unique_ptr<ChildProcess>>& children, double seconds);

  /// After wait().
  const ChildEnd& end() const { return end_; }
  const CallNote& note() const;

 private:
  struct Shared;  // seen by both processes
  [[noreturn]] void live(const Work& work, int parent);
  bool look();  // true once it has ended
  bool goes_on(double seconds) const;
  void give_up(double long_call);
  void kill_group();
  void collect();

  Shared* shared_ = nullptr;
  int report_ = -1, printed_ = -1, process_ = -1;
  bool ended_ = false;
  std::uint64_t calls_seen_ = 0;
  double unchanged_since_ = 0.0;
  ChildEnd end_;
};

}  // namespace freeplay
