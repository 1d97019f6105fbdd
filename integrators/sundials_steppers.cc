#include "integrators/sundials_steppers.h"

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <string_view>
#include <type_traits>

#include "base/engineering.h"
#include "integrators/arrow.h"

namespace softland {
namespace {

// Returns a direct linear solver of SUNDIALS that calls ArrowEquations.
SUNLinearSolver arrow_solver(const OdeSystem& system, SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  solver->content = new ArrowEquations(static_cast<Eigen::Index>(system.size), static_cast<Eigen::Index>(system.core),
                                       static_cast<Eigen::Index>(system.block));
  solver->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
  solver->ops->setup = [](SUNLinearSolver s, SUNMatrix a) {
    constexpr int try_a_shorter_step = 1;
    return static_cast<ArrowEquations*>(s->content)->factor(SUNDenseMatrix_Data(a)) ? 0 : try_a_shorter_step;
  };
  solver->ops->solve = [](SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) {
    N_VScale(1, b, x);
    static_cast<ArrowEquations*>(s->content)->solve(N_VGetArrayPointer(x));
    return 0;
  };
  solver->ops->free = [](SUNLinearSolver s) {
    delete static_cast<ArrowEquations*>(s->content);
    s->content = nullptr;
    SUNLinSolFreeEmpty(s);
    return 0;
  };
  return solver;
}

struct Destroy {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
  void operator()(SUNNonlinearSolver s) const { SUNNonlinSolFree(s); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy>;

/// Owns an object of SUNDIALS. A null pointer means that SUNDIALS was out of memory.
template <class Handle>
Owned<Handle> made(Handle handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return Owned<Handle>(handle);
}

class Context {
 public:
  Context() {
    if (SUNContext_Create(nullptr, &context_) != 0) throw std::bad_alloc();
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { SUNContext_Free(&context_); }
  [[nodiscard]] SUNContext get() const { return context_; }

 private:
  SUNContext context_ = nullptr;
};

/// The common part of the steppers of SUNDIALS: context, vectors, tolerances, messages, and the equations as callbacks. The
/// equations must not throw exceptions.
class SundialsStepper : public Stepper {
 public:
  explicit SundialsStepper(const OdeSystem& system) : system_(system), y_(new_vector()), weights_(new_vector()) {
    // Let SUNDIALS add all terms of a stage in one call: the vectors are so short that calls take most of the time.
    N_VEnableFusedOps_Serial(y_.get(), SUNTRUE);
    last_.rates.resize(system.size - system.frequencies.size());
  }
  SundialsStepper(const SundialsStepper&) = delete;
  SundialsStepper& operator=(const SundialsStepper&) = delete;

  bool restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
               double max_step) final {
    load(t, y, rates, absolute);
    const double longest = std::isfinite(max_step) ? max_step : 0;  // SUNDIALS takes 0 as unbounded
    if (ready_) return reinitialize(t) && set_steps(first_step, longest);
    ready_ = create(t) && set_up();
    return ready_ && set_steps(first_step, longest);
  }
  [[nodiscard]] double time() const final { return t_; }
  [[nodiscard]] const double* state() const final { return N_VGetArrayPointer(y_.get()); }
  // Many methods evaluate the right-hand side at the end of the step last; then no further evaluation is necessary.
  [[nodiscard]] const double* rates() final {
    if (!last_.is_at(t_, state())) evaluate(t_, state());
    return last_.rates.data();
  }
  [[nodiscard]] std::string message() const final { return message_; }

 protected:
  /// Allocates the memory of SUNDIALS for equations that start at (t, y_).
  virtual bool create(double t) = 0;
  /// Sets the options of the integration method in SUNDIALS.
  virtual bool set_up() = 0;
  virtual bool reinitialize(double t) = 0;
  virtual bool set_steps(double first, double longest) = 0;

  /// Returns true when a call of SUNDIALS succeeded; otherwise stores the message of SUNDIALS.
  bool ok(int flag, std::string_view function) {
    if (flag >= 0) return true;
    message_ =
        fmt::format("{} returned {} at t = {}{}{}", function, flag, engineering(t_, "s", 4), said_.empty() ? "" : ": ", said_);
    said_.clear();
    return false;
  }
  void make_dense_solver() {
    const auto n = static_cast<sunindextype>(system_.size);
    matrix_ = made(SUNDenseMatrix(n, n, context()));
    solver_ = made(system_.block > 0 ? arrow_solver(system_, context()) : SUNLinSol_Dense(y_.get(), matrix_.get(), context()));
  }
  [[nodiscard]] SUNContext context() const { return context_.get(); }

  static int rhs(realtype t, N_Vector y, N_Vector dydt, void* self) {
    auto* me = static_cast<SundialsStepper*>(self);
    const double* state = N_VGetArrayPointer(y);
    double* out = N_VGetArrayPointer(dydt);
    // At the start of a step, where the last step ended or the integration restarted, the rates are already known.
    const Evaluation& known = me->last_.is_at(t, state)    ? me->last_
                              : me->begin_.is_at(t, state) ? me->begin_
                                                           : me->evaluate(t, state);
    const std::size_t modes = me->system_.frequencies.size();
    std::copy_n(state + modes, modes, out);
    std::copy(known.rates.begin(), known.rates.end(), out + modes);
    for (std::size_t i = 0; i < me->system_.size; ++i) {
      if (!std::isfinite(out[i])) out[i] = 1e100;  // makes the error test of SUNDIALS fail, so that the step is shortened
    }
    return 0;
  }
  static int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix j, void* self, N_Vector, N_Vector, N_Vector) {
    static_cast<SundialsStepper*>(self)->system_.jacobian(t, N_VGetArrayPointer(y), SUNDenseMatrix_Data(j));
    return 0;
  }
  // Returns the inverse tolerance of each unknown. SUNDIALS refuses tolerances below the rounding error of the unknown, which
  // the absolute tolerances of a stiff contact may be, so that error is their lower bound here.
  static int error_weights(N_Vector y, N_Vector ewt, void* self) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const auto* me = static_cast<SundialsStepper*>(self);
    const double* state = N_VGetArrayPointer(y);
    const double* weights = N_VGetArrayPointer(me->weights_.get());
    double* out = N_VGetArrayPointer(ewt);
    for (std::size_t i = 0; i < me->system_.size; ++i) out[i] = 1 / std::max(1 / weights[i], rounding * std::abs(state[i]));
    return 0;
  }
  static void keep_message(int, const char* module, const char* function, char* text, void* self) {
    static_cast<SundialsStepper*>(self)->said_ = fmt::format("{}: {}: {}", module, function, text);
  }

