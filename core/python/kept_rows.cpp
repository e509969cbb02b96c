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

}  // namespace freeplay
