#include "report/run_data.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "report/base64.h"
#include "results/derived_table.h"
#include "results/hdf5_writer.h"
#include "results/row_grid.h"
#include "results/spectrum.h"

namespace freeplay {
namespace {

constexpr std::size_t shown_impacts = 200, most_orbits = 200, most_orbit_points = 4000;
constexpr std::size_t most_lines = 500, least_lines = 50, most_effort_numbers = std::size_t{1} << 23;
constexpr std::size_t number_size = 25;  // characters of a double, at most

std::size_t size_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace).size(); }

/// Fields of a summary in the order in which they go when a model is so large that its page has no room for them.
constexpr const char* less_wanted[] = {"/bodies", "/statistics", "/twin/bodies", "/noise",    "/repeat",
                                       "/verify", "/joints",     "/drivers",     "/warnings", "/forces"};

}  // namespace

RunData::RunData(ReportedRun& run, std::vector<std::size_t> channels, const RowWindow& window, const Shares& shares)
    : run_(run),
      window_(window),
      shares_(shares),
      summary_(run.summary),
      model_text_(run.model_text),
      note_(run.note),
      wanted_(std::move(channels)),
      impacts_(*run.reader, window) {
  look_at_times();
  shown_ = wanted_;
  std::ranges::sort(shown_);
  if (run_.model) plan_.emplace(*run_.model, run_.columns, rows_, shares.poses);
  if (plan_) left_out_ = plan_->left_out();
  if (plan_ && !plan_->any()) plan_.reset();
  find_orbits(shares.orbit_points);
  find_efforts();
  impacts_json_ = impacts_.json(shown_impacts);
  bearing_ = bearing_json();
  shorten_texts(shares.text);
}

void RunData::look_at_times() {
  const std::size_t time = 0;
  run_.reader->rows({&time, 1}, window_, [&](std::span<const double> block) {
    if (block.empty()) return;
    if (rows_ == 0) first_ = block.front();
    last_ = block.back();
    rows_ += block.size();
  });
  if (rows_ == 0) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("'{}' has no rows in this window", run_.reader->file()), {},
                "change --from and --until, or wait until the run has written rows");
  }
  if (summary_.value("status", "") == "incomplete") {  // as far as rows go
    summary_["time"]["reached"] = last_;
    summary_["counts"]["rows"] = rows_;
  } else {
    note_missing_rows();
  }
  interval_ = counted().interval;
  if (!(interval_ > 0.0) && rows_ > 1) interval_ = (last_ - first_) / static_cast<double>(rows_ - 1);
}

/// A file of rows may have been cut after its run had ended.
void RunData::note_missing_rows() {
  const auto number = [&](const char* path) {
    const Json::json_pointer at(path);
    return summary_.contains(at) && summary_[at].is_number() ? summary_[at].get<double>() : std::nan("");
  };
  const double wrote = number("/counts/rows"), reached = number("/time/reached");
  const bool whole = std::isinf(window_.from) && std::isinf(window_.until), to_the_end = std::isinf(window_.until);
  std::string why;
  if (whole && static_cast<double>(rows_) < wrote) {
    why = fmt::format("the file of rows was cut: it has {} of the {:.0f} that the run wrote", rows_, wrote);
  } else if (to_the_end && last_ < reached - 1.5 * number("/settings/interval")) {
    why = fmt::format("the file of rows was cut: it ends at {:g} s, the run at {:g} s", last_, reached);
  }
  if (!why.empty()) note_ += (note_.empty() ? "" : "; ") + why;
}

/// As the file of rows says, or else the summary beside it.
CountedTime RunData::counted() const {
  CountedTime time = counted_time(*run_.reader, first_);
  const Json settings = summary_.value("settings", Json::object());
  if (time.interval > 0.0 || !settings.is_object()) return time;
  time.origin = settings.value("start", first_);
  time.from = time.origin + settings.value("discard", 0.0);
  time.interval = settings.value("interval", 0.0);
  return time;
}

