#include "python/column_block.h"

#include <algorithm>
#include <new>
#include <utility>

#include <sys/mman.h>

namespace freeplay {
namespace {

std::size_t bytes_of(std::size_t columns, std::size_t rows) {
  std::size_t bytes = 0;
  if (__builtin_mul_overflow(columns * sizeof(double), rows, &bytes)) throw std::bad_alloc();
  return bytes;
}

std::shared_ptr<double> mapped(std::size_t bytes) {
  void* const place =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (place == MAP_FAILED) throw std::bad_alloc();
  // The beginning of every column would take a large page.
  ::madvise(place, bytes, MADV_NOHUGEPAGE);
  return {static_cast<double*>(place), [bytes](double* numbers) { ::munmap(numbers, bytes); }};
}

}  // namespace

ColumnBlock::ColumnBlock(std::size_t columns, std::size_t expected_rows)
    : columns_(columns), room_(std::max<std::size_t>(expected_rows, 1)), data_(mapped(bytes_of(columns_, room_))) {}

void ColumnBlock::add(std::span<const double> row) {
  if (rows_ == room_) {
    ColumnBlock larger(columns_, 2 * room_);
    for (std::size_t i = 0; i < columns_; ++i) {
      std::copy_n(data() + i * room_, rows_, larger.data_.get() + i * larger.room_);
    }
    data_ = std::move(larger.data_);
    room_ = larger.room_;
  }
  for (std::size_t i = 0; i < columns_; ++i) data_.get()[i * room_ + rows_] = row[i];
  ++rows_;
}

}  // namespace freeplay
