// ServantProcess: a copy of this program that answers questions, so that it may crash or hang without harm.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace freeplay {

/// The process is no more, or does not come back; the text says which.
struct ServantGone : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One that waits for a question, answers it and waits for the next. It ends with this program at the latest.
class ServantProcess {
 public:
  struct Answer {
    std::uint64_t kind = 0;
    std::span<const double> body;  ///< bytes or numbers, valid until the next question
    std::size_t bytes = 0;

    std::string_view text() const { return {reinterpret_cast<const char*>(body.data()), bytes}; }
  };
  using Send = std::function<void(std::uint64_t kind, std::string_view body)>;
  /// Takes a question and sends exactly one answer. Throws nothing.
  using Serve = std::function<void(std::string_view question, const Send&)>;

  /// Starts the process, in which `begin` makes what answers. One that takes more processor time for an answer than
  /// that is ended [s]. Throws Error{file} "no-process".
  explicit ServantProcess(const std::function<Serve()>& begin, double longest_answer = 30.0);
  ~ServantProcess();
  ServantProcess(const ServantProcess&) = delete;
  ServantProcess& operator=(const ServantProcess&) = delete;

  /// Throws ServantGone; every later question does so, too.
  Answer ask(std::string_view question);

 private:
  [[noreturn]] void live(const std::function<Serve()>& begin, int parent, int end) const;
  void receive(void* to, std::size_t bytes);
  [[noreturn]] void give_up(const char* why);

  const double longest_answer_;
  int socket_ = -1;
  pid_t process_ = -1;
  std::vector<double> body_;
  std::string gone_;  // why; empty while it lives
};

}  // namespace freeplay
