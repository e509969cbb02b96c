#include "cli/commands.h"

#include "cli/analyze_command.h"
#include "cli/check_plugin_command.h"
#include "cli/compare_command.h"
#include "cli/convert_command.h"
#include "cli/describe_command.h"
#include "cli/doctor_command.h"
#include "cli/export_command.h"
#include "cli/init_command.h"
#include "cli/list_command.h"
#include "cli/plot_command.h"
#include "cli/report_command.h"
#include "cli/reproduce_command.h"
#include "cli/run_command.h"
#include "cli/schema_command.h"
#include "cli/seal_command.h"
#include "cli/show_command.h"
#include "cli/study_command.h"
#include "cli/validate_command.h"

namespace freeplay {

std::span<const CommandEntry> all_commands() {
  static constexpr CommandEntry all[] = {
      // clang-format off
      {"run", add_run_command},
      {"validate", add_validate_command},
      {"study", add_study_command},
      {"analyze", add_analyze_command},
      {"compare", add_compare_command},
      {"export", add_export_command},
      {"report", add_report_command},
      {"seal", add_seal_command},
      {"plot", add_plot_command},
      {"reproduce", add_reproduce_command},
      {"show", add_show_command},
      {"convert", add_convert_command},
      {"doctor", add_doctor_command},
      {"list", add_list_command},
      {"describe", add_describe_command},
      {"schema", add_schema_command},
      {"init", add_init_command},
      {"check-plugin", add_check_plugin_command},
      // clang-format on
  };
  return all;
}

}  // namespace freeplay
