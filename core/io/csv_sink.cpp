#include "io/csv_sink.h"

#include "io/number_text.h"

namespace freeplay {

CsvSink::CsvSink(const std::filesystem::path& path, const Channels& channels, std::vector<std::size_t> columns)
    : columns_(std::move(columns)), file_(path) {
  for (const std::size_t& column : columns_) {
    if (&column != &columns_.front()) file_.line() += ',';
    file_.line() += channels.all()[column].name;
  }
  file_.end_line();
}

void CsvSink::row(std::span<const double> values) {
  for (const std::size_t& column : columns_) {
    if (&column != &columns_.front()) file_.line() += ',';
    append_number(file_.line(), values[column]);
  }
  file_.end_line();
}

}  // namespace freeplay
