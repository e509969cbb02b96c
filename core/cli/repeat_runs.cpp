#include "cli/repeat_runs.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/caught_error.h"
#include "base/error.h"
#include "base/whole_text.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "results/summary.h"
#include "run/play_start.h"
#include "run/simulation.h"

namespace freeplay {
namespace {

constexpr std::size_t most_workers = 256, most_runs = 10'000;

[[noreturn]] void no_process(const char* what) {
  throw Error(Error::Category::file, "no-process", fmt::format("{}: {}", what, std::strerror(errno)));
}

Json failure(std::size_t run, int exit_code, const std::string& reason) {
  return {{"run", run}, {"exit_code", exit_code}, {"reason", reason}};
}

/// One run as the line that its worker reports.
Json record_of(const Model& model, std::uint64_t seed, std::size_t run) {
  try {
    System system(model);
    const Start start = assemble_in_play(system, seed, run);
    const Channels channels(model);
    Simulation simulation(system, start, channels, {});
    const Outcome outcome = simulation.run({});
    if (outcome.exit_code != 0) return failure(run, outcome.exit_code, outcome.reason);
    const ContactAdvice advice(model);
    const RunRecord record{
        model,  channels, start.facts, outcome, simulation.statistics(), simulation.clearances(), simulation.last_row(),
        advice, {},       {}};
    return {{"run", run}, {"exit_code", 0}, {"figures", RepeatSummary::figures_of(summary(record))}};
  } catch (const std::exception& exception) {
    const Error error = error_of(exception);
    return failure(run, error.exit_code(), fmt::format("{} [{}]", error.message(), error.id()));
  }
}

std::string signal_name(int number) {
  const char* name = ::sigabbrev_np(number);
  return name != nullptr ? fmt::format("SIG{}", name) : fmt::format("signal {}", number);
}

}  // namespace

/// Seen by all processes.
struct RepeatRuns::Shared {
  std::atomic<std::size_t> next{1}, ended{0};
  std::atomic<std::size_t> current[most_workers]{};
};

struct RepeatRuns::Worker {
  explicit Worker(std::atomic<std::size_t>& at) : current(at) {}
  std::atomic<std::size_t>& current;  ///< the run it is at, 0 between two; seen by both processes
  int report = -1, process = -1;      ///< -1: it has ended
  std::size_t last_reported = 0;
};

RepeatPlan repeat_plan(const std::string& repeat, const std::string& seed) {
  RepeatPlan plan;
  if (repeat.empty() && !seed.empty()) {
    throw Error(Error::Category::usage, "usage", "--seed is of the starts of --repeat: give both, or neither");
  }
  if (!seed.empty()) plan.seed = static_cast<std::uint64_t>(whole_number("--seed", seed, 0));
  if (!repeat.empty()) plan.runs = static_cast<std::size_t>(whole_number("--repeat", repeat, 2));
  if (plan.runs <= most_runs) return plan;
  throw Error(Error::Category::usage, "bad-value", fmt::format("--repeat makes at most {} runs", most_runs));
}

RepeatRuns::RepeatRuns(const Model& model, const RepeatPlan& plan, int processes)
    : model_(model), plan_(plan), summary_(plan.runs, plan.seed, moved_in_play) {
  if (model.clearance_joints() == 0) {
    throw Error(
        Error::Category::usage, "nothing-to-repeat",
        "--repeat moves bodies in the play of their joints, and no joint of this model has play: all runs would "
        "be the same");
  }
  void* page = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED) no_process("cannot make shared memory");
  shared_ = new (page) Shared;
  const std::size_t count = std::min({static_cast<std::size_t>(processes), plan.runs - 1, most_workers});
  for (std::size_t i = 0; i < count; ++i) workers_.push_back(std::make_unique<Worker>(shared_->current[i]));
  for (std::size_t i = 1; i < static_cast<std::size_t>(processes) && i <= count; ++i) start(*workers_[i - 1]);
}

