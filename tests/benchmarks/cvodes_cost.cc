// SPDX-License-Identifier: Apache-2.0
#include "cvodes_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

constexpr int kState = 2;            // angle [rad], rate [rad/s]
constexpr int kSensitivities = 4;    // with respect to inertia, viscous, coulomb, release_angle
constexpr double kSmoothing = 0.01;  // rad/s

/// The equation of motion in SI: I θ'' = -G sin θ - b θ' - τ tanh(θ' / kSmoothing).
struct SmoothedPendulum {
  double gravity_torque = 0;
  double inertia = 0;
  double viscous = 0;
  double coulomb = 0;

  void Rates(const double* y, double* rates) const {
    rates[0] = y[1];
    rates[1] = -(gravity_torque * std::sin(y[0]) + viscous * y[1] + coulomb * std::tanh(y[1] / kSmoothing)) / inertia;
  }

  /// Time derivatives of the sensitivities s[i] of y, in the order of kSensitivities.
  void SensitivityRates(const double* y, N_Vector* s, N_Vector* s_rates) const {
    const double sign = std::tanh(y[1] / kSmoothing);
    const double acceleration = -(gravity_torque * std::sin(y[0]) + viscous * y[1] + coulomb * sign) / inertia;
    const double by_angle = -gravity_torque * std::cos(y[0]) / inertia;
    const double by_rate = -(viscous + coulomb * (1 - sign * sign) / kSmoothing) / inertia;
    const std::array<double, kSensitivities> direct = {-acceleration / inertia, -y[1] / inertia, -sign / inertia, 0.0};
    for (int i = 0; i < kSensitivities; ++i) {
      const double* from = N_VGetArrayPointer(s[i]);
      double* to = N_VGetArrayPointer(s_rates[i]);
      to[0] = from[1];
      to[1] = by_angle * from[0] + by_rate * from[1] + direct[i];
    }
  }
};

int RatesOf(double /*time*/, N_Vector y, N_Vector rates, void* pendulum) {
  static_cast<const SmoothedPendulum*>(pendulum)->Rates(N_VGetArrayPointer(y), N_VGetArrayPointer(rates));
  return 0;
}

/// The rates passed by CVODES are not used: within the simultaneous corrector they do not belong to y.
int SensitivityRatesOf(int /*count*/, double /*time*/, N_Vector y, N_Vector /*rates*/, N_Vector* s, N_Vector* s_rates,
                       void* pendulum, N_Vector /*scratch*/, N_Vector /*scratch*/) {
  static_cast<const SmoothedPendulum*>(pendulum)->SensitivityRates(N_VGetArrayPointer(y), s, s_rates);
  return 0;
}

/// Ends the program if SUNDIALS reports an error, which would be a bug of the benchmark.
void Check(int flag) {
  if (flag < 0) throw std::runtime_error("CVODES: flag " + std::to_string(flag));
}

struct ContextFree {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
struct VectorFree {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
struct VectorsFree {
  void operator()(N_Vector* vectors) const { N_VDestroyVectorArray(vectors, kSensitivities); }
};
struct CorrectorFree {
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
struct IntegratorFree {
  void operator()(void* integrator) const { CVodeFree(&integrator); }
};
using Context = std::unique_ptr<std::remove_pointer_t<SUNContext>, ContextFree>;
using Vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, VectorFree>;
using Vectors = std::unique_ptr<N_Vector, VectorsFree>;
using Corrector = std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, CorrectorFree>;
using Integrator = std::unique_ptr<void, IntegratorFree>;

Context MakeContext() {
  SUNContext context = nullptr;
  Check(SUNContext_Create(nullptr, &context));
  return Context(context);
}

/// A swing from rest at time 0, with or without its sensitivities. Its memory is reused for every swing.
class CvodesSwing {
 public:
  CvodesSwing(double gravity_torque, double relative_tolerance, bool with_sensitivities)
      : with_sensitivities_(with_sensitivities) {
    pendulum_.gravity_torque = gravity_torque;
    Check(CVodeInit(integrator_.get(), RatesOf, 0.0, y_.get()));
    Check(CVodeSetUserData(integrator_.get(), &pendulum_));
    Check(CVodeSStolerances(integrator_.get(), relative_tolerance, relative_tolerance * kAbsolute));
    Check(CVodeSetMaxNumSteps(integrator_.get(), 1'000'000));
    Check(CVodeSetNonlinearSolver(integrator_.get(), corrector_.get()));
    if (with_sensitivities) InitSensitivities();
  }
  CvodesSwing(const CvodesSwing&) = delete;
  CvodesSwing& operator=(const CvodesSwing&) = delete;
  CvodesSwing(CvodesSwing&&) = delete;
  CvodesSwing& operator=(CvodesSwing&&) = delete;
  ~CvodesSwing() = default;

