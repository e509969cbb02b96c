// Runs a model from its text and keeps what the run said, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "assembly/assembly.h"
#include "component/registry.h"
#include "load/load.h"
#include "run/simulation.h"
#include "source_folder.h"
#include "system/system.h"

namespace freeplay::test {

inline std::string read_text(const std::string& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || text.str().empty()) throw std::runtime_error("cannot read " + file);
  return text.str();
}

/// Text of one of the models that come with the program.
inline std::string mechanism(const std::string& name) {
  return read_text(std::string(source_folder()) + "/mechanisms/" + name + ".yaml");
}

/// `text` with every `from` replaced; a `from` that is not there is a mistake of the test.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t place = text.find(from);
  if (place == std::string::npos) throw std::runtime_error("the text does not hold: " + from);
  for (; place != std::string::npos; place = text.find(from, place + to.size())) text.replace(place, from.size(), to);
  return text;
}

inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// The figure under `name` in the test report.
inline void record(const std::string& name, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  ::testing::Test::RecordProperty(name, text);
}

inline const Registry& builtin_types() {
  static const Registry registry = Registry::with_builtins();
  return registry;
}

struct Event {
  double time = 0.0;
  std::string joint, kind;
  std::vector<double> fields;
  std::optional<ContactRecord> contact = {};  ///< that it ended
};

/// Keeps every row, or only `chosen` columns of it, and every event.
class RowKeeper final : public Sink {
 public:
  RowKeeper(const Model& model, const Channels& channels, const std::vector<std::string>& chosen) : model_(model) {
    for (const std::string& name : chosen) columns_.push_back(column(channels, name));
    if (chosen.empty()) {
      for (std::size_t i = 0; i < channels.all().size(); ++i) columns_.push_back(i);
    }
    for (const std::size_t c : columns_) names_.push_back(channels.all()[c].name);
  }

  void row(std::span<const double> values) override {
    for (const std::size_t c : columns_) numbers_.push_back(values[c]);
  }
  void event(const EventRecord& record) override {
    const JointElement& joint = model_.joints[static_cast<std::size_t>(record.joint)];
    keep(record, joint, joint.layout.events[static_cast<std::size_t>(record.event)].name);
  }
  void open_contact(const EventRecord& record) override {
    keep(record, model_.joints[static_cast<std::size_t>(record.joint)], "contact_open");
  }
  void keep(const EventRecord& record, const JointElement& joint, std::string_view kind) {
    events_.push_back({record.time,
                       joint.name,
                       std::string(kind),
                       {record.fields.begin(), record.fields.end()},
                       record.contact != nullptr ? std::optional(*record.contact) : std::nullopt});
  }
  bool ok() const override { return true; }

  std::size_t rows() const { return names_.empty() ? 0 : numbers_.size() / names_.size(); }
  double at(std::size_t row, const std::string& name) const {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) throw std::runtime_error("no column " + name);
    return numbers_.at(row * names_.size() + static_cast<std::size_t>(found - names_.begin()));
  }
  const std::vector<double>& numbers() const { return numbers_; }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<Event>& events() const { return events_; }

 private:
  static std::size_t column(const Channels& channels, const std::string& name) {
    const int index = channels.find(name);
    if (index < 0) throw std::runtime_error("no channel " + name);
    return static_cast<std::size_t>(index);
  }

  const Model& model_;
  std::vector<std::size_t> columns_;
  std::vector<std::string> names_;
  std::vector<double> numbers_;
  std::vector<Event> events_;
};

/// A checked model. Mistakes of the text are thrown as std::runtime_error with the report.
inline std::unique_ptr<Model> load(const std::string& text, const BuildOptions& options = {},
                                   const Registry& registry = builtin_types()) {
  LoadedModel loaded = load_text(text, "model.yaml", options, registry);
  if (!loaded.model) throw std::runtime_error(loaded.diagnostics.format(0));
  return std::move(loaded.model);
}

/// A model that was put together and run to its end.
class ModelRun {
 public:
  explicit ModelRun(const std::string& text, const BuildOptions& options = {},
                    const std::vector<std::string>& columns = {}, const Registry& registry = builtin_types(),
                    const RunHooks& hooks = {})
      : model_(load(text, options, registry)),
        system_(*model_),
        start_(assemble(system_)),
        channels_(*model_),
        keeper_(*model_, channels_, columns),
        sinks_{&keeper_},
        simulation_(system_, start_, channels_, sinks_),
        outcome_(simulation_.run(hooks)) {}

  const Model& model() const { return *model_; }
  const System& system() const { return system_; }
  const Start& start() const { return start_; }
  const Outcome& outcome() const { return outcome_; }
  const Statistics& statistics() const { return simulation_.statistics(); }
  const ClearanceStatistics& clearances() const { return simulation_.clearances(); }
  const std::vector<Event>& events() const { return keeper_.events(); }
  const RowKeeper& kept() const { return keeper_; }

  std::size_t rows() const { return keeper_.rows(); }
  double at(std::size_t row, const std::string& name) const { return keeper_.at(row, name); }
  double last(const std::string& name) const { return keeper_.at(keeper_.rows() - 1, name); }

 private:
  std::unique_ptr<Model> model_;
  System system_;
  Start start_;
  Channels channels_;
  RowKeeper keeper_;
  std::vector<Sink*> sinks_;
  Simulation simulation_;
  Outcome outcome_;
};

/// Comma-separated numbers of tests/data below a line of names; lines that begin with # are comments.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};
inline Table read_table(const std::string& name) {
  std::istringstream in(read_text(std::string(source_folder()) + "/tests/data/" + name));
  Table table;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    std::istringstream cells_in(line);
    for (std::string cell; std::getline(cells_in, cell, ',');) cells.push_back(cell);
    if (table.names.empty()) {
      table.names = cells;
      continue;
    }
    std::vector<double>& row = table.rows.emplace_back();
    for (const std::string& cell : cells) row.push_back(std::stod(cell));
  }
  if (table.rows.empty()) throw std::runtime_error("no numbers in " + name);
  return table;
}

/// Largest distance [m] of a run from the numbers of a table at its instants, which must all have a row; an angle
/// counts as a length at the radius 0.05 m.
inline double largest_distance(const ModelRun& run, const Table& table) {
  double worst = 0.0;
  std::size_t row = 0;
  for (const std::vector<double>& numbers : table.rows) {
    while (row < run.rows() && run.at(row, "time") < numbers[0] - 1e-9) ++row;
    if (row >= run.rows() || std::abs(run.at(row, "time") - numbers[0]) > 1e-9) {
      ADD_FAILURE() << "no row at " << numbers[0];
      return std::numeric_limits<double>::infinity();
    }
    for (std::size_t i = 1; i < numbers.size(); ++i) {
      double off = run.at(row, table.names[i]) - numbers[i];
      if (table.names[i].ends_with(".angle")) off = std::remainder(off, 2.0 * M_PI) * 0.05;
      if (!(std::abs(off) <= worst)) worst = std::abs(off);
    }
  }
  return worst;
}

/// Observed order between two errors of steps that differ by a factor of two.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace freeplay::test