  const OdeSystem& system_;
  Context context_;
  Owned<N_Vector> y_, weights_;
  Owned<SUNMatrix> matrix_;
  Owned<SUNLinearSolver> solver_;
  double t_ = 0;

 private:
  // A time and a state y at which the right-hand side was evaluated, and its value (v', z') there.
  struct Evaluation {
    double t = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> y, rates;

    [[nodiscard]] bool is_at(double at, const double* state) const { return t == at && std::equal(y.begin(), y.end(), state); }
  };

  [[nodiscard]] Owned<N_Vector> new_vector() const {
    return made(N_VNew_Serial(static_cast<sunindextype>(system_.size), context()));
  }

  const Evaluation& evaluate(double t, const double* y) {
    last_.t = t;
    last_.y.assign(y, y + system_.size);
    system_.rates(t, y, last_.rates.data());
    return last_;
  }

  void load(double t, const double* y, const double* rates, const std::vector<double>& absolute) {
    t_ = t;
    last_.t = std::numeric_limits<double>::quiet_NaN();  // discard the rates from before the discontinuity
    begin_.t = t;
    begin_.y.assign(y, y + system_.size);
    begin_.rates.assign(rates, rates + last_.rates.size());
    std::copy_n(y, system_.size, N_VGetArrayPointer(y_.get()));
    std::transform(absolute.begin(), absolute.end(), N_VGetArrayPointer(weights_.get()), [](double a) { return 1 / a; });
  }

