// RunData: what a page holds of one run, read in one pass over its rows.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report/animation.h"
#include "report/courses.h"
#include "report/impacts.h"
#include "report/orbit.h"
#include "report/reported_run.h"
#include "results/derived_table.h"

namespace freeplay {

/// What one run may take of a page that several share.
struct Shares {
  std::size_t poses, orbit_points, window_numbers;  ///< numbers
  std::size_t bearings, spectrum_points;            ///< joints; lines of all efforts
  std::size_t text;                                 ///< bytes of the model, and of the summary
};

class RunData {
 public:
  /// Looks at times and events. `channels`: indices of the columns to show, the most wanted first.
  RunData(ReportedRun& run, std::vector<std::size_t> channels, const RowWindow& window, const Shares& shares);

  std::size_t rows() const { return rows_; }
  std::size_t channels() const { return shown_.size(); }
  /// The least wanted channel goes. Returns the characters that its name then takes.
  std::size_t leave_out_channel();
  /// What fills the part of the summary that depends on how the run was called, and where, up to a round size: a page
  /// of the same run called in other words has as many buckets.
  std::size_t call_margin() const;
  /// Characters of JSON: all but courses, at most; and those of the courses in so many buckets.
  std::size_t fixed_size() const;
  std::size_t course_size(std::size_t buckets) const;

  /// Reads the rows; again where it is asked for again.
  void read(std::size_t buckets);
  /// After read().
  Json json() const;
  /// Of json(), what is not there for want of room.
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  struct OrbitColumns {
    std::string joint;
    double clearance;
    std::size_t x, y, z;  // z: x again in the plane
    bool in_space() const { return z != x; }
  };

  void look_at_times();
  void note_missing_rows();
  void add_note(const std::string& text);
  CountedTime counted() const;
  void find_orbits(std::size_t points);
  void find_efforts();
  void shorten_texts(std::size_t most);
  std::vector<std::string> names() const;
  std::vector<JointChannels> joint_channels() const;
  std::size_t buckets_of(std::size_t buckets) const { return rows_ <= 2 * buckets ? 0 : buckets; }
  void take(std::span<const double> row, std::vector<std::vector<double>>& efforts);
  Json channels_json() const;
  Json bearing_json() const;
  std::size_t lines_of_effort() const;
  Json spectra_json(const std::vector<std::vector<double>>& efforts) const;

  ReportedRun& run_;
  RowWindow window_;
  Shares shares_;
  Json summary_;
  std::string model_text_, note_;
  std::vector<std::size_t> wanted_, shown_;  // by rank, and in the order of the columns
  std::size_t rows_ = 0;
  double first_ = 0.0, last_ = 0.0, interval_ = 0.0;
  Impacts impacts_;
  std::vector<OrbitColumns> orbit_columns_;
  std::vector<std::size_t> effort_columns_;
  std::optional<Animation> plan_;
  Json impacts_json_, bearing_;
  std::vector<std::string> left_out_;
  // Of the last pass.
  std::size_t buckets_ = 0;
  std::vector<JointChannels> joint_channels_;
  std::optional<Courses> courses_;
  std::optional<ImpactWindows> windows_;
  std::vector<Orbit> orbits_;
  std::optional<Animation> animation_;
  Json spectra_ = Json::array();
};

}  // namespace freeplay
