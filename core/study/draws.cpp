#include "study/draws.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/random/sobol.hpp>

#include "base/philox.h"

namespace freeplay {
namespace {

constexpr std::uint64_t key_of_draws = 0x73747564, key_of_shuffles = 0x7065726d;
constexpr std::uint64_t shift_sample = std::uint64_t{1} << 63;  // no study has it
constexpr unsigned fraction_bits = 52;

using SobolEngine = boost::random::sobol_engine<std::uint64_t, fraction_bits, boost::random::default_sobol_table>;

/// From the bits of a fraction to the middle of what they stand for.
double middle(std::uint64_t bits) { return (static_cast<double>(bits) + 0.5) * 0x1p-52; }

/// The part `word` of 2^64 of `count`, rounded down.
std::uint64_t share(std::uint64_t word, std::uint64_t count) {
  __extension__ using Product = unsigned __int128;
  return static_cast<std::uint64_t>(Product{word} * count >> 64);
}

}  // namespace

// A Feistel network with additions on pairs (a, b), a < rows, b < columns; what comes out beyond the count goes through
// again (Black and Rogaway, "Ciphers with arbitrary finite domains", 2002).
std::uint64_t shuffled(std::uint64_t index, std::uint64_t count, std::uint64_t seed, std::uint64_t axis) {
  constexpr int rounds = 8;
  auto rows = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(count)));
  while (rows * rows < count) ++rows;
  const std::uint64_t columns = (count + rows - 1) / rows;
  do {
    std::uint64_t a = index % rows, b = index / rows;
    for (std::uint64_t round = 0; round < rounds; ++round) {
      const std::uint64_t other = round % 2 == 0 ? b : a;
      const std::uint64_t word = philox({other, axis, round, count}, {seed, key_of_shuffles})[0];
      if (round % 2 == 0) {
        a = (a + share(word, rows)) % rows;
      } else {
        b = (b + share(word, columns)) % columns;
      }
    }
    index = a + rows * b;
  } while (index >= count);
  return index;
}

struct Draws::Sobol {
  explicit Sobol(std::size_t axes) : engine(axes), shifts(axes) {}
  SobolEngine engine;
  std::vector<std::uint64_t> shifts;
};

Draws::Draws(SampleMethod method, std::uint64_t seed, std::uint64_t samples, std::size_t axes)
    : method_(method), seed_(seed), samples_(samples), axes_(axes) {
  if (method != SampleMethod::sobol || axes == 0) return;
  sobol_ = std::make_unique<Sobol>(axes);
  for (std::size_t axis = 0; axis < axes; ++axis) sobol_->shifts[axis] = word(shift_sample, axis) >> 12;
}

Draws::~Draws() = default;
Draws::Draws(Draws&&) noexcept = default;
Draws& Draws::operator=(Draws&&) noexcept = default;

std::uint64_t Draws::word(std::uint64_t sample, std::size_t axis) const {
  return philox({sample, axis, 0, 0}, {seed_, key_of_draws})[0];
}

// Rounding must not lead into the next stratum.
double Draws::in_stratum(std::uint64_t sample, std::size_t axis) const {
  const auto low = static_cast<double>(shuffled(sample, samples_, seed_, axis));
  const double place = std::min(low + unit_number(word(sample, axis)), std::nextafter(low + 1.0, 0.0));
  return std::clamp(place / static_cast<double>(samples_), 0x1p-53, 1.0 - 0x1p-53);
}

void Draws::fill(std::uint64_t sample, std::span<double> numbers) const {
  if (sobol_) {
    if (sample > 0) sobol_->engine.seed(sample - 1);  // Boost leaves out the first element, which is zero
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const std::uint64_t element = sample > 0 ? sobol_->engine() : 0;
      numbers[axis] = middle(element ^ sobol_->shifts[axis]);
    }
    return;
  }
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    numbers[axis] = method_ == SampleMethod::random ? unit_number(word(sample, axis)) : in_stratum(sample, axis);
  }
}

}  // namespace freeplay
