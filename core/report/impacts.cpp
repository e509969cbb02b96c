#include "report/impacts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "report/base64.h"

namespace freeplay {
namespace {

constexpr std::size_t most_windows = 20, most_rows = 64;

std::size_t place(const std::vector<RecordColumn>& columns, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(columns, name, &RecordColumn::name) - columns.begin());
}

std::string word(const std::vector<std::string>& words, double index) {
  const auto i = static_cast<std::size_t>(index);
  return index >= 0.0 && i < words.size() ? words[i] : std::string();
}

}  // namespace

Impacts::Impacts(ResultReader& reader, const RowWindow& window) {
  const std::vector<RecordColumn>& columns = reader.layout().events;
  const std::size_t width = columns.size(), kind = place(columns, "kind"), joint = place(columns, "joint");
  const std::size_t force = place(columns, "max_fn"), duration = place(columns, "duration");
  if (width == 0 || std::max({kind, joint, force, duration}) >= width) return;
  for (const RecordColumn& column : columns) columns_.push_back(column.name);
  reader.events([&](std::span<const double> block) {
    for (; !block.empty(); block = block.subspan(width)) {
      const double time = block[0];
      if (time < window.from || time > window.until) continue;
      if (word(reader.layout().kinds, block[kind]) != "contact_end") continue;
      const double lasted = std::isfinite(block[duration]) ? block[duration] : 0.0;
      impacts_.push_back({{block.begin(), block.begin() + static_cast<std::ptrdiff_t>(width)},
                          word(reader.layout().joints, block[joint]),
                          time - lasted,
                          time,
                          std::isfinite(block[force]) ? block[force] : -1.0});
    }
  });
  std::ranges::stable_sort(impacts_, std::greater{}, &Impact::force);
}

Json Impacts::json(std::size_t most) const {
  std::vector<const Impact*> shown;
  for (const Impact& impact : impacts_) {
    if (shown.size() < most) shown.push_back(&impact);
  }
  std::ranges::stable_sort(shown, {}, &Impact::end);
  Json rows = Json::array();
  for (const Impact* impact : shown) {
    Json row = Json::array();
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i] == "joint") {
        row.push_back(impact->joint);
      } else if (columns_[i] == "kind") {
        row.push_back("contact_end");
      } else {
        row.push_back(json_number(impact->numbers[i]));
      }
    }
    rows.push_back(std::move(row));
  }
  return {{"columns", columns_}, {"rows", std::move(rows)}, {"total", impacts_.size()}};
}

ImpactWindows::ImpactWindows(const Impacts& impacts, std::span<const JointChannels> joints, double interval,
                             std::size_t numbers) {
  std::map<std::string, std::size_t> count;
  std::size_t planned = 0;
  if (!(interval > 0.0)) return;
  for (const Impact& impact : impacts.largest()) {
    const auto joint = std::ranges::find(joints, impact.joint, &JointChannels::joint);
    if (joint == joints.end() || joint->channels.empty() || count[impact.joint] >= most_windows) continue;
    const double lasted = (impact.end - impact.begin) / interval + 6.0;
    const std::size_t rows = lasted < static_cast<double>(most_rows) ? static_cast<std::size_t>(lasted) : most_rows;
    if (planned + rows * joint->channels.size() > numbers) break;
    planned += rows * joint->channels.size();
    ++count[impact.joint];
    const double reach = (2.0 + 1e-9) * interval;
    windows_.push_back({&*joint, impact.begin - reach, impact.end + reach, rows});
  }
  for (std::size_t i = 0; i < windows_.size(); ++i) order_.push_back(i);
  std::ranges::stable_sort(order_, {}, [&](std::size_t i) { return windows_[i].from; });
}

void ImpactWindows::row(std::span<const double> row) {
  const double time = row[0];
  for (; next_ < order_.size() && windows_[order_[next_]].from <= time; ++next_) {
    windows_[order_[next_]].first = row_;
    open_.push_back(order_[next_]);
  }
  ++row_;
  std::erase_if(open_, [&](std::size_t i) {
    Window& window = windows_[i];
    if (time > window.until || window.times.size() >= window.most_rows) return true;
    window.times.push_back(time);
    for (const std::size_t channel : window.joint->channels) window.values.push_back(row[channel + 1]);
    return false;
  });
}

std::size_t ImpactWindows::size(std::span<const std::string> names) const {
  std::size_t size = 2;
  for (const Window& window : windows_) {
    size += 100 + window.joint->joint.size() + base64_size(8 * window.most_rows);
    for (const std::size_t channel : window.joint->channels)
      size += 60 + names[channel].size() + base64_size(4 * window.most_rows);
  }
  return size;
}

Json ImpactWindows::json(const Courses& courses, std::span<const std::string> names) const {
  Json list = Json::array();
  for (const Window& window : windows_) {
    if (window.times.empty()) continue;
    const std::vector<std::size_t>& channels = window.joint->channels;
    Json values = Json::object();
    for (std::size_t c = 0; c < channels.size(); ++c) {
      std::vector<double> column;
      for (std::size_t r = 0; r < window.times.size(); ++r) column.push_back(window.values[r * channels.size() + c]);
      const double offset = courses.offset(channels[c]);
      append(values, names[channels[c]], {{"offset", offset}, {"values", base64_floats(column, offset)}});
    }
    list.push_back({{"joint", window.joint->joint},
                    {"first", window.first},
                    {"rows", window.times.size()},
                    {"times", base64_numbers<double>(window.times)},
                    {"channels", std::move(values)}});
  }
  return list;
}

}  // namespace freeplay
