// PathOverrides: values of the command line in the place of values of the file, by their path in the expanded model.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "format/build_options.h"
#include "format/document.h"

namespace freeplay {

class PathOverrides {
 public:
  /// The entries of `options.set` whose name has a dot, or is a section of the model; the last one of a name wins.
  /// Throws Error{usage} for paths that stand before the expansion (`templates`, `presets`, `instances`, `plugins`,
  /// `urdf`, `study`). Texts that begin with `{` or `[` are read by `options.parse_value`. Makes the texts known to
  /// `diagnostics`.
  PathOverrides(const BuildOptions& options, Diagnostics& diagnostics);

  /// Is the name a path, rather than a parameter?
  static bool is_path(std::string_view name);
  bool empty() const { return entries_.empty(); }

  /// What stands at the address ("joints.leg1.B.clearance.radial_clearance", list items by number): `written`, or the
  /// value of the command line. The last pattern that fits wins.
  const Node& replace(const std::string& address, const Node& written);

  /// Throws Error{usage} with the nearest name when a path led nowhere. Call when the whole file was read without
  /// errors.
  void require_found() const;

 private:
  struct Entry {
    std::string path, file;  ///< file: of the text, for messages
    const Node* value;
    bool found = false;
    std::string reached;                  ///< the longest beginning of the path that the model has
    std::vector<std::string> candidates;  ///< what stands below that
  };
  void note(Entry& entry, const std::string& address) const;

  std::deque<Document> documents_;
  std::vector<Entry> entries_;
  std::vector<std::string>* addresses_;
};

}  // namespace freeplay
