// Diagnostics: the errors and warnings of the input files, collected and printed in one format.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
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

/// Collects messages and prints them. Nothing is thrown; a reader goes on after an error as long as it makes sense.
class Diagnostics {
 public:
  /// With `strict`, warnings are errors.
  explicit Diagnostics(bool strict = false) : strict_(strict) {}

  /// Makes the text of `file` known, so that its lines can be shown. The order of these calls is the order of files.
  void add_source(const std::string& file, std::string text);

  void add(Diagnostic diagnostic);

  /// Shorthands for the common case.
  void error(Location location, int length, std::string id, std::string message, std::string suggestion = {},
             std::string hint = {});
  void warning(Location location, int length, std::string id, std::string message, std::string suggestion = {},
               std::string hint = {});

  bool has_errors() const { return errors_ > 0; }

  /// All messages by order of files, line, column; of messages with the same place, id and text only the first.
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
  int errors_ = 0;
  std::vector<Diagnostic> diagnostics_;
  std::map<std::string, Source> sources_;
};

}  // namespace freeplay
