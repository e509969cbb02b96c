#include "cli/doctor_command.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <thread>

#include <fmt/format.h>

#include "base/error.h"
#include "base/version.h"
#include "base/whole_file.h"
#include "cli/terminal.h"
#include "component/library.h"
#include "contract/component_entry.h"
#include "freeplay/plugin.h"
#include "report/page_parts.h"
#include "results/formats.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

struct DoctorLine {
  const char* verdict;  ///< ok, note, problem
  std::string part, text;
};

class Doctor {
 public:
  explicit Doctor(const CommonOptions& common) : common_(common) {}

  std::vector<DoctorLine> examine() {
    add("ok", "program",
        fmt::format("freeplay {} (schema {}, plugin ABI {}), {}, {}", program_version, schema_version, abi_version,
                    compiler, FREEPLAY_BUILD));
    examine_builtins();
    examine_folders();
    examine_asked_for();
    examine_threads();
    examine_folder_of_results();
    add("ok", "URDF", "links and joints read by urdfdom, loops and places by the program itself");
    add("ok", "HDF5", fmt::format("{}: results are HDF5 and CSV", hdf5_version()));
    add("ok", "dygraphs", fmt::format("{}: plots of reports", page_parts().plots_version));
    examine_reference();
    return std::move(findings_);
  }

 private:
  void add(const char* verdict, std::string part, std::string text) {
    findings_.push_back({verdict, std::move(part), std::move(text)});
  }

  void examine_builtins() {
    try {
      registry_ = Registry::with_builtins();
    } catch (const Error& error) {
      return add("problem", "built-in types", error.message());
    }
    const auto count = [&](ComponentKind kind) { return registry_.names(kind).size(); };
    // Counted as `list joints` does: the gear is a joint of the core.
    const auto is_joint = [](const Json& entry) { return entry["kind"] == "joint"; };
    const std::vector<Json> types = all_entries(registry_);
    const auto joints = static_cast<std::size_t>(std::ranges::count_if(types, is_joint));
    const std::size_t contact = count(ComponentKind::contact_law), friction = count(ComponentKind::friction_law),
                      integrators = count(ComponentKind::integrator);
    const bool complete = joints > 0 && contact > 0 && friction > 0 && integrators > 0;
    add(complete ? "ok" : "problem", "built-in types",
        fmt::format("{} joints, {} contact laws, {} friction laws, {} integrators", joints, contact, friction,
                    integrators));
  }

  void examine_reference() {
    const char* const name = FREEPLAY_REFERENCE_INTEGRATOR;
    if (registry_.find(ComponentKind::integrator, name) != nullptr) return add("ok", "reference integrator", name);
    const char* const remedy = registry_.remedy(ComponentKind::integrator, name);
    add("note", "reference integrator",
        fmt::format("'{}' is not in this build{}{}", name, remedy ? ": " : "", remedy ? remedy : ""));
  }

  void examine_folders() {
    const std::vector<fs::path> folders = plugin_folders();
    for (const fs::path& folder : folders) {
      std::error_code error;
      if (!fs::is_directory(folder, error)) {
        add("note", "plugin folder", fmt::format("{} is not there", folder.string()));
        continue;
      }
      std::size_t libraries = 0;
      for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        libraries += entry.path().extension() == ".so" ? 1 : 0;
      }
      if (error) {
        add("problem", "plugin folder", fmt::format("{} cannot be read: {}", folder.string(), error.message()));
      } else {
        add("ok", "plugin folder", fmt::format("{}: {} libraries", folder.string(), libraries));
      }
    }
    const std::size_t before = registry_.components().size();
    for (const std::string& reason : load_plugin_folders(registry_)) add("problem", "plugin", reason);
    const std::size_t more = registry_.components().size() - before;
    if (more > 0) add("ok", "plugins", fmt::format("{} more types", more));
  }

  void examine_asked_for() {
    for (const std::string& word : common_.plugins) {
      try {
        load_plugin(registry_, find_plugin(word, {}));
        add("ok", "plugin", word);
      } catch (const Error& error) {
        add("problem", "plugin", error.message());
      }
    }
  }

  void examine_threads() {
    const unsigned cores = std::thread::hardware_concurrency();
    const char* wanted = std::getenv("FREEPLAY_THREADS");
    if (wanted == nullptr || *wanted == '\0') return add("ok", "threads", fmt::format("{} cores", cores));
    const std::string_view text = wanted;
    int number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool good = error == std::errc() && stop == text.data() + text.size() && number > 0;
    add(good ? "ok" : "problem", "threads",
        good ? fmt::format("{} (FREEPLAY_THREADS), {} cores", number, cores)
             : fmt::format("FREEPLAY_THREADS is '{}'; it must be a whole number from 1 on", text));
  }

  void examine_folder_of_results() {
    const fs::path probe = ".freeplay-doctor";
    try {
      write_whole_file(probe, "");
      std::error_code ignored;
      fs::remove(probe, ignored);
      add("ok", "results", "this folder can be written");
    } catch (const Error& error) {
      add("problem", "results", error.message());
    }
  }

  const CommonOptions& common_;
  Registry registry_;
  std::vector<DoctorLine> findings_;
};

int examine(const CommonOptions& common) {
  const std::vector<DoctorLine> findings = Doctor(common).examine();
  const auto is_problem = [](const DoctorLine& finding) { return std::string_view(finding.verdict) == "problem"; };
  const bool sound = std::ranges::none_of(findings, is_problem);
  if (common.json) {
    Json list = Json::array();
    for (const DoctorLine& f : findings) list.push_back({{"verdict", f.verdict}, {"part", f.part}, {"text", f.text}});
    print_json({{"ok", sound}, {"findings", list}});
  } else {
    for (const DoctorLine& f : findings) {
      if (!common.quiet || is_problem(f)) print(fmt::format("{:<8} {}: {}\n", f.verdict, f.part, f.text));
    }
  }
  return sound ? 0 : 1;
}

}  // namespace

Command add_doctor_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "doctor", "Say what is installed, found and writable");
  add_common_options(*app, common);
  return {app, [&common] { return examine(common); }};
}

}  // namespace freeplay
