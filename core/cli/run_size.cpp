#include "cli/run_size.h"

#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/number_text.h"
#include "cli/terminal.h"
#include "results/expected_size.h"

namespace freeplay {

std::string settle_format(Model& model, const RunOptions& options, const CommonOptions& common) {
  constexpr double most_columns = 20000.0;  // a dataset with its headers takes some 25 kB while it is written
  if (model.settings.format_given || model.settings.format == ResultFormat::csv) return {};
  const double columns = expected_size(model, Channels(model), 0).columns;
  if (columns <= most_columns) return {};
  model.settings.format = ResultFormat::csv;
  const std::string note = fmt::format(
      "{} columns go to results.csv alone: results.h5 would take some {} of memory; choose some "
      "--channels, or ask for it by --format both",
      number_text(columns), bytes_text(25e3 * columns));
  if (options.twin_pipe < 0 && !common.quiet) print_messages("freeplay: note: " + note + "\n", common.no_color);
  return note;
}

void announce_size(const Model& model, const std::filesystem::path& directory, std::int64_t rows_there,
                   const RunOptions& options, const CommonOptions& common) {
  if (options.twin_pipe >= 0) return;  // its run has counted it
  const ExpectedSize size = expected_size(model, Channels(model), rows_there);
  const double bytes = options.twin ? 2.0 * size.bytes : size.bytes;
  const std::optional<double> room = room_for_result(directory, rows_there == 0);
  const std::string amount =
      fmt::format("about {} ({} rows of {} columns{})", bytes_text(bytes), number_text(size.rows),
                  number_text(size.columns), options.twin ? ", twice for the twin" : "");
  if (room && bytes > share_of_room * *room && !options.yes) {
    throw Error(Error::Category::file, "too-large",
                fmt::format("the run would write {} into '{}', more than half of the {} that are free there", amount,
                            directory.string(), bytes_text(*room)),
                {}, "take a larger --interval or some --channels, another directory with --out, or --yes");
  }
  if (bytes < worth_a_note || common.quiet) return;
  const std::string free = room ? fmt::format("; {} are free there", bytes_text(*room)) : std::string();
  print_messages(fmt::format("freeplay: note: the run will write {} into '{}'{}\n", amount, directory.string(), free),
                 common.no_color);
}

}  // namespace freeplay
