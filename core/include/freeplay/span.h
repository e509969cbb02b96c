// Span: a pointer and a size, the only array type that crosses the plugin boundary.
#pragma once

#include <cstddef>
#include <ranges>
#include <span>
#include <type_traits>

namespace freeplay {

/// View of `size` contiguous numbers. Plain data: the layout of std::span belongs to the standard library.
template <class T>
struct Span {
  T* data = nullptr;
  std::size_t size = 0;

  constexpr Span() = default;
  constexpr Span(T* first, std::size_t count) : data(first), size(count) {}
  constexpr Span(std::span<T> view) : data(view.data()), size(view.size()) {}
  template <std::size_t N>
  constexpr Span(T (&array)[N]) : data(array), size(N) {}
  /// A view of numbers that may be written is also one of numbers that may only be read.
  template <class U>
  requires(std::is_same_v<const U, T>) constexpr Span(Span<U> other) : data(other.data), size(other.size) {}

  constexpr T& operator[](std::size_t i) const { return data[i]; }
  constexpr T* begin() const { return data; }
  constexpr T* end() const { return data + size; }
  constexpr bool empty() const { return size == 0; }
  constexpr Span part(std::size_t offset, std::size_t count) const { return {data + offset, count}; }
};

}  // namespace freeplay

/// A Span refers to numbers that outlive it, so that it turns into a std::span implicitly.
template <class T>
inline constexpr bool std::ranges::enable_borrowed_range<freeplay::Span<T>> = true;
