#include "cli/plugin_examination.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/allocation_watch.h"
#include "cli/child_process.h"
#include "component/library.h"
#include "contract/component_contract.h"
#include "contract/component_entry.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// One line: what a plugin says may hold any byte.
std::string line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json finding_json(const Finding& finding) {
  return {{"rule", finding.rule}, {"held", finding.held}, {"detail", finding.detail}};
}
Finding finding_of(const Json& json) { return {json["rule"], json["held"], printable(std::string(json["detail"]))}; }

// --- In the child.

/// Registers the built-in types, the companions and the library; returns what the library brought.
std::vector<const RegisteredComponent*> load(Registry& registry, const fs::path& library,
                                             const std::vector<fs::path>& companions, CallNote& note) {
  note.enter("load");
  for (const fs::path& companion : companions) load_plugin(registry, companion);
  if (library != builtin_word) load_plugin(registry, library);
  note.leave();
  const std::string& path = library.native();
  std::vector<const RegisteredComponent*> found;
  for (const RegisteredComponent& entry : registry.components()) {
    if (entry.library == path) found.push_back(&entry);
  }
  return found;
}

Json header(const Registry& registry, const std::vector<const RegisteredComponent*>& entries) {
  Json types = Json::array();
  for (const RegisteredComponent* entry : entries) {
    const Json full = component_json(*entry, registry);
    types.push_back({{"name", full["name"]}, {"kind", full["kind"]}, {"parameters", full["parameters"]}});
  }
  const std::string& path = entries.front()->library;
  Json result{{"library", path}, {"types", types}};
  for (const RegisteredLibrary& library : registry.libraries()) {
    if (library.path != path) continue;
    const bool built_in = path == builtin_word;
    result["name"] = built_in ? builtin_word : library.table->name();
    result["version"] = built_in ? program_version : library.table->version();
    result["compiler"] = library.table->compiler();
  }
  return result;
}

ChildProcess::Work list_types(const fs::path& library, const ExaminationOptions& options) {
  return [&](const ChildProcess::Report& report, CallNote& note) {
    Registry registry = Registry::with_builtins();
    try {
      const auto entries = load(registry, library, options.companions, note);
      report(line(header(registry, entries)));
    } catch (const Error& error) {
      report(line({{"id", error.id()}, {"message", error.message()}, {"hint", error.hint()}}));
    }
    return ChildProcess::Leave::at_once;
  };
}

ChildProcess::Work check_type(const fs::path& library, const ExaminationOptions& options, std::size_t index) {
  return [&, index](const ChildProcess::Report& report, CallNote& note) {
    Registry registry = Registry::with_builtins();
    const auto entries = load(registry, library, options.companions, note);
    watch_allocations();
    Conditions conditions{.seed = options.seed, .allocations = &allocations, .note = &note};
    conditions.found = [&](const Finding& finding) { report(line({{"finding", finding_json(finding)}})); };
    const Findings findings = check_component(*entries.at(index)->component, registry, conditions);
    Json all = Json::array();
    for (const Finding& finding : findings.all()) all.push_back(finding_json(finding));
    report(line({{"all", all}}));
    // What remains is the end of the program, in which every program that loads the library runs its destructors.
    note.say("");
    note.enter("exit");
    return ChildProcess::Leave::as_usual;
  };
}

// --- In the parent.

std::string signal_word(int number) {
  const char* word = ::sigabbrev_np(number);
  return word == nullptr ? fmt::format("signal {}", number) : fmt::format("SIG{}", word);
}

/// "in constrain() (as few as possible, in the plane)"; empty when nothing was called.
std::string place(const CallNote& note) {
  const std::string function(note.function, ::strnlen(note.function, sizeof note.function));
  const std::string where(note.circumstances, ::strnlen(note.circumstances, sizeof note.circumstances));
  if (function.empty()) return "";
  if (function == "load") return " while it was loaded (in its static constructors or its entry point)";
  if (function == "exit") return " at the end of the program (in its static destructors)";
  const bool inside = note.inside.load() != 0;
  const std::string call = function.find(' ') == std::string::npos ? function + "()" : function;
  return fmt::format(" {} {}{}", inside ? "in" : "after", call,
                     where.empty() ? "" : fmt::format(" ({})", printable(where)));
}

