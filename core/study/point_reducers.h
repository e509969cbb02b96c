// PointReducers: the reducers of a study at one point.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "analysis/table.h"
#include "base/json_text.h"
#include "model/channel.h"
#include "results/event_sink.h"
#include "run/simulation.h"
#include "run/step_sink.h"
#include "study/reducer_entry.h"
#include "workers/outcome.h"

namespace freeplay {

/// The columns that entries give: one each, or those of a set.
class ReducerColumns {
 public:
  /// Columns of sets are those of the joints with play of all `models`.
  ReducerColumns(std::span<const ReducerEntry> entries, std::span<const Model* const> models);

  const std::vector<StudyColumn>& all() const { return all_; }
  const std::vector<StudyColumn>& samples() const { return samples_; }
  /// Where a column of this name stands, or -1.
  int find(std::string_view name) const;
  /// Of an entry: its first column, and its list of samples.
  std::size_t first(std::size_t entry) const { return first_[entry]; }
  std::size_t list(std::size_t entry) const { return list_[entry]; }
  void set_unit(std::size_t column, std::string unit) { all_[column].unit = std::move(unit); }
  void set_sample_unit(std::size_t list, std::string unit) { samples_[list].unit = std::move(unit); }

 private:
  std::vector<StudyColumn> all_, samples_;
  std::unordered_map<std::string, int> by_name_;
  std::vector<std::size_t> first_, list_;
};

/// The numbers of a joint with play in a set, as in summary.json.
struct ClearanceNumber {
  const char* name;
  const char* unit;
  double (*of)(const JointStatistics& seen);
};
std::span<const ClearanceNumber> clearance_numbers();

/// Takes the steps and events of a run, or the table of an analysis. Mistakes of entries are reported to the
/// diagnostics of their reading, whose scope must hold the parameters of the model while this is made.
class PointReducers final : public StepSink {
 public:
  /// A reducer of what the model lacks is a mistake, or has no value: at a point, where a joint may be closed.
  enum class Lacking { mistake, no_value };
  /// `columns` gets the units. All outlive it.
  PointReducers(std::span<const ReducerEntry> entries, ReducerColumns& columns, const Model& model,
                const Channels& channels, Lacking lacking);

  /// Of the run; empty where there is nothing to take.
  std::span<Sink* const> sinks() { return sinks_; }
  bool needs_summary() const { return needs_summary_; }
  bool needs_steps() const { return !timed_.empty() || !sections_.empty(); }

  void step(std::span<const double> row) override;
  void inside(std::span<const double> row) override;
  double next_instant() const override { return next_; }
  void instant(std::span<const double> row) override;
  std::span<const Passage> passages() const override { return passages_; }
  void passed(std::size_t which, std::span<const double> row) override;

  /// After the run; `summary` is called where one is needed.
  void finish(const Statistics& statistics, const std::function<Json()>& summary);
  void finish(const AnalysisTable& table);
  std::vector<double>& values() { return values_; }
  std::vector<std::vector<std::pair<double, double>>>& samples() { return samples_; }

 private:
  struct Window {
    double from = 0.0, until = std::numeric_limits<double>::infinity();
    bool holds(double t) const;
  };
  /// A number at an instant: a channel, or a formula of them.
  struct Course {
    int channel = 0;
    std::optional<Expression> formula{};
    double at(std::span<const double> row) const;
  };
  struct Timed {
    std::size_t column;
    Course course;
    Window window;
    Reduced reduced;
  };
  struct Section {
    std::size_t column, list;
    Course course;
    Window window;
    double begin = 0.0, every = 0.0, next = std::numeric_limits<double>::infinity();
    double turns = 0.0;
  };
  struct OfEvents {
    std::size_t column;
    std::vector<char> joints;
    double kind;
    int field;  // column of events, or -1
    double above;
    Window window;
    Reduced reduced;
  };
  struct OfColumn {
    std::size_t column;
    const ReducerEntry* entry;
    Reduced reduced;
  };
  struct OfOthers {
    std::size_t column;
    Expression formula;
  };

  void bind(const ReducerEntry& entry, std::size_t index);
  void bind_course(const ReducerEntry& entry, std::size_t index);
  void bind_section(const ReducerEntry& entry, std::size_t index, Course course);
  void bind_events(const ReducerEntry& entry, std::size_t index);
  void refuse_events(const ReducerEntry& entry, const std::vector<std::string>& names) const;
  void bind_of(const ReducerEntry& entry, std::size_t index);
  std::optional<Course> course_of(const ReducerEntry& entry, std::string& unit) const;
  int channel_of(const CheckedValue& name) const;
  ReductionRule rule_of(const ReducerEntry& entry, const std::optional<Dimension>& dimension) const;
  Window window_of(const ReducerEntry& entry) const;
  void take_event(std::span<const double> numbers);
  void take_sample(const Section& section, std::span<const double> row);
  void renew_next();
  void fill_sets(const Statistics& statistics);
  void fill_summaries(const Json& summary);
  void fill_others();

  std::span<const ReducerEntry> entries_;
  ReducerColumns& columns_;
  const Model& model_;
  const Channels& channels_;
  Lacking lacking_;
  std::vector<Timed> timed_;
  std::vector<Section> sections_;
  std::vector<std::size_t> passing_;  // by passage: its section
  std::vector<Passage> passages_;
  double next_ = std::numeric_limits<double>::infinity();
  RecordLayout event_layout_;
  std::vector<OfEvents> of_events_;
  std::optional<EventSink> events_;
  std::vector<Sink*> sinks_;
  std::vector<OfColumn> of_columns_;
  std::vector<OfOthers> of_others_;
  bool needs_summary_ = false;
  std::vector<double> values_;
  std::vector<std::vector<std::pair<double, double>>> samples_;
};

}  // namespace freeplay
