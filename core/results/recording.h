// Recording: the files of one run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "results/contact_advice.h"
#include "results/csv_sink.h"
#include "results/directory.h"
#include "results/event_sink.h"
#include "results/run_log.h"

namespace freeplay {

/// The files of one run, from the open directory to the sealed summary.
class Recording {
 public:
  /// Makes the directory, replaces an earlier result in it (`force`: beside other files) and writes the model and its
  /// inputs. `model` outlives the recording. Throws Error{file}.
  Recording(const std::filesystem::path& path, bool force, const Model& model, const Channels& channels);

  /// Where rows and events of the run go.
  std::vector<Sink*> sinks() { return {&rows_, &events_, &advice_}; }
  RunLog& log() { return log_; }
  const ContactAdvice& advice() const { return advice_; }
  /// Processor time of the thread that makes rows into text [s], after close().
  double text_seconds() const { return rows_.thread_seconds(); }

  /// Hands over what has waited; to be called at least once a second.
  void flush_if_due();
  /// Ends the growing files. Throws Error{file} for the first that could not be written.
  void close();
  /// Sorted names of all files, with the summary, which seal() writes.
  std::vector<std::string> files();
  /// Writes summary.json. Throws Error{file}, also where a file that the summary names has gone since files().
  void seal(const Json& summary);

 private:
  ResultDirectory directory_;
  RunLog log_;
  CsvSink rows_;
  EventSink events_;
  ContactAdvice advice_;
  std::vector<std::string> names_;  // of the files that are written
};

}  // namespace freeplay
