#include "plot/channel_figure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "plot/flights.h"
#include "plot/polar_figure.h"
#include "results/channel_choice.h"
#include "results/table_view.h"

namespace freeplay::plot {
namespace {

constexpr double px_per_x_tick = 90.0, px_per_y_tick = 40.0, orbit_room = 1.05;
constexpr double least_open = 0.25;  // of the longer side of an orbit: the shorter one
constexpr double most_bins = 60.0, px_per_bin = 8.0, percent = 100.0;

std::string named(const std::string& unit) { return unit.empty() || unit == "1" ? "no unit" : unit; }

/// What the first reading of a result tells.
struct Ranges {
  Extremes time;
  std::vector<Extremes> channels;  ///< over time
  Extremes over;
  std::int64_t rows = 0;
};

class ChannelFigure {
 public:
  ChannelFigure(const std::vector<Source>& sources, const FigureRequest& request)
      : sources_(sources), request_(request) {
    for (const Source& source : sources) {
      figure_.names.push_back(source.name);
      columns_.push_back(columns_.empty() ? columns_of(*source.reader) : columns_beside(*source.reader));
    }
  }

  Figure make() {
    if (request_.view == View::spectrum) {
      draw_spectra();
      return std::move(figure_);
    }
    for (std::size_t s = 0; s < sources_.size(); ++s) ranges_.push_back(read_ranges(s));
    switch (request_.view) {
      case View::orbit:
        draw_orbits();
        break;
      case View::over:
        draw_over();
        break;
      case View::histogram:
        draw_histograms();
        break;
      default:
        draw_over_time();
    }
    return std::move(figure_);
  }

 private:
  const std::vector<RecordColumn>& layout(std::size_t source) const {
    return sources_[source].reader->layout().columns;
  }
  std::size_t channels() const { return columns_[0].size() - first_channel(); }
  /// Columns that are read begin with time, and the one that others are drawn over.
  std::size_t first_channel() const { return request_.view == View::over ? 2 : 1; }
  const RecordColumn& column(std::size_t channel) const { return layout(0)[columns_[0][first_channel() + channel]]; }
  double x_ticks() const { return std::max(2.0, request_.across / px_per_x_tick); }
  double y_ticks() const { return std::max(2.0, request_.down / px_per_y_tick); }

  std::vector<std::size_t> columns_of(const ResultReader& reader) const {
    std::vector<std::size_t> columns{0};
    if (request_.view == View::over) {
      const std::vector<std::size_t> over = chosen_channels(reader, {request_.over});
      if (over.size() != 1) {
        throw Error(
            Error::Category::usage, "bad-value",
            fmt::format("'{}' stands for {} channels, and others are drawn over one", request_.over, over.size()));
      }
      columns.push_back(over[0]);
    }
    for (const std::size_t channel : chosen_channels(reader, request_.channels)) columns.push_back(channel);
    if (request_.view == View::orbit && request_.joint.empty() && columns.size() != 3) {
      throw Error(Error::Category::usage, "bad-value",
                  fmt::format("--xy draws one channel over another, and {} are given", columns.size() - 1));
    }
    if (request_.view == View::orbit) {
      const RecordColumn &x = reader.layout().columns[columns[1]], &y = reader.layout().columns[columns[2]];
      if (x.unit != y.unit) {
        throw Error(Error::Category::usage, "bad-value",
                    fmt::format("--xy has equal scales, and '{}' is in {}, '{}' in {}", x.name, named(x.unit), y.name,
                                named(y.unit)),
                    {}, fmt::format("plot '{}' --x '{}'", y.name, x.name));
      }
    }
    return columns;
  }

  /// The columns that another result draws beside those of the first, which must be all that fit.
  std::vector<std::size_t> columns_beside(const ResultReader& other) const {
    const ResultReader& first = *sources_[0].reader;
    std::vector<std::size_t> columns;
    for (const std::size_t column : columns_[0]) columns.push_back(required(layout(0)[column].name, first, other));
    for (const std::size_t column : columns_of(other)) required(other.layout().columns[column].name, other, first);
    return columns;
  }

