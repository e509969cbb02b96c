#include "base/diagnostics.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace freeplay {
namespace {

// Wider source lines are cut to a window around the caret; longer messages carry a hostile name.
constexpr int widest_line = 160, longest_message = 1000;

/// Characters [begin, begin + count) of a text.
std::string_view characters(std::string_view text, int begin, int count) {
  const auto skip = [&](std::size_t from, int n) {
    for (; n > 0 && from < text.size(); --n) from += std::max<std::size_t>(1, character_bytes(text, from));
    return from;
  };
  const std::size_t first = skip(0, begin);
  return text.substr(first, skip(first, count) - first);
}

std::string one_line(std::string_view text) {
  const std::string_view head = characters(text, 0, longest_message);
  return printable(head) + (head.size() < text.size() ? "..." : "");
}

}  // namespace

Diagnostic as_diagnostic(const Error& error) {
  Diagnostic diagnostic;
  diagnostic.id = error.id();
  diagnostic.message = error.message();
  diagnostic.location = error.location();
  if (diagnostic.location.file.empty()) diagnostic.location = {program_as_file, 0, 0};
  diagnostic.hint = error.hint();
  return diagnostic;
}

Diagnostics::Source& Diagnostics::source(const std::string& file) {
  const auto [entry, added] = sources_.try_emplace(file);
  if (added) entry->second.order = sources_.size();
  return entry->second;
}

void Diagnostics::add_source(const std::string& file, std::string text) {
  Source& known = source(file);
  known.text = std::move(text);
  known.line_starts = {0};
  for (std::size_t i = 0; i < known.text.size(); ++i) {
    if (known.text[i] == '\n') known.line_starts.push_back(i + 1);
  }
}

void Diagnostics::add(Diagnostic diagnostic) {
  if (excused_.contains(diagnostic.id)) return;
  if (strict_) diagnostic.severity = Severity::error;
  const bool error = diagnostic.severity == Severity::error;
  if (error) ++errors_;
  const Location at = diagnostic.location;
  std::string key = fmt::format("{}\n{}:{}\n{}\n{}", at.file, at.line, at.column, diagnostic.id, diagnostic.message);
  if (!error && known_.size() >= most_messages) {
    left_out_ += known_.contains(key) ? 0 : 1;
  } else if (known_.insert(std::move(key)).second) {
    if (error) ++kept_errors_;
    source(at.file);
    diagnostics_.push_back(std::move(diagnostic));
  }
  if (full_ || (kept_errors_ < most_messages && errors_ < most_errors)) return;
  full_ = true;
  throw Error(Error::Category::input, "too-large",
              fmt::format("there are {} errors up to here; what is left of the file is not checked", errors_), at);
}

void Diagnostics::error(Location location, int length, std::string id, std::string message, std::string suggestion,
                        std::string hint) {
  add({Severity::error,
       std::move(id),
       std::move(message),
       std::move(location),
       length,
       std::move(suggestion),
       std::move(hint),
       {}});
}

void Diagnostics::warning(Location location, int length, std::string id, std::string message, std::string suggestion,
                          std::string hint) {
  add({Severity::warning,
       std::move(id),
       std::move(message),
       std::move(location),
       length,
       std::move(suggestion),
       std::move(hint),
       {}});
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  const auto place = [&](const Diagnostic& d) {
    return std::tuple(sources_.at(d.location.file).order, d.location.line, d.location.column);
  };
  std::vector<const Diagnostic*> order;
  for (const Diagnostic& diagnostic : diagnostics_) order.push_back(&diagnostic);
  std::stable_sort(order.begin(), order.end(), [&](auto* a, auto* b) { return place(*a) < place(*b); });

  std::vector<Diagnostic> result;
  for (const Diagnostic* d : order) result.push_back(*d);
  if (left_out_ > 0) {
    const std::string& file = diagnostics_.front().location.file;
    result.push_back({Severity::warning, "too-large", fmt::format("{} more warnings", left_out_), {file, 0, 0}});
  }
  return result;
}

std::string Diagnostics::format(int max_errors) const {
  std::string out;
  int shown = 0, left = 0;
  for (const Diagnostic& diagnostic : sorted()) {
    const bool error = diagnostic.severity == Severity::error;
    if (error && max_errors > 0 && shown == max_errors) {
      ++left;
    } else if (left == 0) {
      append(out, diagnostic);
      shown += error ? 1 : 0;
    }
  }
  if (left > 0) {
    out += fmt::format("and {} more error{}; --max-errors 0 shows all\n", left, left == 1 ? "" : "s");
  }
  return out;
}

void Diagnostics::append(std::string& out, const Diagnostic& diagnostic) const {
  const Location& at = diagnostic.location;
  out += one_line(at.file);
  if (at.line > 0) out += fmt::format(":{}:{}", at.line, at.column);
  out += fmt::format("{}{}: {} [{}]\n", at.file.empty() ? "" : ": ",
                     diagnostic.severity == Severity::error ? "error" : "warning", one_line(diagnostic.message),
                     diagnostic.id);
  append_source(out, diagnostic);
  const auto line = [&](std::string_view text) { out += fmt::format("      = {}\n", one_line(text)); };
  if (!diagnostic.suggestion.empty()) line(fmt::format("did you mean '{}'?", diagnostic.suggestion));
  if (!diagnostic.hint.empty()) line(diagnostic.hint);
  for (const std::string& note : diagnostic.notes) line(note);
}

std::string_view Diagnostics::source_line(const Location& location) const {
  const auto found = sources_.find(location.file);
  if (found == sources_.end() || location.line < 1) return {};
  const Source& known = found->second;
  const auto index = static_cast<std::size_t>(location.line - 1);
  if (index >= known.line_starts.size()) return {};
  const std::size_t begin = known.line_starts[index];
  const std::size_t end = std::min(known.text.find('\n', begin), known.text.size());
  std::string_view line = std::string_view(known.text).substr(begin, end - begin);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

void Diagnostics::append_source(std::string& out, const Diagnostic& diagnostic) const {
  const Location& at = diagnostic.location;
  const std::string_view line = source_line(at);
  if (line.empty()) return;
  const int total = character_count(line);
  const int caret = std::clamp(at.column - 1, 0, total);
  const int begin = total <= widest_line ? 0 : std::clamp(caret - widest_line / 2, 0, total - widest_line);
  const int end = std::min(total, begin + widest_line);
  const char* const before = begin > 0 ? "..." : "";
  const char* const after = end < total ? "..." : "";
  const std::string shown = printable(characters(line, begin, end - begin));
  const auto width = [&](int from, int count) { return display_width(printable(characters(line, from, count))); };
  const int tildes = std::max(0, width(caret, std::min(diagnostic.length, end - caret)) - 1);
  const int indent = width(begin, caret - begin) + (begin > 0 ? 3 : 0);
  out += fmt::format("{:>5} | {}{}{}\n      | {:>{}}^{}\n", at.line, before, shown, after, "", indent,
                     std::string(static_cast<std::size_t>(tildes), '~'));
}

}  // namespace freeplay
