#include "study/picture_page.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "base/unit_prefix.h"
#include "svg/page.h"

namespace freeplay {
namespace {

using svg::escaped, svg::px;

constexpr std::size_t most_rows = 6;  // of a legend
constexpr double width = 760.0, height = 460.0, right = 24.0;
constexpr double least_left = 90.0, least_top = 54.0, least_bottom = 56.0, most_left = 320.0, most_bottom = 200.0;
constexpr double letter = 6.8, line_height = 16.0;  // of a text, about [px]
constexpr double lean = 35.0;                       // of labels that have no room side by side [deg]
constexpr double wanted_ticks = 7.0;
// Okabe and Ito (2008): they print, and colour-blind people tell them apart.
constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};

double width_of(const std::string& text) { return letter * static_cast<double>(text.size()); }

double widest(const std::vector<std::string>& labels) {
  double most = 0.0;
  for (const std::string& label : labels) most = std::max(most, width_of(label));
  return most;
}

double width_in_legend(const std::string& name) { return width_of(name) + 28.0; }

/// Rows of a legend, by the number of the first name and of the one after the last. What those have no room for is left
/// out.
std::vector<std::pair<std::size_t, std::size_t>> legend_rows(const std::vector<std::string>& names) {
  std::vector<std::pair<std::size_t, std::size_t>> rows;
  double used = width;
  for (std::size_t i = 0; i < names.size(); ++i) {
    used += width_in_legend(names[i]);
    if (used > width - right - 8.0) {
      if (rows.size() == most_rows) break;
      rows.emplace_back(i, i);
      used = width_in_legend(names[i]);
    }
    rows.back().second = i + 1;
  }
  return rows;
}

/// A long name ends as names do that differ at their end.
std::string shortened(const std::string& label, double room) {
  const auto most = static_cast<std::size_t>(room / letter);
  if (label.size() <= most) return label;
  std::size_t from = label.size() - (most - 3);
  while (from < label.size() && (static_cast<unsigned char>(label[from]) & 0xC0) == 0x80) ++from;
  return "..." + label.substr(from);
}

}  // namespace

PictureScale::PictureScale(std::string label, const std::vector<double>& values, const std::string& unit, svg::Fit fit)
    : label_(std::move(label)) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  axis_ = svg::make_axis(least, most, unit, wanted_ticks, fit);
}

PictureScale::PictureScale(std::string label, std::vector<std::string> words)
    : label_(std::move(label)), words_(std::move(words)) {
  axis_.from = -0.5;
  axis_.until = static_cast<double>(words_.size()) - 0.5;
  for (std::size_t i = 0; i < words_.size(); ++i) axis_.ticks.push_back(static_cast<double>(i));
  axis_.labels = words_;
}

double PictureScale::value_of(const std::string& word) const {
  return static_cast<double>(std::ranges::find(words_, word) - words_.begin());
}

std::string PictureScale::label() const {
  return axis_.unit.empty() ? label_ : fmt::format("{} [{}]", label_, axis_.unit);
}

PicturePage::PicturePage(std::string title, PictureScale x, PictureScale y, std::vector<std::string> families)
    : title_(std::move(title)),
      x_(std::move(x)),
      y_(std::move(y)),
      families_(std::move(families)),
      left_(std::clamp(widest(y_.axis().labels) + 14.0, least_left, most_left)),
      top_(least_top),
      bottom_(least_bottom) {
  // One row stands beside the name of the upright axis, where there is room.
  double wide = width_of(y_.label()) + 20.0 + right;
  for (const std::string& name : families_) wide += width_in_legend(name);
  if (wide > width) top_ += line_height * static_cast<double>(legend_rows(families_).size());
  if (!leans()) return;
  const double tall = widest(x_.axis().labels) * std::sin(lean * std::numbers::pi / 180.0);
  bottom_ = std::clamp(tall + least_bottom - 8.0, least_bottom, most_bottom);
}

/// Have the labels of x no room side by side?
bool PicturePage::leans() const {
  const std::vector<double>& ticks = x_.axis().ticks;
  if (ticks.size() < 2) return false;
  return widest(x_.axis().labels) + 8.0 > px_x(ticks[1]) - px_x(ticks[0]);
}

const char* PicturePage::colour(std::size_t series) { return colours[series % std::size(colours)]; }

double PicturePage::px_x(double x) const { return left_ + x_.at(x) * (width - left_ - right); }
double PicturePage::px_y(double y) const { return height - bottom_ - y_.at(y) * (height - top_ - bottom_); }

