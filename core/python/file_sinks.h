// FileSinks: where rows and events go that are written into files, until another process takes the run on.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "run/sink.h"

namespace freeplay {

class FileSinks final : public Sink {
 public:
  void begin(std::vector<Sink*> sinks) { sinks_ = std::move(sinks); }
  /// Nothing more is given to them.
  void leave() { sinks_.clear(); }

  void row(std::span<const double> values) override {
    for (Sink* const sink : sinks_) sink->row(values);
  }
  void row_in_contact(std::span<const double> values) override {
    for (Sink* const sink : sinks_) sink->row_in_contact(values);
  }
  void event(const EventRecord& record) override {
    for (Sink* const sink : sinks_) sink->event(record);
  }
  void open_contact(const EventRecord& record) override {
    for (Sink* const sink : sinks_) sink->open_contact(record);
  }
  bool ok() const override {
    return std::ranges::all_of(sinks_, [](const Sink* sink) { return sink->ok(); });
  }

 private:
  std::vector<Sink*> sinks_;
};

}  // namespace freeplay
