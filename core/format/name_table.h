// NameTable: the full names of one kind of thing, numbered in order of declaration.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace freeplay {

/// Names of bodies, joints, drivers or forces.
class NameTable {
 public:
  /// False when the name is taken.
  bool add(const std::string& name) {
    const bool fresh = index_.emplace(name, static_cast<int>(names_.size())).second;
    if (fresh) {
      names_.push_back(name);
      characters_ += name.size();
    }
    return fresh;
  }
  /// The thing `index` is called `name` from now on; false when that is taken.
  bool rename(int index, const std::string& name) {
    if (!index_.emplace(name, index).second) return false;
    std::string& old = names_[static_cast<std::size_t>(index)];
    index_.erase(old);
    characters_ += name.size() - old.size();
    old = name;
    return true;
  }
  /// Another word for the thing `index`, where it is free.
  void also(const std::string& name, int index) { index_.emplace(name, index); }
  std::optional<int> find(const std::string& name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? std::nullopt : std::optional<int>(found->second);
  }
  const std::vector<std::string>& names() const { return names_; }
  std::size_t characters() const { return characters_; }

 private:
  std::unordered_map<std::string, int> index_;
  std::vector<std::string> names_;
  std::size_t characters_ = 0;  ///< of all names
};

}  // namespace freeplay
