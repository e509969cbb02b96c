// OpenedModel: a model that a script holds. Nothing of it changes, so that any thread may use it.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "load/load.h"
#include "load/run_words.h"
#include "model/channel.h"
#include "results/provenance.h"

namespace freeplay {

/// What is to be opened, and how.
struct OpenRequest {
  std::optional<std::string> text;  ///< of a YAML model; without it `file` is read
  std::string file;
  RunWords words;
  LoadWords load;
  std::string name;  ///< of a run that goes on, which the copy of the model may not have
};

class OpenedModel {
 public:
  /// Throws Refusal with the messages of the file, Error{usage} for what is asked for.
  explicit OpenedModel(OpenRequest request);
  OpenedModel(const OpenedModel&) = delete;
  OpenedModel& operator=(const OpenedModel&) = delete;
  ~OpenedModel();
  /// All messages of a file, of its assembly too where there is a model.
  static Json check(const OpenRequest& request);

  const OpenRequest& request() const { return request_; }
  const Model& model() const { return *loaded_.model; }
  const Channels& channels() const { return channels_; }
  const Document& document() const { return *loaded_.document; }
  /// Of a parameter, in SI; "" for what is none.
  std::string unit_of(const std::string& parameter) const;
  /// Warnings of the file.
  Json messages() const;
  /// Remarks that are about no place of the file.
  const std::vector<std::string>& remarks() const { return remarks_; }

  /// A system of its own for each caller; `diagnostics` gets the warnings of the file and those of the assembly. Throws
  /// Refusal.
  std::unique_ptr<AssembledModel> assemble(Diagnostics& diagnostics) const;
  /// The same text once more, for what changes it. Throws Refusal.
  LoadedModel read_again() const;
  /// With other options of its build, as far as it can be read. Throws Error{usage}.
  LoadedModel read_with(const BuildOptions& build) const;
  /// The same text with every clearance closed. Throws Refusal.
  std::shared_ptr<const OpenedModel> twin() const;
  /// Throws Error as a message of this file, Refusal where it is one of the file.
  [[noreturn]] void refuse(const Error& error) const;

  /// A picture of `model` with the record of its making, to which options of this model are added.
  std::string with_record(const std::string& picture, const Model& model, Making making) const;

  // What `validate`, `show` and `list channels` say of it. Throws Refusal.
  Json facts() const;
  Json start() const;
  Json tree() const;
  std::string svg() const;

 private:
  /// Assembled when it is first asked for. Without a lock: a child of a fork lacks the thread that holds it.
  const AssembledModel& assembled() const;
  OpenRequest same_text() const;

  OpenRequest request_;
  std::vector<std::string> remarks_;
  LoadedModel loaded_;
  Channels channels_;
  mutable std::atomic<const AssembledModel*> assembled_ = nullptr;
};

}  // namespace freeplay
