#include "cli/window_lines.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "results/figure_text.h"

namespace freeplay {
namespace {

constexpr double clearly = 1.01;       // larger than a peak of the table, to be worth a word
constexpr double of_interest = 0.1;    // of the largest force: joints whose rows are compared
constexpr std::size_t most_names = 3;  // in one line

struct Peak {
  std::string name, value;
  double ratio;  ///< to that of the window
};

/// Two digits where chance takes part, else four.
std::string digits(double value, double noise) {
  if (!(noise > 0.0) || !(value > 0.0)) return fmt::format("{:.4g}", value);
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return fmt::format("{:.6g}", std::round(value / unit) * unit);
}

/// Of a peak that is noisy within the window no more digits are known before it.
void add_peak(const std::string& name, const char* unit, double before, double within, double noise,
              std::vector<Peak>& peaks) {
  if (!(before > 0.0) || (within > 0.0 && !(before > clearly * within))) return;
  const std::string value = fmt::format("{} {}", digits(before, noise), unit);
  peaks.push_back({name, value, within > 0.0 ? before / within : HUGE_VAL});
}

/// Peaks of the excluded part, of its rows and where contacts press hardest, that the window does not reach, the most
/// striking first.
std::vector<Peak> larger_before(const RunRecord& record) {
  const Statistics& statistics = record.statistics;
  const auto before = statistics.largest().before(), within = statistics.largest().in_window();
  const Model& model = record.model;
  std::vector<Peak> peaks;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const std::size_t i = statistics.largest().places().force(static_cast<int>(j));
    if (!model.joints[j].is_force && model.joints[j].gear < 0)
      add_peak(model.joints[j].name, "N", before[i], within[i], statistics.largest().noise().of(i), peaks);
  }
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const std::size_t i = statistics.largest().places().effort(static_cast<int>(d));
    const JointElement& joint = model.joints[static_cast<std::size_t>(model.drivers[d].joint)];
    const bool angle = joint.layout.coordinate == Coordinate::angle;
    add_peak("driver " + model.drivers[d].name, angle ? "N*m" : "N", before[i], within[i],
             statistics.largest().noise().of(i), peaks);
  }
  std::ranges::stable_sort(peaks, std::ranges::greater{}, &Peak::ratio);
  return peaks;
}

std::string before_window(const RunRecord& record) {
  const std::vector<Peak> peaks = larger_before(record);
  std::string text;
  for (std::size_t i = 0; i < std::min(peaks.size(), most_names); ++i) {
    text += fmt::format("{}{} {}{}", i == 0 ? "; before that " : ", ", peaks[i].name, i == 0 ? "reached " : "",
                        peaks[i].value);
  }
  if (peaks.size() > most_names) text += fmt::format(" and {} more", peaks.size() - most_names);
  return text;
}

/// Where rows are farther apart than a peak lasts.
std::string missed_by_rows(const RunRecord& record) {
  const Statistics& statistics = record.statistics;
  const auto all = statistics.largest().in_window(), written = statistics.largest().written();
  const std::vector<JointElement>& joints = record.model.joints;
  const auto force = [&](std::size_t j) { return statistics.largest().places().force(static_cast<int>(j)); };
  double largest = 0.0;
  for (std::size_t j = 0; j < joints.size(); ++j) largest = std::max(largest, all[force(j)]);
  std::size_t worst = joints.size();
  double least = 1.0 / clearly;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double peak = all[force(j)], share = written[force(j)] / peak;
    if (!joints[j].is_force && peak > of_interest * largest && share < least) worst = j, least = share;
  }
  if (worst == joints.size() || !(written[force(worst)] >= 0.0)) return {};
  const double noise = statistics.largest().noise().of(force(worst));
  // Rounded to what is known of it the peak may be below what rows show.
  const double place = noise > 0.0 ? std::pow(10.0, std::floor(std::log10(noise))) : 0.0;
  if (place > 0.0 && std::round(all[force(worst)] / place) * place <= written[force(worst)]) return {};
  const std::string seen = digits(written[force(worst)], noise);
  return fmt::format("  rows {:g} s apart miss peaks between them: they show {} N of the {} in {}\n",
                     record.model.settings.interval, seen, figure_text(all[force(worst)], "N", noise),
                     joints[worst].name);
}

}  // namespace

std::string window_lines(const RunRecord& record) {
  const StatisticsWindow window = record.statistics.window();
  if (!record.statistics.any()) {
    return fmt::format("  no statistics: they begin at {:g} s, and the run ended at {:g} s{}\n", window.from,
                       record.outcome.time, before_window(record));
  }
  return fmt::format("  statistics from {:g} s to {:g} s{}\n", window.from, window.to, before_window(record)) +
         missed_by_rows(record);
}

}  // namespace freeplay