  void Release(const double* p) {
    pendulum_.inertia = p[0];
    pendulum_.viscous = p[1];
    pendulum_.coulomb = p[2];
    y()[0] = p[3];
    y()[1] = 0;
    Check(CVodeReInit(integrator_.get(), 0.0, y_.get()));
    if (!with_sensitivities_) return;
    for (int i = 0; i < kSensitivities; ++i) N_VConst(0.0, s_.get()[i]);
    s(3)[0] = 1;
    Check(CVodeSensReInit(integrator_.get(), CV_SIMULTANEOUS, s_.get()));
  }

  /// Moves y, and the sensitivities, to a later time [s]. Returns false if CVODES fails.
  bool MoveTo(double time) {
    double reached = 0;
    if (CVode(integrator_.get(), time, y_.get(), &reached, CV_NORMAL) < 0) return false;
    return !with_sensitivities_ || CVodeGetSens(integrator_.get(), &reached, s_.get()) == CV_SUCCESS;
  }

  double* y() { return N_VGetArrayPointer(y_.get()); }
  double* s(int i) { return N_VGetArrayPointer(s_.get()[i]); }

 private:
  static constexpr double kAbsolute = 0.1;  // rad, rad/s: small values

  /// The tolerances of the sensitivities follow from the tolerances of the state and the parameters' sizes. Only the
  /// state controls the steps, which is CVODES' default. With control by the sensitivities, too, a solve took a third
  /// to a half longer and gave the same solution.
  void InitSensitivities() {
    s_.reset(N_VCloneVectorArray(kSensitivities, y_.get()));
    for (int i = 0; i < kSensitivities; ++i) N_VConst(0.0, s_.get()[i]);
    Check(CVodeSensInit(integrator_.get(), kSensitivities, CV_SIMULTANEOUS, SensitivityRatesOf, s_.get()));
    Check(CVodeSetSensParams(integrator_.get(), nullptr, sizes_.data(), nullptr));
    Check(CVodeSensEEtolerances(integrator_.get()));
    joint_corrector_.reset(SUNNonlinSol_FixedPointSens(kSensitivities + 1, y_.get(), 0, context_.get()));
    Check(CVodeSetNonlinearSolverSensSim(integrator_.get(), joint_corrector_.get()));
  }

  SmoothedPendulum pendulum_;
  bool with_sensitivities_;
  std::array<double, kSensitivities> sizes_ = {kTruth[0], kTruth[1], kTruth[2], kTruth[3]};
  Context context_ = MakeContext();
  Vector y_{N_VNew_Serial(kState, context_.get())};
  Vectors s_;
  Corrector corrector_{SUNNonlinSol_FixedPoint(y_.get(), 0, context_.get())};
  Corrector joint_corrector_;  // for the state and its sensitivities
  Integrator integrator_{CVodeCreate(CV_ADAMS, context_.get())};
};

class CvodesCost final : public ceres::CostFunction {
 public:
  CvodesCost(const Recording& recording, double gravity_torque, double relative_tolerance)
      : recording_(recording),
        values_(gravity_torque, relative_tolerance, false),
        derivatives_(gravity_torque, relative_tolerance, true) {
    set_num_residuals(static_cast<int>(recording.size()));
    mutable_parameter_block_sizes()->push_back(kParameters);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    double* row = jacobians == nullptr ? nullptr : jacobians[0];
    CvodesSwing& swing = row == nullptr ? values_ : derivatives_;
    const double* p = parameters[0];
    swing.Release(p);
    for (Eigen::Index i = 0; i < recording_.size(); ++i) {
      const double time = recording_.time[i] - p[4];
      if (time > 0 && !swing.MoveTo(time)) return false;
      residuals[i] = recording_.value[i] - (swing.y()[0] + p[5]);
      if (row != nullptr) FillRow(swing, std::exchange(row, row + kParameters));
    }
    return true;
  }

 private:
  static constexpr int kParameters = 6;

  /// Derivatives of one residual. The release shifts the whole swing in time: its derivative is minus the rate.
  static void FillRow(CvodesSwing& swing, double* row) {
    for (int j = 0; j < kSensitivities; ++j) row[j] = -swing.s(j)[0];
    row[4] = swing.y()[1];
    row[5] = -1;
  }

  const Recording& recording_;
  mutable CvodesSwing values_;
  mutable CvodesSwing derivatives_;
};

}  // namespace

std::unique_ptr<ceres::CostFunction> MakeCvodesCost(const Recording& recording, double gravity_torque,
                                                    double relative_tolerance) {
  return std::make_unique<CvodesCost>(recording, gravity_torque, relative_tolerance);
}

}  // namespace pendulum::benchmarks
