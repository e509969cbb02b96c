#include "workers/worker_pool.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>

#include "base/number_text.h"
#include "workers/worker_process.h"

namespace freeplay {
namespace {

constexpr int look_again_after = 50;  // [ms]
constexpr double short_point = 0.02;  // [s]; longer ones are not handed out ahead: another may be idle sooner
constexpr double batch = 2e-3;        // [s]
constexpr std::size_t most_tasks_ahead = 256;

/// Signals by which a mistake in code ends a process.
bool is_crash(int status) {
  constexpr int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP};
  return WIFSIGNALED(status) && std::ranges::find(crashes, WTERMSIG(status)) != std::end(crashes);
}

}  // namespace

WorkerPool::WorkerPool(StudyWork& work, const PoolOptions& options)
    : work_(work), options_(options), notes_(std::make_unique<WorkerNotes>(static_cast<std::size_t>(options.jobs))) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(options.jobs); ++i) {
    workers_.push_back(std::make_unique<WorkerProcess>((*notes_)[i]));
  }
}

WorkerPool::~WorkerPool() = default;

bool WorkerPool::fetch(const Next& next, StudyTask& task) {
  if (!again_.empty()) {
    task = std::move(again_.back());
    again_.pop_back();
    return true;
  }
  exhausted_ = exhausted_ || !next(task);
  return !exhausted_;
}

void WorkerPool::put_back(StudyTask task) {
  if (task.first < task.end) again_.push_back(std::move(task));
}

/// Whether it has less to do than it should have: a task, more where they are short.
bool WorkerPool::hungry(WorkerProcess& worker) const {
  const auto& tasks = worker.tasks();
  if (tasks.empty()) return true;
  if (options_.isolate || point_seconds_ == 0.0 || tasks.size() >= most_tasks_ahead) return false;
  double waiting = 0.0;
  for (const StudyTask& task : tasks) waiting += point_seconds_ * static_cast<double>(task.end - task.first);
  return waiting < batch || (tasks.size() < 2 && waiting < short_point);
}

void WorkerPool::start(WorkerProcess& worker) {
  std::vector<WorkerProcess*> others;
  for (const auto& other : workers_) {
    if (other.get() != &worker) others.push_back(other.get());
  }
  worker.start(work_, options_.isolate, others);
}

void WorkerPool::start(std::size_t workers) {
  for (std::size_t i = 0; i < std::min(workers, workers_.size()); ++i) {
    if (!workers_[i]->runs()) start(*workers_[i]);
  }
}

void WorkerPool::feed(WorkerProcess& worker, const Next& next, bool may_start) {
  StudyTask task;
  while ((worker.runs() || may_start) && hungry(worker) && fetch(next, task)) {
    if (!worker.runs()) start(worker);
    worker.give(std::move(task));
  }
}

void WorkerPool::wait() const {
  std::vector<pollfd> pipes;
  for (const auto& worker : workers_) {
    if (!worker->runs()) continue;
    pipes.push_back({worker->incoming(), POLLIN, 0});
    if (worker->has_to_send()) pipes.push_back({worker->outgoing(), POLLOUT, 0});
  }
  ::poll(pipes.data(), pipes.size(), look_again_after);
}

WorkerPool::Take WorkerPool::timed(const Take& take) {
  return [this, &take](std::uint64_t point, const StudyOutcome& outcome) {
    constexpr double share = 0.1;
    point_seconds_ = point_seconds_ == 0.0 ? outcome.wall : (1.0 - share) * point_seconds_ + share * outcome.wall;
    take(point, outcome);
  };
}

void WorkerPool::look_after_all(const Take& take) {
  for (const auto& worker : workers_) {
    if (worker->runs()) look_after(*worker, take);
  }
}

void WorkerPool::turn(const Next& next, const Take& take) {
  look_after_all(timed(take));
  for (const auto& worker : workers_) feed(*worker, next, false);
}

void WorkerPool::run(const Next& next, const Take& take, const std::function<bool()>& beat) {
  exhausted_ = false;
  for (;;) {
    for (const auto& worker : workers_) feed(*worker, next, true);
    const bool busy = std::ranges::any_of(workers_, [](const auto& worker) { return !worker->tasks().empty(); });
    if (!beat() || !busy) break;
    wait();
    look_after_all(timed(take));
  }
  for (const auto& worker : workers_) {
    if (worker->runs()) worker->end([](std::uint64_t, const StudyOutcome&) {});
  }
}

void WorkerPool::look_after(WorkerProcess& worker, const Take& take) {
  worker.send();
  const std::size_t before = worker.tasks().size();
  const std::uint64_t first = before > 0 ? worker.tasks().front().first : 0;
  const bool lives = worker.receive(take);
  const bool one_done = worker.tasks().size() < before || (before > 0 && worker.tasks().front().first > first);
  if (options_.isolate && one_done) {
    worker.end(take);
    if (!worker.tasks().empty()) put_back(std::move(worker.tasks().front()));
    worker.tasks().clear();
    return;
  }
  if (lives && options_.point_timeout > 0.0 && worker.at_work() > options_.point_timeout) {
    late_.insert(&worker);
    worker.kill();
    bury(worker, take);
  } else if (!lives) {
    bury(worker, take);
  }
}

/// What only waited goes to others, and the point that it was at costs the worker.
void WorkerPool::bury(WorkerProcess& worker, const Take& take) {
  const int status = worker.end(take);
  ++lost_;
  std::uint64_t point = 0;
  const bool at_point = worker.in_hand(point);
  auto tasks = std::exchange(worker.tasks(), {});
  while (tasks.size() > 1) {
    put_back(std::move(tasks.back()));
    tasks.pop_back();
  }
  const bool late = late_.erase(&worker) > 0;
  if (tasks.empty()) return;
  StudyTask& first = tasks.front();
  if (!at_point || work_.unit_point(first.unit, first.first) != point) {
    put_back(std::move(first));
  } else if (late) {
    ++first.first;
    first.state.clear();
    put_back(std::move(first));
    take(point, {.exit_code = 4,
                 .error = "timeout",
                 .message = fmt::format("it took longer than {} s", number_text(options_.point_timeout))});
  } else {
    blame(std::move(first), point, status, take);
  }
}

void WorkerPool::blame(StudyTask task, std::uint64_t point, int status, const Take& take) {
  StudyOutcome outcome{.exit_code = 1, .error = "killed", .message = "its process was ended from outside twice"};
  if (is_crash(status)) {
    const std::string name = fmt::format("SIG{}", ::sigabbrev_np(WTERMSIG(status)));
    outcome = {.exit_code = 5, .error = "crash-" + name, .message = fmt::format("its process ended with {}", name)};
  } else if (WIFEXITED(status)) {
    outcome = {.exit_code = 5,
               .error = "crash-exit",
               .message = fmt::format("code of a plugin ended its process, with exit code {}", WEXITSTATUS(status))};
  } else if (killed_once_.insert(point).second) {
    return put_back(std::move(task));
  }
  ++task.first;
  task.state.clear();
  put_back(std::move(task));
  take(point, outcome);
}

}  // namespace freeplay