  /// Where `other` has a channel of `one`.
  static std::size_t required(const std::string& name, const ResultReader& one, const ResultReader& other) {
    const std::size_t column = other.find(name);
    if (column < other.layout().columns.size()) return column;
    const std::string joint = name.substr(0, name.rfind('.') + 1);
    const auto has = [](const ResultReader& reader, const std::string& channel) {
      return reader.find(channel) < reader.layout().columns.size();
    };
    // Joints with play have a normal force; all have a force.
    const bool rigid = has(one, joint + "fn") && !has(other, joint + "fn") && has(other, joint + "fx");
    throw Error(Error::Category::usage, "unknown-channel",
                fmt::format("'{}' has no channel '{}', which '{}' has", other.file(), name, one.file()), {},
                rigid ? fmt::format("joint '{}' has no play there; draw what both have",
                                    joint.substr(joint.find('.') + 1, joint.size() - joint.find('.') - 2))
                      : "draw what both have");
  }

  template <class Take>
  void each_row(std::size_t source, const Take& take) const {
    const std::size_t width = columns_[source].size();
    sources_[source].reader->rows(columns_[source], request_.window, [&](std::span<const double> block) {
      for (; !block.empty(); block = block.subspan(width)) take(block.first(width));
    });
  }

  /// Time alone where no more is needed, which is quicker.
  Ranges read_ranges(std::size_t source) const {
    Ranges ranges;
    if (request_.view == View::time) {
      sources_[source].reader->rows(std::vector<std::size_t>{0}, request_.window, [&](std::span<const double> block) {
        for (const double time : block) ranges.time.add(time, time);
        ranges.rows += static_cast<std::int64_t>(block.size());
      });
    } else {
      ranges.channels.resize(channels());
      each_row(source, [&](std::span<const double> row) {
        ++ranges.rows;
        ranges.time.add(row[0], row[0]);
        if (request_.view == View::over) ranges.over.add(row[0], row[1]);
        for (std::size_t c = 0; c < channels(); ++c) ranges.channels[c].add(row[0], row[first_channel() + c]);
      });
    }
    if (ranges.rows > 0) return ranges;
    const bool all = std::isinf(request_.window.from) && std::isinf(request_.window.until);
    throw Error(Error::Category::usage, "no-rows",
                fmt::format("'{}' has no rows{}", sources_[source].reader->file(), all ? "" : " in this window"));
  }

  template <class Of>
  Extremes common(const Of& of) const {
    Extremes all;
    for (const Ranges& ranges : ranges_) {
      const Extremes& one = of(ranges);
      all.add(one.least_at, one.least);
      all.add(one.most_at, one.most);
    }
    return all;
  }

  Panel panel(std::size_t channel, svg::Axis x, const std::string& x_unit) const {
    Panel panel;
    panel.channel = panel.title = column(channel).name;
    panel.unit = panel.channel_unit = column(channel).unit;
    panel.x = std::move(x);
    panel.x_unit = x_unit;
    return panel;
  }

  void add_panel(Panel panel, const Extremes& values) {
    panel.y = svg::make_axis(values.least, values.most, panel.unit, y_ticks(), svg::Fit::round);
    figure_.panels.push_back(std::move(panel));
  }

  void draw_over_time() {
    const Extremes time = common([](const Ranges& ranges) -> const Extremes& { return ranges.time; });
    const svg::Axis x = svg::make_axis(time.least, time.most, "s", x_ticks(), svg::Fit::exact);
    std::vector<Panel> panels;
    for (std::size_t c = 0; c < channels(); ++c) panels.push_back(panel(c, x, "s"));
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      std::vector<ColumnCurve> curves(channels(), ColumnCurve(x.from, x.until, static_cast<int>(request_.across)));
      std::vector<Extremes> seen(channels());
      each_row(s, [&](std::span<const double> row) {
        for (std::size_t c = 0; c < channels(); ++c) {
          curves[c].add({row[0], row[1 + c]});
          seen[c].add(row[0], row[1 + c]);
        }
      });
      for (std::size_t c = 0; c < channels(); ++c) {
        panels[c].lines.push_back({curves[c].points(), seen[c], ranges_[s].rows});
      }
    }
    const Flights flights(*sources_[0].reader, x.from, x.until, (x.until - x.from) / request_.across);
    for (Panel& one : panels) {
      one.shaded = flights.of_channel(one.channel);
      Extremes values;
      for (const Line& line : one.lines) {
        values.add(line.seen.least_at, line.seen.least);
        values.add(line.seen.most_at, line.seen.most);
      }
      add_panel(std::move(one), values);
    }
    figure_.panels.back().x_label = "time";
    figure_.shading = "shaded: the joint's surfaces do not touch";
  }

