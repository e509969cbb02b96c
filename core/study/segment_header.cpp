#include "study/segment_header.h"

#include <charconv>
#include <numeric>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "study/row_text.h"

namespace freeplay {
namespace {

constexpr std::string_view first_field = "#freeplay-rows 1";

/// `NAME=VALUE` of a header, or nothing.
std::optional<std::string> field_of(std::string_view field, std::string_view name) {
  if (!field.starts_with(name) || field.substr(name.size(), 1) != "=") return std::nullopt;
  return std::string(field.substr(name.size() + 1));
}

}  // namespace

bool Shard::meets(const Shard& other) const {
  const std::uint64_t common = std::gcd(parts, other.parts);
  return part % common == other.part % common;
}

std::string SegmentHeader::text() const {
  std::string line = fmt::format("{}\tstudy={}\tprogram={}\tarithmetic={}\tshard={}/{}\thost={}\tstarted={}\t",
                                 first_field, study, program, arithmetic, shard.part, shard.parts, host, started);
  seal_line(line, 0);
  return line;
}

std::optional<SegmentHeader> SegmentHeader::parse(std::string_view line) {
  std::string_view rest = unsealed(line);
  std::vector<std::string_view> fields;
  for (std::size_t end = rest.find('\t'); end != std::string_view::npos; end = rest.find('\t')) {
    fields.push_back(rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  if (fields.size() != 7 || fields[0] != first_field) return std::nullopt;
  const auto study = field_of(fields[1], "study"), program = field_of(fields[2], "program"),
             arithmetic = field_of(fields[3], "arithmetic"), shard = field_of(fields[4], "shard"),
             host = field_of(fields[5], "host"), started = field_of(fields[6], "started");
  if (!study || !program || !arithmetic || !shard || !host || !started) return std::nullopt;
  SegmentHeader header{*study, *program, *arithmetic, {}, *host, *started};
  const char* const end = shard->data() + shard->size();
  const auto part = std::from_chars(shard->data(), end, header.shard.part);
  if (part.ptr == end || *part.ptr != '/') return std::nullopt;
  const auto parts = std::from_chars(part.ptr + 1, end, header.shard.parts);
  if (parts.ptr != end || header.shard.part < 1 || header.shard.part > header.shard.parts) return std::nullopt;
  return header;
}

}  // namespace freeplay
