#include "cli/convert_command.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "base/whole_file.h"
#include "cli/failure.h"
#include "cli/loading.h"
#include "cli/terminal.h"
#include "convert/complete_model.h"
#include "convert/flat_model.h"
#include "convert/moved_model.h"
#include "format/readout.h"
#include "load/facts.h"
#include "load/load.h"
#include "load/model_file.h"
#include "urdf/writer.h"
#include "yaml/text.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::string in, out;
  bool force = false;
  ModelOptions build;
};

bool is_yaml(const std::string& file) {
  const fs::path suffix = fs::path(file).extension();
  return suffix == ".yaml" || suffix == ".yml";
}

void require_room(const std::string& file, bool force) {
  std::error_code ignored;
  if (force || !fs::exists(file, ignored)) return;
  throw Error(Error::Category::file, "cannot-write", fmt::format("'{}' exists already", file), {},
              "--force overwrites it");
}

void warn(LoadedModel& loaded, const char* id, const std::string& message) {
  loaded.diagnostics.warning({loaded.document->file_name(), 0, 0}, 1, id, message);
}

/// The name a body of the source has in what was written.
std::string new_name(const Model& written, const Renaming& renamed, const std::string& name) {
  const auto found = renamed.find(name);
  const std::string& flat = found == renamed.end() ? name : found->second;
  for (const Body& body : written.bodies) {
    if (body.name == flat) return flat;
  }
  return "_" + flat;
}

/// Where a body's centre of mass starts [m], and the world axes of its frame: 12 numbers. The place of the frame itself
/// is a matter of writing.
std::array<double, 12> start_of(const AssembledModel& assembled, std::size_t body) {
  const Pose frame = assembled.system.coordinates().frame_pose(static_cast<BodyId>(body), assembled.start.state.q());
  const Vector3& com = assembled.system.model().bodies[body].com;
  std::array<double, 12> out{};
  for (std::size_t r = 0; r < 3; ++r) {
    out[r] = frame.position[r];
    for (std::size_t c = 0; c < 3; ++c) {
      out[r] += frame.rotation[3 * r + c] * com[c];
      out[3 + 3 * r + c] = frame.rotation[3 * r + c];
    }
  }
  return out;
}

/// Reads what was written and compares: a conversion that changes the mechanism must not pass for one.
void verify(const LoadedModel& loaded, const AssembledModel& source, const Renaming& renamed, const std::string& file,
            const CommonOptions& common) {
  CommonOptions lenient = common;
  lenient.strict = false;
  LoadedModel again = load_model(file, {}, loading(lenient));
  const auto assembled = again.exit_code == 0 ? assemble_model(again) : nullptr;
  const auto differs = [&](const std::string& what) {
    throw Error(Error::Category::internal, "internal", fmt::format("'{}' was written, but {}", file, what), {},
                "please report this");
  };
  if (!assembled) differs("does not read back:\n" + again.diagnostics.format(1));
  if (facts_json(*loaded.model, source.start.facts) != facts_json(*again.model, assembled->start.facts)) {
    differs("its facts differ");
  }
  for (std::size_t b = 0; b < loaded.model->bodies.size(); ++b) {
    const std::string name = new_name(*again.model, renamed, loaded.model->bodies[b].name);
    const auto found = std::ranges::find(again.model->bodies, name, &Body::name);
    if (found == again.model->bodies.end()) return differs("a body is missing");
    const std::size_t other = static_cast<std::size_t>(found - again.model->bodies.begin());
    const std::array<double, 12> was = start_of(source, b), is = start_of(*assembled, other);
    for (std::size_t i = 0; i < was.size(); ++i) {
      const double gap = std::abs(was[i] - is[i]);
      if (!(gap <= 1e-8)) differs(fmt::format("body '{}' starts elsewhere, by {:.3g}", name, gap));
    }
  }
}

/// What is written counts paths from the folder it is written to.
Document moved(const Document& document, const ConvertOptions& options) {
  return moved_model(document, fs::path(options.in).parent_path(), fs::path(options.out).parent_path());
}

/// Files that were written, the one to read first.
std::vector<std::string> to_yaml(LoadedModel& loaded, const ConvertOptions& options) {
  require_room(options.out, options.force);
  std::vector<std::string> renamed;
  const std::string text = complete_model_text(moved(*loaded.document, options), renamed);
  for (const std::string& name : renamed)
    warn(loaded, "urdf-renamed", fmt::format("'{}' is called '_{}' there", name, name));
  write_whole_file(options.out, text);
  return {options.out};
}

