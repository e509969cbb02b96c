#include "study/picture_page.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "svg/page.h"

namespace freeplay {
namespace {

using svg::escaped, svg::px;

constexpr double width = 760.0, height = 460.0, left = 90.0, right = 24.0, top = 54.0, bottom = 56.0;
constexpr double wanted_ticks = 7.0;
// Okabe and Ito (2008): they print, and colour-blind people tell them apart.
constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};

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

PicturePage::PicturePage(std::string title, PictureScale x, PictureScale y)
    : title_(std::move(title)), x_(std::move(x)), y_(std::move(y)) {}

const char* PicturePage::colour(std::size_t series) { return colours[series % std::size(colours)]; }

double PicturePage::px_x(double x) const { return left + x_.at(x) * (width - left - right); }
double PicturePage::px_y(double y) const { return height - bottom - y_.at(y) * (height - top - bottom); }

void PicturePage::mark(double x, double y, std::uint64_t point, std::size_t series, double radius) {
  body_ += fmt::format("<circle data-point=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:g}\" fill=\"{}\"/>\n", point,
                       px_x(x), px_y(y), radius, colour(series));
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

void PicturePage::upright(double x, const std::string& words) {
  body_ += fmt::format(
      "<path d=\"M{0:.2f} {1}V{2}\" stroke=\"#222\" stroke-dasharray=\"5 3\"/>\n<text x=\"{3:.2f}\" y=\"{4}\" "
      "font-size=\"10\">{5}</text>\n",
      px_x(x), px(top), px(height - bottom), px_x(x) + 3.0, px(top + 11.0), escaped(words));
}

void PicturePage::shade(double from_x, double until_x) {
  const double x = px_x(from_x);
  body_ +=
      fmt::format("<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"{}\" fill=\"#bbb\" fill-opacity=\"0.5\"/>\n",
                  x, px(top), std::max(0.5, px_x(until_x) - x), px(height - top - bottom));
}

std::string PicturePage::text() const {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n<text x=\"{3}\" y=\"20\" font-size=\"13\">{2}</text>\n",
      width, height, escaped(title_), left);
  for (std::size_t i = 0; i < x_.axis().ticks.size(); ++i) {
    const double x = px_x(x_.axis().ticks[i]);
    out += fmt::format(
        "<path d=\"M{0:.2f} {1}V{2}\" stroke=\"#ddd\"/>\n<text x=\"{0:.2f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4}</text>\n",
        x, px(top), px(height - bottom), px(height - bottom + 15.0), escaped(x_.axis().labels[i]));
  }
  for (std::size_t i = 0; i < y_.axis().ticks.size(); ++i) {
    const double y = px_y(y_.axis().ticks[i]);
    out += fmt::format(
        "<path d=\"M{0} {1:.2f}H{2}\" stroke=\"#ddd\"/>\n<text x=\"{3}\" y=\"{4:.2f}\" "
        "text-anchor=\"end\">{5}</text>\n",
        px(left), y, px(width - right), px(left - 6.0), y + 4.0, escaped(y_.axis().labels[i]));
  }
  out += body_;
  out += fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>\n<text x=\"{}\" y=\"{}\" "
      "text-anchor=\"middle\">{}</text>\n<text x=\"{}\" y=\"{}\">{}</text>\n",
      px(left), px(top), px(width - left - right), px(height - top - bottom), px(0.5 * (left + width - right)),
      px(height - bottom + 36.0), escaped(x_.label()), px(8.0), px(top - 8.0), escaped(y_.label()));
  double x = width - right;
  for (std::size_t i = names_.size(); i-- > 0;) {
    x -= 7.0 * static_cast<double>(names_[i].size()) + 28.0;
    out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"4\" fill=\"{}\"/>\n<text x=\"{}\" y=\"{}\">{}</text>\n",
                       px(x + 8.0), px(top - 12.0), colour(i), px(x + 16.0), px(top - 8.0), escaped(names_[i]));
  }
  return out + "</svg>\n";
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
