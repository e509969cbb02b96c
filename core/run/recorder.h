// Recorder: rows, events and statistics of a run, and largest values inside the steps that an accuracy chooses.
#pragma once

#include <span>
#include <vector>

#include "run/clearance_statistics.h"
#include "run/contact_ledger.h"
#include "run/contact_rows.h"
#include "run/event_storm.h"
#include "run/impact_maxima.h"
#include "run/left_out_loads.h"
#include "run/observer.h"
#include "run/peak_search.h"
#include "run/sink.h"
#include "run/slip_watch.h"
#include "run/small_difference.h"
#include "run/statistics.h"
#include "run/step_feed.h"
#include "run/step_inside.h"

namespace freeplay {

/// Where a function returns false the run is over, with its outcome filled.
class Recorder {
 public:
  [[gnu::cold]] Recorder(RunContext& run, RunFailure& failure, StepAttempt& attempt, StepInside& inside,
                         std::span<Sink* const> sinks);

  /// The row of the start, with which the account of energy begins.
  bool observe_start();
  /// Makes the row of the accepted state, unless it is known.
  bool know_row();
  /// The same of those columns alone that the run is judged by: in steps that no output needs, the rest of a row
  /// would take longer than they do.
  bool know_loads();
  bool loads_are_known() const { return row_is_known_ || loads_are_known_; }
  void forget_row() { row_is_known_ = loads_are_known_ = contacts_are_known_ = false; }
  /// The last that was made, every channel.
  std::span<const double> row() const { return row_; }

  /// What the row at t, inside or at the end of the step that was made, will hold but for energies that are summed up.
  bool see_ahead(double t, std::span<double> row);

  /// Statistics at the end of a step that was just accepted; of one that ends abruptly before it is.
  bool record_step();
  bool note_abrupt_end();
  /// What acts changes at the accepted state, which stays: statistics go on from the new values.
  bool note_change();
  /// All steps from now on.
  void feed(StepSink* sink) { feed_.feed(sink); }
  /// Events of that step.
  bool write_events();

  /// When the next row is due, and it is written elsewhere.
  double next_row_time() const { return row_time(next_row_); }
  double take_next_row() { return row_time(next_row_++); }
  /// Rows up to the accepted state are written.
  void pass_rows();
  long next_row() const { return next_row_; }
  /// The output instant at t but for `within`, or t where there is none [s].
  double instant_at(double t, double within) const;
  bool write_row();
  /// Rows inside of the step that was made, for files and for what looks at all steps.
  bool write_rows_inside();
  /// Rows that are held back, of a run that ends where it has no row.
  void write_held_rows();
  /// What contacts have taken that are on at the end: into the figures and, unless the run may go on, the list.
  void write_open_contacts();

  const Statistics& statistics() const { return statistics_; }
  const ClearanceStatistics& clearances() const { return clearances_; }
  const SlipWatch& slips() const { return slips_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.statistics_, self.difference_, self.clearances_, self.ledger_, self.maxima_, self.peaks_, self.storm_,
            self.row_, self.row_is_known_, self.next_row_, self.contact_rows_, self.contact_peaks_, self.slips_);
  }

 private:
  struct Ends {  // of a step
    const State& start;
    const Evaluation& e_start;
    const State& end;
    const Evaluation& e_end;
  };
  bool is_left_out() const;
  bool know_contacts();
  bool write_row_at(double t);
  bool see_at(double t, std::span<double> row);
  bool begin_statistics_inside(double until);
  void give_step();
  bool write_contact_rows();
  ContactRows::Give giving();
  void look_back();
  bool look_for_peak(double s, const Ends& step, bool wanted_row);
  void see_contact_end(std::span<const double> row);
  void seek_contact_peaks(const Ends& step);
  bool sinks_are_well();
  bool observe_inside(double t, const Ends& step, std::span<double> row);
  void seek_peaks(const Ends& step);
  [[gnu::cold]] double distance_at(double t, const Ends& step);
  [[gnu::cold]] void doubt_forces(const Ends& step, double t);
  double row_time(long index) const;

  RunContext& run_;
  RunFailure& failure_;
  StepAttempt& attempt_;
  StepInside& inside_;
  std::vector<Sink*> sinks_;
  Observer observer_;
  LeftOutLoads left_out_;
  Statistics statistics_;
  SmallDifference difference_;
  ClearanceStatistics clearances_;
  SlipWatch slips_;
  ContactLedger ledger_;
  ImpactMaxima maxima_;
  PeakSearch peaks_;  // with error control
  ContactRows contact_rows_;
  PeakSearch contact_peaks_;  // the same of each contact
  EventStorm storm_;
  StepFeed feed_;
  std::vector<double> row_, row_between_, row_middle_, row_aside_, residual_;
  bool row_is_known_ = false;        // row_ is that of the accepted state
  bool loads_are_known_ = false;     // its columns that know_loads() makes are
  bool contacts_are_known_ = false;  // of those that joints make of contacts
  std::vector<int> touching_;        // joints whose own channels say something of a contact
  long next_row_ = 1;
};

}  // namespace freeplay
