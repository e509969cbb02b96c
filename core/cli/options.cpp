#include "cli/options.h"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/expression.h"
#include "base/suggestion.h"

namespace freeplay {
namespace {

constexpr const char* common_group = "Options of every command";
constexpr const char* hidden_group = "";
constexpr const char* model_group = "Options of every command that reads a model";

/// Options are read before any model, so they know no parameters.
class NoParameters : public Scope {
 public:
  const Quantity* find(std::string_view) const override { return nullptr; }
  std::vector<std::string> names() const override { return {}; }
};

// One value for each mention; by default the parser would also take the words that follow.
CLI::Option* repeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values,
                        const std::string& help) {
  return app.add_option(name, values, help)->allow_extra_args(false);
}

}  // namespace

void bad_value(const std::string& option, const std::string& text, const std::string& why, const std::string& hint) {
  throw Error(Error::Category::usage, "bad-value", fmt::format("bad value '{}' of {}: {}", text, option, why), {},
              hint);
}

CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& help) {
  return program.add_subcommand(name, help);
}

void add_option(CLI::App& app, const std::string& name, std::string& value, const std::string& help,
                const std::string& value_name) {
  app.add_option(name, value, help)->type_name(value_name);
}

void add_option(CLI::App& app, const std::string& name, std::uint64_t& value, const std::string& help,
                const std::string& value_name) {
  app.add_option(name, value, help)->type_name(value_name);
}

void add_file_option(CLI::App& app, const std::string& name, std::string& value, const std::string& help,
                     const std::string& value_name) {
  app.add_option(name, value, help)->type_name(value_name)->check([](const std::string& text) {
    return text.empty() ? std::string("it must not be empty") : std::string();
  });
}

void add_repeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& help,
                    const std::string& value_name) {
  repeatable(app, name, values, help)->type_name(value_name);
}

void add_arguments(CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& help) {
  app.add_option(name, values, help)->type_name("");
}

void add_flag(CLI::App& app, const std::string& name, bool& value, const std::string& help) {
  app.add_flag(name, value, help);
}

void add_later_flag(CLI::App& app, const std::string& name, bool& value) {
  app.add_flag(name, value)->group(hidden_group);
}

void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_flag("-q,--quiet", options.quiet, "No progress, no text but the data asked for")->group(common_group);
  app.add_flag("-v,--verbose", options.verbose, "More on stderr")->group(common_group);
  app.add_flag("--json", options.json, "Machine-readable stdout: one JSON document")->group(common_group);
  app.add_flag("--no-color", options.no_color, "No colour")->group(common_group);
  app.add_option("--max-errors", options.max_errors, "Messages of one file to print (20); 0 is no limit")
      ->type_name("N")
      ->check([](const std::string& text) {
        return text.find_first_not_of("0123456789") == std::string::npos ? "" : "it must be a whole number from 0 on";
      })
      ->group(common_group);
  app.add_flag("--strict", options.strict, "Warnings in input files are errors")->group(common_group);
  repeatable(app, "--plugin", options.plugins, "Load one more plugin, a path or a name; repeatable")
      ->type_name("LIB")
      ->group(common_group);
  app.add_flag("--allow-plugins", options.allow_plugins,
               "Run the code of plugins that a model names, wherever they lie")
      ->group(common_group);
}

void add_model_options(CLI::App& app, ModelOptions& options) {
  repeatable(app, "--set", options.set,
             "Replace a parameter or any value by its path: c=\"50 um\", joints.tip.clearance.radial_clearance=0.1mm; "
             "repeatable")
      ->type_name("NAME=VALUE")
      ->group(model_group);
  repeatable(app, "--ideal", options.ideal, "Close the clearance of a joint: name, pattern with * or all; repeatable")
      ->type_name("JOINT")
      ->group(model_group);
}

void add_model_options_without_ideal(CLI::App& app, ModelOptions& options) {
  add_model_options(app, options);
  app.get_option("--ideal")->group(hidden_group);
}

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

double signed_quantity(const std::string& option, const std::string& text, const Dimension& dimension) {
  try {
    const Expression expression = Expression::compile(text, NoParameters{}, false);
    expression.require(dimension);
    return expression.constant().value;
  } catch (const ExpressionError& e) {
    bad_value(option, text, e.message, e.suggestion.empty() ? e.hint : fmt::format("did you mean '{}'?", e.suggestion));
  }
}

double positive_quantity(const std::string& option, const std::string& text, const Dimension& dimension) {
  const double value = signed_quantity(option, text, dimension);
  if (!(value > 0.0)) bad_value(option, text, "it must be greater than 0");
  return value;
}

void require_word(const std::string& what, const std::string& word, const std::vector<std::string>& allowed) {
  if (std::ranges::find(allowed, word) != allowed.end()) return;
  const auto nearest = suggestion(word, allowed);
  throw Error(
      Error::Category::usage, "unknown-name", fmt::format("there is no {} '{}'", what, word), {},
      nearest ? fmt::format("did you mean '{}'?", *nearest) : fmt::format("one of {}", fmt::join(allowed, ", ")));
}

void not_in_this_release(const std::string& what) {
  throw Error(Error::Category::usage, "not-in-this-release", fmt::format("{}: not in this release", what));
}

long whole_number(const std::string& option, const std::string& text, long least) {
  const double value = signed_quantity(option, text, dimension::none);
  if (value != std::floor(value) || value < static_cast<double>(least) || value > 1e9) {
    bad_value(option, text, fmt::format("a whole number from {} to 10^9 is needed", least));
  }
  return static_cast<long>(value);
}

}  // namespace freeplay
