#include "load/run_words.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/number_text.h"
#include "base/option_value.h"
#include "base/unit.h"

namespace freeplay {
namespace {

std::optional<ResultFormat> result_format(const std::string& word) {
  if (word.empty()) return std::nullopt;
  const auto found = std::ranges::find(result_formats, word, [](const char* format) { return std::string(format); });
  if (found != std::end(result_formats)) return static_cast<ResultFormat>(found - std::begin(result_formats));
  bad_value("--format", word, "it must be csv, hdf5 or both");
}

}  // namespace

BuildOptions build_options(const ModelOptions& options) {
  BuildOptions build;
  for (const std::string& text : options.set) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos || sign == 0)
      bad_value("--set", text, "NAME=VALUE is needed: a parameter, or a path such as joints.tip.clearance.contact.law");
    build.set.emplace_back(text.substr(0, sign), text.substr(sign + 1));
  }
  build.ideal = options.ideal;
  return build;
}

BuildOptions build_options(const RunWords& words) {
  BuildOptions build = build_options(words.model_options);
  if (!words.end.empty()) build.end = positive_quantity("--end", words.end, dimension::time);
  if (!words.step.empty()) build.step = positive_quantity("--step", words.step, dimension::time);
  if (!words.accuracy.empty()) build.accuracy = positive_quantity("--accuracy", words.accuracy, dimension::length);
  if (build.step && build.accuracy) {
    throw Error(Error::Category::usage, "usage", "--step and --accuracy exclude each other");
  }
  if (!words.integrator.empty()) build.integrator = words.integrator;
  build.format = result_format(words.format);
  if (!words.interval.empty()) build.interval = positive_quantity("--interval", words.interval, dimension::time);
  build.channels = words.channels;
  return build;
}

std::vector<std::string> arguments_of(const Model& model, const RunWords& words) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  add("--end", fmt::format("{} s", number_text(model.settings.end)));
  for (const auto& [name, text] : model.overrides) add("--set", fmt::format("{}={}", name, text));
  for (const std::string& joint : model.ideal) add("--ideal", joint);
  add("--step", words.step);
  add("--accuracy", words.accuracy);
  add("--integrator", words.integrator);
  add("--interval", words.interval);
  for (const std::string& pattern : words.channels) add("--channels", pattern);
  add("--format", words.format);
  return arguments;
}

}  // namespace freeplay
