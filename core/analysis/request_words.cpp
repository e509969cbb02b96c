#include "analysis/request_words.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/option_value.h"
#include "base/suggestion.h"

namespace freeplay {
namespace {

constexpr long largest_count = 1'000'000;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Pieces between separators outside of parentheses.
std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out{""};
  int depth = 0;
  for (const char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == separator && depth == 0) {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  for (std::string& piece : out) piece = trimmed(piece);
  return out;
}

const Dimension& dimension_of(const PoseForm& form, std::size_t component) {
  return form.is_turn(component) ? dimension::angle : dimension::length;
}

std::size_t component_of(const PoseForm& form, const std::string& option, const std::string& text,
                         const std::string& word) {
  const auto found = std::ranges::find(form.words, word);
  if (found != form.words.end()) return static_cast<std::size_t>(found - form.words.begin());
  const auto nearest = suggestion(word, {form.words.begin(), form.words.end()});
  bad_value(option, text, fmt::format("'{}' is none of {}", word, enumeration(form.words)),
            nearest ? fmt::format("did you mean '{}'?", *nearest) : "");
}

GridValues space_of(const std::string& option, const std::string& text, const std::string& range,
                    const Dimension& dimension) {
  const std::vector<std::string> parts = split(range, ':');
  if (parts.size() != 3) bad_value(option, text, "FROM:TO:COUNT is needed");
  GridValues grid;
  grid.from = signed_quantity(option, parts[0], dimension);
  grid.to = signed_quantity(option, parts[1], dimension);
  const double count = signed_quantity(option, parts[2], dimension::none);
  if (count != std::floor(count) || count < 1.0 || count > static_cast<double>(largest_count)) {
    bad_value(option, text, "the count must be a whole number from 1 to 10^6");
  }
  grid.count = static_cast<long>(count);
  return grid;
}

PoseWords pose_of(const PoseForm& form, const std::string& text) {
  PoseWords pose;
  const std::vector<std::string> parts = split(text, ',');
  const bool named = text.find('=') != std::string::npos;
  if (parts.size() > form.size()) {
    bad_value("--pose", text, fmt::format("at most {} can be given", enumeration(form.words)));
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t sign = parts[i].find('=');
    if (named && sign == std::string::npos) {
      bad_value("--pose", text, "either all values have a name or none has, as in x=0.05,y=0");
    }
    const std::size_t c = named ? component_of(form, "--pose", text, trimmed(parts[i].substr(0, sign))) : i;
    if (pose.given[c]) bad_value("--pose", text, fmt::format("'{}' is given twice", form.words[c]));
    pose.given[c] = true;
    pose.value[c] =
        signed_quantity("--pose", named ? trimmed(parts[i].substr(sign + 1)) : parts[i], dimension_of(form, c));
  }
  return pose;
}

std::pair<std::size_t, GridValues> grid_axis_of(const PoseForm& form, const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos) {
    bad_value("--grid", text, fmt::format("x=FROM:TO:COUNT is needed (also {})", enumeration(form.words.subspan(1))));
  }
  const std::size_t component = component_of(form, "--grid", text, trimmed(text.substr(0, sign)));
  return {component, space_of("--grid", text, text.substr(sign + 1), dimension_of(form, component))};
}

GridValues times_of(const std::string& text) { return space_of("--time", text, text, dimension::time); }

std::vector<int> elbow_of(const std::string& text) {
  std::vector<int> modes;
  for (const std::string& word : split(text, ',')) {
    if (word != "1" && word != "+1" && word != "-1") bad_value("--elbow", text, "1 or -1 is needed for each leg");
    modes.push_back(word == "-1" ? -1 : 1);
  }
  return modes;
}

std::vector<Jet> inputs_of(const std::string& text, const Model& model, const std::vector<int>& inputs) {
  std::vector<Jet> values(inputs.size(), Jet::constant(std::numeric_limits<double>::quiet_NaN()));
  std::vector<std::string> names;
  for (const int j : inputs) names.push_back(model.joints[static_cast<std::size_t>(j)].name);
  for (const std::string& part : split(text, ',')) {
    const std::size_t sign = part.find('=');
    if (sign == std::string::npos) bad_value("--input", text, "JOINT=VALUE is needed for each driven joint");
    const std::string name = trimmed(part.substr(0, sign));
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
      const auto nearest = suggestion(name, names);
      throw Error(
          Error::Category::usage, "unknown-name", fmt::format("there is no driven joint '{}'", name), {},
          nearest ? fmt::format("did you mean '{}'?", *nearest) : fmt::format("one of {}", fmt::join(names, ", ")));
    }
    const std::size_t i = static_cast<std::size_t>(found - names.begin());
    if (!std::isnan(values[i].value)) bad_value("--input", text, fmt::format("'{}' is given twice", name));
    const bool angle = model.joints[static_cast<std::size_t>(inputs[i])].ideal_layout().coordinate == Coordinate::angle;
    values[i] = Jet::constant(
        signed_quantity("--input", trimmed(part.substr(sign + 1)), angle ? dimension::angle : dimension::length));
  }
  return values;
}

PlayLaw play_law_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string word = trimmed(text.substr(0, colon));
  require_word("distribution of --distribution", word, {"uniform", "rim", "normal"});
  PlayLaw law;
  law.kind = word == "rim" ? PlayLaw::Kind::rim : word == "normal" ? PlayLaw::Kind::normal : PlayLaw::Kind::uniform;
  if (colon == std::string::npos) return law;
  if (word != "normal") bad_value("--distribution", text, fmt::format("'{}' takes no number", word));
  law.sigma = signed_quantity("--distribution", text.substr(colon + 1), dimension::none);
  constexpr double widest = 1000.0;  // as good as uniform
  if (!(law.sigma > 0.0) || law.sigma > widest) {
    bad_value("--distribution", text,
              "the standard deviation is a share of the clearance, greater than 0 and at most 1000");
  }
  return law;
}

