// Recording: the files of one run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/archive.h"
#include "base/json_text.h"
#include "model/channel.h"
#include "results/contact_advice.h"
#include "results/directory.h"
#include "results/event_sink.h"
#include "results/hdf5_writer.h"
#include "results/kept_part.h"
#include "results/provenance.h"
#include "results/record.h"
#include "results/record_thread.h"
#include "results/row_hash.h"
#include "results/run_log.h"
#include "results/text_writers.h"
#include "run/clearance_statistics.h"

namespace freeplay {

/// Tables by bearing sector of a run that has ended.
BearingTables bearing_tables(const RecordLayout& layout, const ClearanceStatistics& clearances);

/// What results.h5 says of itself as a whole: what made it, and from what.
std::vector<std::pair<std::string, std::string>> attributes_of(const Model& model, const Json& provenance);

/// The files of one run, from the open directory to the sealed summary.
class Recording {
 public:
  /// Makes the directory, replaces an earlier result in it (`force`: beside other files) and writes the model and its
  /// inputs. `model` outlives the recording. Throws Error{file}.
  Recording(const std::filesystem::path& path, bool force, const Model& model, const Channels& channels,
            const Making& making);
  /// Goes on in the result of the same model that is in `path`: cuts rows and events to those kept, removes the summary
  /// and continues the log. Throws Error{file}: "bad-checkpoint" where a file holds fewer, before anything is changed.
  static Recording go_on(const std::filesystem::path& path, const Model& model, const Channels& channels,
                         const Making& making, const KeptPart& kept) {
    return Recording(ResultDirectory(path), model, channels, making, &kept);
  }
  Recording(const Recording&) = delete;

  /// What waits to be written, and what was counted, for a checkpoint between two steps; restored before the first.
  void save(Archive& archive) const { ArchiveWriter{archive}(events_, advice_); }
  void restore(const Archive& archive) {
    ArchiveReader reader(archive);
    reader(events_, advice_);
    reader.finish();
  }
  /// Events given to the files so far.
  std::int64_t events() const { return events_given_; }

  /// Where rows and events of the run go.
  std::vector<Sink*> sinks() { return {&rows_, &events_, &advice_}; }
  /// False once a file could not be written, or was removed.
  bool ok() const { return thread_.ok(); }
  /// Once all rows and events so far are safe on the disk, calls `then` in the thread that writes; does not wait.
  /// hashes() are then of these alone.
  void when_safe(std::function<void()> then);
  /// False where nothing keeps other processes out of the directory.
  bool guarded() const { return directory_.guarded(); }
  /// False once the directory or a file that grows was removed, or another took its place. After close().
  bool in_place() const;
  /// Throws Error{file} unless the directory is there.
  void require_directory() const { directory_.require_there(); }
  RunLog& log() { return log_; }
  /// One more file of the result, before files(). Throws Error{file}.
  void add(std::string_view name, std::string_view text) const { directory_.write(name, text); }
  const ContactAdvice& advice() const { return advice_; }
  /// Tables of /bearing, for seal().
  void bearing(const ClearanceStatistics& clearances);

  /// Ends the growing files. Returns the first failure to write any of them, empty without: "cannot write 'FILE':
  /// REASON".
  std::string close();
  /// After close(): false where another program removed, replaced or changed a file: who knows what it holds.
  bool undisturbed() const { return in_place() && !thread_.disturbed(); }
  /// After close(): rows that every file holds.
  HeldRows held() const { return thread_.held(); }
  /// Processor time of the thread that writes [s].
  double text_seconds() const { return thread_.thread_seconds(); }
  /// The fields `provenance` and `hashes` of the summary; these are unknown where a file could not be written.
  const Json& provenance() const { return provenance_; }
  Json hashes() const;

  /// Sorted names of all files, with the summary, which seal() writes.
  std::vector<std::string> files();
  /// Writes the summary into results.h5 and as summary.json. Throws Error{file}, also where a file that the summary
  /// names has gone since files().
  void seal(const Json& summary);

 private:
  class Rows : public Sink {
   public:
    explicit Rows(Recording& recording) : recording_(recording) {}
    void row(std::span<const double> values) override { recording_.thread_.add_row(values, recording_.picked_); }
    void event(const EventRecord&) override {}
    bool ok() const override { return recording_.ok(); }

   private:
    Recording& recording_;
  };
  Recording(ResultDirectory directory, const Model& model, const Channels& channels, const Making& making,
            const KeptPart* kept);
  RecordThread::Writers start_writers(const Model& model);
  RecordThread::Writers continued_writers(const Model& model, const KeptPart& part);

  ResultDirectory directory_;
  RunLog log_;
  Json provenance_;
  std::vector<std::size_t> picked_;
  RecordLayout layout_;
  ResultFormat format_;
  std::int64_t events_given_;
  // Of the thread, which owns them.
  RowHash* row_hash_ = nullptr;
  EventTextWriter* event_text_ = nullptr;
  Hdf5Writer* hdf5_ = nullptr;
  RecordThread thread_;
  Rows rows_{*this};
  EventSink events_;
  ContactAdvice advice_;
  BearingTables tables_;
  std::vector<std::string> names_;  // of the files that are written
};

}  // namespace freeplay
