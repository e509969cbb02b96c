#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <vector>

#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>

#include "freeplay/plugin.h"

namespace freeplay {
namespace {

constexpr ARKODE_ERKTableID tableau = ARKODE_VERNER_8_5_6;
constexpr int method_order = 6, error_power = 6;  // of the result; of h in the difference of the two orders
constexpr double caution = 32.0;                  // as of verner6, whose pair it is

void require(bool good) {
  if (!good) throw std::runtime_error("ARKODE could not be set up");
}

/// ARKODE's memory for y = (d, v, z), for states of one size. Every step starts it anew, so that nothing of one step
/// reaches the next.
class Stepper {
 public:
  explicit Stepper(const StateView& s)
      : nv_(s.v.size), nz_(s.z.size), q_(s.q.size), a_(nv_), lambda_(s.lambda.size), y_(2 * nv_ + nz_), e_(y_.size()) {
    require(SUNContext_Create(nullptr, &context_) == 0);
    y_vector_ = N_VMake_Serial(static_cast<sunindextype>(y_.size()), y_.data(), context_);
    e_vector_ = N_VMake_Serial(static_cast<sunindextype>(e_.size()), e_.data(), context_);
    require(y_vector_ != nullptr && e_vector_ != nullptr);
    memory_ = ERKStepCreate(right_hand_side, 0.0, y_vector_, context_);
    // Whether a step passes is for the host to say: here every error does.
    require(memory_ != nullptr && ERKStepSetErrFile(memory_, nullptr) == 0 &&
            ERKStepSetTableNum(memory_, tableau) == 0 && ERKStepSetUserData(memory_, this) == 0 &&
            ERKStepSStolerances(memory_, 0.0, 1e100) == 0);
  }
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;
  ~Stepper() {
    ERKStepFree(&memory_);
    N_VDestroy(y_vector_);
    N_VDestroy(e_vector_);
    SUNContext_Free(&context_);
  }

  bool fits(const StateView& s) const {
    return s.q.size == q_.size() && s.v.size == nv_ && s.lambda.size == lambda_.size() && s.z.size == nz_;
  }

  /// From the state `from`, by dt: increment(), velocity() and internal() at the end, and their errors. False when
  /// ARKODE gives up: a shorter step may do.
  bool step(double dt, const StateView& from, StageSolver& solver) {
    std::fill_n(y_.begin(), nv_, 0.0);
    std::copy(from.v.begin(), from.v.end(), velocity().begin());
    std::copy(from.z.begin(), from.z.end(), internal().begin());
    std::copy(from.a.begin(), from.a.end(), a_.begin());
    std::copy(from.lambda.begin(), from.lambda.end(), lambda_.begin());
    q_start_ = from.q;
    solver_ = &solver;
    failure_ = nullptr;
    double reached = 0.0;
    const bool ready = ERKStepReset(memory_, 0.0, y_vector_) == 0 && ERKStepSetInitStep(memory_, dt) == 0;
    t_start_ = *from.t;
    const bool good = ready && ERKStepEvolve(memory_, dt, y_vector_, &reached, ARK_ONE_STEP) >= 0;
    if (failure_) std::rethrow_exception(failure_);
    return good && reached == dt && ERKStepGetEstLocalErrors(memory_, e_vector_) == 0;
  }

  Span<double> increment() { return {y_.data(), nv_}; }
  Span<double> velocity() { return {y_.data() + nv_, nv_}; }
  Span<double> internal() { return {y_.data() + 2 * nv_, nz_}; }
  Span<const double> position_error() const { return {e_.data(), nv_}; }
  Span<const double> velocity_error() const { return {e_.data() + nv_, nv_}; }
  Span<const double> internal_error() const { return {e_.data() + 2 * nv_, nz_}; }

 private:
  /// y' = (d', a, z') at the time t since the start of the step.
  static int right_hand_side(double t, N_Vector y, N_Vector y_rate, void* user) noexcept {
    auto& me = *static_cast<Stepper*>(user);
    try {
      me.differentiate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(y_rate));
      return 0;
    } catch (...) {
      me.failure_ = std::current_exception();
      return -1;
    }
  }
  void differentiate(double t, double* y, double* y_rate) {
    double time = t_start_ + t;
    solver_->retract(q_start_, {y, nv_}, {q_.data(), q_.size()});
    StateView at{&time,
                 {q_.data(), q_.size()},
                 {y + nv_, nv_},
                 {a_.data(), nv_},
                 {lambda_.data(), lambda_.size()},
                 {y + 2 * nv_, nz_},
                 {}};
    solver_->accelerate(at, {y_rate + 2 * nv_, nz_});
    solver_->increment_rate({y, nv_}, {y + nv_, nv_}, {y_rate, nv_});
    std::copy(a_.begin(), a_.end(), y_rate + nv_);
  }