void RunData::find_orbits(std::size_t points) {
  const auto clearance_of = [&](const std::string& joint) {
    if (run_.model) {
      for (const JointElement& one : run_.model->joints) {
        if (one.name == joint) return one.layout.clearance;
      }
    }
    const Json value =
        Json(run_.summary).value(Json::json_pointer("/joints/" + joint + "/clearance/radial_clearance"), Json());
    return value.is_number() ? value.get<double>() : 0.0;
  };
  for (std::size_t i = 1; i < run_.columns.size(); ++i) {
    const std::string& name = run_.columns[i].name;
    if (!name.starts_with("joint.") || !name.ends_with(".ex")) continue;
    const std::string joint = name.substr(6, name.size() - 9);
    const std::size_t y = run_.reader->find("joint." + joint + ".ey");
    const double clearance = clearance_of(joint);
    if (y >= run_.columns.size() || !(clearance > 0.0)) continue;
    if (orbit_columns_.size() < most_orbits) {
      const std::size_t z = run_.reader->find("joint." + joint + ".ez");
      orbit_columns_.push_back({joint, clearance, i, y, z < run_.columns.size() ? z : i});
    } else {
      left_out_.push_back("orbit of joint " + joint);
    }
  }
  shares_.orbit_points = std::min(most_orbit_points, points / std::max<std::size_t>(orbit_columns_.size(), 1));
}

void RunData::find_efforts() {
  for (std::size_t i = 1; i < run_.columns.size(); ++i) {
    const std::string& name = run_.columns[i].name;
    if (matches("driver.*.torque", name) || matches("driver.*.force", name)) effort_columns_.push_back(i);
  }
  if (lines_of_effort() < least_lines || rows_ * (effort_columns_.size() + 1) > most_effort_numbers) {
    if (!effort_columns_.empty()) left_out_.push_back("spectra");
    effort_columns_.clear();
  }
}

std::size_t RunData::lines_of_effort() const {
  return std::min(most_lines, shares_.spectrum_points / std::max<std::size_t>(effort_columns_.size(), 1));
}

void RunData::shorten_texts(std::size_t most) {
  if (model_text_.size() > most) {
    left_out_.push_back("text of the model");
    model_text_.clear();
  }
  for (const char* path : less_wanted) {
    if (size_of(summary_) <= most) return;
    const Json::json_pointer pointer(path);
    if (!summary_.contains(pointer) || summary_[pointer].is_null()) continue;
    Json& part = summary_[pointer];
    part = part.is_array() ? Json::array() : std::string_view(path).ends_with("s") ? Json::object() : Json(nullptr);
    left_out_.push_back("summary: " + std::string(path).substr(1));
  }
}

std::size_t RunData::leave_out_channel() {
  left_out_.push_back(run_.columns[wanted_.back()].name);
  std::erase(shown_, wanted_.back());
  wanted_.pop_back();
  return left_out_.back().size() + 3;
}

std::vector<std::string> RunData::names() const {
  std::vector<std::string> names;
  for (const std::size_t column : shown_) names.push_back(run_.columns[column].name);
  return names;
}

std::vector<JointChannels> RunData::joint_channels() const {
  std::vector<JointChannels> joints;
  for (std::size_t c = 0; c < shown_.size(); ++c) {
    const std::string& name = run_.columns[shown_[c]].name;
    const std::size_t end = name.rfind('.');
    if (!name.starts_with("joint.") || end <= 6) continue;
    const std::string joint = name.substr(6, end - 6);
    if (joints.empty() || joints.back().joint != joint) joints.push_back({joint, {}});
    joints.back().channels.push_back(c);
  }
  return joints;
}

std::size_t RunData::call_margin() const {
  std::size_t size = 0;
  for (const char* path : {"/provenance", "/model/file", "/files"}) {
    const Json::json_pointer pointer(path);
    if (summary_.contains(pointer)) size += size_of(summary_[pointer]);
  }
  constexpr std::size_t step = 4096;
  return step - size % step;
}

