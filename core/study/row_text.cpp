#include "study/row_text.h"

#include <array>
#include <charconv>

#include <fmt/format.h>
#include <zlib.h>

#include "base/number_text.h"

namespace freeplay {
namespace {

constexpr std::size_t checksum_digits = 8;

/// What separates fields and lines is none of a text.
void append_plain(std::string& out, std::string_view text) {
  for (const char c : text) out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
}

void append_index(std::string& out, std::uint64_t index) { out += fmt::format("{}\t", index); }

}  // namespace

std::uint32_t row_checksum(std::string_view text) {
  return static_cast<std::uint32_t>(
      ::crc32_z(0, reinterpret_cast<const unsigned char*>(text.data()), static_cast<z_size_t>(text.size())));
}

void seal_line(std::string& out, std::size_t from) {
  out += fmt::format("{:08x}\n", row_checksum(std::string_view(out).substr(from)));
}

std::string_view unsealed(std::string_view line) {
  if (line.size() < checksum_digits + 1 || line[line.size() - checksum_digits - 1] != '\t') return {};
  const std::string_view text = line.substr(0, line.size() - checksum_digits);
  std::uint32_t written = 0;
  const char* end = line.data() + line.size();
  for (const char* at = text.data() + text.size(); at != end; ++at) {
    if (*at >= 'A' && *at <= 'F') return {};
  }
  const auto [last, fault] = std::from_chars(text.data() + text.size(), end, written, 16);
  return fault == std::errc() && last == end && written == row_checksum(text) ? text : std::string_view();
}

void append_point(std::string& out, std::uint64_t index, const std::string& hash, const StudyOutcome& outcome,
                  const RowLayout& layout, std::uint64_t origin) {
  std::size_t from = out.size();
  const bool good = outcome.exit_code == 0;
  for (std::size_t i = 0; good && i < layout.samples.size(); ++i, from = out.size()) {
    out += '+';
    append_index(out, index);
    (out += layout.samples[i]) += '\t';
    for (const auto& [time, value] : outcome.samples.at(i)) {
      append_number(out, time);
      out += ':';
      append_number(out, value);
      out += '\t';
    }
    seal_line(out, from);
  }
  if (!good) {
    out += '!';
    append_index(out, index);
    append_plain(out, outcome.message);
    out += '\t';
    seal_line(out, from);
    from = out.size();
  }
  if (layout.chained) {
    out += '@';
    append_index(out, index);
    (out += outcome.start) += '\t';
    append_index(out, origin);
    (out += outcome.state) += '\t';
    seal_line(out, from);
    from = out.size();
  }
  append_index(out, index);
  out += fmt::format("{}\t{}\t", hash, outcome.exit_code);
  append_plain(out, outcome.error);
  for (const double seconds : {outcome.wall, outcome.cpu, outcome.run}) {
    out += '\t';
    append_number(out, seconds);
  }
  out += '\t';
  for (std::size_t i = 0; good && i < layout.columns.size(); ++i) {
    append_number(out, outcome.values.at(i));
    out += '\t';
  }
  seal_line(out, from);
}

}  // namespace freeplay
