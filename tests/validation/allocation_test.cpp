// Counts calls of the allocator while a run steps. malloc itself is replaced, so that nothing escapes: operator new and
// the matrix library end up there. Sanitizers replace it themselves, so this file is empty with them.
#include "base/address_sanitizer.h"

#if !FREEPLAY_ADDRESS_SANITIZER

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

/// Counts between two rows; keeps nothing.
class Gate final : public Sink {
 public:
  Gate(long first, long last) : first_(first), last_(last) {}
  void row(std::span<const double>) override {
    if (rows_ == first_) counting = true;
    if (rows_ == last_) counting = false;
    ++rows_;
  }
  void event(const EventRecord&) override { events_ += counting ? 1 : 0; }
  bool ok() const override { return true; }
  long rows() const { return rows_; }
  long events() const { return events_; }  ///< while counting

 private:
  long first_, last_, rows_ = 0, events_ = 0;
};

/// The N-four-bar with a loose pin at the right end of every bar: all fly at first, then touch and bounce.
std::string loose_chain() {
  return replaced(mechanism("validation/a02-chain"),
                  "right: {type: revolute, between: [bar/end, \"column{$i + 1}.link/top\"]}",
                  R"(right:
        type: revolute
        bearing: bar/end
        journal: "column{$i + 1}.link/top"
        clearance:
          bearing_radius: 10 mm
          radial_clearance: 10 um
          length: 20 mm
          material: {E: 207 GPa, nu: 0.3}
          contact: {law: lankarani-nikravesh, restitution: 0.9}
          friction: {law: ambrosio, mu: 0.1, v0: 1e-4, v1: 1e-3})");
}

struct Mechanism {
  std::string name;
  bool ideal;
  double interval;  ///< of the rows; fixed steps are as long
  long rows;
  bool touches;  ///< contacts begin and end on the way
};
const std::string chain = "chain";
constexpr const char* chain_windows = "60";  // 121 bodies, 422 unknowns

const Mechanism with_contacts[] = {
    {"slider-crank", false, 1e-6, 2000, true}, {"3-rrr", false, 2e-6, 5000, true}, {chain, false, 1e-5, 400, true}};
const Mechanism others[] = {{"4-rrr", false, 2e-6, 5000, true},
                            {"3-rrr", true, 2e-6, 1000, false},
                            {"4-rrr", true, 2e-6, 1000, false},
                            {"pendulum", false, 1e-3, 2000, false},
                            {"four-bar", false, 1e-3, 2000, false}};

struct Stepping {
  Mechanism mechanism;
  std::optional<std::string> integrator = std::nullopt;  ///< in place of that of the model
  bool accurate = false;                                 ///< steps chosen by an accuracy of 1 um
};

std::string text_of(const Stepping& what) {
  std::string text = what.mechanism.name == chain ? loose_chain() : mechanism(what.mechanism.name);
  const std::string interval = number(what.mechanism.interval), key = "output: {interval: ";
  const std::size_t output = text.find(key);
  if (output == std::string::npos) return replaced(text, "step: 1 ms}", "step: 1 ms, " + key + interval + "}}");
  const std::size_t from = output + key.size();
  return text.replace(from, text.find_first_of(",}", from) - from, interval);
}

std::unique_ptr<Model> model_of(const Stepping& what) {
  BuildOptions options;
  options.end = what.mechanism.interval * static_cast<double>(what.mechanism.rows);
  options.integrator = what.integrator;
  if (what.mechanism.name == chain) options.set = {{"windows", chain_windows}};
  if (what.mechanism.ideal) options.ideal = {"all"};
  if (what.accurate) {
    options.accuracy = 1e-6;
  } else {
    options.step = what.mechanism.interval;
  }
  return load(text_of(what), options);
}

/// Every integrator there is, on every mechanism with contacts: in fixed steps and by accuracy, each where it can.
std::vector<Stepping> every_integrator() {
  std::vector<Stepping> all;
  for (const std::string& name : builtin_types().names(ComponentKind::integrator)) {
    IntegratorLayout layout;
    Message message;
    const auto model = model_of({others[3], name});
    if (!model->settings.integrator.declare(layout, message)) throw std::runtime_error(message.text);
    for (const Mechanism& mechanism : with_contacts) {
      if (layout.always_adaptive == 0) all.push_back({mechanism, name});
      if (layout.error_estimate != 0) all.push_back({mechanism, name, true});
    }
  }
  return all;
}

std::vector<Stepping> other_mechanisms() {
  std::vector<Stepping> all;
  for (const Mechanism& mechanism : others) all.push_back({mechanism});
  return all;
}

void PrintTo(const Stepping& what, std::ostream* out) { *out << what.mechanism.name; }

std::string label(const testing::TestParamInfo<Stepping>& info) {
  const Stepping& what = info.param;
  std::string text = what.mechanism.name + (what.mechanism.ideal ? "_ideal" : "") + "_" +
                     what.integrator.value_or("default") + (what.accurate ? "_accurate" : "_fixed");
  std::ranges::replace(text, '-', '_');
  return text;
}

class SteppingLoop : public testing::TestWithParam<Stepping> {};

TEST_P(SteppingLoop, AllocatesNothing) {
  const Mechanism& mechanism = GetParam().mechanism;
  const auto model = model_of(GetParam());
  System system(*model);
  const Start start = assemble(system);
  const Channels channels(*model);
  // A factor of stages finds its pattern and pivots when it is first used: in fixed steps in the first one, else when
  // the first few step lengths have been tried.
  Gate gate(GetParam().accurate ? mechanism.rows / 10 : 2, mechanism.rows);
  Sink* const sinks[] = {&gate};
  Simulation simulation(system, start, channels, sinks);
  allocations = 0;
  const Outcome outcome = simulation.run({});
  counting = false;
  const long count = allocations;
  record("allocations", static_cast<double>(count));
  EXPECT_EQ(count, 0);
  EXPECT_EQ(outcome.status, RunStatus::completed) << outcome.reason;
  EXPECT_EQ(gate.rows(), mechanism.rows + 1);
  EXPECT_EQ(gate.events() > 1, mechanism.touches);
}
INSTANTIATE_TEST_SUITE_P(Integrators, SteppingLoop, testing::ValuesIn(every_integrator()), label);
INSTANTIATE_TEST_SUITE_P(Models, SteppingLoop, testing::ValuesIn(other_mechanisms()), label);

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
