#include "model/stepper.h"

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
#include <cstdlib>
#include <limits>

#include "base/engineering.h"
#include "model/arrow.h"
#include "model/lawson.h"

namespace softland::internal {
namespace {

// ArrowEquations as a direct solver of SUNDIALS.
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

// What the SUNDIALS steppers share: context, vectors, tolerances, callbacks that never throw (ours cannot).
class SundialsStepper : public Stepper {
 public:
  explicit SundialsStepper(const OdeSystem& system) : system_(system) {
    SUNContext_Create(nullptr, &context_);
    const auto n = static_cast<sunindextype>(system.size);
    y_ = N_VNew_Serial(n, context_);
    // One pass over a stage's sum instead of one per term: the vectors are short, the calls are not.
    N_VEnableFusedOps_Serial(y_, SUNTRUE);
    weights_ = N_VNew_Serial(n, context_);
    last_.rates.resize(system.size - system.frequencies.size());
  }
  SundialsStepper(const SundialsStepper&) = delete;
  SundialsStepper& operator=(const SundialsStepper&) = delete;
  ~SundialsStepper() override {
    N_VDestroy(y_);
    N_VDestroy(weights_);
    if (solver_ != nullptr) SUNLinSolFree(solver_);
    if (fixed_point_ != nullptr) SUNNonlinSolFree(fixed_point_);
    if (matrix_ != nullptr) SUNMatDestroy(matrix_);
    SUNContext_Free(&context_);
  }

  [[nodiscard]] double time() const override { return t_; }
  [[nodiscard]] const double* state() const override { return N_VGetArrayPointer(y_); }
  // The last stage of many methods is the right-hand side where the step ends.
  [[nodiscard]] const double* rates() override {
    if (!last_.is_at(t_, state())) evaluate(t_, state());
    return last_.rates.data();
  }
  [[nodiscard]] std::string message() const override { return message_; }

 protected:
  // An evaluation of the right-hand side.
  struct Evaluation {
    double t = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> y, rates;

    [[nodiscard]] bool is_at(double at, const double* state) const { return t == at && std::equal(y.begin(), y.end(), state); }
  };

  const Evaluation& evaluate(double t, const double* y) {
    last_.t = t;
    last_.y.assign(y, y + system_.size);
    system_.rates(t, y, last_.rates.data());
    return last_;
  }

  void load(double t, const double* y, const double* rates, const std::vector<double>& absolute) {
    t_ = t;
    last_.t = std::numeric_limits<double>::quiet_NaN();  // of another stretch
    begin_.t = t;
    begin_.y.assign(y, y + system_.size);
    begin_.rates.assign(rates, rates + last_.rates.size());
    std::copy_n(y, system_.size, N_VGetArrayPointer(y_));
    std::transform(absolute.begin(), absolute.end(), N_VGetArrayPointer(weights_), [](double a) { return 1 / a; });
  }
  void make_dense_solver() {
    const auto n = static_cast<sunindextype>(system_.size);
    matrix_ = SUNDenseMatrix(n, n, context_);
    solver_ = system_.block > 0 ? arrow_solver(system_, context_) : SUNLinSol_Dense(y_, matrix_, context_);
  }
  bool report(const char* library, int flag, char* (*name)(long)) {
    if (flag >= 0) return true;
    char* why = name(flag);
    message_ = fmt::format("{} stopped with {} ({}) at t = {}", library, why, flag, engineering(t_, "s", 4));
    std::free(why);  // NOLINT: the library's own malloc
    return false;
  }

