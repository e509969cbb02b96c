// UrdfKeptSections: what of a model its side-car still needs: presets, parameters, frames.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "format/document.h"

namespace freeplay {

/// Whether a word or a formula in what is kept of a model names a frame, "body/frame".
bool mentions(const Node& kept, const std::string& frame);

/// Adds to `root`, and to `content`, which holds what the side-car says by now, the entries of a section of the source
/// that this content names, and those that these name in turn.
class KeptSections {
 public:
  KeptSections(const Node& source, Document& target) : source_(source), target_(target) {}

  void add_presets(Node& root, Node& content);
  /// False where the source has no parameters.
  bool add_parameters(Node& root, Node& content);

 private:
  using Names = std::set<std::string>;
  void add(Node& root, Node& content, const char* section, Names wanted,
           const std::function<void(const Node&, Names&)>& collect);
  void put(Node& owner, const char* key, const Node& value);

  const Node& source_;
  Document& target_;
};

}  // namespace freeplay