std::size_t RunData::fixed_size() const {
  std::size_t size = 2000 + size_of(summary_) + call_margin() + size_of(Json(model_text_)) + size_of(impacts_json_) +
                     size_of(bearing_) + size_of(Json(rerun_command(run_))) + size_of(Json(left_out_)) +
                     size_of(Json(note_));
  if (plan_) {
    Animation empty = *plan_;
    size += size_of(empty.json()) + plan_->size();
  }
  for (const OrbitColumns& orbit : orbit_columns_)
    size += 100 + orbit.joint.size() + base64_size((orbit.in_space() ? 8 : 4) * shares_.orbit_points) +
            base64_size(8 * shares_.orbit_points);
  const std::vector<JointChannels> joints = joint_channels();
  const ImpactWindows windows(impacts_, joints, interval_, shares_.window_numbers);
  size += windows.size(names());
  return size + effort_columns_.size() * (120 + 2 * base64_size(4 * lines_of_effort()));
}

std::size_t RunData::course_size(std::size_t buckets) const {
  const std::size_t own = buckets_of(buckets), values = own > 0 ? 2 * own : rows_, times = own > 0 ? own + 1 : rows_;
  std::size_t size = base64_size(8 * times);
  for (const std::size_t column : shown_) {
    const RecordColumn& c = run_.columns[column];
    size += 104 + c.name.size() + c.unit.size() + c.long_name.size() + 6 * number_size + base64_size(4 * values);
  }
  return size;
}

void RunData::read(std::size_t buckets) {
  buckets_ = buckets_of(buckets);
  joint_channels_ = joint_channels();
  courses_.emplace(shown_.size(), rows_, buckets_);
  windows_.emplace(impacts_, joint_channels_, interval_, buckets_ > 0 ? shares_.window_numbers : 0);
  orbits_.clear();
  for (const OrbitColumns& orbit : orbit_columns_)
    orbits_.emplace_back(orbit.joint, orbit.clearance, orbit.in_space(), rows_, shares_.orbit_points);
  animation_.reset();
  if (plan_) animation_.emplace(*plan_);
  std::vector<std::size_t> picked{0};
  picked.insert(picked.end(), shown_.begin(), shown_.end());
  for (const OrbitColumns& orbit : orbit_columns_) picked.insert(picked.end(), {orbit.x, orbit.y, orbit.z});
  picked.insert(picked.end(), effort_columns_.begin(), effort_columns_.end());
  if (animation_) picked.insert(picked.end(), animation_->columns().begin(), animation_->columns().end());
  // The reader gives each column once.
  std::vector<std::size_t> once = picked;
  std::ranges::sort(once);
  once.erase(std::unique(once.begin(), once.end()), once.end());
  std::vector<std::size_t> places;
  for (const std::size_t column : picked)
    places.push_back(static_cast<std::size_t>(std::ranges::lower_bound(once, column) - once.begin()));
  std::vector<std::vector<double>> efforts(effort_columns_.empty() ? 0 : effort_columns_.size() + 1);
  std::vector<double> row(picked.size());
  std::size_t left = rows_;
  run_.reader->rows(once, window_, [&](std::span<const double> block) {
    for (; !block.empty() && left > 0; block = block.subspan(once.size()), --left) {
      for (std::size_t i = 0; i < row.size(); ++i) row[i] = block[places[i]];
      take(row, efforts);
    }
  });
  spectra_ = spectra_json(efforts);
}

void RunData::take(std::span<const double> row, std::vector<std::vector<double>>& efforts) {
  const double time = row[0];
  courses_->row(row);
  windows_->row(row);
  row = row.subspan(1 + shown_.size());
  for (std::size_t i = 0; i < orbits_.size(); ++i) {
    orbits_[i].add({row[0], row[1], orbit_columns_[i].in_space() ? row[2] : 0.0});
    row = row.subspan(3);
  }
  if (!efforts.empty()) efforts[0].push_back(time);
  for (std::size_t i = 1; i < efforts.size(); ++i) efforts[i].push_back(row[i - 1]);
  if (animation_) animation_->row(time, row.subspan(effort_columns_.size()));
}