/// `loaded`: has no instances; `notes` are added to.
std::vector<std::string> to_urdf(const LoadedModel& loaded, const Readout& readout, const AssembledModel& assembled,
                                 const ConvertOptions& options, std::vector<std::string>& notes) {
  const std::string sidecar = options.out + ".sidecar.yaml";
  const State& start = assembled.start.state;
  const UrdfText text = write_urdf(*loaded.document, *loaded.model, readout, start.q(), start.v(),
                                   fs::path(options.out).filename().string());
  require_room(options.out, options.force);
  if (text.sidecar) require_room(sidecar, options.force);
  notes.insert(notes.end(), text.notes.begin(), text.notes.end());
  write_whole_file(options.out, text.urdf);
  if (!text.sidecar) return {options.out};
  write_whole_file(sidecar, yaml_text(moved(*text.sidecar, options).root()));
  return {sidecar, options.out};
}

/// The model with its instances written out under names of their own.
LoadedModel load_flat(const FlatModel& flat, const std::string& file, Readout& readout, const CommonOptions& common) {
  CommonOptions lenient = common;
  lenient.strict = false;
  BuildOptions build;
  build.readout = &readout;
  LoadedModel loaded = load_text(flat.text, file, build, loading(lenient));
  if (loaded.exit_code == 0) return loaded;
  throw Error(Error::Category::internal, "internal",
              "without its instances the model does not read back:\n" + loaded.diagnostics.format(1), {},
              "please report this");
}

/// What --set says becomes the text of the parameter.
void write_overrides(const BuildOptions& build, Document& document) {
  const Node* parameters = document.root().find("parameters");
  for (const auto& [name, text] : build.set) {
    if (parameters == nullptr || parameters->find(name) == nullptr) {
      not_in_this_release(fmt::format("--set {} of convert, which is no parameter", name));
    }
    document.replace_value(*parameters, name, "--set " + name, text);
  }
}

int convert(const ConvertOptions& options, const CommonOptions& common) {
  if (options.in.empty() || options.out.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "convert needs an input and an output file");
  }
  if (!is_yaml(options.out) && !is_urdf(options.out)) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("'{}' must end in .yaml, .yml or .urdf: the suffix says what to write", options.out));
  }
  if (!options.build.ideal.empty()) not_in_this_release("--ideal of convert");
  Readout readout;
  BuildOptions build = build_options(options.build);
  build.readout = &readout;
  LoadedModel loaded = load_model(options.in, build, loading(common));
  if (!is_yaml(options.out)) require_planar(loaded, "conversion to URDF");
  if (loaded.exit_code == 0) write_overrides(build, *loaded.document);
  const auto assembled = loaded.exit_code == 0 ? assemble_model(loaded) : nullptr;
  if (!assembled) return report_failure(loaded.diagnostics, loaded.exit_code, common);
  std::vector<std::string> files, notes;
  Renaming renamed;
  if (is_yaml(options.out)) {
    files = to_yaml(loaded, options);
  } else if (has_instances(*loaded.document)) {
    FlatModel flat = flat_model(*loaded.document, *loaded.model, readout);
    Readout flat_readout;
    LoadedModel written_out = load_flat(flat, options.in, flat_readout, common);
    const auto start = assemble_model(written_out);
    if (!start) return report_failure(written_out.diagnostics, written_out.exit_code, common);
    notes.push_back("instances are written out; a name such as 'leg1.crank' becomes 'leg1_crank'");
    files = to_urdf(written_out, flat_readout, *start, options, notes);
    renamed = std::move(flat.renamed);
  } else {
    files = to_urdf(loaded, readout, *assembled, options, notes);
  }
  for (const std::string& note : notes) warn(loaded, "converted", note);
  print_messages(loaded.diagnostics.format(common.max_errors), common.no_color);
  verify(loaded, *assembled, renamed, files.front(), common);
  if (common.json) {
    print_json(Json{{"files", files}});
  } else if (!common.quiet) {
    for (const std::string& file : files) print(file + "\n");
  }
  return 0;
}

}  // namespace

Command add_convert_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "convert", "Write a URDF file as YAML, or a model as URDF with a side-car");
  const auto options = std::make_shared<ConvertOptions>();
  add_option(*app, "IN", options->in, "Model file");
  add_option(*app, "OUT", options->out, "File to write: .yaml, .yml or .urdf");
  add_flag(*app, "--force", options->force, "Overwrite");
  add_model_options_without_ideal(*app, options->build);
  add_common_options(*app, common);
  return {app, [options, &common] { return convert(*options, common); }};
}

}  // namespace freeplay
