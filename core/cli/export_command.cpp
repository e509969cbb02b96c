#include "cli/export_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/growing_file.h"
#include "base/sha256.h"
#include "base/staged_file.h"
#include "base/whole_file.h"
#include "cli/output_file.h"
#include "cli/study_options.h"
#include "cli/terminal.h"
#include "results/reader.h"
#include "results/result_record.h"
#include "results/table_files.h"
#include "results/whole_result.h"
#include "study/table_export.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string path, to, table, from, until, every, period, phase, out;
  std::vector<std::string> channels;
  bool force = false;
};

/// Refuses options that say nothing of the table.
void require_fitting(const ExportOptions& options, const std::string& table) {
  struct Fitting {
    const char* option;
    bool given;
    std::vector<std::string> tables;
  };
  const std::vector<std::string> timed = {"results", "events", "impacts", "spectra", "poincare", "lyapunov"};
  const Fitting all[] = {{"--channels", !options.channels.empty(), {"results", "spectra", "poincare", "lyapunov"}},
                         {"--from", !options.from.empty(), timed},
                         {"--until", !options.until.empty(), timed},
                         {"--every", !options.every.empty(), {"results", "events", "impacts"}},
                         {"--period", !options.period.empty(), {"poincare", "lyapunov"}},
                         {"--phase", !options.phase.empty(), {"poincare"}}};
  for (const Fitting& one : all) {
    if (!one.given || std::ranges::find(one.tables, table) != one.tables.end()) continue;
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("{} says nothing of the table {}: it goes with {}", one.option, table,
                            fmt::join(one.tables, ", ")));
  }
}

TableRequest request_of(const ExportOptions& options) {
  TableRequest request;
  if (!options.table.empty()) {
    const auto words = table_words();
    require_word("table", options.table, {words.begin(), words.end()});
    request.table = options.table;
  }
  require_fitting(options, request.table);
  request.channels = options.channels;
  if (!options.period.empty()) request.period = positive_quantity("--period", options.period, dimension::time);
  if (!options.phase.empty()) request.phase = signed_quantity("--phase", options.phase, dimension::time);
  if (request.period == 0.0 && (request.table == "poincare" || request.table == "lyapunov")) {
    throw Error(Error::Category::usage, "missing-argument",
                fmt::format("--table {} needs --period T, the time of one turn", request.table));
  }
  RowWindow& window = request.window;
  if (!options.from.empty()) window.from = signed_quantity("--from", options.from, dimension::time);
  if (!options.until.empty()) window.until = signed_quantity("--until", options.until, dimension::time);
  if (!options.every.empty()) window.every = static_cast<std::size_t>(whole_number("--every", options.every, 1));
  if (window.from > window.until) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("--from {} is after --until {}", options.from, options.until));
  }
  return request;
}

/// What makes the same table of the same result.
std::vector<std::string> arguments_of(const ExportOptions& options) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  add("--to", options.to);
  add("--table", options.table);
  for (const std::string& pattern : options.channels) add("--channels", pattern);
  add("--from", options.from);
  add("--until", options.until);
  add("--every", options.every);
  add("--period", options.period);
  add("--phase", options.phase);
  return arguments;
}

class Export {
 public:
  Export(const ExportOptions& options, const CommonOptions& common, const TableRequest& request)
      : options_(options),
        common_(common),
        name_(request.table),
        reader_(ResultReader::open(options.path)),
        table_(*reader_, request),
        provenance_(record_of(options.path, *reader_, {"export", common.command, arguments_of(options)})) {}

  void execute() {
    if (const std::string missing = missing_part(*reader_, name_); !missing.empty()) {
      print_messages("freeplay: warning: " + missing + "\n", common_.no_color);
    }
    if (options_.out.empty()) return give(print_data);
    StagedFile file(options_.out, options_.force);
    if (options_.to == "csv") require_no_other_file(record_file(options_.out), own_record, options_.force);
    const bool text = options_.to == "csv" || options_.to == "json";
    if (text) {
      GrowingFile growing(file.temporary());
      give([&](std::string_view some) {
        hash_.add(some.data(), some.size());
        growing.line() += some;
        growing.flush();
      });
      growing.close();
    } else if (options_.to == "hdf5") {
      write_hdf5(table_, *reader_, provenance_, file.temporary());
    } else {
      write_mat(table_, provenance_, file.temporary());
    }
    file.commit();
    if (options_.to != "csv") return;
    provenance_["data_sha256"] = hash_.digits();
    write_whole_file(record_file(options_.out), json_text(provenance_));
  }

 private:
  void give(const TakeText& take) {
    options_.to == "csv" ? give_csv(table_, take) : give_json(table_, name_, table_.summary(), provenance_, take);
  }

  const ExportOptions& options_;
  const CommonOptions& common_;
  std::string name_;
  std::unique_ptr<ResultReader> reader_;
  TableView table_;
  Json provenance_;
  Sha256 hash_;
};

