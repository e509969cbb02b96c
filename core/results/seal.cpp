#include "results/seal.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/input_text.h"
#include "base/json_text.h"
#include "base/version.h"
#include "base/whole_file.h"
#include "component/json_schema.h"
#include "results/checkpoint.h"
#include "results/checkpoints.h"
#include "results/hdf5_writer.h"
#include "results/kept_part.h"
#include "results/owner.h"
#include "results/reader.h"
#include "results/row_hash.h"
#include "results/summary.h"
#include "results/whole_result.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

bool there_is(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

Json json_of_text(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_discarded() ? Json(nullptr) : json;
}

/// A value of that form with nothing known in it.
Json nothing_known(const Json& schema) {
  if (schema.contains("properties") && schema.value("type", Json()) == "object") {
    Json out = Json::object();
    for (const auto& [name, part] : schema["properties"].items()) out[name] = nothing_known(part);
    return out;
  }
  const Json type = schema.value("type", Json());
  if (type == "array") return Json::array();
  return type == "object" ? Json::object() : Json(nullptr);
}

class Sealing {
 public:
  explicit Sealing(const fs::path& directory)
      : directory_(directory), owner_(directory), reader_(ResultReader::open(directory)) {
    require_readable_hdf5();
  }

  Sealed execute() {
    const bool has_summary = there_is(directory_ / "summary.json");
    if (has_summary) {
      require_whole();
    } else {
      require_own();
    }
    const std::vector<fs::path> cut = unfinished();
    Sealed out{.changed = !has_summary || !cut.empty() || !reader_->sealed()};
    copy();
    out.rows = rows_;
    out.time = time_;
    if (!out.changed) return out;
    std::string text;
    if (has_summary) {
      if (const std::string why = read_input((directory_ / "summary.json").string(), text); !why.empty()) {
        unreadable_result((directory_ / "summary.json").string(), why);
      }
    } else {
      text = json_text(new_summary());
    }
    if (hdf5_ != nullptr) {
      hdf5_->finish({}, text);
      require_written();
    }
    for (const fs::path& file : cut) cut_file(file, whole_lines(file, most_lines).bytes);
    if (hdf5_ != nullptr) {
      hdf5_->put_in_place();
      require_written();
    }
    if (!has_summary) write_whole_file(directory_ / "summary.json", text);
    return out;
  }

 private:
  static constexpr std::int64_t most_lines = std::numeric_limits<std::int64_t>::max();

  /// Nothing that its summary speaks of is missing or was changed.
  void require_whole() const {
    std::string text;
    if (const std::string why = read_input((directory_ / "summary.json").string(), text); !why.empty()) {
      unreadable_result((directory_ / "summary.json").string(), why);
    }
    const Json summary = json_of_text(text);
    if (!summary.is_object()) unreadable_result((directory_ / "summary.json").string(), "it is not JSON");
    std::string misfit = misfit_of(directory_, summary);
    if (const auto changed = changed_source(directory_, summary.value("provenance", Json()))) {
      misfit = fmt::format("{} in '{}' is not that of the run: {} then, {} now", changed->name, directory_.string(),
                           changed->then, changed->now);
    }
    if (!misfit.empty())
      throw Error(Error::Category::file, "changed-result", misfit, {}, "take it from a copy, or run the model again");
  }

  /// No summary speaks of its rows: those of its checkpoint, and those that both files hold, are what its run wrote.
  void require_own() const {
    KeptPart kept;
    try {
      kept = kept_part_of(read_checkpoint(directory_));
    } catch (const Error&) {  // a result without one is sealed, too
    }
    const std::string foreign = foreign_part(directory_, kept);
    if (foreign.empty()) return;
    throw Error(Error::Category::file, "changed-result", foreign, {},
                there_is(directory_ / "results.csv") && there_is(directory_ / "results.h5")
                    ? "take it from a copy, or move away which of results.csv and results.h5 was changed, then seal"
                    : "take it from a copy, or run the model again");
  }

  /// Where results.csv stood in for it nothing would be said of it.
  void require_readable_hdf5() const {
    const fs::path file = directory_ / "results.h5";
    if (!there_is(file)) return;
    try {
      open_hdf5(file);
    } catch (const Error& error) {
      throw Error(
          error.category(), error.id(), error.message(), error.location(),
          there_is(directory_ / "results.csv") ? "results.csv has the same rows: move results.h5 away, then seal" : "");
    }
  }

  std::vector<fs::path> unfinished() const {
    std::vector<fs::path> files;
    for (const char* name : {"results.csv", "events.csv"}) {
      const fs::path file = directory_ / name;
      if (there_is(file) && whole_lines(file, most_lines).more) files.push_back(file);
    }
    return files;
  }

  /// Rows and events, into a new results.h5 where that is needed.
  void copy() {
    const std::size_t width = reader_->layout().columns.size();
    if (!reader_->sealed()) {
      hdf5_ = std::make_unique<Hdf5Writer>(directory_ / "results.h5", reader_->layout(),
                                           Hdf5Writer::Options{.named_later = true});
    }
    std::vector<std::size_t> all(width);
    std::iota(all.begin(), all.end(), std::size_t{0});
    reader_->rows(all, {}, [&](std::span<const double> rows) {
      const RecordBlock block{.rows = rows, .events = {}};
      row_hash_.write(block);
      if (hdf5_ != nullptr) hdf5_->write(block);
      rows_ += static_cast<std::int64_t>(rows.size() / width);
      time_ = rows[rows.size() - width];
    });
    if (hdf5_ == nullptr || reader_->layout().events.empty()) return;
    reader_->events([&](std::span<const double> events) { hdf5_->write({.rows = {}, .events = events}); });
    require_written();
  }

  void require_written() const {
    if (!hdf5_->failure().empty()) throw Error(Error::Category::file, "cannot-write", hdf5_->failure());
  }

  Json attribute(const char* name) const {
    for (const auto& [key, text] : reader_->layout().attributes) {
      if (key == name) return text;
    }
    return nullptr;
  }

  /// What the run was made from: beside the rows, or in its checkpoint.
  Json provenance() const {
    const Json text = attribute("provenance");
    if (text.is_string()) return json_of_text(text.get<std::string>());
    try {
      return read_checkpoint(directory_).made.value("provenance", Json());
    } catch (const Error&) {
      return nullptr;
    }
  }

  Json new_summary() const {
    Json summary = nothing_known(summary_schema());
    summary["freeplay"] = {{"version", program_version}, {"schema", 1}};
    summary["status"] = status_word(RunStatus::interrupted);
    summary["stop_reason"] = "killed";
    summary["time"]["reached"] = rows_ > 0 ? Json(time_) : Json(nullptr);
    summary["counts"]["rows"] = rows_;
    for (const char* name : {"model", "settings"}) summary[name] = nullptr;
    const Json settings = attribute("settings"), digits = attribute("model_sha256"), title = attribute("title");
    if (settings.is_string()) summary["settings"] = json_of_text(settings.get<std::string>());
    if (digits.is_string()) summary["model"] = {{"name", title}, {"sha256", digits}};
    Sha256 events;
    whole_lines(directory_ / "events.csv", most_lines, &events);
    summary["hashes"] = {{"rows", row_hash_.digits()}, {"events", events.digits()}};
    summary["provenance"] = provenance();
    if (summary["provenance"].is_object()) summary["provenance"]["hashes"] = summary["hashes"];
    std::vector<std::string> files{"summary.json"};
    for (const fs::directory_entry& entry : fs::directory_iterator(directory_)) {
      const std::string name = entry.path().filename().string();
      if (!name.ends_with(".part")) files.push_back(name);
    }
    std::ranges::sort(files);
    summary["files"] = files;
    return summary;
  }

  fs::path directory_;
  Owner owner_;
  std::unique_ptr<ResultReader> reader_;
  std::unique_ptr<Hdf5Writer> hdf5_;  // null: the file is an ordinary one already, or there is none
  RowHash row_hash_;
  std::int64_t rows_ = 0;
  double time_ = 0.0;
};

}  // namespace

Sealed seal_result(const fs::path& directory) {
  std::error_code ignored;
  if (!fs::is_directory(directory, ignored)) unreadable_result(directory.string(), "it is no directory");
  if (!there_is(directory / "results.h5") && !there_is(directory / "results.csv")) {
    unreadable_result(directory.string(), "it holds neither results.h5 nor results.csv");
  }
  Sealed out = Sealing(directory).execute();
  const fs::path twin = directory / "twin";
  if (there_is(twin / "results.h5") || there_is(twin / "results.csv")) {
    out.changed = Sealing(twin).execute().changed || out.changed;
  }
  return out;
}

}  // namespace freeplay
