// Hdf5Call: what every use of the HDF5 library needs: its lock, its handles, its failures as exceptions.
#pragma once

#include <cstddef>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include <hdf5.h>

namespace freeplay {

/// A call failed; the text is the system's reason where there is one.
struct Hdf5Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Held during any call: the library knows one thread at a time. The first one sets it up, or throws std::bad_alloc. A
/// thread may hold several.
class Hdf5Lock {
 public:
  Hdf5Lock();

 private:
  std::lock_guard<std::recursive_mutex> lock_;
};

/// In a process that was started while the lock was held: there it is free.
void renew_hdf5_lock();

/// Throws std::bad_alloc where the system would not give what calls may want, `more` bytes besides what every one may:
/// the library ends the program when it gets less.
void require_memory_for_hdf5(std::size_t more = 0);

/// Throws the reason of the last failure.
[[noreturn]] void fail_hdf5();

/// What a call returned, or its failure.
template <class Result>
Result checked(Result result) {
  if (result < 0) fail_hdf5();
  return result;
}

/// Closes what it holds, but not where a call has failed: no other may be made on that file then.
class Hdf5Id {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Id() = default;
  Hdf5Id(hid_t id, Close close) : id_(checked(id)), close_(close) {}
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Id() {
    if (id_ >= 0 && std::uncaught_exceptions() == under_way_) close_(id_);
  }
  operator hid_t() const { return id_; }
  /// Closes and reports a failure of that.
  void close() {
    if (id_ >= 0) checked(close_(std::exchange(id_, -1)));
  }
  void abandon() { id_ = -1; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
  int under_way_ = std::uncaught_exceptions();
};

/// Name of the dataset of a channel: its '/' is no folder.
std::string dataset_name(std::string channel);

}  // namespace freeplay
