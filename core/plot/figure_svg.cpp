#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "base/index.h"
#include "plot/figure.h"
#include "svg/page.h"

namespace freeplay::plot {
namespace {

using svg::escaped, svg::px;

constexpr double left = 72.0, right = 16.0, page_top = 28.0, legend_line = 16.0;
constexpr double panel_top = 22.0, axis_room = 38.0, gap = 10.0;  // of a panel, with and without an axis below
constexpr double px_per_mm = 96.0 / 25.4;
constexpr double letter_width = 6.0;                                      // of 11 px
constexpr double usual_size = 11.0, title_size = 13.0, least_size = 6.0;  // of letters [px]

struct Style {
  const char *colour, *dashes;
};
constexpr Style styles[] = {{"#0072B2", ""},        {"#D55E00", "6 3"},  {"#009E73", "2 2"},
                            {"#CC79A7", "8 2 2 2"}, {"#E69F00", "12 4"}, {"#000000", "1 3"}};

std::string stroke(std::size_t line) {
  const Style& style = styles[line % std::size(styles)];
  const std::string dashes = *style.dashes == '\0' ? "" : fmt::format(" stroke-dasharray=\"{}\"", style.dashes);
  return fmt::format(
      "fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\" stroke-linejoin=\"round\" stroke-linecap=\"round\"{}",
      style.colour, dashes);
}

std::string with_unit(const std::string& words, const std::string& unit) {
  return unit.empty() ? words : fmt::format("{} [{}]", words, unit);
}

struct Fitted {
  std::string size, words;  ///< attribute, and content of a text
};

/// In smaller letters where words would be cut; where not even these fit, what fits, and all of it in a title.
Fitted fitted(const std::string& words, double room, double size = usual_size) {
  const double letter = letter_width / usual_size, width = letter * size * static_cast<double>(words.size());
  if (width <= room) return {"", escaped(words)};
  const double small = std::max(least_size, size * room / width);
  const std::string attribute = fmt::format(" font-size=\"{:.3g}\"", small);
  auto most = static_cast<std::size_t>(std::max(2.0, 1e-9 + room / (letter * small)));
  if (words.size() <= most) return {attribute, escaped(words)};
  --most;
  while (most > 0 && (static_cast<unsigned char>(words[most]) & 0xC0U) == 0x80U) --most;  // whole characters
  return {attribute, fmt::format("<title>{}</title>{}\u2026", escaped(words), escaped(words.substr(0, most)))};
}

/// The place of a panel's lines on the page.
struct Area {
  double left, right, top, bottom;
};

class PanelDrawing {
 public:
  PanelDrawing(const Panel& panel, const Area& area) : panel_(panel), area_(area) {}

  std::string text() {
    out_ = fmt::format(
        "<g class=\"panel\" data-channel=\"{}\" data-unit=\"{}\" data-left=\"{}\" data-right=\"{}\" data-top=\"{}\" "
        "data-bottom=\"{}\" data-x-from=\"{}\" data-x-until=\"{}\" data-y-from=\"{}\" data-y-until=\"{}\">\n",
        escaped(panel_.channel), escaped(panel_.unit), area_.left, area_.right, area_.top, area_.bottom, panel_.x.from,
        panel_.x.until, panel_.y.from, panel_.y.until);
    draw_shades();
    draw_axes();
    draw_circles();
    for (std::size_t i = 0; i < panel_.lines.size(); ++i) draw_line(i);
    out_ += fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\" stroke-width=\"0.8\"/>\n",
        px(area_.left), px(area_.top), px(area_.right - area_.left), px(area_.bottom - area_.top));
    return out_ + "</g>\n";
  }

 private:
  double at_x(double x) const {
    return area_.left + (x - panel_.x.from) / (panel_.x.until - panel_.x.from) * (area_.right - area_.left);
  }
  double at_y(double y) const {
    return area_.bottom - (y - panel_.y.from) / (panel_.y.until - panel_.y.from) * (area_.bottom - area_.top);
  }

