#include "assembly/joint_miss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double beside = 1e-5;  // of the other, in m and rad: rounding

}  // namespace

std::vector<char> rows_of_lengths(const ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows) {
  std::vector<char> lengths(rows.row.size(), 0);
  for (int column = 0; column < static_cast<int>(rows.matrix.cols()); ++column) {
    if (mechanism.system.coordinates().is_turn(column)) continue;
    for (SparseMatrix::InnerIterator entry(rows.matrix, column); entry; ++entry) {
      if (entry.value() != 0.0) lengths[static_cast<std::size_t>(entry.row())] = 1;
    }
  }
  return lengths;
}

JointMiss miss_of(int joint, const ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows) {
  const std::vector<char> lengths = rows_of_lengths(mechanism, rows);
  const Slice own = mechanism.system.layout().rows(joint);
  JointMiss miss;
  for (std::size_t i = 0; i < rows.row.size(); ++i) {
    if (rows.row[i] < own.offset || rows.row[i] >= own.offset + own.size) continue;
    double& sum = lengths[i] ? miss.length : miss.angle;
    sum = std::hypot(sum, rows.residual[static_cast<Eigen::Index>(i)]);
  }
  return miss;
}

std::string words(const JointMiss& miss, double least, int digits) {
  const std::string length = fmt::format("{:.{}g} m", miss.length, digits);
  const std::string angle = fmt::format("{:.4g} deg", miss.angle * 180.0 / std::numbers::pi);
  if (miss.angle <= std::max(least, beside * miss.length)) return length;
  return miss.length <= std::max(least, beside * miss.angle) ? angle : length + " and " + angle;
}

}  // namespace freeplay
