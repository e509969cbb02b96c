#include "results/derived_table.h"

#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "results/divergence.h"
#include "results/hdf5_writer.h"
#include "results/poincare_section.h"
#include "results/row_grid.h"
#include "results/spectrum.h"

namespace freeplay {
namespace {

/// Columns of a result in memory.
struct Columns {
  std::vector<std::vector<double>> values;  // the first is time

  std::span<const double> time() const { return values.front(); }
  std::vector<std::span<const double>> channels() const { return {values.begin() + 1, values.end()}; }
};

Columns read_columns(ResultReader& reader, const std::vector<std::size_t>& picked, const RowWindow& window) {
  Columns columns{std::vector<std::vector<double>>(picked.size())};
  reader.rows(picked, window, [&](std::span<const double> block) {
    for (std::size_t i = 0; i < block.size(); ++i) columns.values[i % picked.size()].push_back(block[i]);
  });
  return columns;
}

void put_row(DerivedTable& table, double first, const std::vector<std::vector<double>>& columns, std::size_t row) {
  table.rows.push_back(first);
  for (const std::vector<double>& column : columns) table.rows.push_back(column[row]);
}

DerivedTable spectra_of(const Columns& columns, const RowGrid& grid) {
  const Spectrum spectrum = freeplay::spectrum(grid, columns.channels());
  DerivedTable out;
  out.columns.push_back({"frequency", "1/s", "frequency", "spectrum with a Hann window"});
  for (std::size_t k = 0; k < spectrum.frequency.size(); ++k)
    put_row(out, spectrum.frequency[k], spectrum.amplitudes, k);
  out.until = columns.time()[grid.rows.back()];
  out.from = out.until - 1.0 / spectrum.frequency[1] + grid.interval;
  out.summary = {{"resolution", spectrum.resolution}, {"estimate", true}};
  return out;
}

DerivedTable section_of(const Columns& columns, double phase, double period, const std::vector<RecordColumn>& names) {
  const PoincareSection section = poincare_section(columns.time(), columns.channels(), phase, period);
  DerivedTable out;
  out.columns.push_back({"time", "s", "time", "Poincare section"});
  for (std::size_t k = 0; k < section.time.size(); ++k) put_row(out, section.time[k], section.values, k);
  Json uncertainty = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i)
    append(uncertainty, names[i].name, json_number(section.uncertainty[i]));
  out.summary = {{"uncertainty", std::move(uncertainty)}, {"estimate", true}};
  return out;
}

DerivedTable divergence_of(const Columns& columns, const RowGrid& grid, double period) {
  const Divergence divergence = freeplay::divergence(grid, columns.channels(), period);
  DerivedTable out;
  const std::string source = "Rosenstein, Collins, De Luca 1993";
  out.columns = {{"time", "s", "time after the nearest approach", source},
                 {"divergence", "1", "mean logarithm of the distance of neighbours", source}};
  for (std::size_t k = 0; k < divergence.time.size(); ++k) {
    out.rows.push_back(divergence.time[k]);
    out.rows.push_back(divergence.logarithm[k]);
  }
  out.summary = {{"lyapunov", json_number(divergence.exponent)},
                 {"uncertainty", json_number(divergence.uncertainty)},
                 {"points", divergence.points},
                 {"estimate", true}};
  return out;
}

}  // namespace

CountedTime counted_time(const ResultReader& reader, double first_time) {
  CountedTime out{first_time, 0.0, first_time};
  for (const auto& [name, text] : reader.layout().attributes) {
    if (name != "settings") continue;
    const Json settings = Json::parse(text, nullptr, false);
    if (!settings.is_object()) continue;
    out.origin = settings.value("start", first_time);
    out.from = out.origin + settings.value("discard", 0.0);
    out.interval = settings.value("interval", 0.0);
  }
  return out;
}

DerivedTable derived_table(ResultReader& reader, const std::string& table, const std::vector<std::size_t>& picked,
                           const RowWindow& window, double period, std::optional<double> phase) {
  const Columns columns = read_columns(reader, picked, window);
  CountedTime counted = counted_time(reader, columns.time().empty() ? 0.0 : columns.time().front());
  if (std::isfinite(window.from)) counted.from = window.from;
  std::vector<RecordColumn> names;
  for (std::size_t i = 1; i < picked.size(); ++i) names.push_back(reader.layout().columns[picked[i]]);
  const auto grid = [&] { return RowGrid::of(columns.time(), counted.origin, counted.from, counted.interval); };
  DerivedTable out = table == "spectra"    ? spectra_of(columns, grid())
                     : table == "poincare" ? section_of(columns, phase.value_or(counted.from), period, names)
                                           : divergence_of(columns, grid(), period);
  if (table != "lyapunov") out.columns.insert(out.columns.end(), names.begin(), names.end());
  return out;
}

DerivedTable bearing_table(ResultReader& reader) {
  DerivedTable out;
  const std::string source = "integrals over accepted steps";
  out.columns = {{"joint", "1", "joint with play", source}, {"angle", "rad", "centre of the bearing sector", source}};
  std::vector<std::vector<double>> tables;
  for (const BearingQuantity& quantity : bearing_quantities()) {
    out.columns.push_back({quantity.name, quantity.unit, quantity.long_name, source});
    tables.push_back(reader.bearing(quantity.name));
  }
  const std::size_t joints = reader.layout().bearings.size();
  if (joints == 0 || tables.front().size() != joints * bearing_sectors) {
    unreadable_result(reader.file(), "it has no tables by bearing sector", 0,
                      "results.h5 of a run that came to its end has them, where a joint has play");
  }
  for (std::size_t i = 0; i < joints * bearing_sectors; ++i) {
    const std::size_t joint = i / bearing_sectors;
    const double sector = static_cast<double>(i % bearing_sectors) + 0.5;
    out.rows.push_back(static_cast<double>(joint));
    out.rows.push_back(sector * (2.0 * std::numbers::pi / static_cast<double>(bearing_sectors)));
    for (const std::vector<double>& table : tables) out.rows.push_back(table[i]);
  }
  return out;
}

}  // namespace freeplay
