#include "cli/loading.h"

#include "cli/terminal.h"

namespace freeplay {

LoadOptions loading(const CommonOptions& common) {
  const LoadWords& words = common;
  LoadOptions options{words};
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
