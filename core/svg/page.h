// Page: a picture that is put together on a page, and names that find room in it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace freeplay::svg {

/// On the page: x to the right, y down [px].
struct Point {
  double x = 0.0, y = 0.0;
};

inline Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y}; }
inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
inline Point operator*(double s, const Point& a) { return {s * a.x, s * a.y}; }
inline double cross(const Point& a, const Point& b) { return a.x * b.y - a.y * b.x; }
double length(const Point& a);

struct Box {
  double left, top, right, bottom;
  bool meets(const Box& o) const { return left < o.right && o.left < right && top < o.bottom && o.top < bottom; }
};

/// Least and largest x and y; the origin twice where there is no point.
std::pair<Point, Point> ends_of(const std::vector<Point>& points);
/// Convex hull, in one sense of turning; fewer than three points when all lie on a line.
std::vector<Point> hull(std::vector<Point> points);
/// "M x y L x y ..." through the points.
std::string path(const std::vector<Point>& points);

/// As text in XML, which knows no control characters.
std::string escaped(const std::string& text);
/// A coordinate to a tenth of a pixel.
std::string px(double value);

/// Tint of a body, by its index: eight that stay apart in print take turns.
const char* tint(int body);

/// What a picture is made of, in the order in which it is drawn. Names are placed last.
class Page {
 public:
  template <class... Values>
  void shape(fmt::format_string<Values...> format, Values&&... values) {
    shapes_ += fmt::format(format, std::forward<Values>(values)...);
  }
  void line(const Point& a, const Point& b, const char* style);
  /// Names keep out of its way.
  void circle(const Point& at, double radius, const char* style);
  /// A centre of mass: a quartered disc.
  void centre(const Point& at);
  /// A force element between two points: a zigzag, or a ring where they coincide.
  void spring(const Point& from, const Point& to);
  /// A mark of what does not move, below a point.
  void hatch(const Point& at);

  /// Names keep out of this place,
  void block(const Point& at, double radius);
  /// and rather stay away from this line.
  void shun(const Point& a, const Point& b);
  /// A name for what is at a point; `style` are attributes of its text.
  void label(std::string text, const Point& at, const char* style);
  /// Finds room for all names within `bounds`; no more labels after that.
  void place_labels(const Box& bounds);

  /// Shapes, then names.
  std::string text() const { return shapes_ + labels_; }

 private:
  struct Label {
    std::string text;
    Point at;  ///< of what it names
    const char* style;
  };
  double crowding(const Box& box, const Box& bounds) const;

  std::string shapes_, labels_;
  std::vector<Label> names_;
  std::vector<Box> taken_, shunned_;
};

/// The head of a picture of width x height [px]; "</svg>" ends it.
std::string head(double width, double height, const std::string& title);

/// A bar with its length, from `left` on, `scale` [px/m]: 1, 2 or 5 times a power of ten, about `wanted` px long.
std::string scale_bar(double scale, double wanted, double left, double y);

}  // namespace freeplay::svg
