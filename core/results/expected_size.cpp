#include "results/expected_size.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "model/channel_selection.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr double bytes_of_text = 19.0;   // a number of results.csv with its comma, as results of the mechanisms have it
constexpr double bytes_of_double = 8.0;  // of results.h5
constexpr double largest_chunk_rows = 1024.0;
constexpr double bytes_of_dataset = 2048.0;  // what describes one

double sum_of_sizes(const fs::path& folder) {
  double sum = 0.0;
  for (const char* name : {"results.csv", "results.h5", "events.csv"}) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(folder / name, error);
    if (!error) sum += static_cast<double>(size);
  }
  return sum;
}

}  // namespace

ExpectedSize expected_size(const Model& model, const Channels& channels, std::int64_t rows_there) {
  const Settings& settings = model.settings;
  ExpectedSize size;
  const double all = std::ceil((settings.end - settings.start) / settings.interval) + 1.0;
  size.rows = std::max(all - static_cast<double>(rows_there), 0.0);
  size.columns = static_cast<double>(select_channels(channels, settings.channels).size());
  if (settings.format != ResultFormat::hdf5) size.bytes += bytes_of_text * size.rows * size.columns;
  if (settings.format == ResultFormat::csv) return size;
  // A file that goes on is written anew.
  const double chunk = std::min(all, largest_chunk_rows);
  size.bytes += size.columns * (bytes_of_double * (all + chunk) + bytes_of_dataset);
  return size;
}

std::optional<double> room_for_result(const fs::path& directory, bool replaces) {
  std::error_code error;
  fs::path there = fs::absolute(directory, error);
  while (!error && !fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  const fs::space_info space = fs::space(there, error);
  if (error) return std::nullopt;
  const double back = replaces ? sum_of_sizes(directory) + sum_of_sizes(directory / "twin") : 0.0;
  return static_cast<double>(space.available) + back;
}

std::string bytes_text(double bytes) {
  constexpr const char* units[] = {"bytes", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (; bytes >= 999.5 && unit + 1 < std::size(units); ++unit) bytes /= 1000.0;
  return fmt::format("{:.{}f} {}", bytes, bytes < 9.95 && unit > 0 ? 1 : 0, units[unit]);
}

}  // namespace freeplay