  Evaluation begin_, last_;
  bool ready_ = false;
  std::string message_, said_;
};

constexpr long unbounded_steps = -1;  // the caller limits the number of steps, not SUNDIALS
// Relative change of the step length above which the matrix of the implicit equations is factorised again.
constexpr double smallest_change_of_step = 1e-10;
constexpr int steps_of_a_jacobian = 2;
// Predictors of ARKODE: start values of the iteration for a stage. The trivial predictor is the state before the step; the
// other one extrapolates the last step, with a lower order for later stages. For a compressible gas film the trivial predictor
// needs half the time at a tolerance of 1e-4, the extrapolation 0.4 of the time at 1e-8; at 1e-5 the times are equal.
constexpr int predictor_trivial = 0, predictor_of_falling_order = 2;
constexpr double extrapolates_below = 3e-6;  // relative tolerance below which the predictor extrapolates

class ErkStepper final : public SundialsStepper {
 public:
  explicit ErkStepper(const OdeSystem& system) : SundialsStepper(system) {}
  ~ErkStepper() override {
    if (memory_ != nullptr) ERKStepFree(&memory_);
  }
  bool step(double t_stop) override {
    return ok(ERKStepSetStopTime(memory_, t_stop), "ERKStepSetStopTime") &&
           ok(ERKStepEvolve(memory_, t_stop, y_.get(), &t_, ARK_ONE_STEP), "ERKStepEvolve");
  }

 private:
  bool create(double t) override {
    memory_ = ERKStepCreate(&SundialsStepper::rhs, t, y_.get(), context());
    if (memory_ == nullptr) throw std::bad_alloc();
    return ok(ERKStepSetErrHandlerFn(memory_, &SundialsStepper::keep_message, static_cast<SundialsStepper*>(this)),
              "ERKStepSetErrHandlerFn");
  }
  bool set_up() override {
    return ok(ERKStepSetUserData(memory_, static_cast<SundialsStepper*>(this)), "ERKStepSetUserData") &&
           ok(ERKStepSetTableNum(memory_, ARKODE_DORMAND_PRINCE_7_4_5), "ERKStepSetTableNum") &&
           ok(ERKStepWFtolerances(memory_, &SundialsStepper::error_weights), "ERKStepWFtolerances") &&
           ok(ERKStepSetMaxNumSteps(memory_, unbounded_steps), "ERKStepSetMaxNumSteps") &&
           // The interpolant of SUNDIALS is not used, so choose the cheapest one.
           ok(ERKStepSetInterpolantType(memory_, ARK_INTERP_LAGRANGE), "ERKStepSetInterpolantType") &&
           ok(ERKStepSetInterpolantDegree(memory_, 0), "ERKStepSetInterpolantDegree");
  }
  bool reinitialize(double t) override { return ok(ERKStepReInit(memory_, &SundialsStepper::rhs, t, y_.get()), "ERKStepReInit"); }
  bool set_steps(double first, double longest) override {
    return ok(ERKStepSetInitStep(memory_, first), "ERKStepSetInitStep") &&
           ok(ERKStepSetMaxStep(memory_, longest), "ERKStepSetMaxStep");
  }

  void* memory_ = nullptr;
};

class DirkStepper final : public SundialsStepper {
 public:
  DirkStepper(const OdeSystem& system, double tolerance)
      : SundialsStepper(system), predictor_(tolerance < extrapolates_below ? predictor_of_falling_order : predictor_trivial) {}
  ~DirkStepper() override {
    if (memory_ != nullptr) ARKStepFree(&memory_);
  }
  bool step(double t_stop) override {
    return ok(ARKStepSetStopTime(memory_, t_stop), "ARKStepSetStopTime") &&
           ok(ARKStepEvolve(memory_, t_stop, y_.get(), &t_, ARK_ONE_STEP), "ARKStepEvolve");
  }

 private:
  bool create(double t) override {
    memory_ = ARKStepCreate(nullptr, &SundialsStepper::rhs, t, y_.get(), context());
    if (memory_ == nullptr) throw std::bad_alloc();
    make_dense_solver();
    return ok(ARKStepSetErrHandlerFn(memory_, &SundialsStepper::keep_message, static_cast<SundialsStepper*>(this)),
              "ARKStepSetErrHandlerFn");
  }
  bool set_up() override {
    return ok(ARKStepSetUserData(memory_, static_cast<SundialsStepper*>(this)), "ARKStepSetUserData") &&
           ok(ARKStepSetTableNum(memory_, ARKODE_ARK548L2SA_DIRK_8_4_5, ARKODE_ERK_NONE), "ARKStepSetTableNum") &&
           ok(ARKStepWFtolerances(memory_, &SundialsStepper::error_weights), "ARKStepWFtolerances") &&
           ok(ARKStepSetLinearSolver(memory_, solver_.get(), matrix_.get()), "ARKStepSetLinearSolver") &&
           ok(ARKStepSetJacFn(memory_, &SundialsStepper::jacobian), "ARKStepSetJacFn") &&
           // Factorise at every change of the step length. SUNDIALS keeps its estimate of the nonlinear iteration's convergence
           // rate until it factorises. If an estimate were too good by chance, SUNDIALS would stop later iterations too early,
           // with errors of a thousand tolerances.
           ok(ARKStepSetDeltaGammaMax(memory_, smallest_change_of_step), "ARKStepSetDeltaGammaMax") &&
           ok(ARKStepSetJacEvalFrequency(memory_, steps_of_a_jacobian), "ARKStepSetJacEvalFrequency") &&
           ok(ARKStepSetPredictorMethod(memory_, predictor_), "ARKStepSetPredictorMethod") &&
           ok(ARKStepSetMaxNumSteps(memory_, unbounded_steps), "ARKStepSetMaxNumSteps");
  }
  bool reinitialize(double t) override {
    return ok(ARKStepReInit(memory_, nullptr, &SundialsStepper::rhs, t, y_.get()), "ARKStepReInit");
  }
  bool set_steps(double first, double longest) override {
    return ok(ARKStepSetInitStep(memory_, first), "ARKStepSetInitStep") &&
           ok(ARKStepSetMaxStep(memory_, longest), "ARKStepSetMaxStep");
  }

