#include "model/arc_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/angle.h"
#include "component/formula_calls.h"

namespace freeplay {
namespace {

using Vector = std::array<double, 2>;

constexpr double quarter_turn = 0.25 * whole_turn;
constexpr double rounding = 1e-9;  // of written numbers: circles touch, an arc has no length

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1]; }
Vector direction(double angle) { return {std::cos(angle), std::sin(angle)}; }
/// On the right of who goes at that angle: from the centre of a counter-clockwise arc to where he is.
Vector on_the_right(double heading) { return {std::sin(heading), -std::cos(heading)}; }
double within_turn(double angle) { return angle - whole_turn * std::floor(angle / whole_turn); }
std::string place_text(const Vector& p) { return fmt::format("({:.4g} m, {:.4g} m)", p[0], p[1]); }

Vector point_on(const Arc& arc, double heading) {
  const Vector n = on_the_right(heading);
  return {arc.centre[0] + arc.radius * n[0], arc.centre[1] + arc.radius * n[1]};
}

/// The tangent from one arc to the next: its heading; none where there is none.
std::optional<double> tangent(const Arc& from, const Arc& to) {
  const Vector d = {to.centre[0] - from.centre[0], to.centre[1] - from.centre[1]};
  const double apart = std::hypot(d[0], d[1]), by = from.radius - to.radius;
  if (!(apart > 0.0) || std::abs(by) > apart * (1.0 + rounding)) return std::nullopt;
  return std::atan2(d[1], d[0]) + std::asin(std::clamp(by / apart, -1.0, 1.0));
}

}  // namespace

/// What is to be known of a curve before it is one.
class ArcCurve::Maker {
 public:
  Maker(std::vector<Arc> arcs, bool closed) : arcs_(std::move(arcs)), closed_(closed) {}

