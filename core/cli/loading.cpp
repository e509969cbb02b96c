#include "cli/loading.h"

#include "cli/terminal.h"

namespace freeplay {

LoadOptions loading(const CommonOptions& common) {
  LoadOptions options;
  options.strict = common.strict;
  options.plugins = common.plugins;
  options.allow_plugins = common.allow_plugins;
  options.recorded_plugins = common.recorded_plugins;
  options.warn = [no_color = common.no_color](const std::string& text) {
    print_messages("freeplay: warning: " + text + "\n", no_color);
  };
  if (!common.quiet) {
    options.note = [no_color = common.no_color](const std::string& text) {
      print_messages("freeplay: note: " + text + "\n", no_color);
    };
  }
  return options;
}

}  // namespace freeplay
