// Remaking: makes a thing again from its record of provenance.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/options.h"
#include "cli/own_program.h"
#include "results/made_file.h"

namespace freeplay {

class Remaking {
 public:
  /// `out`: where what is made stays; empty: a folder that goes with this object. `yes`: however large. Throws
  /// Error{file} "no-provenance" for a record that asks for what makes no such thing, "cannot-write".
  Remaking(const MadeFile& made, const CommonOptions& common, const std::filesystem::path& out, bool yes);
  ~Remaking();
  Remaking(const Remaking&) = delete;
  Remaking& operator=(const Remaking&) = delete;

  /// Runs what made it. Returns whether it was made; else end() says how it failed. Throws Error{plugin}
  /// "plugin-not-found", "plugin-not-allowed" before anything runs.
  bool make();

  /// After make(): the directory or file that was made.
  const std::filesystem::path& again() const { return again_; }
  /// The results that it was made from, made again; none for a result.
  const std::vector<std::string>& results() const { return results_; }
  /// How the last program ended.
  const ProgramEnd& end() const { return end_; }

 private:
  std::filesystem::path stage(const Json& run, std::size_t number) const;
  std::vector<std::string> plugin_words(const Json& run) const;
  std::string known_name(const std::string& library, const Json& run) const;
  bool execute(std::vector<std::string> words, const Json& run);
  bool run_model(const Json& run, std::size_t number, const std::filesystem::path& out);
  bool analyze(const Json& run);
  bool draw(const Json& run);
  bool derive();

  const MadeFile& made_;
  const CommonOptions& common_;
  bool yes_;
  std::string command_;
  std::filesystem::path scratch_, out_, again_;
  std::vector<std::string> results_;
  ProgramEnd end_;
};

}  // namespace freeplay