  void draw_over() {
    const RecordColumn& over = layout(0)[columns_[0][1]];
    const Extremes range = common([](const Ranges& ranges) -> const Extremes& { return ranges.over; });
    const svg::Axis x = svg::make_axis(range.least, range.most, over.unit, x_ticks(), svg::Fit::exact);
    for (std::size_t c = 0; c < channels(); ++c) {
      const Extremes values = common([&](const Ranges& ranges) -> const Extremes& { return ranges.channels[c]; });
      Panel one = panel(c, x, over.unit);
      add_trails(one, c, 1, (x.until - x.from) / request_.across,
                 std::max(values.most - values.least, 1e-300) / request_.down);
      add_panel(std::move(one), values);
    }
    figure_.panels.back().x_label = over.name;
  }

  /// The channel over the column read as number `x`.
  void add_trails(Panel& panel, std::size_t channel, std::size_t x, double pixel_x, double pixel_y) const {
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      Trail trail(pixel_x, pixel_y);
      each_row(s, [&](std::span<const double> row) { trail.add({row[x], row[first_channel() + channel]}); });
      panel.lines.push_back({trail.points(), ranges_[s].channels[channel], ranges_[s].rows});
    }
  }

  /// Of a ball seen along each of three axes.
  void draw_orbits() {
    for (std::size_t a = 0; a < channels(); ++a) {
      for (std::size_t b = a + 1; b < channels(); ++b) draw_orbit(a, b);
    }
  }

  void draw_orbit(std::size_t first, std::size_t second) {
    const auto range = [&](std::size_t c) {
      Extremes values = common([&](const Ranges& ranges) -> const Extremes& { return ranges.channels[c]; });
      for (const double clearance : request_.clearances) {
        for (const double side : {-orbit_room, orbit_room}) values.add(0.0, side * clearance);
      }
      return values;
    };
    Extremes wide = range(first), high = range(second);
    open_up(wide, high);
    const RecordColumn& over = column(first);
    const double ticks = std::max(3.0, std::min(request_.across, request_.down) / px_per_x_tick);
    const double longest = std::max(wide.most - wide.least, high.most - high.least);
    const auto axis = [&](const Extremes& of, const std::string& unit) {
      return svg::make_axis(of.least, of.most, unit, ticks * (of.most - of.least) / longest, svg::Fit::exact);
    };
    Panel one = panel(second, axis(wide, over.unit), over.unit);
    one.y = axis(high, one.unit);
    one.equal_scales = true;
    one.x_label = over.name;
    const double pixel = std::max(longest / std::max(1.0, std::min(request_.across, request_.down)), 1e-300);
    add_trails(one, second, first_channel() + first, pixel, pixel);
    one.circles = clearance_circles();
    figure_.panels.push_back(std::move(one));
  }

  /// One for all results, or where they differ one for each in its colour.
  std::vector<Circle> clearance_circles() const {
    const std::vector<double>& all = request_.clearances;
    std::vector<Circle> circles;
    if (all.empty()) return circles;
    const bool same = std::ranges::all_of(all, [&](double one) { return one == all[0]; });
    for (std::size_t s = 0; s < (same ? 1 : all.size()); ++s) {
      if (all[s] > 0.0) circles.push_back({.radius = all[s], .label = "clearance", .dashed = true});
      if (all[s] > 0.0 && !same) circles.back().line = static_cast<int>(s);
    }
    return circles;
  }

  /// What stands still is drawn in a plane, too, and a straight way in a part of one.
  static void open_up(Extremes& wide, Extremes& high) {
    const auto size = [](const Extremes& of) { return of.any() ? of.most - of.least : 0.0; };
    const auto reach = [](const Extremes& of) { return of.any() ? std::max(-of.least, of.most) : 0.0; };
    double longest = least_open * std::max(size(wide), size(high));
    if (!(longest > 0.0)) longest = 0.1 * std::max(reach(wide), reach(high));
    if (!(longest > 0.0)) longest = 1.0;
    for (Extremes* one : {&wide, &high}) {
      const double middle = one->any() ? 0.5 * (one->least + one->most) : 0.0, part = 0.5 * (longest - size(*one));
      if (!(part > 0.0)) continue;
      const Extremes seen = *one;
      one->add(0.0, (seen.any() ? seen.least : middle) - part);
      one->add(0.0, (seen.any() ? seen.most : middle) + part);
    }
  }

