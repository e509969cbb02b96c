#include "base/speed_law.h"

#include <algorithm>
#include <array>

namespace freeplay {
namespace {

using Step = SpeedLaw::Step;
using Program = std::vector<SpeedLaw::Instruction>;

constexpr double rounding = 1e-9;   // of written numbers that add up
constexpr double shortest = 1e-12;  // part of a law

/// From `begin` to `end` it goes by u (c[0] + u (c[1] + u c[2])) of the whole, where u is what is past `begin`; or,
/// where it is `left`, that much is still to go to `end` when u is: so that it ends exactly at rest.
struct Piece {
  double begin, end;
  std::array<double, 3> c;
  bool left = false;

  double way() const {
    const double u = end - begin;
    return u * (c[0] + u * (c[1] + u * c[2]));
  }
};

/// One after the other; those of no length are left out. The second half is the first one seen from its end.
std::vector<Piece> pieces_of(const SpeedLaw& law) {
  const double start = law.start, end = law.end, up = std::min(law.ramp, 0.5 * (end - start)),
               bend = std::min(law.rise, 0.5 * up);
  // With 1 as the largest acceleration.
  const double speed = up - bend, way = speed * (end - start - up), jerk = bend > 0.0 ? 1.0 / bend : 0.0;
  const auto course = [&](double v, double a, double j) {
    return std::array<double, 3>{v / way, a / (2.0 * way), j / (6.0 * way)};
  };
  const std::array<double, 3> rising = course(0.0, 0.0, jerk), even = course(0.5 * bend, 1.0, 0.0),
                              falling = course(speed - 0.5 * bend, 1.0, -jerk);
  const std::array<Piece, 7> parts = {{{start, start + bend, rising},
                                       {start + bend, start + up - bend, even},
                                       {start + up - bend, start + up, falling},
                                       {start + up, end - up, course(speed, 0.0, 0.0)},
                                       {end - up, end - up + bend, falling, true},
                                       {end - up + bend, end - bend, even, true},
                                       {end - bend, end, rising, true}}};
  std::vector<Piece> pieces;
  for (Piece part : parts) {
    if (part.end - part.begin <= shortest * (end - start)) continue;
    if (!pieces.empty()) part.begin = pieces.back().end;
    pieces.push_back(part);
  }
  return pieces;
}

/// The argument within the piece, as a distance from the end that it counts from. Neighbours compare it with the same
/// number, so that one ends where the next begins, whatever the rounding.
void append_gone(const Piece& piece, Program& program) {
  if (piece.left) program.push_back({Step::constant, piece.end});
  program.insert(
      program.end(),
      {{Step::argument}, {Step::constant, piece.begin}, {Step::maximum}, {Step::constant, piece.end}, {Step::minimum}});
  if (!piece.left) program.push_back({Step::constant, piece.begin});
  program.push_back({Step::subtract});
}

void append_way(const Piece& piece, Program& program) {
  std::size_t count = piece.c.size();
  while (count > 1 && piece.c[count - 1] == 0.0) --count;
  if (piece.left) program.push_back({Step::constant, piece.way()});
  append_gone(piece, program);
  for (std::size_t k = 0; k < count; ++k) {
    program.push_back({Step::constant, piece.c[k]});
    if (k + 1 < count) append_gone(piece, program);
  }
  for (std::size_t k = 1; k < count; ++k) program.insert(program.end(), {{Step::multiply}, {Step::add}});
  program.push_back({Step::multiply});
  if (piece.left) program.push_back({Step::subtract});
}

}  // namespace

std::optional<SpeedLaw::Flaw> SpeedLaw::flaw(bool curved) const {
  const double whole = end - start;
  if (!(whole > 0.0)) return Flaw{1, "the end must be after the start"};
  if (!(ramp > 0.0)) return Flaw{2, "the ramp must be positive"};
  if (ramp > 0.5 * whole * (1.0 + rounding)) return Flaw{2, "the ramp is at most half of the way from start to end"};
  if (curved && !(rise > 0.0)) return Flaw{3, "the rise must be positive"};
  if (rise > 0.5 * ramp * (1.0 + rounding)) return Flaw{3, "the rise is at most half of the ramp"};
  return std::nullopt;
}

std::vector<SpeedLaw::Instruction> SpeedLaw::program() const {
  Program program;
  for (const Piece& piece : pieces_of(*this)) {
    const bool first = program.empty();
    append_way(piece, program);
    if (!first) program.push_back({Step::add});
  }
  return program;
}

}  // namespace freeplay
