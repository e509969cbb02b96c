#include "python/kept_rows.h"

#include <algorithm>
#include <cmath>

#include "model/channel_selection.h"
#include "results/record_layout.h"
#include "results/text_writers.h"

namespace freeplay {
namespace {

std::size_t expected_rows(const Settings& settings) {
  constexpr double rounding = 2.0;  // the end is a row even where it is no instant of the grid
  return static_cast<std::size_t>(
      std::clamp(std::ceil((settings.end - settings.start) / settings.interval) + rounding, 1.0, 1e15));
}

}  // namespace

KeptRows::KeptRows(const Model& model, const Channels& channels)
    : picked_(select_channels(channels, model.settings.channels)),
      layout_(record_layout(model, channels, picked_)),
      block_(picked_.size(), expected_rows(model.settings)),
      row_(picked_.size()),
      sink_(model, layout_, [this](std::span<const double> numbers) { take_event(numbers); }) {
  const std::string header = text_header(layout_.events);
  event_hash_.add(header.data(), header.size());
}

void KeptRows::row(std::span<const double> values) {
  for (std::size_t i = 0; i < picked_.size(); ++i) row_[i] = values[picked_[i]];
  block_.add(row_);
  row_hash_.write({row_, {}});
  sink_.row(values);
}

void KeptRows::take_event(std::span<const double> numbers) {
  events_.insert(events_.end(), numbers.begin(), numbers.end());
  line_.clear();
  EventTextWriter::append(line_, layout_, numbers);
  line_ += '\n';
  event_hash_.add(line_.data(), line_.size());
}

Json KeptRows::hashes() const { return {{"rows", row_hash_.digits()}, {"events", event_hash_.digits()}}; }

void KeptRows::save(ArchiveWriter& archive) const {
  std::vector<double> rows;
  for (std::size_t row = 0; row < block_.rows(); ++row) {
    for (std::size_t column = 0; column < block_.columns(); ++column) rows.push_back(block_.at(row, column));
  }
  archive.list(rows);
  archive.list(events_);
  archive(sink_);
}

void KeptRows::restore(ArchiveReader& archive) {
  std::vector<double> rows, events;
  archive.list(rows);
  archive.list(events);
  archive(sink_);
  const std::size_t width = picked_.size(), event_width = layout_.events.size();
  ArchiveReader::require(rows.size() % width == 0 && events.size() % event_width == 0);
  for (std::size_t at = 0; at < rows.size(); at += width) {
    std::copy_n(&rows[at], width, row_.begin());
    block_.add(row_);
    row_hash_.write({row_, {}});
  }
  for (std::size_t at = 0; at < events.size(); at += event_width) {
    take_event(std::span(events).subspan(at, event_width));
  }
}

}  // namespace freeplay
