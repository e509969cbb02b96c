// PointSet: which points of a study, a bit each.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>

namespace freeplay {

/// Pages are made where there are points: a few of 10^12 take no memory.
class PointSet {
 public:
  /// Returns whether it was not there.
  bool insert(std::uint64_t point);
  bool erase(std::uint64_t point);
  bool has(std::uint64_t point) const;
  std::uint64_t count() const { return count_; }

 private:
  static constexpr std::uint64_t page_bits = 1 << 15;
  using Page = std::array<std::uint64_t, page_bits / 64>;

  std::unordered_map<std::uint64_t, std::unique_ptr<Page>> pages_;
  std::uint64_t count_ = 0;
};

}  // namespace freeplay
