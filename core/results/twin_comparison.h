// TwinComparison: how far a mechanism with clearances is from the same one without, row by row.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "model/channel.h"
#include "model/model.h"

namespace freeplay {

/// What both have of a row: time, poses of bodies, efforts of drivers.
class TwinNumbers {
 public:
  TwinNumbers(const Model& model, const Channels& channels);
  std::size_t size() const { return columns_.size(); }
  void pick(std::span<const double> row, std::span<double> numbers) const;

 private:
  std::vector<std::size_t> columns_;
};

class TwinComparison {
 public:
  explicit TwinComparison(const Model& model);

  /// Numbers of a row of the run and of the twin's row at the same time. What is before the time that counts is left
  /// out.
  void add(std::span<const double> numbers, std::span<const double> twin);
  /// `{bodies: {NAME: {max_position, rms_position, max_angle, rms_angle}}, drivers: {NAME: {max, rms, ripple}}}`, null
  /// without a row.
  Json json() const;

 private:
  struct Sum {
    double largest = 0.0, square = 0.0;
    void add(double value);
  };
  struct OfBody {
    Sum distance, angle;
  };
  struct OfDriver {
    Sum difference, twin;
  };
  double rms(const Sum& sum) const;

  const Model& model_;
  double from_, count_ = 0.0;
  std::vector<OfBody> bodies_;
  std::vector<OfDriver> drivers_;
};

}  // namespace freeplay
