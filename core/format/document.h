// Document: a tree of values that know their place in the text they come from.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace freeplay {

/// A value: nothing, a scalar, a list or a map. Nodes live in a Document and are read through `const Node&`; an alias
/// is the same node at several places of the tree, so the tree is an acyclic graph.
struct Node {
  enum class Kind { null, scalar, list, map };
  struct Entry {
    const Node* key;  ///< always a scalar
    const Node* value;
  };

  Kind kind = Kind::null;
  int line = 0, column = 0;           ///< where the value begins, from 1; a quoted scalar begins at its quote
  int length = 1;                     ///< characters on the first line, quotes included; 1 for lists and maps
  std::string text{};                 ///< of a scalar: decoded, without quotes; `~` and `null` are scalars
  bool quoted = false;                ///< 'so' or "so", or a block scalar
  bool verbatim = false;              ///< the text stands in the file as it is, on one line
  bool foreign = false;               ///< a name that another format declares: it may begin with a digit
  std::vector<const Node*> items{};   ///< of a list
  std::vector<Entry> entries{};       ///< of a map, in file order
  const std::string* file = nullptr;  ///< owned by the document

  bool is_null() const { return kind == Kind::null; }
  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_list() const { return kind == Kind::list; }
  bool is_map() const { return kind == Kind::map; }

  /// "nothing", "a scalar", "a list" or "a map", for messages.
  const char* kind_name() const;

  /// Value of the entry `key` of a map, or null.
  const Node* find(std::string_view key) const;

  Location location() const { return {file ? *file : std::string(), line, column}; }

  /// The place of character `offset` of the text. A folded or escaped scalar has only the place where it begins.
  Location location_at(int offset) const;
};

/// Owns the nodes of one file. Immutable for its readers apart from replace_value(). Moving keeps the nodes in place.
class Document {
 public:
  /// A null node at 1:1 until the reader sets the root.
  Document(std::string file_name, std::string text);
  Document(Document&&) = default;
  Document& operator=(Document&&) = default;

  /// A document that is one scalar, `text` from line 1, column 1 of the pseudo file `file_name`.
  static Document scalar(std::string file_name, std::string text);

  const std::string& file_name() const { return files_.front(); }
  const std::string& text() const { return text_; }
  const Node& root() const { return *root_; }

  /// Replaces the value of entry `key` of `map`, which belongs to this document, by the scalar `text` that comes from
  /// the pseudo file `file_name` (such as "--set c"). Other uses of an aliased value stay as they are. Returns false if
  /// there is no such entry.
  bool replace_value(const Node& map, std::string_view key, std::string file_name, std::string text);

  /// For the reader that builds the document: a node of this file, to be filled.
  Node& add(Node::Kind kind, int line, int column);
  void set_root(const Node& root) { root_ = &root; }
  /// What another file should have given is missing, and that has been reported: a name or key that is not here proves
  /// no mistake.
  void set_incomplete() { incomplete_ = true; }
  bool incomplete() const { return incomplete_; }
  /// Another file that nodes come from; its text is kept, byte for byte.
  const std::string* add_file(std::string name, std::string text);
  struct Attachment {
    const std::string* name;
    std::string text;
  };
  const std::vector<Attachment>& attachments() const { return attachments_; }

 private:
  std::deque<std::string> files_;  // deques: nodes point to names and to each other
  std::deque<Node> nodes_;
  std::string text_;
  std::vector<Attachment> attachments_;
  const Node* root_;
  bool incomplete_ = false;
};

}  // namespace freeplay