/// What went wrong with the child itself; empty if nothing did. `who` begins the sentence.
std::string failure_of(const ChildProcess& child, const std::string& who, double time_limit) {
  const ChildEnd& end = child.end();
  const std::string where = place(child.note());
  switch (end.how) {
    case ChildEnd::How::finished:
      return "";
    case ChildEnd::How::exited:
      return fmt::format("{} ended the program with exit code {}{}", who, end.code, where);
    case ChildEnd::How::crashed:
      return fmt::format("{} crashed ({}){}", who, signal_word(end.code), where);
    case ChildEnd::How::stuck:
      return where.starts_with(" in ")
                 ? fmt::format("{} did not return from{} within {:g} s", who, where.substr(3), time_limit)
                 : fmt::format("{} did not come to an end within {:g} s{}", who, time_limit, where);
    case ChildEnd::How::late:
      break;
  }
  return fmt::format("{} was not examined to its end: {:g} s were over after {} calls", who, time_limit,
                     child.note().calls.load());
}

/// Calls `use` for each line of a report. The last line of a child that was killed may be cut; it is left out.
template <class Use>
void for_each_line(const std::string& report, Use&& use) {
  std::string_view rest = report;
  for (std::size_t end; (end = rest.find('\n')) != std::string_view::npos; rest.remove_prefix(end + 1)) {
    const Json json = Json::parse(rest.substr(0, end), nullptr, false);
    if (!json.is_discarded()) use(json);
  }
}

[[noreturn]] void refuse_library(const fs::path& library, const std::string& failure) {
  throw Error(Error::Category::plugin, "plugin-failed", fmt::format("plugin '{}' {}", library.string(), failure));
}

Examination read_header(const ChildProcess& child, const fs::path& library, double time_limit) {
  Examination found;
  found.printed = child.end().printed;
  for_each_line(child.end().report, [&](const Json& json) {
    if (json.contains("message")) {
      throw Error(Error::Category::plugin, json["id"], json["message"], {}, json["hint"]);
    }
    found.library = json["library"];
    found.name = json["name"];
    found.version = json["version"];
    found.compiler = json["compiler"];
    found.abi = static_cast<int>(abi_version);
    for (const Json& type : json["types"]) {
      found.types.push_back({type["name"], type["kind"], type["parameters"], {}, {}, {}});
    }
  });
  const std::string failure = failure_of(child, "", time_limit);
  if (!failure.empty()) refuse_library(library, failure.substr(1));
  if (found.types.empty()) refuse_library(library, "ended the program before it gave its types");
  return found;
}

void read_findings(const ChildProcess& child, double time_limit, ExaminedType& type) {
  Findings so_far;
  std::vector<Finding> all;
  for_each_line(child.end().report, [&](const Json& json) {
    if (json.contains("all")) {
      for (const Json& finding : json["all"]) all.push_back(finding_of(finding));
    } else if (json.contains("finding")) {
      const Finding finding = finding_of(json["finding"]);
      so_far.expect(finding.rule.c_str(), finding.held, [&] { return finding.detail; });
    }
  });
  type.rules = all.empty() ? so_far.all() : all;
  type.printed = child.end().printed;
  type.failure = failure_of(child, "'" + type.name + "'", time_limit);
  if (type.failure.empty() && all.empty()) type.failure = "'" + type.name + "' cut off the report of its examination";
}

std::vector<std::unique_ptr<ChildProcess>> one(const ChildProcess::Work& work) {
  std::vector<std::unique_ptr<ChildProcess>> children;
  children.push_back(std::make_unique<ChildProcess>(work));
  return children;
}

}  // namespace

bool ExaminedType::held() const {
  return failure.empty() && std::ranges::all_of(rules, [](const Finding& finding) { return finding.held; });
}

bool Examination::held() const {
  return std::ranges::all_of(types, [](const ExaminedType& type) { return type.held(); });
}

Examination examine_plugin(const fs::path& library, const ExaminationOptions& options) {
  std::error_code unreadable;
  const fs::path canonical = fs::canonical(library, unreadable), path = unreadable ? library : canonical;
  const Clock::time_point started = Clock::now();
  const auto lister = one(list_types(path, options));
  ChildProcess::wait(lister, options.time_limit);
  Examination found = read_header(*lister.front(), path, options.time_limit);

  // All at once: a type that hangs takes no time from the others.
  std::vector<std::unique_ptr<ChildProcess>> children;
  for (std::size_t i = 0; i < found.types.size(); ++i) {
    children.push_back(std::make_unique<ChildProcess>(check_type(path, options, i)));
  }
  const double spent = std::chrono::duration<double>(Clock::now() - started).count();
  ChildProcess::wait(children, options.time_limit - spent);
  for (std::size_t i = 0; i < children.size(); ++i) read_findings(*children[i], options.time_limit, found.types[i]);
  return found;
}

}  // namespace freeplay