void PicturePage::disc(const PictureMark& mark, std::size_t series, double radius) {
  body_ += fmt::format("<circle data-point=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2g}\" fill=\"{}\"/>\n", mark.point,
                       px_x(mark.x), px_y(mark.y), radius, colour(series));
}

void PicturePage::marks(std::span<const PictureMark> marks, std::size_t series, double radius) {
  if (marks.size() <= most_marks) {
    for (const PictureMark& mark : marks) disc(mark, series, radius);
    return;
  }
  struct Cell {
    const PictureMark* first = nullptr;
    double count = 0.0;
  };
  std::map<std::pair<long, long>, Cell> cells;
  double size = 1.0;  // [px]
  do {
    size += 1.0;
    cells.clear();
    for (const PictureMark& mark : marks) {
      Cell& cell = cells[{std::lround(px_x(mark.x) / size), std::lround(px_y(mark.y) / size)}];
      if (cell.first == nullptr) cell.first = &mark;
      ++cell.count;
    }
  } while (cells.size() > most_marks);
  for (const auto& [place, cell] : cells) {
    disc(*cell.first, series,
         std::clamp(0.7 * radius * std::sqrt(cell.count), 0.7 * radius, std::max(radius, 0.6 * size)));
  }
}

void PicturePage::tile(double from_x, double until_x, double from_y, double until_y, std::uint64_t point,
                       const std::string& fill, const std::string& words) {
  const double x = px_x(from_x), y = px_y(until_y);
  body_ += fmt::format(
      "<rect data-point=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" "
      "stroke=\"white\" stroke-width=\"0.5\"><title>{}</title></rect>\n",
      point, x, y, px_x(until_x) - x, px_y(from_y) - y, fill, escaped(words));
}

std::string PicturePage::path(const std::vector<std::pair<double, double>>& points) const {
  std::string d;
  for (const auto& [x, y] : points) d += fmt::format("{}{:.2f} {:.2f}", d.empty() ? "M" : "L", px_x(x), px_y(y));
  return d;
}

void PicturePage::line(const std::vector<std::pair<double, double>>& points, std::size_t series) {
  if (points.size() < 2) return;
  body_ +=
      fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\"/>\n", path(points), colour(series));
}

void PicturePage::band(const std::vector<std::pair<double, double>>& points, std::size_t series) {
  if (points.size() < 4) return;
  body_ += fmt::format("<path d=\"{}Z\" fill=\"{}\" fill-opacity=\"0.18\"/>\n", path(points), colour(series));
}

std::string PicturePage::shade(double dark) {
  const auto part = [&](double at_dark) { return static_cast<int>(std::lround(250.0 + dark * (at_dark - 250.0))); };
  return fmt::format("#{:02x}{:02x}{:02x}", part(8.0), part(48.0), part(107.0));
}

void PicturePage::shades(double least, double most, const std::string& unit) {
  constexpr double pieces = 12.0, piece = 9.0;
  const bool plain = unit.empty() || unit == "1";
  const PrefixedUnit to =
      plain ? PrefixedUnit{1.0, ""} : prefixed_unit(std::max(std::abs(least), std::abs(most)), unit);
  const std::string from = fmt::format("{:.4g}", least / to.factor),
                    until = fmt::format("{:.4g}{}{}", most / to.factor, plain ? "" : " ", to.unit);
  const double end = width - right - width_of(until) - 6.0, begin = end - pieces * piece;
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n<text x=\"{}\" y=\"{}\">{}</text>\n",
                       px(begin - 6.0), px(top_ - 8.0), from, px(end + 6.0), px(top_ - 8.0), escaped(until));
  for (double i = 0.0; i < pieces; ++i) {
    body_ += fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"11\" fill=\"{}\" stroke=\"#444\" "
        "stroke-width=\"0.3\"/>\n",
        px(begin + i * piece), px(top_ - 18.0), px(piece), shade(i / (pieces - 1.0)));
  }
}

