#include "report/report.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/growing_file.h"
#include "base/input_text.h"
#include "base/sha256.h"
#include "base/staged_file.h"
#include "base/version.h"
#include "report/channel_choice.h"
#include "report/page.h"
#include "report/reported_run.h"
#include "report/run_data.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_runs = 8, most_buckets = 2000, least_buckets = 200, bucket_step = 100;

constexpr std::size_t most_words = 40;            // characters of a name that tell runs of one model apart
constexpr std::size_t most_pictures = 1'000'000;  // bytes

/// Of all runs together.
constexpr Shares whole_page{100'000, 16'000, 10'000, 40, 8'000, 300'000};

Shares share(double part) {
  const auto of = [&](std::size_t whole) { return static_cast<std::size_t>(part * static_cast<double>(whole)); };
  return {of(whole_page.poses),    of(whole_page.orbit_points),    of(whole_page.window_numbers),
          of(whole_page.bearings), of(whole_page.spectrum_points), of(whole_page.text)};
}

void require_different(const std::vector<std::string>& results) {
  if (results.empty()) throw Error(Error::Category::usage, "missing-argument", "report needs a result directory");
  if (results.size() > most_runs) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("a report shows {} runs at most, not {}", most_runs, results.size()));
  }
  std::set<fs::path> seen;
  for (const std::string& path : results) {
    if (seen.insert(whole_result(path)).second) continue;
    throw Error(Error::Category::usage, "bad-value", fmt::format("'{}' is given twice", path));
  }
}

