#include "cli/study_reproduction.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "cli/own_program.h"
#include "cli/scratch_folder.h"
#include "cli/study_options.h"
#include "cli/study_table.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "results/made_text.h"
#include "results/reproduction.h"
#include "study/page.h"
#include "study/picture.h"
#include "study/table_export.h"
#include "study/table_rows.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr int not_the_same = 7;  // exit code
constexpr std::array tables = {"study.csv", "samples.csv", "failures.jsonl", "study.h5"};

bool holds_study(const fs::path& folder) { return StudyFolder(folder.empty() ? "." : folder).holds_study(); }

/// Is gone at the end, unless it was asked for.
class MadeFolder {
 public:
  explicit MadeFolder(const fs::path& asked) : path(asked), kept_(!asked.empty()) {
    std::error_code error;
    if (kept_ && fs::exists(path, error) && !fs::is_empty(path, error)) {
      throw Error(Error::Category::file, "cannot-write",
                  fmt::format("'{}' is there already, and not empty", path.string()), {},
                  "choose another directory with --out");
    }
    if (!kept_) path = new_scratch_folder();
  }
  ~MadeFolder() {
    std::error_code ignored;
    if (!kept_) fs::remove_all(path, ignored);
  }
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

  fs::path path;

 private:
  bool kept_;
};

/// What a study was begun from: enough to run all points again.
void copy_beginning(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to, error);
  for (const char* name : {"study.yaml", "study.json", "inputs"}) {
    if (!error) fs::copy(from / name, to / name, fs::copy_options::recursive, error);
  }
  if (!error) return;
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("cannot copy '{}' to '{}': {}", from.string(), to.string(), error.message()));
}

std::string around(const std::string& line) {
  constexpr std::size_t most = 60;
  return line.substr(0, most);
}

/// Where two lines of a table differ.
std::string cell_difference(const std::string& header, const std::string& then, const std::string& now) {
  std::vector<std::string_view> names, before, after;
  split_cells(header, names);
  split_cells(then, before);
  split_cells(now, after);
  if (names.size() != before.size() || names.size() != after.size() || before.front() != after.front()) return {};
  const auto [ours, theirs] = std::ranges::mismatch(before, after);
  if (ours == before.end()) return {};
  const auto column = static_cast<std::size_t>(ours - before.begin());
  return fmt::format("point {}, {}: {} recorded, {} now", before.front(), names[column], *ours, *theirs);
}

/// Goes over both files line by line; memory does not grow with them.
ReproductionCheck compare_files(const char* name, const fs::path& before, const fs::path& after) {
  std::ifstream then(before / name, std::ios::binary), now(after / name, std::ios::binary);
  ReproductionCheck check{.what = name, .size = {}, .first_difference = {}};
  std::string header, old_line, new_line;
  std::size_t line = 0;
  for (;; ++line) {
    const bool more = static_cast<bool>(std::getline(then, old_line)),
               others = static_cast<bool>(std::getline(now, new_line));
    if (!more && !others) break;
    if (line == 0) header = old_line;
    if (more && others && old_line == new_line) continue;
    const bool text = std::string_view(name) != "study.h5";
    std::string where = text && more && others ? cell_difference(header, old_line, new_line) : std::string();
    if (where.empty() && text) {
      where = fmt::format("line {}: '{}' recorded, '{}' now", line + 1, more ? around(old_line) : "nothing",
                          others ? around(new_line) : "nothing");
    }
    check.first_difference = text ? where : "its bytes are others";
    break;
  }
  std::error_code ignored;
  check.size = fmt::format("{} bytes", fs::file_size(before / name, ignored));
  return check;
}

ReproductionCheck compare_texts(const std::string& what, const std::string& then, const std::string& now) {
  ReproductionCheck check{.what = what, .size = fmt::format("{} bytes", then.size()), .first_difference = {}};
  if (then == now) return check;
  const auto [ours, theirs] = std::ranges::mismatch(then, now);
  check.first_difference = fmt::format("byte {} on", ours - then.begin() + 1);
  return check;
}