  std::variant<ArcCurve, Flaw> make(double aside) {
    if (auto flaw = flaw_of_arcs()) return *flaw;
    if (auto flaw = move_aside(closed_ ? aside : -aside)) return *flaw;
    if (auto flaw = join()) return *flaw;
    if (auto flaw = closed_ ? flaw_of_turning() : std::nullopt) return *flaw;
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      if (auto flaw = closed_ ? turning_back_in_angle(i) : turning_back_in_x(i)) return *flaw;
    }
    return finished();
  }

 private:
  bool is_end(std::size_t i) const { return !closed_ && (i == 0 || i + 1 == arcs_.size()); }

  std::optional<Flaw> flaw_of_arcs() const {
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      if (is_end(i) && arcs_[i].radius != 0.0) {
        return Flaw{i, "a curve over x begins and ends at a point: write [x, y]"};
      }
      if (!is_end(i) && arcs_[i].radius == 0.0) return Flaw{i, "a corner has no normal: give it a radius"};
    }
    return std::nullopt;
  }

  std::optional<Flaw> move_aside(double by) {
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      const double was = arcs_[i].radius;
      arcs_[i].radius += by;
      if (is_end(i) || was * arcs_[i].radius > 0.0) continue;
      return Flaw{i, fmt::format("the roller does not fit into the arc of the radius {:.4g} m", std::abs(was))};
    }
    return std::nullopt;
  }

  /// Where each arc begins and ends, as headings.
  std::optional<Flaw> join() {
    const std::size_t n = arcs_.size();
    in_.assign(n, 0.0), turn_.assign(n, 0.0);
    if (closed_ && n == 1) {
      turn_[0] = arcs_[0].radius > 0.0 ? whole_turn : -whole_turn;
      return std::nullopt;
    }
    std::vector<double> out(n, 0.0);
    for (std::size_t i = 0; i < (closed_ ? n : n - 1); ++i) {
      const std::size_t next = (i + 1) % n;
      const auto heading = tangent(arcs_[i], arcs_[next]);
      if (!heading) return Flaw{next, "this circle and the one before it have no common tangent in their sense"};
      out[i] = in_[next] = *heading;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (is_end(i)) {
        if (i == 0) in_[i] = out[i];
        continue;
      }
      const bool left = arcs_[i].radius > 0.0;
      double turn = within_turn(left ? out[i] - in_[i] : in_[i] - out[i]);
      if (turn > whole_turn - rounding) turn = 0.0;
      turn_[i] = left ? turn : -turn;
    }
    return std::nullopt;
  }

  std::optional<Flaw> flaw_of_turning() const {
    double turned = 0.0;
    std::size_t longest = 0;
    for (std::size_t i = 0; i < turn_.size(); ++i) {
      turned += turn_[i];
      if (turn_[i] > turn_[longest]) longest = i;
    }
    if (std::abs(turned - whole_turn) < 1e-6) return std::nullopt;
    return Flaw{longest,
                "the curve crosses itself: list its circles counter-clockwise, hollow ones with a negative radius"};
  }

  // A curve is a distance over the angle where it goes to the left, seen from the origin: p.n > 0, n on the right of
  // it.
  std::optional<Flaw> turning_back_in_angle(std::size_t i) const {
    const Arc& arc = arcs_[i];
    const double low = std::min(in_[i], in_[i] + turn_[i]), high = low + std::abs(turn_[i]);
    // Along an arc p.n is least where n is opposite to the centre.
    const double opposite = std::atan2(-arc.centre[1], -arc.centre[0]) + quarter_turn;
    const double inside = low + within_turn(opposite - low);
    for (const double heading : {low, high, inside <= high ? inside : low}) {
      const Vector p = point_on(arc, heading);
      if (dot(p, on_the_right(heading)) > 0.0) continue;
      return Flaw{i, "seen from the origin the curve does not go round it once: it turns back at " + place_text(p)};
    }
    return std::nullopt;
  }

  std::optional<Flaw> turning_back_in_x(std::size_t i) const {
    const double begin = std::remainder(in_[i], whole_turn), end = begin + turn_[i];
    if (std::max(std::abs(begin), std::abs(end)) < quarter_turn) return std::nullopt;
    return Flaw{i, "the curve turns back at " + place_text(point_on(arcs_[i], in_[i])) + ": x must increase along it"};
  }

  ArcCurve finished() const {
    ArcCurve curve;
    curve.closed_ = closed_;
    const auto add = [&](const Vector& begin, Piece piece) {
      piece.from = closed_ ? std::atan2(begin[1], begin[0]) : begin[0];
      if (closed_ && !curve.pieces_.empty()) {
        piece.from = curve.pieces_.front().from + within_turn(piece.from - curve.pieces_.front().from);
      }
      curve.pieces_.push_back(piece);
    };
    const std::size_t n = arcs_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Arc& arc = arcs_[i];
      const double out = in_[i] + turn_[i];
      if (turn_[i] != 0.0) add(point_on(arc, in_[i]), {0.0, false, arc.centre, arc.radius, 0.0});
      if (closed_ ? n == 1 : i + 1 == n) continue;
      const Vector from = point_on(arc, out), to = point_on(arcs_[(i + 1) % n], out);
      const bool some = std::hypot(to[0] - from[0], to[1] - from[1]) > 0.0;
      if (some) add(from, {0.0, true, from, 0.0, out});
      if (i + 2 == n) curve.last_ = to[0];
    }
    return curve;
  }

  std::vector<Arc> arcs_;
  bool closed_;
  std::vector<double> in_, turn_;  ///< of arcs: heading where it begins, what is turned along it [rad]
};

std::variant<ArcCurve, ArcCurve::Flaw> ArcCurve::make(std::vector<Arc> arcs, bool closed, double aside) {
  return Maker(std::move(arcs), closed).make(aside);
}

ArcCurve::At ArcCurve::at(double x) const noexcept {
  if (closed_) x = pieces_.front().from + within_turn(x - pieces_.front().from);
  const double inside = closed_ ? x : std::clamp(x, pieces_.front().from, last_);
  const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), inside,
                                     [](double place, const Piece& piece) { return place < piece.from; });
  const Piece& piece = next == pieces_.begin() ? pieces_.front() : *std::prev(next);
  if (closed_) return distance(piece, x);
  const At there = height(piece, inside);
  return {there.value + there.slope * (x - inside), there.slope};
}

// Where the piece after that at x begins, for ever after the last of an open curve.
double ArcCurve::end_of_piece(double x) const noexcept {
  const double first = pieces_.front().from, place = closed_ ? first + within_turn(x - first) : x;
  const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), place,
                                     [](double at, const Piece& piece) { return at < piece.from; });
  if (!closed_) return next == pieces_.end() ? std::numeric_limits<double>::infinity() : next->from;
  return x + (next == pieces_.end() ? first + whole_turn : next->from) - place;
}

