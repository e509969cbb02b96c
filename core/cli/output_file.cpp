#include "cli/output_file.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/json_text.h"
#include "base/whole_file.h"
#include "cli/terminal.h"
#include "report/page.h"
#include "results/made_text.h"

namespace freeplay {

namespace {

/// Does a file hold a record of how something was made?
bool is_record(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const Json json = Json::parse(stream, nullptr, false);
  return json.is_object() && json.contains("freeplay");
}

bool is_table(const std::filesystem::path& file) { return is_record(record_file(file.string())); }

}  // namespace

const OwnFile own_picture{"picture", is_own_picture}, own_table{"table", is_table}, own_page{"page", is_page},
    own_record{"record of a table", is_record};

void require_no_other_file(const std::string& path, const OwnFile& own, bool force) {
  std::error_code ignored;
  // An empty file holds nothing, and terminals and pipes are written to.
  if (path.empty() || force || !std::filesystem::is_regular_file(path, ignored)) return;
  if (std::filesystem::file_size(path, ignored) == 0 || own.is(path)) return;
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("cannot write '{}': it is there already, and no {} of this program", path, own.what), {},
              "replace it with --force, or choose another name");
}

void require_no_other_table(const std::string& path, bool force) {
  if (path.empty()) return;
  require_no_other_file(path, own_table, force);
  require_no_other_file(record_file(path), own_record, force);
}

std::string record_file(const std::string& table) { return table + ".provenance.json"; }

void write_output(const std::string& path, const std::string& text) {
  if (path.empty()) {
    print_data(text);
  } else {
    write_whole_file(path, text);
  }
}

}  // namespace freeplay
