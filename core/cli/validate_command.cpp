#include "cli/validate_command.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "base/message_json.h"
#include "base/text.h"
#include "cli/failure.h"
#include "cli/loading.h"
#include "cli/terminal.h"
#include "load/facts.h"
#include "load/load.h"
#include "study/open_study.h"

namespace freeplay {
namespace {

struct ValidateOptions {
  std::vector<std::string> models;
  ModelOptions model;
  bool no_assemble = false;
};

/// What is known of one file.
struct Validation {
  std::string file;
  LoadedModel loaded;
  std::optional<ModelFacts> facts;
  Structure structure{};
  Json start = nullptr;
  Json start_changes = nullptr;
  std::string moved{};
  std::optional<std::uint64_t> points{};  ///< of a study

  bool ok() const { return loaded.exit_code == 0; }
};

/// The study of a model, or of a file that has one alone and is no model.
void judge_study(Validation& verdict, const ValidateOptions& options, const CommonOptions& common) {
  StudyPlanOptions plan;
  plan.load = loading(common);
  plan.set = build_options(options.model).set;
  plan.many_points = true;
  const auto study = OpenStudy::open(verdict.file, plan, verdict.loaded.diagnostics);
  if (study) verdict.points = study->plan().points();
  verdict.loaded.exit_code = study && !verdict.loaded.diagnostics.has_errors() ? 0 : 3;
}

Validation judge(const std::string& file, const ValidateOptions& options, const CommonOptions& common) {
  Validation verdict{file, load_model(file, build_options(options.model), loading(common)), {}, {}, {}, {}, {}};
  const Node* root = verdict.loaded.document ? &verdict.loaded.document->root() : nullptr;
  if (root != nullptr && root->is_map() && has_study_alone(*root)) {
    verdict.loaded.diagnostics = Diagnostics(common.strict);
    judge_study(verdict, options, common);
    return verdict;
  }
  if (verdict.ok() && root->find("study") != nullptr) judge_study(verdict, options, common);
  if (!verdict.ok()) return verdict;
  if (options.no_assemble) {
    verdict.facts = count_facts(*verdict.loaded.model);
  } else if (const auto assembled = assemble_model(verdict.loaded)) {
    verdict.facts = assembled->start.facts;
    verdict.structure = assembled->start.structure;
    verdict.start = start_json(*verdict.loaded.model, assembled->start);
    verdict.start_changes = start_changes_json(*verdict.loaded.model, assembled->start.report);
    verdict.moved = moved_text(*verdict.loaded.model, assembled->start.report);
  }
  return verdict;
}

Json verdict_json(const Validation& verdict, int max_errors) {
  Json json = {
      {"file", verdict.file},
      {"ok", verdict.ok()},
      {"facts", verdict.ok() && verdict.facts ? facts_json(*verdict.loaded.model, *verdict.facts, verdict.structure)
                                              : Json(nullptr)},
      {"start", verdict.start},
      {"start_changes", verdict.start_changes},
      {"messages", messages_json(verdict.loaded.diagnostics, max_errors)}};
  if (verdict.points) json["study"] = {{"points", *verdict.points}};
  return json;
}

void print_verdict(const Validation& verdict, const CommonOptions& common) {
  if (!common.quiet && !common.json) {
    print(printable(verdict.file) + (verdict.ok() ? ": ok\n" : ": not ok\n"));
    if (verdict.ok() && verdict.points) print(fmt::format("  study of {} points\n", *verdict.points));
    if (verdict.ok() && verdict.facts) {
      print(facts_text(*verdict.loaded.model, *verdict.facts) + structure_text(verdict.structure) + verdict.moved);
    }
  }
  print_messages(verdict.loaded.diagnostics.format(common.max_errors), common.no_color);
}

int validate(const ValidateOptions& options, const CommonOptions& common) {
  if (options.models.empty()) throw Error(Error::Category::usage, "missing-argument", "validate needs a model file");
  Json list = Json::array();
  int exit_code = 0;
  for (const std::string& file : options.models) {
    const Validation verdict = judge(file, options, common);
    print_verdict(verdict, common);
    list.push_back(verdict_json(verdict, common.max_errors));
    exit_code = std::max(exit_code, verdict.loaded.exit_code);
  }
  if (common.json) print_json(options.models.size() == 1 ? list.front() : list);
  return exit_code;
}

}  // namespace

Command add_validate_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "validate", "Check model files, assemble them and print their facts");
  const auto options = std::make_shared<ValidateOptions>();
  add_arguments(*app, "MODEL", options->models, "Model files");
  add_flag(*app, "--no-assemble", options->no_assemble, "Check the text only: rank and dof stay unknown");
  add_model_options(*app, options->model);
  add_common_options(*app, common);
  return {app, [options, &common] { return validate(*options, common); }};
}

}  // namespace freeplay
