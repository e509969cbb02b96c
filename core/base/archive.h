// Archive: what changes during a run as plain numbers, written by its owners and read back in the same order.
//
// A class lists its members once, for both directions:
//   template <class Self, class Archive>
//   static void exchange(Self& self, Archive& archive) { archive(self.time_, self.values_); }
// Where reading takes more than that, as of factors that follow from saved matrices, it has
//   void save(ArchiveWriter& archive) const;   void restore(ArchiveReader& archive);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace freeplay {

/// The numbers, in the order in which they were written. Doubles keep all their bits.
struct Archive {
  std::vector<double> reals;
  std::vector<std::int64_t> integers;  ///< counts, flags, sizes of lists, characters

  friend bool operator==(const Archive& a, const Archive& b);  ///< bit for bit
};

/// Lists their own members, see above.
template <class T, class A>
concept Exchanged = requires(T& value, A& archive) {
  T::exchange(value, archive);
};

class ArchiveWriter {
 public:
  explicit ArchiveWriter(Archive& archive) : archive_(archive) {}

  // Cold, here and below: a state is written once in thousands of steps, so small code serves better than quick code.
  template <class... T>
  [[gnu::cold]] void operator()(const T&... values) {
    (put(values), ...);
  }
  /// A list whose length changes during a run.
  template <class T>
  void list(const std::vector<T>& values) {
    put(values);
  }
  /// Lists of structs that are made of doubles alone.
  template <class... T>
  void doubles(const std::vector<T>&... lists) {
    (put_doubles(lists), ...);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      archive_.reals.push_back(value);
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
      archive_.integers.push_back(static_cast<std::int64_t>(value));
    } else if constexpr (Exchanged<T, ArchiveWriter>) {
      T::exchange(value, *this);
    } else {
      value.save(*this);
    }
  }
  template <class T>
  void put(const std::vector<T>& values) {
    if constexpr (std::is_same_v<T, double>) {
      put_doubles(values);
    } else {
      put(values.size());
      for (const T& value : values) put(value);
    }
  }
  template <class T, std::size_t count>
  void put(const std::array<T, count>& values) {
    for (const T& value : values) put(value);
  }
  template <class T, std::size_t count>
  void put(const T (&values)[count]) {
    for (const T& value : values) put(value);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  void put(const std::string& text) {
    put(text.size());
    for (const char c : text) put(c);
  }
  template <class T>
  [[gnu::cold]] void put_doubles(const std::vector<T>& values) {
    static_assert(sizeof(T) % sizeof(double) == 0 && alignof(T) == alignof(double));
    put(values.size());
    const std::size_t count = values.size() * sizeof(T) / sizeof(double), first = archive_.reals.size();
    archive_.reals.resize(first + count);
    if (count > 0) {
      const void* const from = values.data();  // structs of doubles, Eigen's among them, which are copied bit for bit
      std::memcpy(archive_.reals.data() + first, from, count * sizeof(double));
    }
  }

  Archive& archive_;
};

/// Throws Error{input} "state-mismatch" where the numbers are not those that its callers expect: those of another
/// model, or damaged ones.
class ArchiveReader {
 public:
  explicit ArchiveReader(const Archive& archive) : archive_(archive) {}

  /// Lists keep their lengths.
  template <class... T>
  [[gnu::cold]] void operator()(T&... values) {
    (get(values), ...);
  }
  template <class T>
  [[gnu::cold]] void list(std::vector<T>& values) {
    // Whatever is damaged asks for no more room than the numbers that are there take themselves.
    const std::int64_t count = integer();
    require(count >= 0 && static_cast<std::uint64_t>(count) <= archive_.reals.size() + archive_.integers.size());
    values.resize(static_cast<std::size_t>(count));
    for (T& value : values) get(value);
  }
  template <class... T>
  void doubles(std::vector<T>&... lists) {
    (get_doubles(lists), ...);
  }
  /// A number of a fixed set, such as a size: any other one is a mismatch.
  void expect(std::int64_t value) { require(integer() == value); }
  static void require(bool good);
  /// Nothing may be left.
  void finish() const { require(real_ == archive_.reals.size() && integer_ == archive_.integers.size()); }

 private:
  double real() {
    require(real_ < archive_.reals.size());
    return archive_.reals[real_++];
  }
  std::int64_t integer() {
    require(integer_ < archive_.integers.size());
    return archive_.integers[integer_++];
  }
  template <class T>
  void get(T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      value = real();
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
      value = static_cast<T>(integer());
    } else if constexpr (Exchanged<T, ArchiveReader>) {
      T::exchange(value, *this);
    } else {
      value.restore(*this);
    }
  }
  template <class T>
  void get(std::vector<T>& values) {
    if constexpr (std::is_same_v<T, double>) {
      get_doubles(values);
    } else {
      expect(static_cast<std::int64_t>(values.size()));
      for (T& value : values) get(value);
    }
  }
  template <class T, std::size_t count>
  void get(std::array<T, count>& values) {
    for (T& value : values) get(value);
  }
  template <class T, std::size_t count>
  void get(T (&values)[count]) {
    for (T& value : values) get(value);
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool has = false;
    get(has);
    value.reset();
    if (has) get(value.emplace());
  }
  void get(std::string& text) {
    std::vector<char> characters;
    list(characters);
    text.assign(characters.begin(), characters.end());
  }
  template <class T>
  [[gnu::cold]] void get_doubles(std::vector<T>& values) {
    expect(static_cast<std::int64_t>(values.size()));
    const std::size_t count = values.size() * sizeof(T) / sizeof(double);
    require(count <= archive_.reals.size() - real_);
    if (count > 0)
      std::memcpy(static_cast<void*>(values.data()), archive_.reals.data() + real_, count * sizeof(double));
    real_ += count;
  }

  const Archive& archive_;
  std::size_t real_ = 0, integer_ = 0;
};

}  // namespace freeplay
