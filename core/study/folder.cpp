#include "study/folder.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/sha256.h"
#include "base/whole_file.h"
#include "study/segment_reader.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr const char* record_name = "study.json";
/// What a run of a study makes, but for the rows.
const std::set<std::string> tables = {"study.csv", "samples.csv", "study.h5", "failures.jsonl", "timing.csv"};

/// The second at which a segment was begun, from its name.
long begun(const fs::path& segment) {
  const std::string stem = segment.stem().string();
  const std::size_t dot = stem.rfind('.');
  long seconds = 0;
  if (dot != std::string::npos) std::from_chars(stem.data() + dot + 1, stem.data() + stem.size(), seconds);
  return seconds;
}

[[noreturn]] void fail_to(const char* what, const fs::path& path, const std::string& why) {
  throw Error(Error::Category::file, "cannot-write", fmt::format("cannot {} '{}': {}", what, path.string(), why));
}

[[noreturn]] void no_record(const fs::path& folder) {
  throw Error(Error::Category::input, "file-not-found",
              fmt::format("'{}' is no directory of a study: there is no {} of one", folder.string(), record_name), {},
              "freeplay study run FILE --out DIR makes one");
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (!fs::exists(from, error)) return;
  fs::rename(from, to, error);
  if (error) fail_to("move", from, error.message());
}

/// Returns whether there was nothing at `to` before.
bool link_to(const fs::path& from, const fs::path& to) {
  const int reason = ::link(from.c_str(), to.c_str()) == 0 ? 0 : errno;
  if (reason != 0 && reason != EEXIST) fail_to("make", to, std::strerror(reason));
  return reason == 0;
}

/// Is gone at the end.
struct PrivateFolder {
  explicit PrivateFolder(fs::path place) : path(std::move(place)) {}
  ~PrivateFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const fs::path path;
};

}  // namespace

bool StudyFolder::holds_study() const {
  std::error_code ignored;
  return fs::is_regular_file(path_ / record_name, ignored);
}

void StudyFolder::require_room() const {
  static const std::set<std::string> own = {"study.yaml", "inputs", "rows", "extended", "old"};
  std::error_code error;
  if (holds_study() || !fs::exists(path_, error)) return;
  if (!fs::is_directory(path_, error)) {
    throw Error(Error::Category::file, "cannot-write", fmt::format("'{}' is no directory", path_.string()));
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, error)) {
    const std::string name = entry.path().filename().string();
    if (own.contains(name) || name.starts_with('.')) continue;
    if (holds_study()) return;  // begun by another program meanwhile
    throw Error(Error::Category::file, "not-empty",
                fmt::format("'{}' holds other files, such as '{}'", path_.string(), name), {},
                "another --out, or an empty directory");
  }
}

Json StudyFolder::record() const {
  std::ifstream stream(path_ / record_name);
  const Json record = stream ? Json::parse(stream, nullptr, false) : Json();
  const auto text = [&](const char* key) { return record.is_object() && record.value(key, Json()).is_string(); };
  if (text("study") && text("arithmetic") && text("rows") && record.value("program", Json()).is_object()) return record;
  no_record(path_);
}

void StudyFolder::begin(const StudyPlan& plan, const StudyMark& mark, const Json& record) const {
  std::error_code error;
  fs::create_directories(rows(), error);
  if (error) fail_to("make", rows(), error.message());
  make_record(plan.kept_files(), mark, record);
  take_extended(mark.study);
}

// Whose record is the first has begun the study, and its copies count; others that begin it put there what is missing,
// as after a kill between the two.
void StudyFolder::make_record(const std::vector<KeptFile>& files, const StudyMark& mark, const Json& record) const {
  const auto is_there = [&](const KeptFile& file) {
    std::error_code ignored;
    return fs::exists(path_ / file.path, ignored);
  };
  if (holds_study()) {
    require_begun(mark);
    if (std::ranges::all_of(files, is_there)) return;
  }
  const PrivateFolder own(path_ / fmt::format(".begin.{}.{}", host_name(), ::getpid()));
  for (const KeptFile& file : files) write_whole_file(own.path / file.path, file.bytes, true);
  write_whole_file(own.path / record_name, json_text(record), true);
  const fs::path place = path_ / record_name;
  const bool first = link_to(own.path / record_name, place);
  if (!first) require_begun(mark);
  for (const KeptFile& file : files) {
    const fs::path copy = path_ / file.path;
    std::error_code error;
    fs::create_directories(copy.parent_path(), error);
    if (error) fail_to("make", copy.parent_path(), error.message());
    if (first) {
      move(own.path / file.path, copy);
    } else {
      link_to(own.path / file.path, copy);
    }
    sync_folder_of(copy);
  }
  sync_folder_of(place);
}

// Of several that do so at once one moves a segment. An incomplete one is of a run that was cut short: what it has is
// right, and what it lacks was in rows() until a complete one was there.
void StudyFolder::take_extended(const std::string& study) const {
  for (const fs::path& segment : extending_segments()) {
    const SegmentReader reader(segment, [](const fs::path&, std::size_t) {});
    if (!reader.header() || reader.header()->study != study) continue;
    std::error_code error;
    fs::rename(segment, rows() / segment.filename(), error);
    if (error && error != std::errc::no_such_file_or_directory) fail_to("move", segment, error.message());
  }
  std::error_code not_empty;
  fs::remove(extended(), not_empty);
}

