#include "format/pose_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/suggestion.h"
#include "base/text.h"
#include "format/doubtful_points.h"
#include "format/table_file.h"
#include "format/table_keys.h"

namespace freeplay {
namespace {

constexpr double length_limit = 1e-3;                 // of a quaternion from 1
constexpr double widest_turn = 170.0 / 180.0 * M_PI;  // between neighbours [rad]
constexpr double smallest_way = 1e-9;                 // of a path [m or rad]: else rounding
constexpr double closed_limit = 1e-9;                 // of the largest number, between both ends of a period

std::vector<std::string> column_words(bool in_space) {
  if (in_space) return {"x", "y", "z", "qw", "qx", "qy", "qz"};
  return {"x", "y", "angle"};
}

/// Of one file.
class PoseReader {
 public:
  PoseReader(Draft& draft, const CheckedValue& value, const CheckedValue& file)
      : draft_(draft),
        value_(value),
        in_space_(value.in_space()),
        words_(column_words(in_space_)),
        file_(draft, file) {}

  bool read(const std::optional<CheckedValue>& time, double time_unit, double unit, double angle_unit,
            FramePath& path) {
    if (!file_.open()) return false;
    const auto time_column = file_.column(time, 0);
    if (!time_column || !find_columns(*time_column)) return false;
    std::vector<TableFile::Column> columns;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      const bool length = i < (in_space_ ? 3U : 2U);
      if (places_[i]) columns.push_back({*places_[i], length ? unit : in_space_ ? 1.0 : angle_unit});
    }
    std::vector<double> times;
    std::vector<std::vector<double>> values;
    if (!file_.read({*time_column, time_unit}, columns, times, values)) return false;
    if (places_[3] && !align({values.end() - 4, values.end()})) return false;
    return make(times, std::move(values), path);
  }

 private:
  bool find_columns(std::size_t time) {
    const std::vector<std::string>& names = file_.text().names();
    bool good = true;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (i == time) continue;
      const auto word = std::ranges::find(words_, names[i]);
      if (word != words_.end()) {
        places_[static_cast<std::size_t>(word - words_.begin())] = i;
        continue;
      }
      const auto nearest_word = suggestion(names[i], words_);
      const CsvText::Field field = file_.text().header(i);
      draft_.diagnostics.error(field.location, std::max(1, character_count(field.text)), "unknown-name",
                               fmt::format("'{}' is no column of a path: after the time they are {}",
                                           printable(names[i]), fmt::join(words_, ", ")),
                               nearest_word.value_or(""));
      good = false;
    }
    if (!good) return false;
    const auto parts =
        std::count_if(places_.begin() + 3, places_.end(), [](const auto& place) { return place.has_value(); });
    for (std::size_t i = 3; i < words_.size() && parts > 0; ++i) {
      if (places_[i]) continue;
      file_.bad(file_.text().header(0),
                fmt::format("the column '{}' is missing: a quaternion has qw, qx, qy and qz", words_[i]));
      good = false;
    }
    return good;
  }

  // Checks the quaternions of all rows and gives each the sign that lies on the side of the one before.
  bool align(std::span<std::vector<double>> q) const {
    for (std::size_t row = 0; row < q[0].size(); ++row) {
      double squared = 0.0, along = 0.0;
      for (const std::vector<double>& part : q) squared += part[row] * part[row];
      const CsvText::Field place = file_.text().field(row, *places_[3]);
      if (!(std::abs(std::sqrt(squared) - 1.0) <= length_limit)) {
        file_.bad(place, fmt::format("the quaternion has the length {:.6g}, not 1", std::sqrt(squared)));
        return false;
      }
      if (row == 0) continue;
      for (const std::vector<double>& part : q) along += part[row] * part[row - 1];
      if (std::abs(along) < std::cos(0.5 * widest_turn)) {
        file_.bad(place, "the frame turns by about half a turn since the row before, one way or the other",
                  "give more rows, less than 170 deg apart");
        return false;
      }
      if (along >= 0.0) continue;
      for (std::vector<double>& part : q) part[row] = -part[row];
    }
    return true;
  }

  bool make(const std::vector<double>& times, std::vector<std::vector<double>> values, FramePath& path) const {
    const bool periodic = path.source.interpolation == Interpolation::cubic && path.source.ends == SplineEnds::periodic;
    const Location body = file_.text().body_location();
    if (const std::size_t least = periodic ? 3 : 2; times.size() < least) {
      draft_.diagnostics.error(body, 1, "bad-table", fmt::format("a table needs at least {} rows", least));
      return false;
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (!places_[i]) continue;
      std::vector<double>& column = values[next++];
      double largest = i < 3 ? 0.0 : 1.0;
      for (const double number : column) largest = std::max(largest, std::abs(number));
      if (periodic && !(std::abs(column.front() - column.back()) <= closed_limit * largest)) {
        draft_.diagnostics.error(
            body, 1, "bad-table",
            fmt::format("first and last value of a periodic table must agree: '{}' is {} and {}", words_[i],
                        column.front(), column.back()),
            "", i < 3 ? "" : "after an odd number of turns the quaternion comes back with the other sign");
        return false;
      }
      path.tables[i] = std::make_shared<const TimeTable>(times, std::move(column), path.source.interpolation,
                                                         path.source.ends, path.source.outside);
      const auto [low, high] = std::ranges::minmax(path.tables[i]->values());
      if (i < 3 && high - low > smallest_way)
        doubt_overshoot(*path.tables[i], value_, {"t", " s", fmt::format(" in '{}'", words_[i])});
      Jet jet;
      EvaluationFailure failure;
      const double start = value_.reading().start_time;
      if (path.tables[i]->evaluate(start, jet, failure)) continue;
      value_.fail(failure.id, fmt::format("{}: {} s", failure.reason, start));
      return false;
    }
    return true;
  }

  Draft& draft_;
  const CheckedValue& value_;
  bool in_space_;
  std::vector<std::string> words_;
  TableFile file_;
  std::array<std::optional<std::size_t>, most_path_numbers + 1> places_{};  // columns, by word
};

}  // namespace

std::optional<FramePath> read_pose_table(Draft& draft, const CheckedValue& value, MapReader& map) {
  const bool short_form = value.node().is_scalar();
  const auto file = short_form ? std::optional<CheckedValue>(value) : map.find("file");
  const auto time = map.find("time"), time_unit = map.find("time_unit"), unit = map.find("unit");
  const auto seconds = unit_factor(time_unit, dimension::time), metres = unit_factor(unit, dimension::length);
  const auto angle_unit = map.find("angle_unit");
  const auto radians = unit_factor(angle_unit, dimension::angle);
  const auto interpolation = word_place(map.find("interpolation"), {"cubic", "linear"});
  const auto ends = word_place(map.find("ends"), {"natural", "clamped", "periodic"});
  const auto outside = word_place(map.find("outside"), {"hold", "repeat", "error"});
  map.finish();
  if (!map.good() || !seconds || !metres || !radians || !interpolation || !ends || !outside) return std::nullopt;
  const auto text = [](const std::optional<CheckedValue>& key) { return key ? key->node().text : std::string(); };
  FramePath path;
  path.source = {text(file),
                 text(time),
                 "",
                 text(time_unit),
                 text(unit),
                 static_cast<Interpolation>(*interpolation),
                 static_cast<SplineEnds>(*ends),
                 static_cast<Outside>(*outside)};
  path.angle_unit = text(angle_unit);
  if (!PoseReader(draft, value, *file).read(time, *seconds, *metres, *radians, path)) return std::nullopt;
  return path;
}

}  // namespace freeplay
