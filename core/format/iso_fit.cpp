#include "format/iso_fit.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <string>

namespace freeplay {
namespace {

constexpr std::size_t sizes = 13;
using Row = std::array<int, sizes>;  // [um]

constexpr std::array<double, sizes> largest_diameters = {3,   6,   10,  18,  30,  50, 80,
                                                         120, 180, 250, 315, 400, 500};  // [mm]

constexpr int first_grade = 5;
constexpr std::array<Row, 7> grades = {{{4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27},
                                        {6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40},
                                        {10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63},
                                        {14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97},
                                        {25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155},
                                        {40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250},
                                        {60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400}}};

/// Distance of the zone from the nominal size; of d, e, f, g and h.
constexpr std::string_view letters = "defgh";
constexpr std::array<Row, 5> distances = {{{20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230},
                                           {14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135},
                                           {6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68},
                                           {2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20},
                                           {}}};

struct Zone {
  double low, high;  // [um]
};

/// Of a shaft such as "g6", in small letters.
std::optional<Zone> shaft_zone(std::string_view code, std::size_t size) {
  const std::size_t digits = code.find_first_of("0123456789");
  if (digits == std::string_view::npos) return std::nullopt;
  const std::string_view word = code.substr(0, digits), number = code.substr(digits);
  int grade = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), grade);
  const bool whole = error == std::errc() && end == number.data() + number.size() && number.front() != '0';
  if (!whole || grade < first_grade || grade >= first_grade + static_cast<int>(grades.size())) return std::nullopt;
  const double width = grades[static_cast<std::size_t>(grade - first_grade)][size];
  if (word == "js") return Zone{-width / 2, width / 2};
  const std::size_t letter = word.size() == 1 ? letters.find(word) : std::string_view::npos;
  if (letter == std::string_view::npos) return std::nullopt;
  const double distance = distances[letter][size];
  return Zone{-distance - width, -distance};
}

/// Holes mirror the shafts of the same letter.
std::optional<Zone> hole_zone(std::string_view code, std::size_t size) {
  std::string small;
  for (const char c : code) {
    if (c >= 'a' && c <= 'z') return std::nullopt;
    small += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  const std::optional<Zone> shaft = shaft_zone(small, size);
  if (!shaft) return std::nullopt;
  return Zone{-shaft->high, -shaft->low};
}

}  // namespace

std::optional<IsoFit> iso_fit(std::string_view code, double diameter) {
  constexpr double slack = 1e-9;  // of a diameter that was written in another unit
  if (!(diameter > 0.0)) return std::nullopt;
  std::size_t size = 0;
  while (size < sizes && diameter * 1e3 > largest_diameters[size] * (1 + slack)) ++size;
  const std::size_t slash = code.find('/');
  if (size == sizes || slash == std::string_view::npos) return std::nullopt;
  const std::optional<Zone> hole = hole_zone(code.substr(0, slash), size);
  const std::optional<Zone> shaft = shaft_zone(code.substr(slash + 1), size);
  if (!hole || !shaft) return std::nullopt;
  return IsoFit{hole->low / 1e6, hole->high / 1e6, shaft->low / 1e6, shaft->high / 1e6};
}

}  // namespace freeplay
