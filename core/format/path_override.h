// PathOverrides: values of the command line in the place of values of the file, and where it has none, by their path in
// the expanded model.
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

/// What the keys of a map from names are: names of what stands there, or references to what stands elsewhere, which may
/// hold dots.
enum class MapNames { own, references };

class PathOverrides {
 public:
  /// The entries of `options.set` whose name has a dot, or is a section of the model; the last one of a name wins.
  /// Throws Error{usage} for paths that stand before the expansion (`templates`, `presets`, `instances`, `plugins`,
  /// `urdf`, `study`). Texts that begin with `{` or `[` are read by `options.parse_value`. Makes the texts known to
  /// `diagnostics`.
  PathOverrides(const BuildOptions& options, Diagnostics& diagnostics);

  /// Is the name a path, rather than a parameter?
  static bool is_path(std::string_view name);
  /// With this value: a whole section is given by a list or map, which no parameter can be.
  static bool is_path(std::string_view name, std::string_view value);
  bool empty() const { return entries_.empty(); }

  /// What stands at the address ("joints.leg1.B.clearance.radial_clearance", list items by number): `written`, or the
  /// value of the command line. The last pattern that fits wins.
  const Node& replace(const std::string& address, const Node& written);
  /// For a key that a reader looks for and the file lacks: an entry with the value of the command line, or with a map
  /// for what it has below. Null when it has nothing there.
  const Node::Entry* added(const std::string& address);
  /// Entries that the command line adds to the map of names at `address`, which has `written`. A name that may be one
  /// of its own misspelt is none.
  std::vector<const Node::Entry*> added_names(const std::string& address, const std::vector<std::string>& written,
                                              MapNames names);
  /// A key that may stand there, written or not.
  void offer(const std::string& address);

  /// Throws Error{usage} with the nearest name when a path led nowhere. Call when the whole file was read without
  /// errors.
  void require_found() const;

 private:
  struct Entry {
    std::string path, file;  ///< file: of the text, for messages
    const Node* value;
    bool found = false;
    std::string reached;                  ///< the longest beginning of the path that the model has
    const Node* at = nullptr;             ///< what stands there
    std::vector<std::string> candidates;  ///< what stands below that
  };
  static void note(Entry& entry, const std::string& address, const Node& value);
  static void note_candidate(Entry& entry, const std::string& address);
  static std::string hint_for(const Entry& entry, const std::string& rest);
  const Entry* first_below(const std::string& address) const;
  const Node::Entry& make(const std::string& address, const std::string& key, const Entry& from);

  std::deque<Document> documents_;
  std::vector<Entry> entries_;
  std::deque<Node> nodes_;
  std::map<std::string, Node::Entry> made_;  ///< by address
  std::vector<std::string>*addresses_, *offered_;
};

}  // namespace freeplay
