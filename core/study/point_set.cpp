#include "study/point_set.h"

namespace freeplay {

bool PointSet::insert(std::uint64_t point) {
  std::unique_ptr<Page>& page = pages_[point / page_bits];
  if (!page) page = std::make_unique<Page>();
  std::uint64_t& word = (*page)[point % page_bits / 64];
  const std::uint64_t bit = std::uint64_t{1} << point % 64;
  if ((word & bit) != 0) return false;
  word |= bit;
  ++count_;
  return true;
}

bool PointSet::erase(std::uint64_t point) {
  if (!has(point)) return false;
  (*pages_.find(point / page_bits)->second)[point % page_bits / 64] &= ~(std::uint64_t{1} << point % 64);
  --count_;
  return true;
}

bool PointSet::has(std::uint64_t point) const {
  const auto page = pages_.find(point / page_bits);
  return page != pages_.end() && ((*page->second)[point % page_bits / 64] >> point % 64 & 1) != 0;
}

}  // namespace freeplay
