// Diagnostics: the errors and warnings of the input files, collected and printed in one format.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/error.h"

namespace freeplay {

enum class Severity { error, warning };

/// One message of section 17 of the model format.
struct Diagnostic {
  Severity severity = Severity::error;
  std::string id;                    ///< stable, such as "unknown-key"
  std::string message;               ///< one line, without the id
  Location location{};               ///< line 0: the file as a whole
  int length = 1;                    ///< width of the caret line [characters]; cut at the end of the source line
  std::string suggestion{};          ///< a word, printed as: did you mean 'word'?
  std::string hint{};                ///< a free line
  std::vector<std::string> notes{};  ///< more lines, such as "in instance 'leg2'"
};

/// Stands for the file of messages that belong to none.
inline constexpr const char* program_as_file = "freeplay";

/// The error as a message of its file; one that has no file belongs to the program.
Diagnostic as_diagnostic(const Error& error);

/// Collects messages and prints them. A reader goes on after an error as long as it makes sense. A message with the
/// same place, id and text as an earlier one (an error in a template, say, once more for the next instance) is not
/// kept.
class Diagnostics {
 public:
  /// Limits for a text that is hostile or no model at all: messages that are kept, and errors that are reported.
  static constexpr int most_messages = 10'000, most_errors = 20'000;

  /// With `strict`, warnings are errors.
  explicit Diagnostics(bool strict = false) : strict_(strict) {}

  /// Makes the text of `file` known, so that its lines can be shown. The order of these calls is the order of files.
  void add_source(const std::string& file, std::string text);

  /// Throws Error{input} `too-large`, once, when errors reach one of the limits; the caller keeps it as the last
  /// message. Warnings beyond the limit are only counted.
  void add(Diagnostic diagnostic);

  /// From now on messages of these ids are not kept: what they are about may follow from an error reported before.
  /// Returns the ids excused before.
  std::set<std::string> excuse(std::set<std::string> ids) { return std::exchange(excused_, std::move(ids)); }

  /// Shorthands for the common case.
  void error(Location location, int length, std::string id, std::string message, std::string suggestion = {},
             std::string hint = {});
  void warning(Location location, int length, std::string id, std::string message, std::string suggestion = {},
               std::string hint = {});

  bool has_errors() const { return errors_ > 0; }
  int errors() const { return errors_; }

  /// All messages by order of files, line, column; last how many warnings were only counted.
  std::vector<Diagnostic> sorted() const;

  /// The messages as section 17 prints them, one after the other, each line ended by a line feed. After `max_errors`
  /// errors (0: no limit) the rest is left out and a last line says how many more there are. Control characters in
  /// names and source lines are replaced; long source lines are shown around the caret.
  std::string format(int max_errors) const;

 private:
  struct Source {
    std::size_t order = 0;
    std::string text;
    std::vector<std::size_t> line_starts;  // byte offsets
  };

  Source& source(const std::string& file);
  std::string_view source_line(const Location& location) const;
  void append(std::string& out, const Diagnostic& diagnostic) const;
  void append_source(std::string& out, const Diagnostic& diagnostic) const;

  bool strict_;
  int errors_ = 0, kept_errors_ = 0, left_out_ = 0;
  bool full_ = false;
  std::vector<Diagnostic> diagnostics_;
  std::unordered_set<std::string> known_;  // what makes each message the same as another
  std::set<std::string> excused_;
  std::map<std::string, Source> sources_;
};

}  // namespace freeplay