RepeatRuns::~RepeatRuns() {
  kill_all();
  for (const auto& worker : workers_) {
    if (worker->report >= 0) ::close(worker->report);
  }
  ::munmap(shared_, sizeof(Shared));
}

void RepeatRuns::start(Worker& worker) {
  worker.report = ::memfd_create("repeat", MFD_CLOEXEC);
  if (worker.report < 0) no_process("cannot make shared memory");
  worker.current = 0;
  std::fflush(nullptr);  // what is buffered would be printed twice
  const int parent = ::getpid();
  worker.process = ::fork();
  if (worker.process < 0) no_process("cannot start a process");
  if (worker.process == 0) work(worker, parent);
  ::setpgid(worker.process, worker.process);  // the child says so too; whoever comes first
}

void RepeatRuns::work(Worker& worker, int parent) {
  ::setpgid(0, 0);  // Ctrl-C is for the parent, who ends its workers
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) _exit(1);
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP}) {
    std::signal(number, SIG_DFL);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, file);
  for (std::size_t run = shared_->next++; run < plan_.runs; run = shared_->next++) {
    worker.current = run;
    if (!write_all(worker.report,
                   record_of(model_, plan_.seed, run).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"))
      _exit(1);
    ++shared_->ended;
    worker.current = 0;
  }
  _exit(0);
}

void RepeatRuns::reap() {
  for (const auto& worker : workers_) {
    int status = 0;
    if (worker->process < 0 || ::waitpid(worker->process, &status, WNOHANG) != worker->process) continue;
    worker->process = -1;
    take_report(*worker);
    const std::size_t lost = worker->current;
    if (lost != 0 && lost != worker->last_reported) {
      const bool killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
      const std::string how =
          WIFSIGNALED(status) ? signal_name(WTERMSIG(status)) : fmt::format("exit code {}", WEXITSTATUS(status));
      summary_.fail(lost, killed ? 1 : 5, fmt::format("its process ended with {}", how));
      ++shared_->ended;
    }
    if (shared_->next < plan_.runs) start(*worker);
  }
}

Json RepeatRuns::finish(const Json& first, const Outcome& outcome, const std::function<void(std::size_t)>& progress) {
  const std::atomic<int>& interrupts = watch_interrupts();
  for (const auto& worker : workers_) {
    if (interrupts == 0 && worker->report < 0 && shared_->next < plan_.runs) start(*worker);
  }
  const auto all_ended = [&] { return std::ranges::all_of(workers_, [](const auto& w) { return w->process < 0; }); };
  for (reap(); interrupts == 0 && !all_ended(); reap()) {
    progress(shared_->ended);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  kill_all();
  for (const auto& worker : workers_) take_report(*worker);
  if (outcome.status == RunStatus::completed || outcome.status == RunStatus::stopped)
    summary_.add(0, RepeatSummary::figures_of(first));
  if (outcome.status == RunStatus::failed) summary_.fail(0, outcome.exit_code, outcome.reason);
  return summary_.json();
}

void RepeatRuns::kill_all() {
  for (const auto& worker : workers_) {
    if (worker->process < 0) continue;
    ::kill(-worker->process, SIGKILL);
    ::kill(worker->process, SIGKILL);
    ::waitpid(worker->process, nullptr, 0);
    worker->process = -1;
  }
}

/// Of a process that has ended: the lines that it has written to their ends.
void RepeatRuns::take_report(Worker& worker) {
  if (worker.report < 0) return;
  const std::string report = read_all(worker.report);
  ::close(worker.report);
  worker.report = -1;
  std::size_t from = 0;
  for (std::size_t end = report.find('\n'); end != std::string::npos; end = report.find('\n', from)) {
    const Json record = Json::parse(std::string_view(report).substr(from, end - from));
    from = end + 1;
    worker.last_reported = record["run"];
    if (record.contains("figures")) {
      summary_.add(worker.last_reported, record["figures"]);
    } else {
      summary_.fail(worker.last_reported, record["exit_code"], record["reason"]);
    }
  }
}

}  // namespace freeplay