  static int rhs(realtype t, N_Vector y, N_Vector dydt, void* self) {
    auto* me = static_cast<SundialsStepper*>(self);
    const double* state = N_VGetArrayPointer(y);
    double* out = N_VGetArrayPointer(dydt);
    // A step begins where the last one ended.
    const Evaluation& known = me->last_.is_at(t, state)    ? me->last_
                              : me->begin_.is_at(t, state) ? me->begin_
                                                           : me->evaluate(t, state);
    const std::size_t modes = me->system_.frequencies.size();
    std::copy_n(state + modes, modes, out);
    std::copy(known.rates.begin(), known.rates.end(), out + modes);
    for (std::size_t i = 0; i < me->system_.size; ++i) {
      if (!std::isfinite(out[i]))
        out[i] = 1e100;  // fails the error test: an explicit method has no other way to ask for a shorter step
    }
    return 0;
  }
  static int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix j, void* self, N_Vector, N_Vector, N_Vector) {
    static_cast<SundialsStepper*>(self)->system_.jacobian(t, N_VGetArrayPointer(y), SUNDenseMatrix_Data(j));
    return 0;
  }
  // SUNDIALS refuses tolerances below the rounding of what they are about, which those in a stiff contact are.
  static int error_weights(N_Vector y, N_Vector ewt, void* self) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const auto* me = static_cast<SundialsStepper*>(self);
    const double* state = N_VGetArrayPointer(y);
    const double* weights = N_VGetArrayPointer(me->weights_);
    double* out = N_VGetArrayPointer(ewt);
    for (std::size_t i = 0; i < me->system_.size; ++i) out[i] = 1 / std::max(1 / weights[i], rounding * std::abs(state[i]));
    return 0;
  }
  static void silent(int, const char*, const char*, char*, void*) {}

  const OdeSystem& system_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  N_Vector weights_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  SUNNonlinearSolver fixed_point_ = nullptr;
  Evaluation begin_, last_;
  double t_ = 0;
  std::string message_;
};

constexpr long unbounded_steps = -1;  // the closing keeps its own work bound

class ErkStepper final : public SundialsStepper {
 public:
  explicit ErkStepper(const OdeSystem& system) : SundialsStepper(system) {}
  ~ErkStepper() override {
    if (memory_ != nullptr) ERKStepFree(&memory_);
  }

  bool restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
               double max_step) override {
    load(t, y, rates, absolute);
    if (memory_ == nullptr) {
      memory_ = ERKStepCreate(&SundialsStepper::rhs, t, y_, context_);
      ERKStepSetErrHandlerFn(memory_, &SundialsStepper::silent, nullptr);
      ERKStepSetUserData(memory_, static_cast<SundialsStepper*>(this));
      ERKStepSetTableNum(memory_, ARKODE_DORMAND_PRINCE_7_4_5);
      ERKStepWFtolerances(memory_, &SundialsStepper::error_weights);
      ERKStepSetMaxNumSteps(memory_, unbounded_steps);
      ERKStepSetInterpolantType(memory_, ARK_INTERP_LAGRANGE);  // never asked for: the closing interpolates on its own
      ERKStepSetInterpolantDegree(memory_, 0);
    } else if (!report("ERKStep", ERKStepReInit(memory_, &SundialsStepper::rhs, t, y_), ERKStepGetReturnFlagName)) {
      return false;
    }
    ERKStepSetInitStep(memory_, first_step);
    return report("ERKStep", ERKStepSetMaxStep(memory_, std::isfinite(max_step) ? max_step : 0), ERKStepGetReturnFlagName);
  }

  bool step(double t_stop) override {
    ERKStepSetStopTime(memory_, t_stop);
    return report("ERKStep", ERKStepEvolve(memory_, t_stop, y_, &t_, ARK_ONE_STEP), ERKStepGetReturnFlagName);
  }

 private:
  void* memory_ = nullptr;
};

class DirkStepper final : public SundialsStepper {
 public:
  explicit DirkStepper(const OdeSystem& system) : SundialsStepper(system) {}
  ~DirkStepper() override {
    if (memory_ != nullptr) ARKStepFree(&memory_);
  }

