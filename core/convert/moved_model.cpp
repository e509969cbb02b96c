#include "convert/moved_model.h"

#include <string>

namespace freeplay {
namespace {

namespace fs = std::filesystem;

class Move {
 public:
  Move(const Document& document, const fs::path& from, const fs::path& to)
      : target_(document.file_name(), document.text()),
        from_(fs::current_path() / from),
        to_((fs::current_path() / to).lexically_normal()) {}

  Document run(const Node& root) {
    target_.set_root(root.is_map() ? copy_sections(root) : copy(root));
    return std::move(target_);
  }

 private:
  Node& same(const Node& node) {
    Node& made = target_.add(node.kind, node.line, node.column);
    const std::string* file = made.file;
    made = node;
    made.file = file;
    made.items.clear();
    made.entries.clear();
    return made;
  }

  Node& copy(const Node& node) {
    Node& made = same(node);
    for (const Node* item : node.items) made.items.push_back(&copy(*item));
    for (const Node::Entry& entry : node.entries) made.entries.push_back({&copy(*entry.key), &copy(*entry.value)});
    return made;
  }

  /// Copies the entries of a map; `change` copies the value of those that may hold paths.
  template <class Change>
  Node& copy_entries(const Node& map, Change change) {
    if (!map.is_map()) return copy(map);
    Node& made = same(map);
    for (const Node::Entry& entry : map.entries) {
      made.entries.push_back({&copy(*entry.key), &change(entry.key->text, *entry.value)});
    }
    return made;
  }

  Node& copy_sections(const Node& root) {
    return copy_entries(root, [&](const std::string& key, const Node& value) -> Node& {
      if (key == "plugins") return copy_plugins(value);
      if (key == "drivers" || key == "presets") return copy_drivers(value);
      if (key == "joints" || key == "forces" || key == "simulation") return copy_parameters(value);
      if (key == "analysis") return copy_path_of(value);
      if (key == "templates") {
        return copy_entries(value, [&](const std::string&, const Node& content) -> Node& {
          return copy_entries(content, [&](const std::string& section, const Node& entries) -> Node& {
            return section == "drivers" ? copy_drivers(entries) : copy_parameters(entries);
          });
        });
      }
      return copy(value);
    });
  }

  /// Presets, too: one of them may hold keys of a driver.
  Node& copy_drivers(const Node& section) {
    return copy_entries(section, [&](const std::string&, const Node& driver) -> Node& {
      return copy_entries(driver, [&](const std::string& key, const Node& table) -> Node& {
        if (key == "inverse_kinematics") return copy_path_of(table);
        return key == "table" ? copy_table(table) : copy_parameters(table);
      });
    });
  }

  /// Of types, whose parameters may be `pull.csv` or `{file: pull.csv}`.
  Node& copy_parameters(const Node& value) {
    if (value.is_scalar()) return value.text.ends_with(".csv") ? moved(value) : copy(value);
    return copy_entries(value, [&](const std::string& key, const Node& inner) -> Node& {
      return key == "file" && inner.is_scalar() ? moved(inner) : copy_parameters(inner);
    });
  }

  Node& copy_path_of(const Node& map) {
    return copy_entries(map, [&](const std::string& key, const Node& value) -> Node& {
      return key == "path" ? copy_table(value) : copy(value);
    });
  }

  Node& copy_table(const Node& table) {
    if (table.is_scalar()) return moved(table);
    return copy_entries(table, [&](const std::string& key, const Node& value) -> Node& {
      return key == "file" && value.is_scalar() ? moved(value) : copy(value);
    });
  }

  Node& copy_plugins(const Node& plugins) {
    if (!plugins.is_list()) return copy(plugins);
    Node& made = same(plugins);
    for (const Node* item : plugins.items) {
      const bool path = item->text.find('/') != std::string::npos || item->text.ends_with(".so");
      made.items.push_back(path ? &moved(*item) : &copy(*item));
    }
    return made;
  }

  Node& moved(const Node& path) {
    Node& made = same(path);
    if (!fs::path(path.text).is_absolute()) made.text = (from_ / path.text).lexically_normal().lexically_proximate(to_);
    // A bare name would be searched in other places than here.
    if (path.text.ends_with(".so") && made.text.find('/') == std::string::npos) made.text = "./" + made.text;
    return made;
  }

  Document target_;
  fs::path from_, to_;
};

}  // namespace

Document moved_model(const Document& document, const fs::path& from, const fs::path& to) {
  return Move(document, from, to).run(document.root());
}

}  // namespace freeplay