  /// Rows count by the time to their neighbours.
  void draw_histograms() {
    const double bins = std::floor(std::clamp(request_.across / px_per_bin, 4.0, most_bins));
    for (std::size_t c = 0; c < channels(); ++c) {
      const Extremes values = common([&](const Ranges& ranges) -> const Extremes& { return ranges.channels[c]; });
      Panel one = panel(c, svg::make_axis(values.least, values.most, column(c).unit, x_ticks(), svg::Fit::exact),
                        column(c).unit);
      one.unit = "%";
      one.x_label = one.title;
      one.title = "part of the time";
      Extremes parts;
      parts.add(0.0, 0.0);
      for (std::size_t s = 0; s < sources_.size(); ++s) {
        const std::vector<double> share = shares(s, c, one.x, static_cast<std::size_t>(bins));
        Line line{{}, ranges_[s].channels[c], ranges_[s].rows};
        const double width = (one.x.until - one.x.from) / bins;
        for (std::size_t i = 0; i < share.size(); ++i) {
          const double begin = one.x.from + static_cast<double>(i) * width;
          line.points.push_back({begin, share[i]});
          line.points.push_back({begin + width, share[i]});
          parts.add(begin, share[i]);
        }
        one.lines.push_back(std::move(line));
      }
      add_panel(std::move(one), parts);
    }
  }

  std::vector<double> shares(std::size_t source, std::size_t channel, const svg::Axis& x, std::size_t bins) const {
    std::vector<double> share(bins, 0.0);
    const auto place = [&](double value) {
      const double at = (value - x.from) / (x.until - x.from) * static_cast<double>(bins);
      return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(bins) - 1.0));
    };
    const auto add = [&](double value, double time) {
      if (!std::isnan(value)) share[place(value)] += time;
    };
    double last_time = std::nan(""), last = 0.0, sum = 0.0;
    each_row(source, [&](std::span<const double> row) {
      const double value = row[first_channel() + channel];
      if (!std::isnan(last_time)) {
        add(last, 0.5 * (row[0] - last_time));
        add(value, 0.5 * (row[0] - last_time));
      }
      last_time = row[0];
      last = value;
    });
    for (const double part : share) sum += part;
    for (double& part : share) part *= sum > 0.0 ? percent / sum : 0.0;
    return share;
  }

  void draw_spectra() {
    std::string span;
    std::vector<Panel> panels;
    std::vector<Extremes> values(channels());
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      const DerivedTable table = derived_table(*sources_[s].reader, "spectra", columns_[s], request_.window, 0.0, {});
      const std::size_t width = table.columns.size(), lines = table.rows.size() / width;
      const double last = table.rows[(lines - 1) * width];
      if (s == 0) span = fmt::format(", rows from {:.6g} s to {:.6g} s", table.from, table.until);
      for (std::size_t c = 0; c < channels(); ++c) {
        if (s == 0) {
          panels.push_back(panel(c, svg::make_axis(0.0, last, "Hz", x_ticks(), svg::Fit::exact), "Hz"));
          panels[c].title = "amplitude of " + panels[c].title;
        }
        ColumnCurve curve(panels[c].x.from, panels[c].x.until, static_cast<int>(request_.across));
        Extremes seen;
        for (std::size_t k = 0; k < lines; ++k) {
          const double amplitude = table.rows[k * width + 1 + c];
          curve.add({table.rows[k * width], amplitude});
          seen.add(table.rows[k * width], amplitude);
          values[c].add(0.0, amplitude);
        }
        panels[c].lines.push_back({curve.points(), seen, static_cast<std::int64_t>(lines)});
      }
    }
    for (std::size_t c = 0; c < channels(); ++c) add_panel(std::move(panels[c]), values[c]);
    figure_.panels.back().x_label = "frequency" + span;
  }

  const std::vector<Source>& sources_;
  const FigureRequest& request_;
  std::vector<std::vector<std::size_t>> columns_;  // by source
  std::vector<Ranges> ranges_;
  Figure figure_;
};

}  // namespace

Figure channel_figure(const std::vector<Source>& sources, const FigureRequest& request) {
  return request.view == View::polar ? polar_figure(sources, request) : ChannelFigure(sources, request).make();
}

}  // namespace freeplay::plot
