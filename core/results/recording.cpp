#include "results/recording.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/sha256.h"
#include "base/version.h"
#include "model/channel_selection.h"
#include "results/record_layout.h"
#include "results/summary.h"

namespace freeplay {
namespace {

std::string compact(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

RecordLayout layout_of(const Model& model, const Channels& channels, std::span<const std::size_t> picked,
                       const Json& provenance) {
  const bool described = model.settings.format != ResultFormat::csv;
  RecordLayout layout = record_layout(model, channels, picked, described);
  if (described) layout.attributes = attributes_of(model, provenance);
  return layout;
}

/// Of the whole run; what it does not reach leaves chunks a little larger.
std::size_t expected_rows(const Settings& settings) {
  const double rows = (settings.end - settings.start) / settings.interval + 1.0;
  return static_cast<std::size_t>(std::clamp(std::ceil(rows), 1.0, 1e9));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> attributes_of(const Model& model, const Json& provenance) {
  Json inputs = Json::array();
  for (const InputFile& input : model.inputs) {
    inputs.push_back({{"name", input.name}, {"sha256", sha256(input.text)}, {"text", input.text}});
  }
  return {{"Conventions", "Freeplay-1"},
          {"title", model.name},
          {"freeplay_version", program_version},
          {"model", model.text},
          {"model_sha256", sha256(model.text)},
          {"inputs", compact(inputs)},
          {"settings", compact(settings_json(model))},
          {"provenance", compact(provenance)}};
}

Recording::Recording(const std::filesystem::path& path, bool force, const Model& model, const Channels& channels,
                     const Making& making)
    : Recording(ResultDirectory(path, force), model, channels, making, nullptr) {}

Recording::Recording(ResultDirectory directory, const Model& model, const Channels& channels, const Making& making,
                     const KeptPart* kept)
    : directory_(std::move(directory)),
      log_(directory_.file("run.log"), kept == nullptr ? GrowingFile::Begin::empty : GrowingFile::Begin::append),
      provenance_(freeplay::provenance(model, making)),
      picked_(select_channels(channels, model.settings.channels)),
      layout_(layout_of(model, channels, picked_, provenance_)),
      format_(model.settings.format),
      events_given_(kept == nullptr ? 0 : kept->events),
      thread_(picked_.size(), kept == nullptr ? start_writers(model) : continued_writers(model, *kept)),
      events_(model, layout_,
              [this](std::span<const double> numbers) {
                ++events_given_;
                thread_.add_event(numbers);
              }),
      advice_(model) {
  if (format_ == ResultFormat::csv) std::vector<RecordColumn>().swap(layout_.columns);  // the text has its header
  if (kept != nullptr) return;
  directory_.write(model_copy_name(model), model.text);
  for (const InputFile& input : model.inputs) directory_.write("inputs/" + input.name, input.text);
}

RecordThread::Writers Recording::continued_writers(const Model& model, const KeptPart& part) {
  if (part.rows == 0 && part.events == 0) {  // not even a header may be there
    directory_.remove("summary.json");
    return start_writers(model);
  }
  KeptFiles kept =
      read_kept(directory_.path(), part, format_, layout_, {.expected_rows = expected_rows(model.settings)});
  cut_back(directory_.path(), kept, format_);
  directory_.remove("summary.json");
  RecordThread::Writers writers;
  auto events = std::make_unique<EventTextWriter>(directory_.file("events.csv"), layout_, kept.event_text);
  row_hash_ = kept.row_hash.get();
  event_text_ = events.get();
  hdf5_ = kept.hdf5.get();
  writers.push_back(std::move(kept.row_hash));
  writers.push_back(std::move(events));
  if (format_ != ResultFormat::hdf5) {
    writers.push_back(std::make_unique<RowTextWriter>(directory_.file("results.csv"), layout_, kept.text_rows));
  }
  if (hdf5_ != nullptr) writers.push_back(std::move(kept.hdf5));
  return writers;
}

RecordThread::Writers Recording::start_writers(const Model& model) {
  RecordThread::Writers writers;
  auto hash = std::make_unique<RowHash>();
  auto events = std::make_unique<EventTextWriter>(directory_.file("events.csv"), layout_);
  row_hash_ = hash.get();
  event_text_ = events.get();
  writers.push_back(std::move(hash));
  writers.push_back(std::move(events));
  if (format_ != ResultFormat::hdf5) {
    writers.push_back(std::make_unique<RowTextWriter>(directory_.file("results.csv"), layout_));
  }
  if (format_ != ResultFormat::csv) {
    const Hdf5Writer::Options options{.expected_rows = expected_rows(model.settings), .grows = true};
    auto hdf5 = std::make_unique<Hdf5Writer>(directory_.file("results.h5"), layout_, options);
    hdf5_ = hdf5.get();
    writers.push_back(std::move(hdf5));
  }
  return writers;
}

void Recording::when_safe(std::function<void()> then) { thread_.when_safe(std::move(then)); }

bool Recording::in_place() const {
  std::error_code error;
  const auto is_there = [&](const char* name) { return std::filesystem::exists(directory_.file(name), error); };
  return directory_.there() && is_there("events.csv") && (format_ == ResultFormat::hdf5 || is_there("results.csv")) &&
         (hdf5_ == nullptr || !hdf5_->placed() || is_there("results.h5"));
}

std::string Recording::close() {
  events_.finish();
  std::string failure = thread_.close();
  try {
    directory_.require_there();
  } catch (const Error& error) {
    failure = error.message();  // whatever came of it
  }
  try {
    log_.close();
  } catch (const Error& error) {
    if (failure.empty()) failure = error.message();
  }
  return failure;
}

BearingTables bearing_tables(const RecordLayout& layout, const ClearanceStatistics& clearances) {
  constexpr std::pair<const char*, BearingTable::Column BearingTable::*> all[] = {
      {"contact_time", &BearingTable::contact_time}, {"impulse", &BearingTable::impulse},
      {"sliding", &BearingTable::sliding},           {"work", &BearingTable::work},
      {"pv_mean", &BearingTable::pv_mean},           {"pv_max", &BearingTable::pv_max}};
  BearingTable::Column unknown;
  unknown.fill(std::numeric_limits<double>::quiet_NaN());
  BearingTables tables;
  for (const std::string& name : layout.bearings) {
    const int joint = static_cast<int>(std::ranges::find(layout.joints, name) - layout.joints.begin());
    const bool has_table = clearances.has_table(joint);
    const BearingTable table = has_table ? clearances.table(joint) : BearingTable{};
    for (const auto& [quantity, column] : all) {
      const BearingTable::Column& numbers = has_table ? table.*column : unknown;
      std::vector<double>& out = tables[quantity];
      out.insert(out.end(), numbers.begin(), numbers.end());
    }
  }
  return tables;
}

void Recording::bearing(const ClearanceStatistics& clearances) { tables_ = bearing_tables(layout_, clearances); }

Json Recording::hashes() const {
  // Of all that was given to the files; where one of them failed they hold less.
  if (!ok()) return {{"rows", nullptr}, {"events", nullptr}};
  return {{"rows", row_hash_->digits()}, {"events", event_text_->digits()}};
}

std::vector<std::string> Recording::files() {
  names_ = directory_.files();
  std::vector<std::string> names = names_;
  names.insert(std::ranges::lower_bound(names, "summary.json"), "summary.json");
  return names;
}

void Recording::seal(const Json& summary) {
  directory_.require_all(names_);
  const std::string text = json_text(summary);
  if (hdf5_ != nullptr && hdf5_->failure().empty() && thread_.ok()) {
    hdf5_->finish(tables_, text);
    if (!hdf5_->failure().empty()) throw Error(Error::Category::file, "cannot-write", hdf5_->failure());
  }
  directory_.write("summary.json", text);
}

}  // namespace freeplay