AnalysisKind analysis_kind(const std::string& word) {
  return word == "ik"            ? AnalysisKind::inverse_kinematics
         : word == "workspace"   ? AnalysisKind::workspace
         : word == "singularity" ? AnalysisKind::singularity
         : word == "error"       ? AnalysisKind::error
                                 : AnalysisKind::inverse_dynamics;
}

/// A torque where all inputs turn, a force where all slide; either where they differ.
double preload_of(const IdealMechanism& mechanism, const std::string& text) {
  int turning = 0;
  const int inputs = static_cast<int>(mechanism.platform().inputs.size());
  for (int i = 0; i < inputs; ++i) turning += mechanism.is_angle(i) ? 1 : 0;
  if (turning == 0) return signed_quantity("--preload", text, dimension::force);
  if (turning == inputs) return signed_quantity("--preload", text, dimension::torque);
  try {
    return signed_quantity("--preload", text, dimension::torque);
  } catch (const Error&) {
    return signed_quantity("--preload", text, dimension::force);
  }
}

}  // namespace

PlatformOverrides platform_overrides(Model& model, const AnalysisWords& words) {
  PlatformOverrides overrides;
  if (!words.frame.empty()) overrides.marker = frame_marker(model, words.frame);
  if (!words.elbow.empty()) overrides.elbow = elbow_of(words.elbow);
  return overrides;
}

AnalysisRequest request_of(const IdealMechanism& mechanism, const AnalysisWords& words, int threads) {
  const int ways = (words.pose.empty() ? 0 : 1) + (words.grid.empty() ? 0 : 1) + (words.time.empty() ? 0 : 1) +
                   (words.input.empty() ? 0 : 1);
  if (ways > 1) {
    throw Error(Error::Category::usage, "bad-value", "--pose, --grid, --time and --input exclude each other");
  }
  AnalysisRequest request;
  request.kind = analysis_kind(words.kind);
  for (const std::string& text : words.pose) {
    request.poses.push_back({pose_of(mechanism.form(), text), fmt::format("--pose {}", text)});
  }
  for (const std::string& text : words.input) {
    request.inputs.push_back({inputs_of(text, mechanism.model(), mechanism.platform().inputs), text});
  }
  if (!words.time.empty()) request.times = times_of(words.time);
  for (const std::string& text : words.grid) {
    const auto [axis, values] = grid_axis_of(mechanism.form(), text);
    if (request.grid[axis]) {
      throw Error(Error::Category::usage, "bad-value", fmt::format("--grid {}: this axis is given twice", text));
    }
    request.grid[axis] = values;
  }
  request.branches = words.branches;
  request.chooses_elbow = !words.elbow.empty();
  request.error.sensitivity = words.sensitivity;
  if (!words.samples.empty()) request.error.samples = whole_number("--samples", words.samples, 1);
  if (!words.seed.empty()) {
    request.error.seed = static_cast<std::uint64_t>(seed_of(words));
  }
  if (!words.distribution.empty()) request.error.law = play_law_of(words.distribution);
  if (!words.preload.empty()) request.preload = preload_of(mechanism, words.preload);
  request.threads = threads;
  return request;
}

void require_sense(const AnalysisWords& words) {
  require_word("kind of analysis", words.kind, {"ik", "workspace", "singularity", "error", "inverse-dynamics"});
  const auto only = [&](bool given, const char* option, const char* kind) {
    if (!given || words.kind == kind) return;
    throw Error(Error::Category::usage, "bad-value", fmt::format("{} is for {}, not for {}", option, kind, words.kind));
  };
  only(words.sensitivity, "--sensitivity", "error");
  only(!words.samples.empty(), "--samples", "error");
  only(!words.seed.empty(), "--seed", "error");
  only(!words.distribution.empty(), "--distribution", "error");
  only(!words.preload.empty(), "--preload", "inverse-dynamics");
  only(words.branches, "--branches", "ik");
  for (const auto& [text, option] : {std::pair{&words.seed, "--seed"}, {&words.distribution, "--distribution"}}) {
    if (text->empty() || !words.samples.empty()) continue;
    throw Error(Error::Category::usage, "bad-value", fmt::format("{} is given without --samples", option), {},
                "--samples N draws random play");
  }
}

std::vector<std::string> arguments_of(const AnalysisWords& asked, bool coloured) {
  std::vector<std::string> words{asked.kind};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  const auto add_each = [&](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) add(option, value);
  };
  add("--frame", asked.frame);
  add_each("--pose", asked.pose);
  add_each("--grid", asked.grid);
  add("--time", asked.time);
  add_each("--input", asked.input);
  add("--elbow", asked.elbow);
  if (asked.sensitivity) words.emplace_back("--sensitivity");
  add("--samples", asked.samples);
  add("--seed", asked.seed);
  add("--distribution", asked.distribution);
  if (asked.branches) words.emplace_back("--branches");
  if (coloured) words.emplace_back("--colours");
  add("--preload", asked.preload);
  return words;
}

long seed_of(const AnalysisWords& words) { return words.seed.empty() ? 0 : whole_number("--seed", words.seed, 0); }

}  // namespace freeplay