// Along a piece the slope of a height never turns back, and that of a distance does so once at most: it is looked at in
// five places and taken to be half as wide again.
ArcCurve::Range ArcCurve::over(double from, double to) const noexcept {
  Range out{};
  bool first = true;
  for (double begin = from; first || begin < to;) {
    const double next = end_of_piece(begin), end = next > begin ? std::min(next, to) : to;
    const double half = 0.5 * (end - begin);
    Interval slope = Interval::at(at(begin + half).slope);
    for (const double s : {0.0, 0.25, 0.75, 1.0}) {
      slope = hull(slope, Interval::at(at(begin + s * (1.0 - 1e-9) * (end - begin)).slope));
    }
    const double more = 0.25 * (slope.high - slope.low);
    slope = {slope.low - more, slope.high + more};
    const Interval value = Interval::at(at(begin + half).value) + slope * Interval{-half, half};
    out = first ? Range{value, slope} : Range{hull(out.value, value), hull(out.slope, slope)};
    first = false;
    begin = end;
  }
  return out;
}

// Opposite to where it is, it passes zero once more, the other way.
double ArcCurve::past(std::size_t joint, double x) const noexcept {
  return closed_ ? std::sin(x - pieces_[joint].from) : x - pieces_[joint + 1].from;
}

// With u at that angle and t across it: of an arc rho u = c + r n, and the curve goes along n turned to the left.
ArcCurve::At ArcCurve::distance(const Piece& piece, double angle) const noexcept {
  const Vector u = direction(angle), t = {-u[1], u[0]};
  if (piece.straight) {
    const Vector n = on_the_right(piece.heading);
    const double rho = dot(piece.place, n) / dot(u, n);
    return {rho, -rho * dot(t, n) / dot(u, n)};
  }
  const double along = dot(piece.place, u), across = dot(piece.place, t);
  const double root = std::sqrt(std::max(0.0, piece.radius * piece.radius - across * across));
  const double rho = along + (piece.radius > 0.0 ? root : -root);
  // n = (rho u - c)/r
  const double n_u = (rho - along) / piece.radius, n_t = -across / piece.radius;
  return {rho, -rho * n_t / n_u};
}

ArcCurve::At ArcCurve::height(const Piece& piece, double x) noexcept {
  const double dx = x - piece.place[0];
  if (piece.straight) {
    const double slope = std::tan(piece.heading);
    return {piece.place[1] + slope * dx, slope};
  }
  const double sine = dx / piece.radius, cosine = std::sqrt(std::max(0.0, 1.0 - sine * sine));
  return {piece.place[1] - piece.radius * cosine, sine / cosine};
}

namespace {

struct ArcFormula final : ServedFormula {
  explicit ArcFormula(ArcCurve arcs) : curve(std::move(arcs)) {}

  bool may_hide() const noexcept override { return true; }
  bool value(std::span<const double> variables, double& out) const noexcept override {
    out = curve.at(variables[0]).value;
    return true;
  }
  void bound(const FormulaBounds::Span& span, FormulaBounds::Bounds& out) const noexcept override {
    const Jet& x = span.at_middle[0];
    const ArcCurve::At at = curve.at(x.value);
    out.at_middle = {at.value, at.slope * x.rate, 0.0};
    const IntervalJet& way = span.ranges[0];
    if (!way.value.is_finite()) {
      out.range = unknown_jet();
      return;
    }
    const ArcCurve::Range range = curve.over(way.value.low, way.value.high);
    out.range = {range.value, range.slope * way.rate, Interval::whole()};
    tighten(out.range, out.at_middle, span.half);
  }

  ArcCurve curve;
};

constexpr abi::FormulaTable arc_formula{
    sizeof(abi::FormulaTable),
    [](const void* self, Span<const double> variables, double* value, Span<double> slopes, Message*) noexcept {
      FormulaCalls::note(self, variables);
      const ArcCurve::At at = static_cast<const ArcFormula*>(self)->curve.at(variables[0]);
      *value = at.value;
      std::ranges::fill(slopes, 0.0);
      if (!slopes.empty()) slopes[0] = at.slope;
      return Status::ok;
    },
    [](const void* self) noexcept {
      return static_cast<std::int32_t>(static_cast<const ArcFormula*>(self)->curve.joints());
    },
    [](const void* self, Span<const double> variables, Span<double> values) noexcept {
      for (std::size_t i = 0; i < values.size; ++i) {
        values[i] = static_cast<const ArcFormula*>(self)->curve.past(i, variables[0]);
      }
    }};

}  // namespace

void set_arc_formula(ParameterValue& value, ArcCurve curve) {
  const auto served = std::make_shared<const ArcFormula>(std::move(curve));
  value.formula = Formula(arc_formula, served.get());
  value.function_owner = served;
  value.served = served;
}

}  // namespace freeplay
