// Draws: the random numbers of a study, by sample and axis, each computed without the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace freeplay {

enum class SampleMethod { random, latin_hypercube, sobol };

inline constexpr std::size_t most_sobol_axes = 1000;

/// Place of sample `index` among the `count` strata of an axis: a bijection of 0 ... count - 1 by `seed` and `axis`.
std::uint64_t shuffled(std::uint64_t index, std::uint64_t count, std::uint64_t seed, std::uint64_t axis);

/// Numbers strictly between 0 and 1. The map from method, seed, samples, axis and sample to a number never changes: a
/// study means the same values for ever.
class Draws {
 public:
  /// `samples` counts for Latin hypercubes alone; at most most_sobol_axes axes are for Sobol's numbers.
  Draws(SampleMethod method, std::uint64_t seed, std::uint64_t samples, std::size_t axes);
  ~Draws();
  Draws(Draws&&) noexcept;
  Draws& operator=(Draws&&) noexcept;

  std::size_t axes() const { return axes_; }
  /// Those of all axes for one sample. One thread at a time.
  void fill(std::uint64_t sample, std::span<double> numbers) const;

 private:
  struct Sobol;
  std::uint64_t word(std::uint64_t sample, std::size_t axis) const;
  double in_stratum(std::uint64_t sample, std::size_t axis) const;

  SampleMethod method_;
  std::uint64_t seed_, samples_;
  std::size_t axes_;
  std::unique_ptr<Sobol> sobol_;
};

}  // namespace freeplay
