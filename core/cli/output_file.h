// OutputFile: where a command that prints one thing puts it.
#pragma once

#include <filesystem>
#include <string>

namespace freeplay {

/// What a command may replace: its own.
struct OwnFile {
  const char* what;
  bool (*is)(const std::filesystem::path&);
};

/// A picture with the record of how it was made; a table or a page of this program; the record beside a table.
extern const OwnFile own_picture, own_table, own_page, own_record;

/// Throws Error{file} "cannot-write" where a file that is none of its own would be replaced; `force` allows it.
void require_no_other_file(const std::string& path, const OwnFile& own, bool force);

/// The same for a table and the record beside it.
void require_no_other_table(const std::string& path, bool force);

/// Where the record of a table stands.
std::string record_file(const std::string& table);

/// Writes `text` to stdout, or to the file `path` if there is one: under a temporary name that is renamed when
/// complete. Throws Error{file}.
void write_output(const std::string& path, const std::string& text);

}  // namespace freeplay
