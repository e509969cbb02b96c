#include "results/mat_table.h"

#include <cstdint>
#include <fstream>
#include <memory>
#include <new>
#include <string_view>

#include <fmt/format.h>
#include <matio.h>

#include "base/byte_numbers.h"
#include "base/servant_process.h"
#include "results/reader.h"

namespace freeplay {
namespace {

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

std::size_t bytes_of(const matvar_t& variable) { return variable.data == nullptr ? 0 : variable.nbytes; }

std::string text_in(const matvar_t* variable) {
  if (variable == nullptr || variable->class_type != MAT_C_CHAR || variable->data_size != 1) return {};
  return {static_cast<const char*>(variable->data), bytes_of(*variable)};
}

std::vector<std::string> words_in(const matvar_t& variable) {
  std::vector<std::string> words;
  if (variable.class_type != MAT_C_CELL || variable.data == nullptr) return words;
  const auto* cells = static_cast<matvar_t* const*>(variable.data);
  for (std::size_t i = 0; i < variable.nbytes / sizeof(void*); ++i) words.push_back(text_in(cells[i]));
  return words;
}

std::vector<double> numbers_in(const matvar_t& variable) {
  if (variable.class_type != MAT_C_DOUBLE || variable.data_type != MAT_T_DOUBLE || variable.isComplex != 0) return {};
  const auto* first = static_cast<const double*>(variable.data);
  return {first, first + bytes_of(variable) / sizeof(double)};
}

/// Bytes that the parts of a MAT-file of level 5 end at, 0 of another one. The library takes zeros for what a cut file
/// has lost.
std::uint64_t end_of_parts(const std::filesystem::path& path) {
  constexpr std::uint64_t head_bytes = 128, mark_at = 124, tag_bytes = 8, size_at = 4;
  std::ifstream file(path, std::ios::binary);
  char head[head_bytes] = {}, tag[tag_bytes];
  if (!file.read(head, sizeof head)) return 0;
  const std::string_view mark(head + mark_at, 4);
  const bool little = mark == std::string_view("\0\1IM", 4);
  if (!little && mark != std::string_view("\1\0MI", 4)) return 0;
  std::uint64_t end = head_bytes;
  while (file.read(tag, sizeof tag)) {
    std::uint64_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      size = size << 8 | static_cast<unsigned char>(tag[size_at + (little ? 3 - i : i)]);
    }
    end += tag_bytes + size;
    file.seekg(static_cast<std::streamoff>(end));
  }
  return file.gcount() > 0 ? end + tag_bytes : end;
}

void require_whole(const std::filesystem::path& path) {
  const std::uint64_t end = end_of_parts(path);
  std::error_code ignored;
  const std::uint64_t size = std::filesystem::file_size(path, ignored);
  if (end > size) {
    unreadable_result(path.string(), fmt::format("it was cut: it has {} bytes, its last part ends at {}", size, end));
  }
}

/// In a process of its own: on a damaged file the library may crash or never come back.
MatTable read_here(const std::filesystem::path& path) {
  const std::unique_ptr<mat_t, decltype(&Mat_Close)> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY), Mat_Close);
  if (file == nullptr) unreadable_result(path.string(), "it is no MAT-file that can be read");
  MatTable table;
  for (;;) {
    const Variable variable(Mat_VarReadNext(file.get()), Mat_VarFree);
    if (variable == nullptr || variable->name == nullptr) break;
    const std::string_view name = variable->name;
    if (name == "time") table.time = numbers_in(*variable);
    if (name == "data") table.data = numbers_in(*variable);
    if (name == "channels") table.channels = words_in(*variable);
    if (name == "units") table.units = words_in(*variable);
    if (name == "provenance") table.provenance = text_in(variable.get());
  }
  return table;
}

enum Found : std::uint64_t { table_found, none_found, no_room };

std::string message_of(const MatTable& table) {
  std::string bytes;
  for (const auto* words : {&table.channels, &table.units}) {
    append_bytes(bytes, static_cast<std::uint64_t>(words->size()));
    for (const std::string& word : *words) append_bytes(bytes, std::string_view(word));
  }
  append_bytes(bytes, std::string_view(table.provenance));
  append_bytes(bytes, table.time);
  append_bytes(bytes, table.data);
  return bytes;
}

MatTable table_of(std::string_view bytes) {
  MatTable table;
  ByteNumbers numbers(bytes, [] { throw ServantGone("crashes"); });
  for (auto* words : {&table.channels, &table.units}) {
    for (std::uint64_t left = numbers.next(); left > 0; --left) numbers.next(words->emplace_back());
  }
  numbers.next(table.provenance);
  numbers.next(table.time);
  numbers.next(table.data);
  return table;
}

}  // namespace

MatTable read_mat(const std::filesystem::path& path) {
  require_whole(path);
  ServantProcess reader([&]() -> ServantProcess::Serve {
    return [&path](std::string_view, const ServantProcess::Send& send) {
      try {
        send(table_found, message_of(read_here(path)));
      } catch (const std::bad_alloc&) {
        send(no_room, {});
      } catch (const std::exception&) {
        send(none_found, {});
      }
    };
  });
  try {
    const ServantProcess::Answer answer = reader.ask({});
    if (answer.kind == no_room) throw std::bad_alloc();
    if (answer.kind == table_found) return table_of(answer.text());
  } catch (const ServantGone& gone) {
    unreadable_result(path.string(), fmt::format("it is damaged: matio {} while it reads it", gone.what()));
  }
  unreadable_result(path.string(), "it is no MAT-file that can be read");
}

}  // namespace freeplay
