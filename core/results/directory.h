// ResultDirectory: where the files of one run go.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/model.h"
#include "results/owner.h"

namespace freeplay {

/// Name of the default directory below `results`: the model's name with characters outside [A-Za-z0-9_.-] and leading
/// dots replaced by '_', and `-ideal` appended for an ideal run.
std::string result_name(std::string_view model_name, bool ideal);

/// Names of the files and folders that a result is made of, whatever its format.
std::span<const char* const> result_names();

/// Name of the copy of the model's file in a result: model.yaml, model.urdf, model.sdf or model.xml.
std::string model_copy_name(const Model& model);

/// Throws Error{file} unless a result may go to `path`: it does not exist, is empty, holds an earlier result (a
/// summary.json of this program) or what runs left that were ended before they had rows, or `force` allows to write
/// beside other files; and no process writes into it. Changes nothing.
void check_result_directory(const std::filesystem::path& path, bool force);

/// Throws Error{file} where `path` holds the result of another model file that is still there.
void require_no_other_model(const std::filesystem::path& path, const Model& model);

/// A directory that this process alone writes a result into.
class ResultDirectory {
 public:
  /// Checks, makes the directory and removes the files of an earlier result, and only these; its run.log stays as it is
  /// until it is written anew. Throws Error{file}.
  ResultDirectory(std::filesystem::path path, bool force);
  /// That of a result that goes on: every file stays. Throws Error{file} "result-in-use", "cannot-write".
  explicit ResultDirectory(std::filesystem::path path) : path_(std::move(path)), owner_(path_) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(std::string_view name) const { return path_ / name; }
  /// False once it was removed, or another took its place.
  bool there() const { return owner_.holds(path_); }
  /// Throws Error{file} unless it is there.
  void require_there() const;
  /// Writes a whole file under a temporary name and renames it, so that it is there complete or not at all. A name such
  /// as "inputs/motor.csv" stands in a folder of the directory.
  /// Throws Error{file}.
  void write(std::string_view name, std::string_view text) const;
  /// Removes a file where there is one. Throws Error{file}.
  void remove(std::string_view name) const;
  /// Throws Error{file} for the first of these files that is not there any more.
  void require_all(std::span<const std::string> names) const;
  /// Sorted names of what is there.
  std::vector<std::string> files() const;

  /// False where nothing keeps other processes away.
  bool guarded() const { return owner_.guarded(); }

 private:
  std::filesystem::path path_;
  Owner owner_;
};

}  // namespace freeplay
