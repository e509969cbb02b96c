// EventSink: the events of a run in order, as rows of a table.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "model/model.h"
#include "results/record.h"
#include "run/sink.h"

namespace freeplay {

/// Columns of events (RecordLayout::events, joints and kinds): time, joint, kind, those of a contact, those of
/// EventRecord::contact, then fields of other names in declaration order.
void add_event_columns(const Model& model, RecordLayout& layout);

/// A field of an event fills the column of its name; the others stay NaN. Rows are sorted by time, then joint in
/// declaration order: events of one step come in any order, so they wait for the next result row, which no event of a
/// later step precedes.
class EventSink : public Sink {
 public:
  using Take = std::function<void(std::span<const double>)>;

  /// `layout` has the columns of the model; `take` gets the numbers of each event.
  EventSink(const Model& model, const RecordLayout& layout, Take take);

  void row(std::span<const double> values) override;
  void event(const EventRecord& record) override;
  /// An event of the kind contact_open, with the prefix that the contact's other events have.
  void open_contact(const EventRecord& record) override;
  bool ok() const override { return true; }
  /// Gives what still waits.
  void finish();

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive.list(self.waiting_);
    archive.list(self.fields_);
  }

 private:
  /// What the run itself says of a contact that ended: the columns from `of_contact` on, whatever the joint tells.
  static constexpr std::size_t of_contact = 10, contact_numbers = 5;
  using ContactNumbers = std::array<double, contact_numbers>;
  struct Waiting {
    double time;
    std::size_t joint, event, first_field, order;
    ContactNumbers contact;
    bool open = false;  // a contact that is on at the end: none waits in a checkpoint
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.time, self.joint, self.event, self.first_field, self.order, self.contact);
    }
  };
  struct OfEvent {
    std::size_t kind;
    std::size_t open_kind;           // of a contact that it would end
    std::vector<std::size_t> place;  // field: its column
  };

  void wait(const EventRecord& record, bool open);
  void give_until(double time);
  void give(const Waiting& event);

  std::vector<std::vector<OfEvent>> events_;  // joint, event
  std::vector<Waiting> waiting_;
  std::vector<double> fields_;   // of the waiting events
  std::vector<double> numbers_;  // of the row in hand
  Take take_;
};

}  // namespace freeplay