std::string file_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// All points of a study, which failed ones are part of. Returns 0, or the exit code with which it ended.
int run_study(const fs::path& folder, const CommonOptions& common) {
  const bool shows = stderr_is_terminal() && !common.quiet;
  std::vector<std::string> words{"study", "run", folder.string(), "--allow-failed", "--json"};
  if (!shows) words.emplace_back("--quiet");
  for (const std::string& plugin : common.plugins) words.insert(words.end(), {"--plugin", plugin});
  if (common.allow_plugins) words.emplace_back("--allow-plugins");
  const ProgramEnd end = run_own_program(words, shows);
  if (end.exit_code != 0 && !shows) print_messages(end.messages, common.no_color);
  return end.exit_code;
}

int tell(const fs::path& path, const Json& record, const Json& rerun, const std::vector<ReproductionCheck>& checks,
         const CommonOptions& common) {
  const bool same = std::ranges::all_of(checks, &ReproductionCheck::same);
  if (common.json) {
    Json list = Json::array();
    for (const ReproductionCheck& check : checks) {
      list.push_back({{"what", check.what},
                      {"same", check.same()},
                      {"first_difference", check.same() ? Json(nullptr) : Json(check.first_difference)}});
    }
    print_json({{"same", same}, {"ended", true}, {"record", record}, {"rerun", rerun}, {"checks", std::move(list)}});
  } else if (!common.quiet) {
    TextTable table;
    for (const ReproductionCheck& check : checks) {
      table.add_row(
          {check.what, check.size, check.same() ? "same bytes" : "first difference: " + check.first_difference});
    }
    std::string text = fmt::format("{}: study '{}' of {} points\n", printable(path.string()),
                                   printable(record.value("name", "")), record.value("points", std::uint64_t{0}));
    if (rerun.is_object() && rerun.value("program", Json()) != record.value("program", Json())) {
      text += "  its rows were computed by another program\n";
    }
    print(text + table.text("  ") + (same ? "same bytes\n" : "different\n"));
  }
  return same ? 0 : not_the_same;
}

class StudyReproduction {
 public:
  StudyReproduction(const fs::path& path, const fs::path& folder, const CommonOptions& common)
      : path_(path),
        folder_(folder),
        common_(common),
        opened_(open_kept(folder.string(), StudyUse::look, common, true)) {}

  int execute(const fs::path& out) {
    if (!opened_.study) return opened_.exit_code;
    const std::string identity = opened_.study->plan().identity();
    if (opened_.folder.record()["study"] != identity) {
      checks_.push_back({.what = "study.yaml, inputs",
                         .size = {},
                         .first_difference = "not what its rows were computed of: a file in it was changed"});
      return end();
    }
    const std::string ending = path_.extension().string();
    const MadeFolder made(out);
    if (ending == ".svg") {
      draw_again(made.path);
    } else if (ending == ".html") {
      write_again(made.path);
    } else if (const int failed = run_again(made.path); failed != 0) {
      return failed;
    }
    return end();
  }

 private:
  /// Rows that are not there would be missing in one of the two.
  void require_whole() {
    StudyTable table(*opened_.study, opened_.folder);
    table.look(kept_mark(opened_.folder), {}, warn_of_damage(common_));
    const std::uint64_t wanted = table.wanted(), done = table.done();
    if (done < wanted) {
      throw Error(Error::Category::input, "study-gaps",
                  fmt::format("{} of {} points of '{}' are missing", wanted - done, wanted, folder_.string()), {},
                  fmt::format("freeplay study run {} computes them; study verify runs some of those that are there",
                              folder_.string()));
    }
    if (!opened_.folder.is_merged()) {
      throw Error(Error::Category::input, "file-not-found",
                  fmt::format("'{}' has no table of all its rows yet", folder_.string()), {},
                  fmt::format("freeplay study merge {} makes it", folder_.string()));
    }
  }

