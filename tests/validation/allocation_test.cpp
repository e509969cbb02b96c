// Counts calls of the allocator while a run steps. malloc itself is replaced, so that nothing escapes: operator new and
// the matrix library end up there. Sanitizers replace it themselves, so this file is empty with them.
#if !defined(__SANITIZE_ADDRESS__)

#include <atomic>
#include <cerrno>
#include <cstdlib>

#include "run_model.h"

namespace {
std::atomic<bool> counting{false};
std::atomic<long> allocations{0};
void count() {
  if (counting.load(std::memory_order_relaxed)) allocations.fetch_add(1, std::memory_order_relaxed);
}
}  // namespace

// The C library's own entry points under their second names.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

__attribute__((visibility("default"))) void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
__attribute__((visibility("default"))) void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
__attribute__((visibility("default"))) void* realloc(void* old, std::size_t size) {
  count();
  return __libc_realloc(old, size);
}
__attribute__((visibility("default"))) void* memalign(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  count();
  *out = __libc_memalign(alignment, size);
  return *out != nullptr ? 0 : ENOMEM;
}
}

namespace freeplay::test {
namespace {

/// Counts from the row of the second step to the last row; keeps nothing.
class Gate final : public Sink {
 public:
  explicit Gate(long last) : last_(last) {}
  void row(std::span<const double>) override {
    if (rows_ == 2) counting = true;
    if (rows_ == last_) counting = false;
    ++rows_;
  }
  void event(const EventRecord&) override { ++events_; }
  bool ok() const override { return true; }
  long rows() const { return rows_; }
  long events() const { return events_; }

 private:
  long last_, rows_ = 0, events_ = 0;
};

struct Stepping {
  const char* model;
  bool ideal;
  double step;
  long steps;
  bool touches;
  bool accurate = false;  ///< steps chosen by an accuracy of 1 um, rows at every `step`
};
void PrintTo(const Stepping& what, std::ostream* out) { *out << what.model << (what.ideal ? " ideal" : ""); }

long allocations_of(const Stepping& what, long& events) {
  std::string text = mechanism(what.model);
  const std::size_t output = text.find("output: {interval: ");
  if (output != std::string::npos) {
    const std::size_t from = output + std::string("output: {interval: ").size();
    text.replace(from, text.find_first_of(",}", from) - from, number(what.step));
  } else {
    text = replaced(text, "step: 1 ms}", "step: 1 ms, output: {interval: " + number(what.step) + "}}");
  }
  BuildOptions options{
      .set = {}, .ideal = {}, .end = what.step * static_cast<double>(what.steps), .step = what.step, .integrator = {}};
  if (what.ideal) options.ideal = {"all"};
  if (what.accurate) options.accuracy = 1e-6, options.step.reset();
  const auto model = load(text, options);
  System system(*model);
  const Start start = assemble(system);
  const Channels channels(*model);
  Gate gate(what.steps);
  Sink* const sinks[] = {&gate};
  Simulation simulation(system, start, channels, sinks);
  allocations = 0;
  const Outcome outcome = simulation.run({});
  counting = false;
  EXPECT_EQ(outcome.status, RunStatus::completed) << outcome.reason;
  EXPECT_EQ(gate.rows(), what.steps + 1);
  events = gate.events();
  return allocations;
}

class SteppingLoop : public ::testing::TestWithParam<Stepping> {};

TEST_P(SteppingLoop, AllocatesNothing) {
  long events = 0;
  const long count = allocations_of(GetParam(), events);
  record("allocations", static_cast<double>(count));
  EXPECT_EQ(count, 0);
  EXPECT_EQ(events > 0, GetParam().touches);  // contacts begin and end on the way
}
INSTANTIATE_TEST_SUITE_P(
    Models, SteppingLoop,
    ::testing::Values(Stepping{"3-rrr", false, 2e-6, 5000, true}, Stepping{"4-rrr", false, 2e-6, 5000, true},
                      Stepping{"3-rrr", true, 2e-6, 1000, false}, Stepping{"4-rrr", true, 2e-6, 1000, false},
                      Stepping{"slider-crank", false, 1e-6, 2000, true}, Stepping{"pendulum", false, 1e-3, 2000, false},
                      Stepping{"four-bar", false, 1e-3, 2000, false}, Stepping{"3-rrr", false, 1e-5, 1000, true, true},
                      Stepping{"slider-crank", false, 1e-5, 300, true, true}));

TEST(AllocationCounter, SeesNewAndMalloc) {
  allocations = 0;
  counting = true;
  auto* number = new double(1.0);
  void* volatile bytes = std::malloc(8);
  counting = false;
  EXPECT_GE(allocations, 2);
  delete number;
  std::free(bytes);
}

}  // namespace
}  // namespace freeplay::test

#endif