/// Refuses what is of results of runs.
void require_study_options(const ExportOptions& options) {
  const std::pair<const char*, bool> of_runs[] = {
      {"--table", !options.table.empty()}, {"--from", !options.from.empty()},     {"--until", !options.until.empty()},
      {"--every", !options.every.empty()}, {"--period", !options.period.empty()}, {"--phase", !options.phase.empty()}};
  for (const auto& [option, given] : of_runs) {
    if (given)
      throw Error(Error::Category::usage, "bad-value",
                  fmt::format("a study has one table: {} says nothing of it", option));
  }
  if (options.to == "mat") {
    throw Error(Error::Category::usage, "bad-value", "a table of a study is no MAT-file", {},
                "--to hdf5 is read by MATLAB (h5read), --to csv by readtable");
  }
  if (options.to == "hdf5" && !options.channels.empty()) {
    throw Error(Error::Category::usage, "bad-value", "--to hdf5 takes all columns of a study", {}, "--to csv or json");
  }
}

/// The table of a study's directory.
int export_study(const ExportOptions& options, const CommonOptions& common) {
  require_study_options(options);
  const StudyInFolder opened = open_kept(options.path, StudyUse::look, common);
  if (!opened.study) return opened.exit_code;
  const TableExport of{*opened.study, opened.folder.path(), options.channels};
  Json provenance = {{"made", "export"}, {"command", common.command}, {"arguments", arguments_of(options)}};
  provenance.update(study_provenance(*opened.study, opened.folder));
  const auto give = [&](const TakeText& take) {
    options.to == "csv" ? give_study_csv(of, take) : give_study_json(of, provenance, take);
  };
  if (options.out.empty()) {
    give(print_data);
    return 0;
  }
  StagedFile file(options.out, options.force);
  if (options.to == "hdf5") {
    std::error_code error;
    fs::copy_file(of.folder / "study.h5", file.temporary(), fs::copy_options::overwrite_existing, error);
    if (error) {
      throw Error(Error::Category::file, "cannot-write",
                  fmt::format("cannot copy '{}': {}", (of.folder / "study.h5").string(), error.message()));
    }
    file.commit();
    return 0;
  }
  if (options.to == "csv") require_no_other_file(record_file(options.out), own_record, options.force);
  Sha256 hash;
  GrowingFile growing(file.temporary());
  give([&](std::string_view some) {
    hash.add(some.data(), some.size());
    growing.line() += some;
    growing.flush();
  });
  growing.close();
  file.commit();
  if (options.to != "csv") return 0;
  provenance["data_sha256"] = hash.digits();
  write_whole_file(record_file(options.out), json_text(provenance));
  return 0;
}

int export_result(const ExportOptions& options, const CommonOptions& common) {
  if (options.path.empty()) throw Error(Error::Category::usage, "missing-argument", "export needs a result");
  if (options.to.empty())
    throw Error(Error::Category::usage, "missing-argument", "export needs --to csv, hdf5, mat or json");
  require_word("format", options.to, {"csv", "hdf5", "mat", "json"});
  if (StudyFolder(options.path).holds_study()) {
    if (options.to == "hdf5" && options.out.empty()) {
      throw Error(Error::Category::usage, "missing-argument", "--to hdf5 needs --out FILE");
    }
    return export_study(options, common);
  }
  const TableRequest request = request_of(options);
  const bool binary = options.to == "hdf5" || options.to == "mat";
  if (binary && options.out.empty()) {
    throw Error(Error::Category::usage, "missing-argument", fmt::format("--to {} needs --out FILE", options.to));
  }
  if (options.to == "hdf5" && request.table != "results") {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("--to hdf5 holds rows and events of a result, not a table of {}", request.table), {},
                "take --to csv, json or mat");
  }
  Export(options, common, request).execute();
  return 0;
}

}  // namespace

Command add_export_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "export", "Write rows or events of a result as another file");
  const auto options = std::make_shared<ExportOptions>();
  add_option(*app, "RESULT", options->path, "Result directory, results.csv or results.h5, or directory of a study");
  add_option(*app, "--to", options->to, "csv, hdf5, mat or json", "FORMAT");
  add_option(*app, "--table", options->table,
             "results, events, impacts, bearing, spectra, poincare or lyapunov (results)", "NAME");
  add_repeatable(*app, "--channels", options->channels, "Channels to write, a name or pattern with *; repeatable",
                 "PATTERN");
  add_option(*app, "--from", options->from, "First time: \"10 ms\"", "T");
  add_option(*app, "--until", options->until, "Last time", "T");
  add_option(*app, "--every", options->every, "Every N-th row of these", "N");
  add_option(*app, "--period", options->period, "Of poincare and lyapunov: the time of one turn", "T");
  add_option(*app, "--phase", options->phase, "Of poincare: the first instant (where counting begins)", "T");
  add_file_option(*app, "--out", options->out, "File (stdout, for csv and json)", "FILE");
  add_flag(*app, "--force", options->force, "Replace a file that is there already");
  add_common_options(*app, common);
  return {app, [options, &common] { return export_result(*options, common); }};
}

}  // namespace freeplay
