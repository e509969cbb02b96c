#include "python/kept_run.h"

#include <algorithm>
#include <span>
#include <utility>

#include "results/directory.h"
#include "results/record_thread.h"
#include "results/recording.h"
#include "results/text_writers.h"

namespace freeplay {
namespace {

/// Writes rows and events of `run` in blocks.
void write_rows(const KeptRun& run, std::span<const std::unique_ptr<RecordWriter>> writers) {
  constexpr std::size_t rows_at_once = 1024;
  const ColumnBlock& block = run.record.block;
  std::vector<double> rows;
  for (std::size_t row = 0; row < block.rows(); ++row) {
    for (std::size_t column = 0; column < block.columns(); ++column) rows.push_back(block.at(row, column));
    if ((row + 1) % rows_at_once != 0 && row + 1 < block.rows()) continue;
    for (const auto& writer : writers) writer->write({rows, {}});
    rows.clear();
  }
  for (const auto& writer : writers) {
    writer->write({{}, run.record.events});
    writer->close();
    if (!writer->failure().empty()) throw Error(Error::Category::file, "cannot-write", writer->failure());
  }
}

}  // namespace

void save_run(const KeptRun& run, const std::filesystem::path& path, bool force, ResultFormat format) {
  const Model& model = run.model->model();
  check_result_directory(path, force);
  const ResultDirectory directory(path, force);
  directory.write(model_copy_name(model), model.text);
  for (const InputFile& input : model.inputs) directory.write("inputs/" + input.name, input.text);
  if (!run.inputs.empty()) directory.write("inputs.csv", run.inputs);
  if (!run.asked.name.empty()) directory.write("inputs/" + run.asked.name, run.asked.text);
  const RecordLayout& layout = run.record.layout;
  RecordLayout whole = layout;
  std::vector<std::unique_ptr<RecordWriter>> writers;
  writers.push_back(std::make_unique<EventTextWriter>(directory.file("events.csv"), layout));
  if (format != ResultFormat::hdf5) {
    writers.push_back(std::make_unique<RowTextWriter>(directory.file("results.csv"), layout));
  }
  Hdf5Writer* hdf5 = nullptr;
  if (format != ResultFormat::csv) {
    whole.attributes = attributes_of(model, run.summary.value("provenance", Json()));
    auto writer = std::make_unique<Hdf5Writer>(
        directory.file("results.h5"), whole,
        Hdf5Writer::Options{.expected_rows = std::max<std::size_t>(run.record.block.rows(), 1)});
    hdf5 = writer.get();
    writers.push_back(std::move(writer));
  }
  write_rows(run, writers);
  Json summary = run.summary;
  std::vector<std::string> files = directory.files();
  files.insert(std::ranges::lower_bound(files, "summary.json"), "summary.json");
  summary["files"] = files;
  if (hdf5 != nullptr) {
    hdf5->finish(run.bearings, json_text(summary));
    if (!hdf5->failure().empty()) throw Error(Error::Category::file, "cannot-write", hdf5->failure());
  }
  directory.write("summary.json", json_text(summary));
}

}  // namespace freeplay
