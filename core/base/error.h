// Error: the core's only exception. Location: a place in an input file.
#pragma once

#include <exception>
#include <string>
#include <utility>

namespace freeplay {

/// A place in an input text. Lines and columns count from 1, columns in characters; 0 means "no place known".
struct Location {
  std::string file;
  int line = 0, column = 0;
};

/// Thrown while a model is read and built, and by commands; never inside the time loop.
/// `id` is the stable message id of the model format, such as "unknown-key".
class Error : public std::exception {
 public:
  enum class Category { usage, input, numerical, plugin, file, internal };

  Error(Category category, std::string id, std::string message, Location location = {}, std::string hint = {})
      : category_(category),
        id_(std::move(id)),
        message_(std::move(message)),
        location_(std::move(location)),
        hint_(std::move(hint)) {}

  const char* what() const noexcept override { return message_.c_str(); }
  Category category() const { return category_; }
  const std::string& id() const { return id_; }
  const std::string& message() const { return message_; }
  const Location& location() const { return location_; }
  const std::string& hint() const { return hint_; }

  /// Exit code of the command line for this category: internal 1, usage 2, input 3, numerical 4, plugin 5, file 6.
  int exit_code() const {
    switch (category_) {
      case Category::usage:
        return 2;
      case Category::input:
        return 3;
      case Category::numerical:
        return 4;
      case Category::plugin:
        return 5;
      case Category::file:
        return 6;
      case Category::internal:
        break;
    }
    return 1;
  }

 private:
  Category category_;
  std::string id_, message_;
  Location location_;
  std::string hint_;
};

}  // namespace freeplay