  bool restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
               double max_step) override {
    load(t, y, rates, absolute);
    if (memory_ == nullptr) {
      memory_ = ARKStepCreate(nullptr, &SundialsStepper::rhs, t, y_, context_);
      make_dense_solver();
      ARKStepSetErrHandlerFn(memory_, &SundialsStepper::silent, nullptr);
      ARKStepSetUserData(memory_, static_cast<SundialsStepper*>(this));
      ARKStepSetTableNum(memory_, ARKODE_ARK548L2SA_DIRK_8_4_5, ARKODE_ERK_NONE);
      ARKStepWFtolerances(memory_, &SundialsStepper::error_weights);
      ARKStepSetLinearSolver(memory_, solver_, matrix_);
      ARKStepSetJacFn(memory_, &SundialsStepper::jacobian);
      ARKStepSetMaxNumSteps(memory_, unbounded_steps);
    } else if (!report("ARKStep", ARKStepReInit(memory_, nullptr, &SundialsStepper::rhs, t, y_), ARKStepGetReturnFlagName)) {
      return false;
    }
    ARKStepSetInitStep(memory_, first_step);
    return report("ARKStep", ARKStepSetMaxStep(memory_, std::isfinite(max_step) ? max_step : 0), ARKStepGetReturnFlagName);
  }

  bool step(double t_stop) override {
    ARKStepSetStopTime(memory_, t_stop);
    return report("ARKStep", ARKStepEvolve(memory_, t_stop, y_, &t_, ARK_ONE_STEP), ARKStepGetReturnFlagName);
  }

 private:
  void* memory_ = nullptr;
};

class CvodeStepper final : public SundialsStepper {
 public:
  CvodeStepper(const OdeSystem& system, int method) : SundialsStepper(system), method_(method) {}
  ~CvodeStepper() override {
    if (memory_ != nullptr) CVodeFree(&memory_);
  }

  bool restart(double t, const double* y, const double* rates, const std::vector<double>& absolute, double first_step,
               double max_step) override {
    load(t, y, rates, absolute);
    if (memory_ == nullptr) {
      memory_ = CVodeCreate(method_, context_);
      if (!report("CVODE", CVodeInit(memory_, &SundialsStepper::rhs, t, y_), CVodeGetReturnFlagName)) return false;
      CVodeSetErrHandlerFn(memory_, &SundialsStepper::silent, nullptr);
      CVodeSetUserData(memory_, static_cast<SundialsStepper*>(this));
      CVodeWFtolerances(memory_, &SundialsStepper::error_weights);
      if (method_ == CV_BDF) {
        make_dense_solver();
        CVodeSetLinearSolver(memory_, solver_, matrix_);
        CVodeSetJacFn(memory_, &SundialsStepper::jacobian);
      } else {
        fixed_point_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
        CVodeSetNonlinearSolver(memory_, fixed_point_);
      }
      CVodeSetMaxNumSteps(memory_, unbounded_steps);
    } else if (!report("CVODE", CVodeReInit(memory_, t, y_), CVodeGetReturnFlagName)) {
      return false;
    }
    CVodeSetInitStep(memory_, first_step / 100);  // a restart begins at order 1
    return report("CVODE", CVodeSetMaxStep(memory_, std::isfinite(max_step) ? max_step : 0), CVodeGetReturnFlagName);
  }

  bool step(double t_stop) override {
    CVodeSetStopTime(memory_, t_stop);
    return report("CVODE", CVode(memory_, t_stop, y_, &t_, CV_ONE_STEP), CVodeGetReturnFlagName);
  }

 private:
  int method_;
  void* memory_ = nullptr;
};

}  // namespace

std::unique_ptr<Stepper> make_stepper(Integrator integrator, const OdeSystem& system) {
  switch (integrator) {
    case Integrator::esdirk:
      return std::make_unique<DirkStepper>(system);
    case Integrator::bdf:
      return std::make_unique<CvodeStepper>(system, CV_BDF);
    case Integrator::adams:
      return std::make_unique<CvodeStepper>(system, CV_ADAMS);
    case Integrator::arkode_erk:
      return std::make_unique<ErkStepper>(system);
    case Integrator::automatic:  // the caller knows better: see automatic_integrator()
    case Integrator::lawson:
      break;
  }
  return std::make_unique<Lawson>(system);
}

}  // namespace softland::internal
