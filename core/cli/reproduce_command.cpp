#include "cli/reproduce_command.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/remaking.h"
#include "cli/study_reproduction.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "freeplay/plugin.h"
#include "results/made_file.h"
#include "results/reproduction.h"
#include "results/whole_result.h"

namespace freeplay {
namespace {

constexpr int not_reproduced = 7;  // exit code

struct ReproduceOptions {
  std::string path, out;
  bool yes = false;
};

std::string text_at(const Json& json, const char* name) {
  const Json value = json.value(name, Json());
  return value.is_string() ? value.get<std::string>() : std::string("unknown");
}

/// "1.2.3 (gcc 12.2, release)"
std::string program_words(const Json& record) {
  std::string build = text_at(record, "build");
  std::ranges::transform(build, build.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return fmt::format("freeplay {} ({}, {})", text_at(record, "freeplay"), text_at(record, "compiler"), build);
}

Json this_program() {
  return {
      {"freeplay", program_version}, {"compiler", compiler}, {"build", FREEPLAY_BUILD}, {"plugin_abi", abi_version}};
}

Json without_texts(Json record) {
  for (const char* name : {"model", "inputs", "runs"}) {
    if (!record.contains(name)) continue;
    Json& part = record[name];
    if (part.is_object()) part.erase("text");
    if (!part.is_array()) continue;
    for (Json& one : part) one = std::string_view(name) == "runs" ? without_texts(one) : Json(one);
    for (Json& one : part) {
      if (one.is_object()) one.erase("text");
    }
  }
  return record;
}

/// Plugins of all runs, by name; the digits of each as they are shown.
std::map<std::string, std::string> plugins_of(const MadeFile& made) {
  std::map<std::string, std::string> digits;
  for (const Json& run : runs_of(made)) {
    for (const Json& plugin : run.value("plugins", Json::array())) {
      digits[text_at(plugin, "name")] = text_at(plugin, "sha256");
    }
  }
  return digits;
}

/// Plugins that are others now, as sentences.
std::vector<std::string> other_plugins(const MadeFile& then, const MadeFile& now) {
  std::vector<std::string> found;
  const std::map<std::string, std::string> after = plugins_of(now);
  for (const auto& [name, digits] : plugins_of(then)) {
    const auto other = after.find(name);
    if (other != after.end() && other->second == digits) continue;
    found.push_back(fmt::format("the plugin '{}' is another: SHA-256 {} recorded, {} now", name, digits.substr(0, 12),
                                other != after.end() ? other->second.substr(0, 12) : "not there"));
  }
  return found;
}

class Reproduction {
 public:
  Reproduction(const MadeFile& made, const CommonOptions& common) : made_(made), common_(common) {}

  int execute(const ReproduceOptions& options) {
    faults_ = record_faults(made_);
    if (made_.kind == MadeKind::result && made_.ended) {
      if (std::string part = part_of_a_line(made_.path); !part.empty()) faults_.push_back({.what = std::move(part)});
    }
    const bool changed_model = std::ranges::any_of(faults_, &RecordFault::of_model);
    if (!changed_model) {
      Remaking remaking(made_, common_, options.out, options.yes);
      if (!remaking.make()) return give_up(remaking.end());
      checks_ = compare_again(made_, remaking.again(), remaking.results());
      const MadeFile again = read_made_file(remaking.again());
      rerun_ = again.record;
      other_plugins_ = other_plugins(made_, again);
    }
    const bool same = faults_.empty() && std::ranges::all_of(checks_, &ReproductionCheck::same);
    if (common_.json) {
      print_json(json(same));
    } else if (!common_.quiet) {
      print(text(same));
    }
    return same ? 0 : not_reproduced;
  }

 private:
  /// Nothing was made: what the program that was to make it says.
  int give_up(const ProgramEnd& end) const {
    if (common_.json) print_data(end.printed);
    if (!common_.verbose) print_messages(end.messages, common_.no_color);
    if (end.exit_code > 0 && end.exit_code < 128) return end.exit_code;
    if (end.exit_code == 130) return 130;
    throw Error(Error::Category::internal, "internal",
                fmt::format("what was to make it again ended with exit code {}", end.exit_code));
  }

  std::string text(bool same) const {
    std::string text = fmt::format("{}: made by {}, rerun by {}\n", printable(made_.path.string()),
                                   program_words(made_.record), program_words(this_program()));
    for (const char* name : {"freeplay", "compiler", "build", "plugin_abi", "platform", "arithmetic"}) {
      const Json now = rerun_.is_object() ? rerun_.value(name, Json()) : Json();
      const Json then = made_.record.value(name, Json());
      if (now.is_null() || now == then) continue;
      text += fmt::format("  another {}: {} recorded, {} now\n", name, then.dump(), now.dump());
    }
    for (const std::string& sentence : other_plugins_) text += "  " + sentence + "\n";
    for (const RecordFault& fault : faults_) text += "  " + fault.what + "\n";
    if (!made_.ended) text += "  its run had not ended: compared as far as it goes\n";
    TextTable table;
    for (const ReproductionCheck& check : checks_) {
      const char* good = check.bytes ? "same bytes" : "same";
      table.add_row({check.what, check.size, check.same() ? good : "first difference: " + check.first_difference});
    }
    return text + table.text("  ") + (same ? "same bytes\n" : "different\n");
  }

  Json json(bool same) const {
    Json checks = Json::array();
    const auto add = [&](const std::string& what, const std::string& difference) {
      checks.push_back({{"what", what},
                        {"same", difference.empty()},
                        {"first_difference", difference.empty() ? Json(nullptr) : Json(difference)}});
    };
    add("record", faults_.empty() ? "" : faults_.front().what);
    for (const ReproductionCheck& check : checks_) add(check.what, check.first_difference);
    return {{"same", same},
            {"ended", made_.ended},
            {"record", without_texts(made_.record)},
            {"rerun", rerun_.is_object() ? without_texts(rerun_) : Json(nullptr)},
            {"checks", std::move(checks)}};
  }

  const MadeFile& made_;
  const CommonOptions& common_;
  std::vector<RecordFault> faults_;
  std::vector<ReproductionCheck> checks_;
  std::vector<std::string> other_plugins_;
  Json rerun_ = nullptr;  // null where nothing was made
};

int reproduce(const ReproduceOptions& options, const CommonOptions& common) {
  if (options.path.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "reproduce needs a result, table, picture or page");
  }
  if (study_of(options.path)) return reproduce_study(options.path, options.out, common);
  try {
    const MadeFile made = read_made_file(options.path);
    if (made.record.contains("study")) return reproduce_study_table(made, options.out, common);
    return Reproduction(made, common).execute(options);
  } catch (const Json::exception&) {
    throw Error(Error::Category::file, "no-provenance",
                fmt::format("'{}' has a record of another form than this program writes", options.path));
  }
}

}  // namespace

Command add_reproduce_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "reproduce", "Make a result, table, picture or page again, and compare");
  const auto options = std::make_shared<ReproduceOptions>();
  add_option(*app, "RESULT", options->path,
             "Result directory, directory of a study, or a file that this program has made");
  add_file_option(*app, "--out", options->out, "Keep what was made again (a temporary folder)", "DIR");
  add_flag(*app, "--yes", options->yes, "Run again even what takes more than half of the room that is free");
  add_common_options(*app, common);
  return {app, [options, &common] { return reproduce(*options, common); }};
}

}  // namespace freeplay
