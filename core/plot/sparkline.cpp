#include "plot/sparkline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"
#include "base/unit_prefix.h"
#include "plot/curve.h"

namespace freeplay::plot {
namespace {

constexpr std::size_t cells = 40, most_lines = 6;
constexpr const char* bars[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr const char* plain_bars[] = {"_", ".", ":", "-", "=", "+", "*", "#"};  // the more ink the higher

/// A column that may become a line.
struct Candidate {
  std::size_t column;
  std::string words;
  bool is_normal_force;
};

/// "driver.leg1.A.torque" as "leg1.A torque".
std::string words_of(const std::string& name) {
  const std::size_t first = name.find('.') + 1, last = name.rfind('.');
  return name.substr(first, last - first) + " " + name.substr(last + 1);
}

std::vector<Candidate> candidates(const ResultReader& reader) {
  std::vector<Candidate> paths, efforts, forces;
  const std::vector<RecordColumn>& columns = reader.layout().columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& name = columns[i].name;
    const auto is = [&](const char* head, const char* tail) { return name.starts_with(head) && name.ends_with(tail); };
    if (is("joint.", ".fn")) forces.push_back({i, words_of(name), true});
    if (is("driver.", ".ex") || is("driver.", ".ey") || is("driver.", ".ez"))
      paths.push_back({i, words_of(name), false});
    if (is("driver.", ".torque") || is("driver.", ".force")) efforts.push_back({i, words_of(name), false});
  }
  const std::size_t of_force = forces.empty() ? 0 : 1;
  const std::size_t of_paths = std::min(paths.size(), std::size_t{2});
  paths.resize(of_paths);
  efforts.resize(std::min(efforts.size(), most_lines - of_force - of_paths));
  paths.insert(paths.end(), efforts.begin(), efforts.end());
  paths.insert(paths.end(), forces.begin(), forces.end());
  return paths;
}

struct Seen {
  std::array<double, cells> largest;  // by amount, with its sign
  Extremes range;
};

std::string line_of(const Candidate& candidate, const Seen& seen, const std::string& unit, int wide, bool unicode) {
  const double low = std::min(0.0, seen.range.least), high = std::max(0.0, seen.range.most);
  const char* const* levels = unicode ? bars : plain_bars;
  std::string text;
  double last = 0.0;
  for (const double value : seen.largest) {
    if (!std::isnan(value)) last = value;
    const double part = high > low ? (last - low) / (high - low) : 0.0;
    text += levels[static_cast<std::size_t>(std::clamp(std::floor(part * 8.0), 0.0, 7.0))];
  }
  const double size = std::max(std::abs(seen.range.least), std::abs(seen.range.most));
  const PrefixedUnit to = unit == "1" ? PrefixedUnit{} : prefixed_unit(size, unit);
  return fmt::format("  {}{}  {}  {:.3g} {} {:.3g} {}\n", candidate.words,
                     std::string(static_cast<std::size_t>(wide - character_count(candidate.words)), ' '), text,
                     seen.range.least / to.factor, unicode ? "…" : "...", seen.range.most / to.factor, to.unit);
}

}  // namespace

std::string sparklines(ResultReader& reader, bool unicode) {
  const std::vector<Candidate> lines = candidates(reader);
  if (lines.empty()) return "";
  double from = std::nan(""), until = from;
  reader.rows(std::vector<std::size_t>{0}, {}, [&](std::span<const double> times) {
    if (std::isnan(from) && !times.empty()) from = times.front();
    if (!times.empty()) until = times.back();
  });
  if (!(until > from)) return "";
  std::vector<std::size_t> columns{0};
  for (const Candidate& line : lines) columns.push_back(line.column);
  std::vector<Seen> seen(lines.size());
  for (Seen& one : seen) one.largest.fill(std::nan(""));
  reader.rows(columns, {}, [&](std::span<const double> block) {
    for (; !block.empty(); block = block.subspan(columns.size())) {
      const double part = (block[0] - from) / (until - from) * static_cast<double>(cells);
      const auto cell = static_cast<std::size_t>(std::clamp(part, 0.0, static_cast<double>(cells) - 1.0));
      for (std::size_t i = 0; i < lines.size(); ++i) {
        const double value = block[1 + i];
        seen[i].range.add(block[0], value);
        double& largest = seen[i].largest[cell];
        if (std::isfinite(value) && !(std::abs(value) <= std::abs(largest))) largest = value;
      }
    }
  });
  std::size_t strongest = lines.size();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!lines[i].is_normal_force) continue;
    if (strongest == lines.size() || seen[i].range.most > seen[strongest].range.most) strongest = i;
  }
  int wide = 0;
  for (const Candidate& line : lines) wide = std::max(wide, character_count(line.words));
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if ((lines[i].is_normal_force && i != strongest) || !seen[i].range.any()) continue;
    text += line_of(lines[i], seen[i], reader.layout().columns[lines[i].column].unit, wide, unicode);
  }
  return text;
}

}  // namespace freeplay::plot