  std::size_t nv_, nz_;
  std::vector<double> q_, a_, lambda_, y_, e_;
  Span<const double> q_start_{};
  double t_start_ = 0.0;
  StageSolver* solver_ = nullptr;
  std::exception_ptr failure_;
  SUNContext context_ = nullptr;
  N_Vector y_vector_ = nullptr, e_vector_ = nullptr;
  void* memory_ = nullptr;
};

/// Explicit Runge-Kutta pair of orders 6 and 5 of Verner on the index-1 form
///   d' = rate(d, v),  v' = a(t, q, v, z),  z' = z'(t, q, v, z)  with  q = retract(q_n, d)
/// stepped by ARKODE of SUNDIALS: an implementation by others to hold our own against. At the end of the step q is
/// projected on Phi = 0 and v on Phi_q v = nu, and a, lambda are solved there. Verner 1978; Reynolds, Gardner, Woodward
/// and Chinomona 2023 (ARKODE).
class Arkode final : public Integrator {
 public:
  explicit Arkode(const Parameters&) {}

  void declare(IntegratorLayout& layout) const override {
    const Sizes& n = layout.sizes;
    layout.scratch = n.nq + n.nz;
    layout.order = method_order;
    layout.error_order = error_power;
    layout.error_estimate = 1;
    layout.explicit_stages = 1;
    layout.always_adaptive = 1;
  }

  Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const override {
    const Span<double> start = scratch.part(0, to.q.size), z_rate = scratch.part(to.q.size, to.z.size);
    std::copy(to.q.begin(), to.q.end(), start.begin());
    const Borrowed stepper(*this, to);
    if (!stepper->step(dt, to, solver)) return {.converged = 0, .error = 0.0};
    *to.t += dt;
    solver.retract(start, stepper->increment(), to.q);
    std::copy_n(stepper->velocity().begin(), to.v.size, to.v.begin());
    std::copy_n(stepper->internal().begin(), to.z.size, to.z.begin());
    solver.project_position(to);
    solver.project_velocity(to);
    solver.accelerate(to, z_rate);
    const double error = solver.error_norm(stepper->position_error(), stepper->velocity_error());
    const double in_internal = solver.internal_error_norm(dt, to, stepper->internal_error());
    return {.converged = 1, .error = caution * std::max(error, in_internal)};
  }

 private:
  /// Steppers that are not in use. They are work space, too large and too foreign for the scratch: kept, so that a step
  /// allocates nothing; lent out one by one, so that several runs may share this integrator.
  class Borrowed {
   public:
    Borrowed(const Arkode& owner, const StateView& s) : owner_(owner) {
      {
        const std::lock_guard lock(owner.mutex_);
        auto& idle = owner.idle_;
        const auto found = std::find_if(idle.begin(), idle.end(), [&](const auto& one) { return one->fits(s); });
        if (found != idle.end()) {
          stepper_ = std::move(*found);
          idle.erase(found);
        }
      }
      if (!stepper_) stepper_ = std::make_unique<Stepper>(s);
    }
    ~Borrowed() {
      const std::lock_guard lock(owner_.mutex_);
      owner_.idle_.push_back(std::move(stepper_));
    }
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;
    Stepper* operator->() const { return stepper_.get(); }

   private:
    const Arkode& owner_;
    std::unique_ptr<Stepper> stepper_;
  };

  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Stepper>> idle_;
};

}  // namespace

Component sundials_arkode() {
  return integrator<Arkode>(
      {.name = "arkode",
       .summary = "Explicit Runge-Kutta pair of orders 6 and 5 from SUNDIALS with projection, always adaptive.",
       .formula =
           "d' = v, v' = a, z' = g with M a + Phi_q^T lambda = f, Phi_q a = gamma; eight stages of Verner's pair "
           "in ARKODE; then q on Phi = 0 and v on Phi_q v = nu; error: difference of the orders.",
       .validity =
           "A reference to hold other integrators against: motions that are not stiff against the accuracy asked "
           "for.",
       .references = "Verner 1978, SIAM J Numer Anal 15, 772-790; Reynolds, Gardner, Woodward and Chinomona 2023, ACM "
                     "Trans Math Softw 49, 19:1-19:26"});
}

}  // namespace freeplay
