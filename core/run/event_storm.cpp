#include "run/event_storm.h"

namespace freeplay {
namespace {
constexpr long most_at_once = 1000, most_in_step_size = 20000, most_full_steps = 100;
}  // namespace

long EventStorm::Window::count(double time, double length) {
  if (events == 0 || time - from > length) from = time, events = 0;
  return ++events;
}

EventStorm::Finding EventStorm::note(int joint, double time, long step) {
  Count& count = counts_[static_cast<std::size_t>(joint)];
  if (step != count.step) {
    const bool goes_on = step == count.step + 1 && count.in_step >= limits_.most_in_step;
    count.full_steps = goes_on ? count.full_steps + 1 : 0;
    if (!goes_on) count.full_from = time;
    count.step = step;
    count.in_step = 0;
  }
  ++count.in_step;
  if (const long events = count.instant.count(time, limits_.instant); events > most_at_once) {
    return {events, time - count.instant.from};
  }
  if (limits_.step_size > 0.0) {
    const long events = count.step_size.count(time, limits_.step_size);
    if (events > most_in_step_size) return {events, time - count.step_size.from};
  }
  if (count.full_steps < most_full_steps) return {};
  return {count.full_steps * limits_.most_in_step, time - count.full_from};
}

}  // namespace freeplay