  /// Returns 0, or the exit code with which the run ended.
  int run_again(const fs::path& made) {
    require_whole();
    const fs::path again = made / "study";
    copy_beginning(folder_, again);
    if (const int failed = run_study(again, common_); failed != 0) return failed;
    rerun_ = StudyFolder(again).record();
    for (const char* name : tables) {
      std::error_code ignored;
      if (fs::exists(folder_ / name, ignored) || fs::exists(again / name, ignored)) {
        checks_.push_back(compare_files(name, folder_, again));
      }
    }
    return 0;
  }

  void draw_again(const fs::path& made) {
    const std::vector<PictureRequest> requests = picture_requests(opened_.study->plan());
    const auto request = std::ranges::find(requests, path_.stem().string(), &PictureRequest::name);
    if (request == requests.end()) {
      throw Error(Error::Category::file, "no-provenance",
                  fmt::format("'{}' is none of the `plots` of its study", path_.string()), {},
                  "freeplay study plot DIR draws these");
    }
    keep(made, picture_with_record(study_picture(*opened_.study, folder_, *request), nullptr));
  }

  void write_again(const fs::path& made) { keep(made, study_page(*opened_.study, folder_)); }

  void keep(const fs::path& made, const std::string& text) {
    write_whole_file(made / path_.filename(), text);
    checks_.push_back(compare_texts(path_.filename().string() + " of the table", file_text(path_), text));
    rerun_ = opened_.folder.record();
  }

  int end() const { return tell(path_, opened_.folder.record(), rerun_, checks_, common_); }

  const fs::path& path_;
  const fs::path& folder_;
  const CommonOptions& common_;
  StudyInFolder opened_;
  std::vector<ReproductionCheck> checks_;
  Json rerun_ = nullptr;
};

}  // namespace

std::optional<fs::path> study_of(const fs::path& path) {
  std::error_code ignored;
  if (holds_study(path)) return path;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  const fs::path folder = path.parent_path(), above = folder.parent_path();
  const std::string name = path.filename().string();
  const bool table = std::ranges::find(tables, name) != tables.end() || name == "study.json" || name == "study.yaml";
  if ((table || name == "report.html") && holds_study(folder)) return folder.empty() ? fs::path(".") : folder;
  if (path.extension() == ".svg" && folder.filename() == "plots" && holds_study(above)) {
    return above.empty() ? fs::path(".") : above;
  }
  return std::nullopt;
}

int reproduce_study(const fs::path& path, const fs::path& out, const CommonOptions& common) {
  const fs::path folder = study_of(path).value_or(path);
  return StudyReproduction(path, folder, common).execute(out);
}

int reproduce_study_table(const MadeFile& made, const fs::path& out, const CommonOptions& common) {
  const MadeFolder folder(out);
  const fs::path study = folder.path / "study", again = folder.path / ("table" + made.path.extension().string());
  stage_study(made.record, study);
  if (const int failed = run_study(study, common); failed != 0) return failed;
  std::vector<std::string> words{"export", study.string()};
  const std::vector<std::string> asked = made.record.value("arguments", Json()).get<std::vector<std::string>>();
  for (std::size_t i = 0; i < asked.size(); ++i) {
    // What a record may ask for, wherever it is from.
    if (i % 2 == 0 && asked[i] != "--to" && asked[i] != "--channels") {
      throw Error(
          Error::Category::file, "no-provenance",
          fmt::format("'{}' has a record that cannot be followed: it asks for {}", made.path.string(), asked[i]));
    }
    words.push_back(asked[i]);
  }
  words.insert(words.end(), {"--out", again.string()});
  const ProgramEnd end = run_own_program(words, false);
  if (end.exit_code != 0) {
    print_messages(end.messages, common.no_color);
    return end.exit_code;
  }
  return tell(made.path, made.record["study"], StudyFolder(study).record(),
              {compare_texts("table", made.data, data_of(made.kind, again))}, common);
}

}  // namespace freeplay
