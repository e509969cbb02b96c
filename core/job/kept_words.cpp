#include "job/kept_words.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/option_value.h"
#include "base/unit.h"
#include "job/repeat_work.h"
#include "results/checkpoints.h"
#include "results/directory.h"
#include "results/summary.h"

namespace freeplay {
namespace {

/// Every option that the numbers or the files of a run depend on.
template <class Words, class Visit>
void each_kept(Words& words, Visit&& visit) {
  visit("end", words.end);
  visit("step", words.step);
  visit("accuracy", words.accuracy);
  visit("integrator", words.integrator);
  visit("format", words.format);
  visit("repeat", words.repeat);
  visit("seed", words.seed);
  visit("set", words.model_options.set);
  visit("ideal", words.model_options.ideal);
  visit("verify", words.verify);
  visit("interval", words.interval);
  visit("inputs", words.inputs);
  visit("channels", words.channels);
  visit("twin", words.twin);
  visit("plugins", words.plugins);
  visit("strict", words.strict);
}

}  // namespace

void require_together(const KeptWords& words) {
  if (!words.inputs.empty() && (words.verify || !words.repeat.empty())) {
    throw Error(Error::Category::usage, "usage",
                fmt::format("--inputs and {} exclude each other: other runs have no inputs",
                            words.verify ? "--verify" : "--repeat"));
  }
  if (words.twin && !words.repeat.empty()) {
    throw Error(Error::Category::usage, "usage",
                "--twin and --repeat exclude each other: a twin without play has one start only");
  }
}

void require_twin(const Model& model) {
  if (model.clearance_joints() > 0) return;
  throw Error(
      Error::Category::usage, "no-clearance",
      "--twin runs the model with every clearance closed alongside, and no joint of this model has a clearance");
}

Json kept_options(const KeptWords& words) {
  Json kept;
  each_kept(words, [&](const char* name, const auto& value) { kept[name] = value; });
  return kept;
}

bool keep_options(const Json& kept, KeptWords& words) {
  try {
    each_kept(words, [&](const char* name, auto& value) { kept.at(name).get_to(value); });
  } catch (const Json::exception&) {
    return false;
  }
  return true;
}

Making making(const KeptWords& words, const std::string& command, const Model& model) {
  Making making{.made = "run", .command = command, .arguments = arguments_of(model, words), .build = FREEPLAY_BUILD};
  const auto add = [&](const char* option, const std::string& value) {
    if (value.empty()) return;
    making.arguments.emplace_back(option);
    making.arguments.push_back(value);
  };
  add("--inputs", words.inputs);
  add("--repeat", words.repeat);
  add("--seed", words.seed);
  if (!words.repeat.empty()) making.seed = repeat_plan(words.repeat, words.seed).seed;
  if (words.verify) making.arguments.emplace_back("--verify");
  if (words.twin) making.arguments.emplace_back("--twin");
  for (const std::string& plugin : words.plugins) add("--plugin", plugin);
  return making;
}

Json made_from(const KeptWords& words, const std::string& command, const Model& model) {
  return {{"program", program_of_checkpoints()},
          {"options", kept_options(words)},
          {"settings", settings_json(model)},
          {"model_copy", model_copy_name(model)},
          {"provenance", provenance(model, making(words, command, model))}};
}

double checkpoint_period(const std::string& words) {
  constexpr double usual = 10.0;
  if (words.empty()) return usual;
  if (words == "0") return 0.0;
  const double period = signed_quantity("--checkpoint", words, dimension::time);
  if (!(period >= 0.0)) bad_value("--checkpoint", words, "it must not be negative");
  return period;
}

}  // namespace freeplay
