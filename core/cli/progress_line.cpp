#include "cli/progress_line.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace freeplay {

std::string clock_text(double seconds) {
  const long s = std::lround(seconds);
  if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
  return fmt::format("{:02}:{:02}", s / 60, s % 60);
}

namespace {

/// Digits in groups of three.
std::string grouped(long number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ' ');
  return text;
}

/// For a share that is done after `elapsed` seconds.
std::string eta_text(double share, double elapsed) {
  return share > 0.0 ? clock_text(elapsed * (1.0 - share) / share) : "--:--";
}

}  // namespace

std::string progress_text(const char* what, long done, long total, double elapsed) {
  const double share = total > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0) : 0.0;
  return fmt::format("{:4.0f} %  {} / {} {}  eta {}", std::floor(100.0 * share), grouped(done), grouped(total), what,
                     eta_text(share, elapsed));
}

std::string progress_text(double start, double end, double t, long steps, double elapsed) {
  const double done = std::clamp((t - start) / (end - start), 0.0, 1.0);
  const std::string eta = eta_text(done, elapsed);
  return fmt::format("{:4.0f} %  t = {:.3g} / {:g} s  {} steps  eta {}", std::floor(100.0 * done), t, end,
                     grouped(steps), eta);
}

ProgressLine::ProgressLine(double start, double end, bool shown)
    : start_(start), end_(end), shown_(shown), began_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
  if (width_ == 0) return;
  show("");
  std::fputc('\r', stderr);
}

void ProgressLine::update(double t, long steps) {
  if (due()) show(progress_text(start_, end_, t, steps, elapsed()));
}

void ProgressLine::update(const char* what, long done, long total) {
  if (due()) show(progress_text(what, done, total, elapsed()));
}

bool ProgressLine::due() {
  const auto now = std::chrono::steady_clock::now();
  if (!shown_ || now - last_ < std::chrono::milliseconds(100)) return false;
  last_ = now;
  return true;
}

double ProgressLine::elapsed() const { return std::chrono::duration<double>(last_ - began_).count(); }

void ProgressLine::show(const std::string& line) {
  // Blanks over the rest of the last line: escape sequences are not for every terminal.
  std::fputs(fmt::format("\r{:<{}}", line, width_).c_str(), stderr);  // fmt::print throws on a closed pipe
  std::fflush(stderr);
  width_ = line.size();
}

}  // namespace freeplay
