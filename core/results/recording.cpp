#include "results/recording.h"

#include <algorithm>

#include "model/channel_selection.h"

namespace freeplay {

Recording::Recording(const std::filesystem::path& path, bool force, const Model& model, const Channels& channels)
    : directory_(path, force),
      log_(directory_.file("run.log")),
      rows_(directory_.file("results.csv"), channels, select_channels(channels, model.settings.channels)),
      events_(directory_.file("events.csv"), model),
      advice_(model) {
  directory_.write(model_copy_name(model), model.text);
  for (const InputFile& input : model.inputs) directory_.write("inputs/" + input.name, input.text);
}

void Recording::flush_if_due() {
  rows_.flush_if_due();
  events_.flush_if_due();
}

void Recording::close() {
  rows_.close();
  events_.close();
  log_.close();
}

std::vector<std::string> Recording::files() {
  names_ = directory_.files();
  std::vector<std::string> names = names_;
  names.insert(std::ranges::lower_bound(names, "summary.json"), "summary.json");
  return names;
}

void Recording::seal(const Json& summary) {
  directory_.require_all(names_);
  directory_.write("summary.json", json_text(summary));
}

}  // namespace freeplay