  int predictor_;
  void* memory_ = nullptr;
};

class CvodeStepper final : public SundialsStepper {
 public:
  CvodeStepper(const OdeSystem& system, int method) : SundialsStepper(system), method_(method) {}
  ~CvodeStepper() override {
    if (memory_ != nullptr) CVodeFree(&memory_);
  }
  bool step(double t_stop) override {
    return ok(CVodeSetStopTime(memory_, t_stop), "CVodeSetStopTime") &&
           ok(CVode(memory_, t_stop, y_.get(), &t_, CV_ONE_STEP), "CVode");
  }

 private:
  bool create(double t) override {
    memory_ = CVodeCreate(method_, context());
    if (memory_ == nullptr) throw std::bad_alloc();
    return ok(CVodeSetErrHandlerFn(memory_, &SundialsStepper::keep_message, static_cast<SundialsStepper*>(this)),
              "CVodeSetErrHandlerFn") &&
           ok(CVodeInit(memory_, &SundialsStepper::rhs, t, y_.get()), "CVodeInit");
  }
  bool set_up() override {
    return ok(CVodeSetUserData(memory_, static_cast<SundialsStepper*>(this)), "CVodeSetUserData") &&
           ok(CVodeWFtolerances(memory_, &SundialsStepper::error_weights), "CVodeWFtolerances") && set_up_equations() &&
           ok(CVodeSetMaxNumSteps(memory_, unbounded_steps), "CVodeSetMaxNumSteps");
  }
  bool set_up_equations() {
    if (method_ == CV_BDF) {
      make_dense_solver();
      return ok(CVodeSetLinearSolver(memory_, solver_.get(), matrix_.get()), "CVodeSetLinearSolver") &&
             ok(CVodeSetJacFn(memory_, &SundialsStepper::jacobian), "CVodeSetJacFn");
    }
    fixed_point_ = made(SUNNonlinSol_FixedPoint(y_.get(), 0, context()));
    return ok(CVodeSetNonlinearSolver(memory_, fixed_point_.get()), "CVodeSetNonlinearSolver");
  }
  bool reinitialize(double t) override { return ok(CVodeReInit(memory_, t, y_.get()), "CVodeReInit"); }
  bool set_steps(double first, double longest) override {
    // BDF and Adams methods restart at order 1, which needs shorter steps than those of order 5 for which `first` is suggested.
    return ok(CVodeSetInitStep(memory_, first / 100), "CVodeSetInitStep") &&
           ok(CVodeSetMaxStep(memory_, longest), "CVodeSetMaxStep");
  }

  int method_;
  void* memory_ = nullptr;
  Owned<SUNNonlinearSolver> fixed_point_;
};

}  // namespace

std::unique_ptr<Stepper> make_esdirk(const OdeSystem& system, double tolerance) {
  return std::make_unique<DirkStepper>(system, tolerance);
}
std::unique_ptr<Stepper> make_bdf(const OdeSystem& system) { return std::make_unique<CvodeStepper>(system, CV_BDF); }
std::unique_ptr<Stepper> make_adams(const OdeSystem& system) { return std::make_unique<CvodeStepper>(system, CV_ADAMS); }
std::unique_ptr<Stepper> make_arkode_erk(const OdeSystem& system) { return std::make_unique<ErkStepper>(system); }

}  // namespace softland
