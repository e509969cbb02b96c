#include "workers/outcome_bytes.h"

#include <cstring>
#include <stdexcept>

namespace freeplay {
namespace {

using Length = std::uint64_t;

template <class Plain>
void put(std::string& out, const Plain& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& out, const std::string& text) {
  put(out, Length{text.size()});
  out += text;
}

std::string_view take_bytes(std::string_view& bytes, std::size_t count) {
  if (bytes.size() < count) throw std::runtime_error("a message between processes is too short");
  const std::string_view taken = bytes.substr(0, count);
  bytes.remove_prefix(count);
  return taken;
}

template <class Plain>
Plain take(std::string_view& bytes) {
  Plain value;
  std::memcpy(&value, take_bytes(bytes, sizeof value).data(), sizeof value);
  return value;
}

std::string take_text(std::string_view& bytes) {
  const auto length = take<Length>(bytes);
  return std::string(take_bytes(bytes, length));
}

/// Puts the length of what was appended since in its place.
void end_message(std::string& out, std::size_t from) {
  const Length length = out.size() - from - sizeof(Length);
  std::memcpy(out.data() + from, &length, sizeof length);
}

}  // namespace

void append_message(std::string& out, const StudyTask& task) {
  const std::size_t from = out.size();
  put(out, Length{0});
  put(out, task.unit);
  put(out, task.first);
  put(out, task.end);
  put(out, task.state);
  end_message(out, from);
}

void append_message(std::string& out, std::uint64_t point, const StudyOutcome& outcome) {
  const std::size_t from = out.size();
  put(out, Length{0});
  put(out, point);
  put(out, outcome.exit_code);
  for (const double number : {outcome.wall, outcome.cpu, outcome.run}) put(out, number);
  for (const std::string* text : {&outcome.error, &outcome.message, &outcome.start, &outcome.state}) put(out, *text);
  put(out, Length{outcome.values.size()});
  for (const double value : outcome.values) put(out, value);
  put(out, Length{outcome.samples.size()});
  for (const auto& list : outcome.samples) {
    put(out, Length{list.size()});
    for (const auto& [time, value] : list) {
      put(out, time);
      put(out, value);
    }
  }
  end_message(out, from);
}

bool take_message(std::string_view& bytes, std::string_view& message) {
  std::string_view rest = bytes;
  if (rest.size() < sizeof(Length)) return false;
  const auto length = take<Length>(rest);
  if (rest.size() < length) return false;
  message = take_bytes(rest, length);
  bytes = rest;
  return true;
}

StudyTask task_of(std::string_view message) {
  StudyTask task;
  task.unit = take<std::uint64_t>(message);
  task.first = take<std::uint64_t>(message);
  task.end = take<std::uint64_t>(message);
  task.state = take_text(message);
  return task;
}

StudyOutcome outcome_of(std::string_view message, std::uint64_t& point) {
  point = take<std::uint64_t>(message);
  StudyOutcome outcome;
  outcome.exit_code = take<int>(message);
  for (double* number : {&outcome.wall, &outcome.cpu, &outcome.run}) *number = take<double>(message);
  for (std::string* text : {&outcome.error, &outcome.message, &outcome.start, &outcome.state}) {
    *text = take_text(message);
  }
  outcome.values.resize(take<Length>(message));
  for (double& value : outcome.values) value = take<double>(message);
  outcome.samples.resize(take<Length>(message));
  for (auto& list : outcome.samples) {
    list.resize(take<Length>(message));
    for (auto& [time, value] : list) {
      time = take<double>(message);
      value = take<double>(message);
    }
  }
  return outcome;
}

}  // namespace freeplay