void StudyFolder::require_begun(const StudyMark& mark) const {
  const Json begun = record();
  if (begun["study"] == mark.study && begun["rows"] == mark.columns) return;
  throw Error(Error::Category::input, "study-changed", fmt::format("another study was begun in '{}'", path_.string()),
              {}, "another --out");
}

std::vector<fs::path> StudyFolder::segments_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".rows") found.push_back(entry.path());
  }
  std::ranges::sort(found, {}, [](const fs::path& path) { return std::pair(begun(path), path.filename().string()); });
  return found;
}

bool StudyFolder::is_merged() const {
  std::error_code error;
  const auto merged = fs::last_write_time(table(), error);
  if (error) return false;
  return std::ranges::all_of(segments(), [&](const fs::path& segment) {
    const auto written = fs::last_write_time(segment, error);
    return !error && written < merged;
  });
}

void StudyFolder::forget_extended() const {
  std::error_code ignored;
  fs::remove_all(extended(), ignored);
}

void StudyFolder::set_aside() const {
  std::error_code error;
  fs::path place;
  for (int number = 1; place.empty() || fs::exists(place, error); ++number) {
    place = path_ / "old" / fmt::format("{:04}", number);
  }
  fs::create_directories(place, error);
  if (error) fail_to("make", place, error.message());
  // The record last: until then the folder is that of the old study.
  for (const std::string& name : tables) move(path_ / name, place / name);
  for (const char* name : {"rows", "plots", "kept"}) move(path_ / name, place / name);
  for (const char* name : {"study.yaml", "inputs", record_name}) move(path_ / name, place / name);
}

std::vector<std::string> StudyFolder::changed_copies() const {
  std::vector<std::string> changed;
  const Json copies = record().value("copies", Json::object());
  for (const auto& [path, digits] : copies.items()) {
    std::error_code ignored;
    const bool there = fs::is_regular_file(path_ / path, ignored);
    if (!there || sha256_of_file((path_ / path).string()) != digits) changed.push_back(path);
  }
  return changed;
}

StudyColumns StudyFolder::columns() const {
  const Json all = record();
  StudyColumns columns;
  try {
    for (std::size_t i = 0; i < all.at("columns").size(); ++i) {
      columns.table.push_back({all["columns"][i].get<std::string>(), all.at("units").at(i).get<std::string>()});
    }
    for (const Json& one : all.at("samples")) {
      columns.samples.push_back({one.at("name").get<std::string>(), one.at("unit").get<std::string>()});
    }
  } catch (const Json::exception&) {
    no_record(path_);
  }
  return columns;
}

Json study_record(const StudyPlan& plan, const StudyMark& mark, const StudyColumns& columns) {
  Json axes = Json::array(), models = Json::array(), names = Json::array(), units = Json::array(),
       samples = Json::array();
  for (const StudyColumn& column : columns.table) {
    names.push_back(column.name);
    units.push_back(column.unit);
  }
  for (const StudyColumn& column : columns.samples) samples.push_back({{"name", column.name}, {"unit", column.unit}});
  for (const AxisColumn& column : plan.axis_columns()) axes.push_back({{"name", column.name}, {"unit", column.unit}});
  Json copies = Json::object();
  for (const KeptFile& file : plan.kept_files()) copies[file.path] = sha256(file.bytes);
  for (const StudyModel& model : plan.models()) {
    models.push_back({{"name", model.name}, {"file", model.file}, {"sha256", model.sha256}});
  }
  return {{"schema", 1},
          {"name", plan.name()},
          {"study", mark.study},
          {"rows", mark.columns},
          {"program", {{"version", mark.version}, {"build", mark.build}}},
          {"arithmetic", mark.arithmetic},
          {"points", plan.points()},
          {"axes", axes},
          {"columns", std::move(names)},
          {"units", std::move(units)},
          {"samples", std::move(samples)},
          {"models", models},
          {"copies", std::move(copies)}};
}

void require_same(const SegmentHeader& header, const fs::path& segment, const StudyMark& mark) {
  const auto refuse = [&](const char* id, const std::string& message, const std::string& hint) {
    throw Error(Error::Category::input, id, message, {segment.string(), 1, 0}, hint);
  };
  if (header.study != mark.study) {
    refuse("study-mixed",
           fmt::format("these rows are of study {}, not of {}", header.study.substr(0, 12), mark.study.substr(0, 12)),
           "rows of different studies stand in different directories");
  }
  if (header.arithmetic != mark.arithmetic) {
    refuse("arithmetic-differs",
           fmt::format("these rows were computed on '{}' with arithmetic {}, here it is {}", header.host,
                       header.arithmetic, mark.arithmetic),
           "a program that was built the same way on both machines, or --restart");
  }
  if (header.program == mark.program()) return;
  refuse("program-changed",
         fmt::format("these rows were computed by freeplay {}, this is {}", header.program, mark.program()),
         "the program and the plugins of then, or --restart, which computes all points again");
}

std::string host_name() {
  char name[256] = "";
  if (::gethostname(name, sizeof name - 1) != 0) return "host";
  std::string host(name);
  host = host.substr(0, host.find('.'));
  std::ranges::replace_if(
      host, [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; }, '_');
  return host.empty() ? "host" : host;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace freeplay