  void draw_shades() {
    for (const auto& [from, until] : panel_.shaded) {
      const double begin = std::clamp(at_x(from), area_.left, area_.right);
      const double end = std::clamp(at_x(until), area_.left, area_.right);
      out_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#e9e9e9\"/>\n", px(begin),
                          px(area_.top), px(end - begin), px(area_.bottom - area_.top));
    }
  }

  void draw_axes() {
    const Fitted title = fitted(with_unit(panel_.title, panel_.y.unit), area_.right - area_.left);
    out_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", px(area_.left), px(area_.top - 6.0), title.size,
                        title.words);
    for (std::size_t i = 0; i < panel_.y.ticks.size(); ++i) {
      const double y = at_y(panel_.y.ticks[i]);
      out_ += fmt::format(
          "<path d=\"M{0} {1}H{2}\" stroke=\"#d4d4d4\" stroke-width=\"0.6\"/>\n<text x=\"{3}\" y=\"{4}\" "
          "text-anchor=\"end\">{5}</text>\n",
          px(area_.left), px(y), px(area_.right), px(area_.left - 6.0), px(y + 4.0), panel_.y.labels[i]);
    }
    double taken = -1e9;
    for (std::size_t i = 0; i < panel_.x.ticks.size(); ++i) {
      const double x = at_x(panel_.x.ticks[i]);
      out_ += fmt::format("<path d=\"M{0} {1}V{2}\" stroke=\"#d4d4d4\" stroke-width=\"0.6\"/>\n", px(x), px(area_.top),
                          px(area_.bottom));
      const double half = 0.5 * letter_width * static_cast<double>(panel_.x.labels[i].size());
      if (panel_.x_label.empty() || x - half < taken + letter_width) continue;
      taken = x + half;
      out_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", px(x), px(area_.bottom + 15.0),
                          panel_.x.labels[i]);
    }
    if (panel_.x_label.empty()) return;
    const Fitted label = fitted(with_unit(panel_.x_label, panel_.x.unit), area_.right - area_.left);
    out_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\"{}>{}</text>\n",
                        px(0.5 * (area_.left + area_.right)), px(area_.bottom + 31.0), label.size, label.words);
  }

  void draw_circles() {
    for (const Circle& circle : panel_.circles) {
      const double radius = circle.radius / (panel_.x.until - panel_.x.from) * (area_.right - area_.left);
      out_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.8\"{}/>\n",
                          px(at_x(0.0)), px(at_y(0.0)), px(radius),
                          circle.line < 0 ? "#555" : styles[at(circle.line) % std::size(styles)].colour,
                          circle.dashed ? " stroke-dasharray=\"5 3\"" : "");
      if (circle.label.empty()) continue;
      const double x = at_x(circle.radius * std::cos(circle.label_angle));
      const Fitted label = fitted(circle.label, 2.0 * std::min(x - area_.left, area_.right - x));
      out_ += fmt::format(
          "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"#333\" paint-order=\"stroke\" stroke=\"white\" "
          "stroke-width=\"3\"{}>{}</text>\n",
          px(x), px(at_y(circle.radius * std::sin(circle.label_angle)) + (circle.dashed ? 12.0 : 4.0)), label.size,
          label.words);
    }
  }

  void draw_line(std::size_t i) {
    const std::vector<Point>& points = panel_.lines[i].points;
    std::string d;
    bool down = false;
    for (const Point& point : points) {
      if (std::isnan(point.y)) {
        down = false;
        continue;
      }
      d += fmt::format("{}{:.2f} {:.2f}", down ? "L" : "M", at_x(point.x) + 0.0, at_y(point.y) + 0.0);
      down = true;
    }
    // A point alone is a line back to itself, and a dot.
    if (d.find('L') == std::string::npos && !d.empty()) {
      d += "L" + d.substr(1);
      const Point& point = *std::ranges::find_if(points, [](const Point& p) { return !std::isnan(p.y); });
      out_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"3\" fill=\"{}\"/>\n", px(at_x(point.x)), px(at_y(point.y)),
                          styles[i % std::size(styles)].colour);
    }
    if (!d.empty()) out_ += fmt::format("<path class=\"line\" d=\"{}\" {}/>\n", d, stroke(i));
    const Fitted note = fitted(missing_words(panel_.lines[i]), area_.right - area_.left - 12.0);
    if (note.words.empty()) return;
    // In the middle of an empty panel, else in its upper right, below those of other lines.
    const char* colour = panel_.lines.size() > 1 ? styles[i % std::size(styles)].colour : "#333";
    const double line_height = legend_line * static_cast<double>(i);
    out_ += fmt::format(
        "<text class=\"missing\" x=\"{}\" y=\"{}\" text-anchor=\"{}\" fill=\"{}\" paint-order=\"stroke\" "
        "stroke=\"white\" stroke-width=\"3\"{}>{}</text>\n",
        px(d.empty() ? 0.5 * (area_.left + area_.right) : area_.right - 6.0),
        px((d.empty() ? 0.5 * (area_.top + area_.bottom) : area_.top + 14.0) + line_height),
        d.empty() ? "middle" : "end", colour, note.size, note.words);
  }

  const Panel& panel_;
  Area area_;
  std::string out_;
};