Json RunData::channels_json() const {
  Json list = Json::array();
  for (std::size_t c = 0; c < shown_.size(); ++c) {
    const RecordColumn& column = run_.columns[shown_[c]];
    Json json = {{"name", column.name}, {"unit", column.unit.empty() ? "1" : column.unit}, {"label", column.long_name}};
    courses_->describe(c, json);
    list.push_back(std::move(json));
  }
  return list;
}

/// Tables by sector; only of the first joints where there are many.
Json RunData::bearing_json() const {
  Json list = Json::array();
  const std::vector<std::string>& joints = run_.reader->layout().bearings;
  std::vector<std::pair<std::string, std::vector<double>>> tables;
  if (joints.empty()) return list;
  for (const BearingQuantity& quantity : bearing_quantities()) {
    tables.emplace_back(quantity.name, run_.reader->bearing(quantity.name));
    if (tables.back().second.size() != joints.size() * bearing_sectors) return list;
  }
  for (std::size_t j = 0; j < std::min(joints.size(), shares_.bearings); ++j) {
    Json json = {{"joint", joints[j]}};
    bool any = false;  // a joint without a bearing angle has no table
    for (const auto& [name, numbers] : tables) {
      const auto sectors = std::span(numbers).subspan(j * bearing_sectors, bearing_sectors);
      json[name] = base64_floats(sectors);
      any = any || std::ranges::any_of(sectors, [](double number) { return number > 0.0; });
    }
    if (any) list.push_back(std::move(json));
  }
  return list;
}

/// Of each effort the largest line of each of some parts of the frequencies.
Json RunData::spectra_json(const std::vector<std::vector<double>>& efforts) const {
  Json list = Json::array();
  if (efforts.empty()) return list;
  Spectrum spectrum;
  try {
    const CountedTime time = counted();
    const RowGrid grid = RowGrid::of(efforts[0], time.origin, time.from, time.interval);
    const std::vector<std::span<const double>> columns(efforts.begin() + 1, efforts.end());
    spectrum = freeplay::spectrum(grid, columns);
  } catch (const Error&) {  // too few rows
    return list;
  }
  const std::size_t lines = spectrum.frequency.size(), parts = std::min(lines, lines_of_effort());
  for (std::size_t i = 0; i < effort_columns_.size(); ++i) {
    const std::vector<double>& amplitude = spectrum.amplitudes[i];
    std::vector<double> frequencies, largest;
    for (std::size_t p = 0; p < parts; ++p) {
      const auto begin = amplitude.begin() + static_cast<std::ptrdiff_t>(bucket_begin(p, lines, parts));
      const auto end = amplitude.begin() + static_cast<std::ptrdiff_t>(bucket_begin(p + 1, lines, parts));
      const auto top = std::max_element(begin, end);
      frequencies.push_back(spectrum.frequency[static_cast<std::size_t>(top - amplitude.begin())]);
      largest.push_back(*top);
    }
    const RecordColumn& column = run_.columns[effort_columns_[i]];
    list.push_back({{"name", column.name},
                    {"unit", column.unit.empty() ? "1" : column.unit},
                    {"frequency", base64_floats(frequencies)},
                    {"amplitude", base64_floats(largest)}});
  }
  return list;
}

Json RunData::json() const {
  Json orbits = Json::array();
  for (const Orbit& orbit : orbits_) orbits.push_back(orbit.json());
  Json json = {{"name", run_.name},
               {"summary", summary_},
               {"model", model_text_},
               {"rerun", rerun_command(run_)},
               {"rows", rows_},
               {"channels", channels_json()},
               {"buckets", buckets_},
               {"times", courses_->times()},
               {"windows", windows_->json(*courses_, names())},
               {"events", impacts_json_},
               {"orbits", std::move(orbits)},
               {"animation", animation_ ? animation_->json() : Json(nullptr)},
               {"bearing", bearing_},
               {"spectra", spectra_},
               {"left_out", left_out_}};
  if (!note_.empty()) json["note"] = note_;
  return json;
}

}  // namespace freeplay
