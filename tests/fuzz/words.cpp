// Prints the words of a model file as a dictionary of libFuzzer, from the tables that the program itself reads by.
#include <cstdio>
#include <set>
#include <string>

#include <fmt/format.h>

#include "base/unit.h"
#include "format/key_table.h"
#include "fuzz/harness.h"

namespace {

using namespace freeplay;

void add_words(std::string_view alternatives, std::set<std::string>& words) {
  for (std::size_t begin = alternatives.find('"'); begin != std::string_view::npos;) {
    const std::size_t end = alternatives.find('"', begin + 1);
    if (end == std::string_view::npos) return;
    words.emplace(alternatives.substr(begin + 1, end - begin - 1));
    begin = alternatives.find('"', end + 1);
  }
}

}  // namespace

int main() {
  std::set<std::string> words;
  for (const FormatMap& map : format_maps()) {
    for (const FormatKey& key : map.keys) {
      words.insert(std::string(key.name) + ": ");
      add_words(key.value, words);
    }
  }
  for (const RegisteredComponent& type : fuzz::builtin_types().components()) {
    words.insert(type.component->description.name);
    for (const Parameter& parameter : type.component->description.parameters)
      words.insert(std::string(parameter.name) + ": ");
  }
  for (const std::string& unit : unit_names()) words.insert(" " + unit);
  for (const std::string& word : words) {
    std::string escaped;
    for (const char c : word) {
      const bool plain = c >= ' ' && c <= '~' && c != '"' && c != '\\';
      escaped += plain ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    std::printf("\"%s\"\n", escaped.c_str());
  }
  return 0;
}
