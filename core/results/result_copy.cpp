#include "results/result_copy.h"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "results/directory.h"
#include "results/reader.h"
#include "results/result_record.h"
#include "results/text_writers.h"
#include "results/whole_result.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

/// What writing the copy takes away first must not be what is copied.
void require_apart(const fs::path& from, const fs::path& to) {
  std::error_code ignored;
  const fs::path source = fs::weakly_canonical(from, ignored), target = fs::weakly_canonical(to, ignored);
  for (fs::path folder = source;; folder = folder.parent_path()) {
    if (folder == target) {
      throw Error(
          Error::Category::usage, "bad-value",
          fmt::format("'{}' is or holds the result '{}', of which it would be a copy", to.string(), from.string()));
    }
    if (folder == folder.parent_path()) return;
  }
}

void require_same(const fs::path& from, const Json& summary) {
  std::string misfit;
  if (read_summary(from) != summary) {
    misfit = fmt::format("'{}' has another summary than when it was opened", from.string());
  } else {
    misfit = misfit_of(from, summary);
  }
  if (!misfit.empty()) throw Error(Error::Category::file, "unreadable-result", misfit);
}

void copy_part(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy(from, to, fs::copy_options::recursive, error);
  if (error) {
    throw Error(Error::Category::file, "cannot-write",
                fmt::format("cannot copy '{}' to '{}': {}", from.string(), to.string(), error.message()));
  }
}

/// Into the file that is there: others look at its lock.
void copy_log(const fs::path& from, const fs::path& to) {
  std::ifstream text(from, std::ios::binary);
  std::ofstream copy(to, std::ios::binary | std::ios::trunc);
  if (text.peek() != std::ifstream::traits_type::eof()) copy << text.rdbuf();
  copy.close();
  if (copy && !text.bad()) return;
  throw Error(Error::Category::file, "cannot-write", fmt::format("cannot write '{}'", to.string()));
}

void write_text_rows(const fs::path& from, const fs::path& to) {
  const auto reader = ResultReader::open(from);
  std::vector<std::size_t> all(reader->layout().columns.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  RowTextWriter writer(to, reader->layout());
  reader->rows(all, {}, [&](std::span<const double> rows) { writer.write({.rows = rows, .events = {}}); });
  writer.close();
  if (!writer.failure().empty()) throw Error(Error::Category::file, "cannot-write", writer.failure());
}

/// Whether the copy has this file of rows.
bool wanted(const std::string& name, std::optional<ResultFormat> format) {
  if (name == "results.csv") return format != ResultFormat::hdf5;
  return name != "results.h5" || format != ResultFormat::csv;
}

}  // namespace

void copy_result(const fs::path& from, const Json& summary, const fs::path& to, bool force,
                 std::optional<ResultFormat> format) {
  std::error_code ignored;
  require_apart(from, to);
  require_same(from, summary);
  if (format && format != ResultFormat::csv && !fs::exists(from / "results.h5", ignored)) {
    throw Error(
        Error::Category::usage, "bad-value",
        fmt::format("'{}' has no results.h5, whose tables by bearing sector cannot be made from rows", from.string()),
        {}, "run its model again with that format");
  }
  check_result_directory(to, force);
  const ResultDirectory directory(to, force);
  for (const std::string name : result_names()) {
    if (!fs::exists(from / name, ignored) || name == "summary.json" || !wanted(name, format)) continue;
    name == "run.log" ? copy_log(from / name, to / name) : copy_part(from / name, to / name);
  }
  if (format && format != ResultFormat::hdf5 && !fs::exists(from / "results.csv", ignored)) {
    write_text_rows(from / "results.h5", to / "results.csv");
  }
  const auto alike = [&](const char* name) {
    return fs::exists(from / name, ignored) == fs::exists(to / name, ignored);
  };
  if (alike("results.csv") && alike("results.h5")) {
    copy_part(from / "summary.json", to / "summary.json");
    return;
  }
  std::vector<std::string> files = directory.files();
  files.insert(std::ranges::lower_bound(files, "summary.json"), "summary.json");
  Json own = summary;
  own["files"] = files;
  directory.write("summary.json", json_text(own));
}

}  // namespace freeplay
