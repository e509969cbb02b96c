// RowMemory: the rows of a run kept as a table.
#pragma once

#include "results/table.h"
#include "run/sink.h"

namespace freeplay {

/// Keeps every channel of every row of the output grid: two runs have these in common.
class RowMemory : public Sink {
 public:
  explicit RowMemory(const Channels& channels) {
    for (const ChannelInfo& channel : channels.all()) table_.names.push_back(channel.name);
    table_.values.resize(table_.names.size());
  }

  void row(std::span<const double> values) override {
    for (std::size_t i = 0; i < values.size(); ++i) table_.values[i].push_back(values[i]);
  }
  void row_in_contact(std::span<const double>) override {}
  void event(const EventRecord&) override {}
  bool ok() const override { return true; }

  const ResultTable& table() const { return table_; }

 private:
  ResultTable table_;
};

}  // namespace freeplay
