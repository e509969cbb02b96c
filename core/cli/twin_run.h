// TwinRun: the run of a model with every clearance closed, beside that of the model as it is.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "results/twin_comparison.h"
#include "run/sink.h"

namespace freeplay {

/// The twin's side: its rows go to the other process. When that has gone, the twin goes on alone.
class TwinRows final : public Sink {
 public:
  TwinRows(int pipe, const Model& model, const Channels& channels);
  ~TwinRows() override { send(); }
  void row(std::span<const double> values) override;
  void event(const EventRecord&) override {}
  bool ok() const override { return true; }

 private:
  void send();

  int pipe_;
  TwinNumbers numbers_;
  std::vector<double> waiting_;
  std::size_t filled_ = 0;
};

/// The twin runs in a process of its own: a crash costs the comparison alone, and plugins with variables of their own
/// cannot disturb each other. Each of the two waits for the other when it is some rows ahead.
class TwinRun {
 public:
  /// Makes the process, which waits for start(). It leaves with what `work` returns; `work` gives rows to TwinRows on
  /// this pipe. Call it before there are threads. Throws Error{file} "no-process".
  explicit TwinRun(const std::function<int(int pipe)>& work);
  /// Ends what still runs.
  ~TwinRun();
  TwinRun(const TwinRun&) = delete;
  TwinRun& operator=(const TwinRun&) = delete;

  /// Lets the twin begin, and returns where rows of the other run go. Both arguments outlive this.
  Sink& start(const Model& model, const Channels& channels);
  /// Waits for its end. Returns how far both are apart; null when it failed, for a reason that `trouble` receives, or
  /// was interrupted.
  Json finish(std::string& trouble);

 private:
  class Comparing;
  [[noreturn]] void live(const std::function<int(int pipe)>& work, int gate, int pipe, int parent) const;

  int process_ = -1, gate_ = -1, pipe_ = -1, messages_ = -1;
  std::unique_ptr<Comparing> comparing_;
};

}  // namespace freeplay
