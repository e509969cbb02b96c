#include "results/verification.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

namespace freeplay {
namespace {

constexpr double sure = 30.0;       // differences that the second method does not explain, over those that it does
constexpr double loud = 10.0;       // limits
constexpr double loud_way = 0.01;   // of the farthest way, with fixed steps
constexpr double chaotic = 30.0;    // limits, by which runs of one method part
constexpr double same_peak = 0.1;   // of the larger one
constexpr double same_sight = 0.5;  // of the larger one: two largest values that are farther apart saw other loads
constexpr double negligible_peak = 1e-6;   // of the largest of the same kind
constexpr double negligible_lever = 1e-5;  // of the model's size: a torque that its forces have by it is none
constexpr double negligible_work = 1e-2;   // of the energy that was moved: what comes and goes leaves rounding
constexpr double negligible_force = 1e-9;  // of the one that does that energy's work along the model's size
constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Moments {
  double squares = 0.0, largest = 0.0;
  std::size_t count = 0;

  void add(double x) {
    if (std::isnan(x)) return;
    squares += x * x;
    largest = std::max(largest, std::abs(x));
    ++count;
  }
  double rms() const { return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : none; }
  double maximum() const { return count > 0 ? largest : none; }
};

/// Rows of both at the same times: a run that a condition stops ends with one of its own.
std::size_t common_rows(const ResultTable& a, const ResultTable& b) {
  const std::vector<double>&x = a.time(), &y = b.time();
  const double same = x.size() < 2 ? 0.0 : 1e-9 * (x[1] - x[0]);
  std::size_t rows = 0;
  while (rows < std::min(x.size(), y.size()) && std::abs(x[rows] - y[rows]) <= same) ++rows;
  return rows;
}

/// Largest difference of the positions, by row.
std::vector<double> differences(const ResultTable& a, const ResultTable& b, const VerificationRules& rules) {
  std::vector<double> largest(common_rows(a, b), 0.0);
  for (const PositionChannel& position : rules.positions) {
    const int i = a.find(position.name), k = b.find(position.name);
    if (i < 0 || k < 0) continue;
    const std::vector<double>&x = a.values[static_cast<std::size_t>(i)], &y = b.values[static_cast<std::size_t>(k)];
    for (std::size_t r = 0; r < largest.size(); ++r) {
      const double off = position.lever * std::abs(x[r] - y[r]);
      if (off > largest[r]) largest[r] = off;
    }
  }
  return largest;
}

double limit_at(const ResultTable& table, std::size_t row, const VerificationRules& rules) {
  return rules.limit * std::max(1.0, table.time()[row] - table.time().front());
}

/// How far the body that goes farthest does, in one direction.
double farthest_way(const ResultTable& table, const VerificationRules& rules) {
  double way = 0.0;
  for (const PositionChannel& position : rules.positions) {
    const int i = table.find(position.name);
    if (i < 0 || table.time().empty()) continue;
    const auto [low, high] = std::ranges::minmax_element(table.values[static_cast<std::size_t>(i)]);
    way = std::max(way, position.lever * (*high - *low));
  }
  return way;
}

/// The last word of a name.
std::string_view kind_of(const PeakPair& peak) { return std::string_view(peak.name).substr(peak.name.rfind(' ') + 1); }

/// An error of a path, or how deep surfaces are in each other.
bool is_length(const PeakPair& peak) { return kind_of(peak) == "error" || kind_of(peak) == "delta"; }
/// One instant decides a largest value; a mean or a work is of all the run.
bool is_largest(const PeakPair& peak) { return peak.name.find(" max ") != std::string::npos; }

/// Below, a figure is none: in terms of the largest of its kind, a torque of that of all forces, too; a length is none
/// that is shorter than what positions may err by.
double negligible(std::span<const PeakPair> peaks, const PeakPair& of, const VerificationRules& rules) {
  if (kind_of(of) == "work") return negligible_work * rules.energy;
  const double size = rules.size;
  double alike = 0.0, force = 0.0;
  for (const PeakPair& peak : peaks) {
    const double larger = std::fmax(std::abs(peak.run), std::abs(peak.second));
    if (kind_of(peak) == kind_of(of)) alike = std::fmax(alike, larger);
    if (kind_of(peak) == "|F|" || kind_of(peak) == "|force|") force = std::fmax(force, larger);
  }
  const double limit = negligible_peak * alike, by_energy = negligible_force * rules.energy;
  if (is_length(of)) return std::fmax(limit, rules.length);
  if (kind_of(of) == "|torque|") return std::max({limit, negligible_lever * size * force, by_energy});
  return size > 0.0 ? std::fmax(limit, by_energy / size) : limit;
}

void compare_peaks(const RunResult& run, const RunResult& second, const VerificationRules& rules, Verification& out) {
  for (std::size_t i = 0; i < std::min(run.peaks.size(), second.peaks.size()); ++i) {
    out.peaks.push_back({run.peaks[i].name, run.peaks[i].value, second.peaks[i].value});
  }
  for (PeakPair& peak : out.peaks) {
    const double larger = std::fmax(std::abs(peak.run), std::abs(peak.second));
    const double off = std::abs(peak.run - peak.second);
    peak.differs = off > same_peak * larger && off > negligible(out.peaks, peak, rules);
  }
}

}  // namespace

Verification compare_runs(const RunResult& run, const RunResult& second, const VerificationRules& rules) {
  const ResultTable &a = *run.rows, &b = *second.rows;
  Verification out;
  out.limit = rules.limit;
  const std::vector<double> off = differences(a, b, rules);
  std::size_t agreeing = 0;
  while (agreeing < off.size() && off[agreeing] <= limit_at(a, agreeing, rules)) ++agreeing;
  out.agree_until = agreeing > 0 ? a.time()[agreeing - 1] : (a.time().empty() ? 0.0 : a.time().front());
  out.until = off.empty() ? 0.0 : a.time()[off.size() - 1];
  if (const auto worst = std::ranges::max_element(off); worst != off.end()) {
    out.largest = *worst;
    out.at = a.time()[static_cast<std::size_t>(worst - off.begin())];
  }
  for (std::size_t c = 1; c < a.names.size(); ++c) {
    ChannelError channel{.name = a.names[c]};
    Moments first, other;
    for (std::size_t r = 0; r < off.size(); ++r) {
      const double x = a.values[c][r], y = b.values[c][r];
      if (r >= agreeing) {
        first.add(x);
        other.add(y);
      } else if (std::abs(x - y) > channel.error) {
        channel.error = std::abs(x - y);
      }
    }
    channel.rms = first.rms();
    channel.second_rms = other.rms();
    channel.largest = first.maximum();
    channel.second_largest = other.maximum();
    out.channels.push_back(std::move(channel));
  }
  compare_peaks(run, second, rules, out);
  const bool good = agreeing == off.size() && std::ranges::none_of(out.peaks, &PeakPair::differs);
  out.agreement = good ? Agreement::agree : Agreement::err;
  return out;
}

void judge(Verification& verification, const RunResult& run, const RunResult& second, const RunResult& third,
           const VerificationRules& rules) {
  const std::vector<double> off = differences(*run.rows, *second.rows, rules);
  const std::vector<double> explained = differences(*second.rows, *third.rows, rules);
  const double way = farthest_way(*second.rows, rules);
  double spread = 0.0;
  bool parts = false, explains = false;
  for (std::size_t r = 0; r < std::min(off.size(), explained.size()); ++r) {
    const double limit = limit_at(*run.rows, r, rules);
    spread = std::max(spread, explained[r]);
    parts = parts || spread > chaotic * limit;
    // Fixed steps may err much more at first than the second method does: they part earlier.
    explains = explains || spread > (rules.fixed ? limit : chaotic * limit);
    const double heard = rules.fixed ? std::max(loud * limit, loud_way * way) : loud * limit;
    if (!explains && off[r] > heard && off[r] > sure * spread) {
      verification.agreement = Agreement::disagree;
      return;
    }
  }
  if (parts) {
    verification.agreement = Agreement::part;
    return;
  }
  for (std::size_t i = 0; i < std::min(verification.peaks.size(), third.peaks.size()); ++i) {
    const PeakPair& peak = verification.peaks[i];
    const double by_method = std::abs(peak.second - third.peaks[i].value);
    const double by_run = std::abs(peak.run - peak.second);
    const double sight = is_largest(peak) ? same_sight : same_peak;
    const double larger = std::fmax(std::abs(peak.run), std::abs(peak.second));
    if (peak.differs && by_run > sight * larger && 5.0 * by_method < by_run) {
      verification.agreement = Agreement::disagree;
      return;
    }
  }
}

}  // namespace freeplay