/// The parameters that a run was started with, as ", c = 0.2 mm".
std::string words_of_settings(const ReportedRun& run) {
  const Json set = run.summary.value(Json::json_pointer("/settings/set"), Json::object());
  std::string words;
  for (const auto& [name, value] : set.items()) {
    words += fmt::format(", {} = {}", name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return words.size() <= most_words ? words : std::string();
}

/// Names that differ: by the parameters of the runs, else by a number.
void name_apart(std::vector<ReportedRun>& runs) {
  std::map<std::string, int> same;
  for (const ReportedRun& run : runs) ++same[run.name];
  for (ReportedRun& run : runs) {
    if (same[run.name] > 1) run.name += words_of_settings(run);
  }
  std::map<std::string, int> count;
  for (ReportedRun& run : runs) {
    const int number = ++count[run.name];
    if (number > 1) run.name += fmt::format(" ({})", number);
  }
}

/// All runs of a page with as many buckets as it has room for.
class PageRuns {
 public:
  PageRuns(std::vector<ReportedRun>& runs, const ReportRequest& request, std::size_t room) {
    const auto channels = choose_channels(runs, request.channels);
    // Motion, orbits and windows make room for channels, up to a half; for themselves as far as it takes.
    for (double part = 1.0;; part *= 0.7) {
      data_.clear();
      data_.reserve(runs.size());
      fixed_ = 0;
      for (std::size_t i = 0; i < runs.size(); ++i) {
        data_.emplace_back(runs[i], channels[i], request.window, share(part / static_cast<double>(runs.size())));
        fixed_ += data_.back().fixed_size();
      }
      if (size(least_buckets) <= room || part < 0.01 || (part < 0.5 && fixed_ <= room / 10 * 9)) break;
    }
    while (size(least_buckets) > room && leave_one_out()) continue;
    buckets_ = least_buckets;
    while (buckets_ < most_buckets && size(buckets_ + bucket_step) <= room) buckets_ += bucket_step;
  }

  Json read() {
    Json list = Json::array();
    for (RunData& data : data_) {
      data.read(buckets_);
      list.push_back(data.json());
    }
    return list;
  }

  /// Takes more buckets where a page of `page` bytes has room for them: sizes are estimated with some margin.
  bool grow(std::size_t page) {
    for (const RunData& data : data_) page += data.call_margin();
    const std::size_t before = buckets_, rest = page - courses(before);
    while (buckets_ < most_buckets && rest + courses(buckets_ + bucket_step) <= largest_page) buckets_ += bucket_step;
    return buckets_ > before && courses(buckets_) > courses(before);
  }
  std::vector<std::string> left_out() const {
    std::vector<std::string> all;
    for (const RunData& data : data_) all.insert(all.end(), data.left_out().begin(), data.left_out().end());
    return all;
  }

 private:
  std::size_t courses(std::size_t buckets) const {
    std::size_t size = 0;
    for (const RunData& data : data_) size += data.course_size(buckets);
    return size;
  }
  std::size_t size(std::size_t buckets) const { return fixed_ + courses(buckets); }

  /// Of the run that shows most.
  bool leave_one_out() {
    const auto most = std::ranges::max_element(data_, {}, &RunData::channels);
    if (most->channels() == 0) return false;
    fixed_ += most->leave_out_channel();
    return true;
  }

  std::vector<RunData> data_;
  std::size_t fixed_ = 0, buckets_ = least_buckets;
};

Json record_of(const ReportRequest& request, const std::vector<ReportedRun>& runs) {
  const Json& first = runs.front().summary;
  const Json made = first.contains("provenance") ? first["provenance"] : Json::object();
  Json record = {
      {"freeplay", program_version}, {"schema", schema_version}, {"build", request.build}, {"compiler", compiler}};
  for (const char* field : {"plugin_abi", "platform", "arithmetic"}) record[field] = made.value(field, Json());
  record["made"] = "report";
  std::string command = "freeplay report";
  for (const ReportedRun& run : runs) command += " " + run.name;
  for (const std::string& word : request.arguments) command += " " + word;
  record["command"] = command;
  record["arguments"] = request.arguments;
  for (const char* field : {"model", "inputs", "plugins", "seed", "hashes"}) record[field] = made.value(field, Json());
  Json inputs = Json::array();
  for (const ReportedRun& run : runs) {
    for (const Json& input : run.inputs) {
      if (std::ranges::find(inputs, input) == inputs.end()) inputs.push_back(input);
    }
  }
  if (inputs.dump(-1, ' ', false, Json::error_handler_t::replace).size() <= whole_page.text) record["inputs"] = inputs;
  record["data_sha256"] = nullptr;
  return record;
}

std::string title_of(const ReportRequest& request, const std::vector<ReportedRun>& runs) {
  if (!request.title.empty()) return request.title;
  std::string title;
  for (const ReportedRun& run : runs) title += (title.empty() ? "" : ", ") + run.name;
  return title;
}

/// The text of `runs` is the last of the data, on a line of its own, so that its hash can be checked.
std::string data_text(const std::string& title, Json record, const std::string& runs) {
  record["data_sha256"] = sha256(runs);
  return "{\"schema\":1,\"title\":" + page_json(title) + ",\"provenance\":" + page_json(record) +
         ",\n\"runs\":" + runs + "\n}";
}

/// SVG files as elements of the page.
std::string pictures_of(const ReportRequest& request) {
  std::string all;
  for (const std::string& file : request.pictures) {
    std::string svg;
    std::string why = read_input(file, svg);
    if (why.empty() && (!svg.starts_with('<') || svg.find("<svg") == std::string::npos)) why = "it is no SVG";
    if (!why.empty()) {
      throw Error(Error::Category::file, "unreadable-input", fmt::format("the picture '{}': {}", file, why));
    }
    all += picture_element(svg);
    if (all.size() > most_pictures) {
      throw Error(Error::Category::usage, "too-large",
                  fmt::format("'{}' is more than the {} bytes that pictures may have in a page", file, most_pictures),
                  {}, "a map of fewer points is smaller");
    }
  }
  return all;
}

std::string make_page(const ReportRequest& request, std::vector<ReportedRun>& runs,
                      std::vector<std::string>& left_out) {
  const std::string title = title_of(request, runs);
  const Json record = record_of(request, runs);
  const std::string pictures = pictures_of(request);
  const std::size_t frame = page_frame_size() + pictures.size() + 6 * title.size() + page_json(record).size() + 500;
  PageRuns page_runs(runs, request, largest_page - std::min(frame, largest_page));
  for (;;) {
    const Json list = page_runs.read();
    const std::string page = page_text(title, list, data_text(title, record, page_json(list)), pictures);
    left_out = page_runs.left_out();
    if (!page_runs.grow(page.size())) return page;
  }
}

}  // namespace

ReportMade write_report(const ReportRequest& request) {
  require_different(request.results);
  const fs::path first = request.results.front();
  std::error_code ignored;
  const fs::path folder = fs::is_directory(first, ignored) ? first : first.parent_path();
  const fs::path file = request.out.empty() ? folder / "report.html" : fs::path(request.out);
  std::vector<ReportedRun> runs;
  for (const std::string& path : request.results) runs.push_back(open_reported(path, request.load));
  StagedFile staged(file, request.force || is_page(file));
  name_apart(runs);
  ReportMade made{file.string(), 0, {}, {}};
  for (const ReportedRun& run : runs) made.runs.push_back(run.name);
  std::string page;
  try {
    page = make_page(request, runs, made.left_out);
  } catch (const Json::exception& error) {
    unreadable_result(folder.string(), fmt::format("its summary.json is of another form: {}", error.what()));
  }
  made.bytes = page.size();
  GrowingFile growing(staged.temporary());
  growing.line() += page;
  growing.flush();
  growing.close();
  staged.commit();
  return made;
}

}  // namespace freeplay
