// KeptRows: rows and events of a run kept in memory, as its files would hold them.
#pragma once

#include <string>
#include <vector>

#include "base/archive.h"
#include "base/json_text.h"
#include "base/sha256.h"
#include "python/column_block.h"
#include "results/event_sink.h"
#include "results/record.h"
#include "results/row_hash.h"
#include "run/sink.h"

namespace freeplay {

/// Rows and events of a run up to some instant.
struct KeptRecord {
  RecordLayout layout;
  ColumnBlock block;
  std::vector<double> events;  ///< numbers of all, as the layout says
};

class KeptRows : public Sink {
 public:
  /// Throws std::bad_alloc where there is no room for all rows. `model` outlives the run.
  KeptRows(const Model& model, const Channels& channels);
  KeptRows(const KeptRows&) = delete;
  KeptRows& operator=(const KeptRows&) = delete;

  void row(std::span<const double> values) override;
  void event(const EventRecord& record) override { sink_.event(record); }
  void open_contact(const EventRecord& record) override { sink_.open_contact(record); }
  bool ok() const override { return true; }
  /// Takes what still waits, when the run has ended.
  void finish() { sink_.finish(); }

  const RecordLayout& layout() const { return layout_; }
  const ColumnBlock& block() const { return block_; }
  /// What there is now; the memory of the rows is shared.
  KeptRecord record() const { return {layout_, block_, events_}; }
  /// Places of the kept channels in a whole row.
  std::span<const std::size_t> picked() const { return picked_; }
  /// `hashes` of a summary.
  Json hashes() const;
  /// All that there is, for one that goes on from it.
  void save(ArchiveWriter& archive) const;
  void restore(ArchiveReader& archive);

 private:
  void take_event(std::span<const double> numbers);

  std::vector<std::size_t> picked_;
  RecordLayout layout_;
  ColumnBlock block_;
  std::vector<double> row_, events_;
  RowHash row_hash_;
  Sha256 event_hash_;
  std::string line_;
  EventSink sink_;
};

}  // namespace freeplay
