// EventSink: events.csv, one row per event of a joint.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/growing_file.h"
#include "model/model.h"
#include "run/sink.h"

namespace freeplay {

/// Columns time, joint, kind, those of a contact, those of EventRecord::contact, then fields of other names in
/// declaration order. A field of an event fills the column of its name; the others stay empty. Rows are sorted by time,
/// then joint in declaration order: events of one step come in any order, so they wait for the next result row, which
/// no event of a later step precedes.
class EventSink : public Sink {
 public:
  /// `model` outlives the sink. Throws Error{file}.
  EventSink(const std::filesystem::path& path, const Model& model);

  void row(std::span<const double> values) override;
  void event(const EventRecord& record) override;
  bool ok() const override { return file_.ok(); }
  void flush_if_due() { file_.flush_if_due(); }
  /// Writes what still waits. Throws Error{file} if anything could not be written.
  void close();

 private:
  /// What the run itself says of a contact that ended: the columns from `of_contact` on, whatever the joint tells.
  static constexpr std::size_t of_contact = 7, contact_numbers = 5;
  using ContactNumbers = std::array<double, contact_numbers>;
  struct Waiting {
    double time;
    std::size_t joint, event, first_field, order;
    ContactNumbers contact;
  };

  std::size_t column(const std::string& name);
  void write_until(double time);
  void write(const Waiting& event);

  const Model& model_;
  std::vector<std::string> columns_;                          // after time, joint and kind
  std::vector<std::vector<std::vector<std::size_t>>> place_;  // joint, event, field: its column
  std::vector<Waiting> waiting_;
  std::vector<double> fields_;  // of the waiting events
  std::vector<double> cells_;   // of the row in hand
  GrowingFile file_;
};

}  // namespace freeplay
