#include "cli/check_plugin_command.h"

#include <algorithm>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/plugin_examination.h"
#include "cli/terminal.h"
#include "component/library.h"
#include "contract/component_entry.h"
#include "contract/rules.h"

namespace freeplay {
namespace {

constexpr std::size_t line_width = 110;

struct CheckOptions {
  std::string library, time_limit;
  std::uint64_t seed = 1;
};

/// Words set in lines, each after `indent`.
std::string paragraph(std::string_view text, const std::string& indent) {
  std::string result, row = indent;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (row.size() > indent.size() && row.size() + 1 + word.size() > line_width) {
      result += row + "\n";
      row = indent;
    }
    if (row.size() > indent.size()) row += ' ';
    row += word;
  }
  return result + row + "\n";
}

/// "kept      jacobian, gamma, ...": a word, and a list that continues below itself.
std::string labelled(const std::string& label, const std::string& text) {
  std::string set = paragraph(text, "            ");
  return set.replace(2, label.size(), label);
}

ComponentKind kind_of(const std::string& word) {
  for (const ComponentKind kind : {ComponentKind::joint, ComponentKind::contact_law, ComponentKind::friction_law}) {
    if (word == kind_word(kind)) return kind;
  }
  return ComponentKind::integrator;
}

std::string joined(std::string& list, const std::string& word) { return list += (list.empty() ? "" : ", ") + word; }

std::string type_text(const ExaminedType& type, bool brief) {
  const auto broken = std::ranges::count_if(type.rules, [](const Finding& finding) { return !finding.held; });
  std::string verdict = "ok";
  if (broken > 0) verdict = fmt::format("breaks {} of {} rules", broken, type.rules.size());
  if (!type.failure.empty()) verdict = broken > 0 ? "failed, and " + verdict : "failed";
  std::string text = fmt::format("\n{} '{}': {}\n", type.kind, type.name, verdict);
  if (!type.failure.empty()) text += labelled("failed", type.failure + ".");
  std::string parameters, kept;
  for (const Json& parameter : type.parameters) joined(parameters, parameter["name"]);
  for (const Finding& finding : type.rules) {
    if (finding.held) {
      joined(kept, finding.rule);
      continue;
    }
    text += labelled("broken", finding.rule);
    text += paragraph(finding.detail, "              ");
    text += paragraph(rule_meaning(kind_of(type.kind), finding.rule), "              ");
  }
  if (brief) return text;
  if (!kept.empty()) text += labelled(type.failure.empty() ? "kept" : "so far", kept);
  if (!parameters.empty()) text += labelled("takes", parameters);
  return text;
}

std::string verdict_text(const Examination& found) {
  const auto bad = std::ranges::count_if(found.types, [](const ExaminedType& type) { return !type.held(); });
  const std::size_t count = found.types.size();
  if (count == 1) return bad == 0 ? "\nThe type keeps its contract.\n" : "\nThe type does not keep its contract.\n";
  if (bad == 0) return fmt::format("\nAll {} types keep their contracts.\n", count);
  return fmt::format("\n{} of {} types {} not keep their contracts.\n", bad, count, bad == 1 ? "does" : "do");
}

std::string examination_text(const Examination& found, bool quiet) {
  std::string text;
  if (!quiet) {
    text = fmt::format("{} {} ({})\n", found.name, found.version, found.library);
    text += fmt::format("  plugin ABI {}, compiler {}, {} type{}\n", found.abi, found.compiler, found.types.size(),
                        found.types.size() == 1 ? "" : "s");
  }
  for (const ExaminedType& type : found.types) {
    if (!quiet || !type.held()) text += type_text(type, quiet);
  }
  return quiet ? text : text + verdict_text(found);
}

Json examination_json(const Examination& found) {
  Json types = Json::array();
  for (const ExaminedType& type : found.types) {
    Json rules = Json::array();
    for (const Finding& finding : type.rules) {
      rules.push_back({{"rule", finding.rule}, {"held", finding.held}, {"detail", finding.detail}});
    }
    types.push_back({{"name", type.name},
                     {"kind", type.kind},
                     {"parameters", type.parameters},
                     {"ok", type.held()},
                     {"rules", rules},
                     {"failure", type.failure.empty() ? Json(nullptr) : Json(type.failure)}});
  }
  return {{"library", found.library},
          {"name", found.name},
          {"version", found.version},
          {"abi", found.abi},
          {"compiler", found.compiler},
          {"ok", found.held()},
          {"types", types}};
}

/// What the library itself printed goes to stderr, apart from the report.
void show_printed(const Examination& found, const CommonOptions& common) {
  const auto show = [&](const std::string& who, const std::string& text) {
    if (text.empty()) return;
    constexpr std::size_t most = 4000;
    std::string shown = text.substr(0, most);
    if (!shown.ends_with('\n')) shown += '\n';
    if (text.size() > most) shown += fmt::format("... and {} bytes more\n", text.size() - most);
    print_messages(fmt::format("freeplay: note: {} printed:\n{}", who, shown), common.no_color);
  };
  show("the library", found.printed);
  for (const ExaminedType& type : found.types) show("'" + type.name + "'", type.printed);
}

int check_plugin(const CheckOptions& options, const CommonOptions& common) {
  if (options.library.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "check-plugin needs a library", {},
                fmt::format("give a path, a name in FREEPLAY_PLUGIN_PATH, or '{}'", builtin_word));
  }
  ExaminationOptions examination;
  examination.seed = options.seed;
  if (!options.time_limit.empty()) {
    examination.time_limit = positive_quantity("--time-limit", options.time_limit, dimension::time);
  }
  for (const std::string& word : common.plugins) examination.companions.push_back(find_plugin(word, {}));
  const bool built_in = options.library == builtin_word;
  const Examination found = examine_plugin(built_in ? builtin_word : find_plugin(options.library, {}), examination);
  if (common.verbose) show_printed(found, common);
  if (common.json) {
    print_json(examination_json(found));
  } else {
    print(examination_text(found, common.quiet));
  }
  return found.held() ? 0 : 5;
}

}  // namespace

Command add_check_plugin_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "check-plugin", "Check that the types of a plugin keep their contracts");
  const auto options = std::make_shared<CheckOptions>();
  add_option(*app, "LIB", options->library,
             "Library: a path, a name in FREEPLAY_PLUGIN_PATH, or 'built-in' for the types of the program itself");
  add_option(*app, "--seed", options->seed, "Seed of the random states (1)", "N");
  add_option(*app, "--time-limit", options->time_limit, "Time for all types together (60 s)", "TIME");
  add_common_options(*app, common);
  return {app, [options, &common] { return check_plugin(*options, common); }};
}

}  // namespace freeplay
