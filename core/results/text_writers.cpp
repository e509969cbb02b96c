#include "results/text_writers.h"

#include "base/error.h"
#include "base/number_text.h"

namespace freeplay {

std::string text_header(std::span<const RecordColumn> columns) {
  std::string header;
  for (const RecordColumn& column : columns) (header += column.name) += ',';
  header.back() = '\n';
  return header;
}

TextWriter::TextWriter(const std::filesystem::path& path, std::span<const RecordColumn> columns,
                       GrowingFile::Begin begin)
    : width_(columns.size()), file_(path, begin) {
  if (begin == GrowingFile::Begin::append) return;
  std::string header = text_header(columns);
  header.pop_back();
  file_.line().reserve(header.size() + 1);
  file_.line() += header;
  file_.end_line();
}

void TextWriter::note() {
  if (failure_.empty() && !file_.ok()) failure_ = file_.failure();
}

void TextWriter::close() {
  try {
    file_.close();
  } catch (const Error&) {
    note();
  }
}

void RowTextWriter::write(const RecordBlock& block) {
  for (std::size_t i = 0; i < block.rows.size(); ++i) {
    append_number(file_.line(), block.rows[i]);
    if ((i + 1) % width_ == 0) {
      file_.end_line();
      given_ = {given_.count + 1, block.rows[i + 1 - width_]};
      if (!file_.waits()) note();
    } else {
      file_.line() += ',';
    }
  }
  note();
}

void RowTextWriter::note() {
  TextWriter::note();
  if (failure().empty() && !file_.waits()) held_ = given_;
}

void EventTextWriter::append(std::string& line, const RecordLayout& layout, std::span<const double> event) {
  append_number(line, event[0]);
  ((line += ',') += layout.joints[static_cast<std::size_t>(event[1])]) += ',';
  line += layout.kinds[static_cast<std::size_t>(event[2])];
  for (const double field : event.subspan(3)) append_number(line += ',', field);
}

void EventTextWriter::write(const RecordBlock& block) {
  for (std::size_t i = 0; i < block.events.size(); i += width_) {
    std::string& line = file_.line();
    const std::size_t begin = line.size();
    append(line, layout_, block.events.subspan(i, width_));
    hash_.add(line.data() + begin, line.size() - begin);
    hash_.add("\n", 1);
    file_.end_line();
  }
  note();
}

}  // namespace freeplay