/// Below `top`, as high as `height` at most.
Area area_of(const Panel& panel, const PageSize& size, double top) {
  const double below = panel.x_label.empty() ? gap : axis_room;
  const Area whole{left, size.width - right, top + panel_top, top + size.panel_height - below};
  if (!panel.equal_scales) return whole;
  const double wide = panel.x.until - panel.x.from, high = panel.y.until - panel.y.from;
  const double scale = std::min((whole.right - whole.left) / wide, (whole.bottom - whole.top) / high);
  const double begin = std::max(left, 0.5 * (size.width - scale * wide));
  return {begin, begin + scale * wide, whole.top, whole.top + scale * high};
}

}  // namespace

double line_room(const PageSize& size) { return size.width - left - right; }

std::string figure_svg(const Figure& figure, const PageSize& size) {
  std::string body;
  double y = page_top;
  const Fitted title = fitted(figure.title, line_room(size), title_size);
  body += fmt::format("<text x=\"{}\" y=\"18\"{}>{}</text>\n", px(left),
                      title.size.empty() ? fmt::format(" font-size=\"{:g}\"", title_size) : title.size, title.words);
  const auto legend = [&](const std::string& sign, const std::string& all) {
    const Fitted words = fitted(all, line_room(size) - 36.0);
    body += fmt::format("{}<text x=\"{}\" y=\"{}\"{}>{}</text>\n", sign, px(left + 36.0), px(y + 9.0), words.size,
                        words.words);
    y += legend_line;
  };
  if (figure.names.size() > 1) {
    for (std::size_t i = 0; i < figure.names.size(); ++i) {
      legend(fmt::format("<path d=\"M{} {}h28\" {}/>\n", px(left), px(y + 5.0), stroke(i)), figure.names[i]);
    }
  }
  const bool shaded = std::ranges::any_of(figure.panels, [](const Panel& panel) { return !panel.shaded.empty(); });
  if (shaded) {
    legend(fmt::format("<rect x=\"{}\" y=\"{}\" width=\"28\" height=\"10\" fill=\"#e9e9e9\" stroke=\"#999\" "
                       "stroke-width=\"0.5\"/>\n",
                       px(left), px(y)),
           figure.shading);
  }
  for (const Panel& panel : figure.panels) {
    const Area area = area_of(panel, size, y);
    body += PanelDrawing(panel, area).text();
    y = area.bottom + (panel.x_label.empty() ? gap : axis_room);
  }
  const double scale = size.in_millimetres ? 1.0 / px_per_mm : 1.0;
  const char* unit = size.in_millimetres ? "mm" : "";
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{2}{4}\" height=\"{3}{4}\" viewBox=\"0 0 {0} {1}\" "
             "font-family=\"sans-serif\" font-size=\"11\">\n<title>{5}</title>\n"
             "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
             px(size.width), px(y), fmt::format("{:g}", std::round(size.width * scale * 1e3) / 1e3),
             fmt::format("{:g}", std::round(y * scale * 1e3) / 1e3), unit, escaped(figure.title)) +
         body + "</svg>\n";
}

}  // namespace freeplay::plot
