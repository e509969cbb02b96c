#include "job/resumption.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/option_value.h"
#include "base/unit.h"
#include "results/checkpoints.h"
#include "results/whole_result.h"

namespace freeplay {
namespace {

[[noreturn]] void mismatch(const std::string& what, const std::string& then, const std::string& now) {
  throw Error(Error::Category::input, "resume-mismatch",
              fmt::format("{} is not that of the run: {} then, {} now", what, then, now), {},
              "the rest would not fit what is there: run the model again from its start");
}

std::string words_of(const Json& value) {
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  const bool digest = text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  return digest ? text.substr(0, 12) : text;
}

void require_same(const std::string& what, const Json& then, const Json& now) {
  if (then != now) mismatch(what, words_of(then), words_of(now));
}

Json summary_of(const std::filesystem::path& directory) {
  std::ifstream file(directory / "summary.json");
  Json json = Json::parse(file, nullptr, false);
  return json.is_object() ? json : Json::object();
}

/// Settings that the run had, as results.h5 and summary.json keep them.
double number_at(const Json& json, const char* pointer) {
  const Json::json_pointer path(pointer);
  return json.contains(path) && json.at(path).is_number() ? json.at(path).get<double>() : 0.0;
}

/// Whether a comparison with the run without clearances that is null is to stay so: another would find the same.
bool has_no_comparison(const std::filesystem::path& directory, const Json& summary) {
  const Json twin = summary_of(directory / "twin");
  const std::string status = twin.value("status", "");
  if (status == "failed") return number_at(twin, "/exit_code") != 6.0;
  const Json::json_pointer until("/statistics/to");
  return (status == "completed" || status == "stopped") && summary.contains(until) && summary.at(until).is_null();
}

/// A result that stays or is replaced is one: made from what lies beside it, with all that its summary counts.
void require_whole(const std::filesystem::path& directory, const Json& summary, const Json& record) {
  if (const auto changed = changed_source(directory, record)) mismatch(changed->name, changed->then, changed->now);
  if (const std::string misfit = misfit_of(directory, summary); !misfit.empty()) {
    throw Error(Error::Category::file, "bad-checkpoint", misfit, {}, "run the model again");
  }
  if (const std::string part = part_of_a_line(directory); !part.empty()) {
    throw Error(Error::Category::file, "bad-checkpoint", part, {},
                fmt::format("cut it off with `freeplay seal {}`", directory.string()));
  }
}

}  // namespace

void require_same_program(const Checkpoint& checkpoint) {
  const Json now = program_of_checkpoints();
  for (const auto& [name, value] : now.items()) {
    require_same(fmt::format("the program's {}", name), checkpoint.made["program"].value(name, Json()), value);
  }
}

Resumption read_resumption(const std::filesystem::path& directory, const std::string& asked_end) {
  Resumption out;
  out.checkpoint = read_checkpoint(directory);
  const Json& made = out.checkpoint.made;
  if (!keep_options(made.value("options", Json()), out.words)) {
    throw Error(Error::Category::file, "bad-checkpoint",
                fmt::format("'{}' does not say how the run was made", (directory / checkpoint_name).string()));
  }
  require_same_program(out.checkpoint);
  const Json record = made.value("provenance", Json::object());
  for (const Json& plugin : record.value("plugins", Json::array())) {
    out.recorded_plugins.push_back(plugin.value("file", ""));
  }
  out.model = (directory / made.value("model_copy", "model.yaml")).string();
  out.model_name = record.value("model", Json::object()).value("name", "");
  const double end = number_at(made, "/settings/end");
  out.interval = number_at(made, "/settings/interval");
  const Json summary = summary_of(directory);
  const std::string status = summary.value("status", "");
  const double reached = status.empty() ? 0.0 : number_at(summary, "/time/reached");
  const double later = asked_end.empty() ? end : positive_quantity("--end", asked_end, dimension::time);
  if (!asked_end.empty() && later < end) {
    const double at = std::max(reached, out.checkpoint.state ? out.checkpoint.state->time : 0.0);
    bad_value("--end", asked_end,
              fmt::format("the run went to {0:g} s and is to end at {1:g} s: it can end later, not before", at, end));
  }
  const bool no_twin =
      out.words.twin && summary.value("twin", Json()).is_null() && !has_no_comparison(directory, summary);
  const bool ended = status == "stopped" || status == "completed", there = status == "stopped" || later == end;
  if (ended) require_whole(directory, summary, record);
  if (ended && there && !no_twin) {
    out.nothing_to_do = fmt::format("{} at {:g} s", status, reached);
    return out;
  }
  if (later != end || ended) {
    out.goes_on = false;
    if (later != end) out.words.end = asked_end;
  }
  // Those beside it need every channel of all rows.
  if (out.words.verify || out.words.twin) out.checkpoint = Checkpoint{.made = Json(made)};
  return out;
}

void require_same_making(const Checkpoint& checkpoint, const Json& now) {
  const Json& then = checkpoint.made["provenance"];
  require_same("the model", then["model"]["sha256"], now["model"]["sha256"]);
  for (const char* kind : {"inputs", "plugins"}) {
    const Json &before = then[kind], &after = now[kind];
    if (before.size() != after.size())
      mismatch(fmt::format("the number of {}", kind), words_of(before.size()), words_of(after.size()));
    for (std::size_t i = 0; i < before.size(); ++i) {
      require_same(fmt::format("'{}' of the {}", words_of(before[i]["name"]), kind), before[i]["sha256"],
                   after[i]["sha256"]);
    }
  }
}

void require_same_settings(const Checkpoint& checkpoint, const Json& now) {
  const Json& then = checkpoint.made["settings"];
  for (const auto& [name, value] : now.items()) {
    require_same(fmt::format("'{}' of the settings", name), then.value(name, Json()), value);
  }
}

}  // namespace freeplay