void PicturePage::upright(double x, std::optional<std::pair<double, double>> interval, std::size_t series,
                          const std::string& words) {
  const double row = top_ + 3.0 + 13.0 * static_cast<double>(series);
  const char* const own = families_.empty() ? "#222" : colour(series);
  if (interval) {
    const double from = px_x(interval->first);
    body_ +=
        fmt::format("<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"11\" fill=\"{}\" fill-opacity=\"0.3\"/>\n",
                    from, px(row), std::max(0.5, px_x(interval->second) - from), own);
  }
  const bool near_end = px_x(x) + 3.0 + width_of(words) > width - right;
  body_ += fmt::format(
      "<path d=\"M{0:.2f} {1}V{2}\" stroke=\"{3}\" stroke-dasharray=\"5 3\"/>\n<text x=\"{4:.2f}\" y=\"{5}\" "
      "font-size=\"10\"{6}>{7}</text>\n",
      px_x(x), px(row), px(height - bottom_), own, px_x(x) + (near_end ? -3.0 : 3.0), px(row + 9.0),
      near_end ? " text-anchor=\"end\"" : "", escaped(words));
}

std::string PicturePage::labels_of_x() const {
  std::string out;
  const bool leaning = leans();
  for (std::size_t i = 0; i < x_.axis().ticks.size(); ++i) {
    const double x = px_x(x_.axis().ticks[i]), y = height - bottom_ + (leaning ? 12.0 : 15.0);
    const std::string turn = leaning ? fmt::format(" transform=\"rotate({:g} {:.2f} {})\"", -lean, x, px(y)) : "";
    const std::string label =
        leaning ? shortened(x_.axis().labels[i], (most_bottom - least_bottom) / std::sin(0.6)) : x_.axis().labels[i];
    out += fmt::format(
        "<path d=\"M{0:.2f} {1}V{2}\" stroke=\"#ddd\"/>\n<text x=\"{0:.2f}\" y=\"{3}\" "
        "text-anchor=\"{4}\"{5}>{6}</text>\n",
        x, px(top_), px(height - bottom_), px(y), leaning ? "end" : "middle", turn, escaped(label));
  }
  return out;
}

std::string PicturePage::legend() const {
  std::string out;
  const bool beside = top_ == least_top;  // the name of the upright axis
  double y = beside ? top_ - 8.0 : 38.0;
  const auto rows = legend_rows(families_);
  for (const auto& [first, end] : rows) {
    double x = beside ? width - right : 8.0;
    for (std::size_t i = first; beside && i < end; ++i) x -= width_in_legend(families_[i]);
    for (std::size_t i = first; i < end; ++i) {
      out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"4\" fill=\"{}\"/>\n<text x=\"{}\" y=\"{}\">{}</text>\n",
                         px(x + 8.0), px(y - 4.0), colour(i), px(x + 16.0), px(y), escaped(families_[i]));
      x += width_in_legend(families_[i]);
    }
    y += line_height;
  }
  const std::size_t named = rows.empty() ? 0 : rows.back().second;
  if (named < families_.size()) {
    out += fmt::format("<text x=\"{}\" y=\"20\" text-anchor=\"end\">and {} more</text>\n", px(width - right),
                       families_.size() - named);
  }
  return out;
}

std::string PicturePage::text() const {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n<text x=\"{3}\" y=\"20\" font-size=\"13\">{2}</text>\n",
      width, height, escaped(title_), left_);
  out += labels_of_x();
  for (std::size_t i = 0; i < y_.axis().ticks.size(); ++i) {
    const double y = px_y(y_.axis().ticks[i]);
    out += fmt::format(
        "<path d=\"M{0} {1:.2f}H{2}\" stroke=\"#ddd\"/>\n<text x=\"{3}\" y=\"{4:.2f}\" "
        "text-anchor=\"end\">{5}</text>\n",
        px(left_), y, px(width - right), px(left_ - 6.0), y + 4.0,
        escaped(shortened(y_.axis().labels[i], left_ - 14.0)));
  }
  out += body_;
  out += fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>\n<text x=\"{}\" y=\"{}\" "
      "text-anchor=\"middle\">{}</text>\n<text x=\"{}\" y=\"{}\">{}</text>\n",
      px(left_), px(top_), px(width - left_ - right), px(height - top_ - bottom_), px(0.5 * (left_ + width - right)),
      px(height - 20.0), escaped(x_.label()), px(8.0), px(top_ - 8.0), escaped(y_.label()));
  return out + legend() + "</svg>\n";
}

std::string PicturePage::stacked(const std::vector<PicturePage>& pages) {
  if (pages.size() == 1) return pages.front().text();
  const double whole = height * static_cast<double>(pages.size());
  std::string out =
      fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n",
                  width, whole);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    out += fmt::format("<g transform=\"translate(0 {})\">\n{}</g>\n", px(height * static_cast<double>(i)),
                       pages[i].text());
  }
  return out + "</svg>\n";
}

}  // namespace freeplay
