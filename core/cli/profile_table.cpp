#include "cli/profile_table.h"

#include <ctime>

#include <fmt/format.h>

#include "cli/text_table.h"

namespace freeplay {
namespace {

using Align = TextTable::Align;

struct Row {
  Phase phase;
  const char* name;
  const char* unit;  // what its count counts
};
constexpr Row rows[] = {
    {Phase::start, "start", "times"},
    {Phase::assembly, "assembly", "evaluations"},
    {Phase::joints, "joints and contact", "times"},
    {Phase::factorization, "factorization", "times"},
    {Phase::solution, "solution", "times"},
    {Phase::integrator, "integrator", "attempts"},
    {Phase::events, "events", "looks"},
    {Phase::statistics, "statistics", "states"},
    {Phase::output, "output", "rows"},
};

}  // namespace

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string profile_table(const Profile& profile, const Outcome& outcome, double first_step_seconds,
                          double text_seconds) {
  const double total = profile.total();
  const auto share = [&](double part) { return fmt::format("{:.1f} %", total > 0.0 ? 100.0 * part / total : 0.0); };
  const auto seconds = [](double s) { return fmt::format("{:.6f}", s); };
  TextTable times({Align::left, Align::right, Align::right, Align::right, Align::left});
  times.add_row({"profile", "seconds", "share", "count", ""});
  for (const Row& row : rows) {
    const double spent = profile.seconds(row.phase);
    times.add_row({row.name, seconds(spent), share(spent), std::to_string(profile.count(row.phase)), row.unit});
  }
  const double rest = profile.seconds(Phase::rest);
  times.add_row({"rest", seconds(rest), share(rest)});
  times.add_row({"all", seconds(total), share(total)});
  TextTable counts({Align::left, Align::right});
  const std::pair<const char*, long> numbers[] = {{"steps", outcome.steps},
                                                  {"rejected", outcome.rejected},
                                                  {"evaluations", profile.count(Phase::assembly)},
                                                  {"iterations", outcome.iterations},
                                                  {"factorizations", outcome.factorizations},
                                                  {"events", outcome.events},
                                                  {"rows", outcome.rows}};
  for (const auto& [name, number] : numbers) counts.add_row({name, std::to_string(number)});
  const std::string first_step =
      first_step_seconds > 0.0
          ? fmt::format("  the first step ended after {:.6f} s of processor time of the program\n", first_step_seconds)
          : "";
  return times.text("  ") + counts.text("  ") + first_step +
         fmt::format("  rows became text beside the run in {:.6f} s of another thread\n", text_seconds);
}

}  // namespace freeplay
