#include "results/run_log.h"

#include <chrono>
#include <ctime>

#include <fmt/format.h>

namespace freeplay {
namespace {

std::string time_stamp() {
  using namespace std::chrono;
  const auto now = system_clock::now();
  const std::time_t seconds = system_clock::to_time_t(now);
  const auto milliseconds = duration_cast<std::chrono::milliseconds>(now - system_clock::from_time_t(seconds)).count();
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  return fmt::format("{}.{:03}Z", text, milliseconds);
}

}  // namespace

void RunLog::write(std::string_view kind, std::string_view message) {
  const std::string stamp = time_stamp();
  while (!message.empty()) {
    const std::string_view line = message.substr(0, message.find('\n'));
    file_.line() += fmt::format("{} {}: {}", stamp, kind, line);
    file_.end_line();
    message.remove_prefix(std::min(line.size() + 1, message.size()));
  }
  file_.flush();  // messages are few, and what a killed run said is to be there
}

}  // namespace freeplay
