// PluginTable: what a library publishes, brought into this program's layout.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "freeplay/plugin.h"

namespace freeplay {

/// Asks a library for its types and checks the answer: version, fingerprint, struct sizes, then every row. Rows of a
/// library with smaller structs are copied into ours, and functions that it does not have yet do nothing. Immutable and
/// never moved: components and tables are referred to by pointer for the life of the program.
class PluginTable {
 public:
  /// Throws Error{plugin} "plugin-refused" that names the library and says why. `library` is its path.
  PluginTable(PluginEntry entry, const std::string& library);
  PluginTable(const PluginTable&) = delete;
  PluginTable& operator=(const PluginTable&) = delete;

  const std::deque<Component>& components() const { return components_; }
  /// Types that it could bring but does not.
  const std::deque<Component>& missing() const { return missing_; }
  const std::string& name() const { return name_; }
  const std::string& version() const { return version_; }
  const std::string& compiler() const { return compiler_; }
  /// How many bytes of a ContactPair its joints fill.
  std::size_t contact_pair_size() const { return contact_pair_size_; }

 private:
  void check(const Manifest& manifest, Status status) const;
  void copy_row(const Component& row, const Manifest& manifest);
  void check_parameters(const Component& row) const;
  template <class Table>
  const void* copy_table(const Component& row, const void* functions, std::deque<Table>& tables);
  [[noreturn]] void refuse(const std::string& why) const;

  std::string library_, name_, version_, compiler_;
  std::size_t contact_pair_size_ = sizeof(ContactPair);
  std::deque<Component> components_, missing_;
  std::deque<std::vector<Parameter>> parameters_;
  std::deque<abi::JointTable> joints_;
  std::deque<abi::ContactLawTable> contact_laws_;
  std::deque<abi::FrictionLawTable> friction_laws_;
  std::deque<abi::IntegratorTable> integrators_;
};

}  // namespace freeplay
