// SPDX-License-Identifier: Apache-2.0
// Tests with the certified nonlinear regressions of NIST's Statistical Reference Datasets,
// https://www.itl.nist.gov/div898/strd/: the estimates of a Levenberg-Marquardt solution and their standard deviations
// by InvertInformation must match the certified values.

#include <cmath>
#include <fstream>
#include <numeric>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/QR>
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/solve/covariance.h"

namespace pendulum::nist_test {
namespace {

/// Lanczos1 has residuals of 1e-13 for responses of about 1: doubles keep three digits of them.
using Extended = long double;
using ExtendedVector = Eigen::Matrix<Extended, Eigen::Dynamic, 1>;
using ExtendedMatrix = Eigen::Matrix<Extended, Eigen::Dynamic, Eigen::Dynamic>;

/// One file of tests/fitting/nist: P parameters, N observations of one response and R predictors.
struct DataSet {
  Eigen::MatrixXd parameter;  ///< P x 4: far start, near start, certified estimate, its certified standard deviation.
  double sum_of_squares = 0;  ///< Certified, of the residuals.
  ExtendedVector response;    ///< N.
  ExtendedMatrix predictor;   ///< R x N.

  Eigen::VectorXd Certified() const { return parameter.col(2); }
  Eigen::VectorXd CertifiedDeviation() const { return parameter.col(3); }
};

ExtendedMatrix ReadMatrix(std::istream& words, Eigen::Index rows, Eigen::Index columns) {
  ExtendedMatrix matrix(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Extended& entry : matrix.row(i)) words >> entry;
  }
  return matrix;
}

/// Words and numbers, without lines that begin with #: `parameters P`, P rows of four; `residual_sum_of_squares S`;
/// `observations N R`, N rows of a response and R predictors.
DataSet ReadDataSet(const std::string& name) {
  std::ifstream file("tests/fitting/nist/" + name + ".dat");
  EXPECT_TRUE(file.is_open()) << name;
  std::stringstream words;
  for (std::string line; std::getline(file, line);) words << (line.starts_with('#') ? "" : line) << '\n';
  DataSet set;
  std::string key;
  Eigen::Index rows = 0;
  Eigen::Index predictors = 0;
  words >> key >> rows;
  set.parameter = ReadMatrix(words, rows, 4).cast<double>();
  words >> key >> set.sum_of_squares >> key >> rows >> predictors;
  const ExtendedMatrix observations = ReadMatrix(words, rows, 1 + predictors);
  EXPECT_FALSE(words.fail()) << name;
  set.response = observations.col(0);
  set.predictor = observations.rightCols(predictors).transpose();
  return set;
}

// ---- Models: a response from parameters b (index 0 is NIST's 1) and predictors x ------------------------------------

using std::atan;
using std::cos;
using std::exp;
using std::pow;
using std::sin;

constexpr auto kRise = [](const auto* b, const auto* x) { return b[0] * (1.0 - exp(-b[1] * x[0])); };
constexpr auto kMisra1b = [](const auto* b, const auto* x) {
  return b[0] * (1.0 - pow(1.0 + b[1] * x[0] / 2.0, -2.0));
};
constexpr auto kMisra1c = [](const auto* b, const auto* x) {
  return b[0] * (1.0 - pow(1.0 + 2.0 * b[1] * x[0], -0.5));
};
constexpr auto kMisra1d = [](const auto* b, const auto* x) { return b[0] * b[1] * x[0] / (1.0 + b[1] * x[0]); };
constexpr auto kChwirut = [](const auto* b, const auto* x) { return exp(-b[0] * x[0]) / (b[1] + b[2] * x[0]); };
constexpr auto kDanWood = [](const auto* b, const auto* x) { return b[0] * exp(b[1] * std::log(x[0])); };
constexpr auto kMgh09 = [](const auto* b, const auto* x) {
  return b[0] * (x[0] * x[0] + b[1] * x[0]) / (x[0] * x[0] + b[2] * x[0] + b[3]);
};
constexpr auto kMgh10 = [](const auto* b, const auto* x) { return b[0] * exp(b[1] / (x[0] + b[2])); };
constexpr auto kMgh17 = [](const auto* b, const auto* x) {
  return b[0] + b[1] * exp(-b[3] * x[0]) + b[2] * exp(-b[4] * x[0]);
};
constexpr auto kRat42 = [](const auto* b, const auto* x) { return b[0] / (1.0 + exp(b[1] - b[2] * x[0])); };
constexpr auto kRat43 = [](const auto* b, const auto* x) {
  return b[0] / pow(1.0 + exp(b[1] - b[2] * x[0]), 1.0 / b[3]);
};
constexpr auto kEckerle4 = [](const auto* b, const auto* x) {
  const auto z = (x[0] - b[2]) / b[1];
  return b[0] / b[1] * exp(-0.5 * z * z);
};
constexpr auto kLanczos = [](const auto* b, const auto* x) {
  return b[0] * exp(-b[1] * x[0]) + b[2] * exp(-b[3] * x[0]) + b[4] * exp(-b[5] * x[0]);
};
constexpr auto kCubics = [](const auto* b, const auto* x) {
  return (b[0] + x[0] * (b[1] + x[0] * (b[2] + x[0] * b[3]))) / (1.0 + x[0] * (b[4] + x[0] * (b[5] + x[0] * b[6])));
};
constexpr auto kKirby2 = [](const auto* b, const auto* x) {
  return (b[0] + x[0] * (b[1] + x[0] * b[2])) / (1.0 + x[0] * (b[3] + x[0] * b[4]));
};
constexpr auto kBennett5 = [](const auto* b, const auto* x) { return b[0] * pow(b[1] + x[0], -1.0 / b[2]); };
constexpr auto kNelson = [](const auto* b, const auto* x) { return b[0] - b[1] * x[0] * exp(-b[2] * x[1]); };
constexpr auto kRoszman1 = [](const auto* b, const auto* x) {
  return b[0] - b[1] * x[0] - atan(b[2] / (x[0] - b[3])) / kPi;
};
constexpr auto kGauss = [](const auto* b, const auto* x) {
  const auto first = (x[0] - b[3]) / b[4];
  const auto second = (x[0] - b[6]) / b[7];
  return b[0] * exp(-b[1] * x[0]) + b[2] * exp(-first * first) + b[5] * exp(-second * second);
};
constexpr auto kEnso = [](const auto* b, const auto* x) {
  const auto year = 2 * kPi * x[0] / 12;
  const auto second = 2 * kPi * x[0] / b[3];
  const auto third = 2 * kPi * x[0] / b[6];
  return b[0] + b[1] * cos(year) + b[2] * sin(year) + b[4] * cos(second) + b[5] * sin(second) + b[7] * cos(third) +
         b[8] * sin(third);
};

// ---- Solution -------------------------------------------------------------------------------------------------------

using Dual = ceres::Jet<double, 9>;  // as many derivatives as the largest model has parameters

/// A response from parameters and predictors.
struct Model {
  int parameters = 0;
  Dual (*dual)(const Dual*, const double*) = nullptr;
  Extended (*extended)(const Extended*, const Extended*) = nullptr;
};

struct Solution {
  Eigen::VectorXd estimate;   ///< P.
  Eigen::VectorXd deviation;  ///< P; empty when not identifiable.
  double sum_of_squares = 0;
};

/// Residuals, and the model's Jacobian by dual numbers.
struct Linearized {
  ExtendedVector residual;   ///< N, measured minus modelled.
  Eigen::MatrixXd jacobian;  ///< N x P.
};

Linearized Linearize(const DataSet& set, const Model& model, const ExtendedVector& estimate) {
  std::vector<Dual> parameters;
  for (int j = 0; j < model.parameters; ++j) parameters.emplace_back(static_cast<double>(estimate[j]), j);
  const Eigen::MatrixXd predictor = set.predictor.cast<double>();
  Linearized linearized{set.response, Eigen::MatrixXd(set.response.size(), model.parameters)};
  for (Eigen::Index i = 0; i < set.response.size(); ++i) {
    linearized.residual[i] -= model.extended(estimate.data(), set.predictor.col(i).data());
    linearized.jacobian.row(i) = model.dual(parameters.data(), predictor.col(i).data()).v.head(model.parameters);
  }
  return linearized;
}

/// All residuals of a set, for Ceres.
class Residuals : public ceres::CostFunction {
 public:
  Residuals(const DataSet& set, const Model& model) : set_(set), model_(model) {
    set_num_residuals(static_cast<int>(set.response.size()));
    mutable_parameter_block_sizes()->push_back(model.parameters);
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> at(parameters[0], model_.parameters);
    const Linearized linearized = Linearize(set_, model_, at.cast<Extended>());
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = linearized.residual.cast<double>();
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], num_residuals(), model_.parameters) = -linearized.jacobian;
    return true;
  }

 private:
  const DataSet& set_;
  const Model& model_;
};

Eigen::VectorXd Minimize(const DataSet& set, const Model& model, Eigen::VectorXd start) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 10000;
  options.function_tolerance = 1e-30;
  options.gradient_tolerance = 1e-30;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Problem problem;
  problem.AddResidualBlock(new Residuals(set, model), nullptr, start.data());
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return start;
}

/// Standard deviations are sqrt(RSS/(N - P) diag (J'J)^-1).
Solution Solve(const DataSet& set, const Model& model, int start) {
  EXPECT_EQ(set.parameter.rows(), model.parameters);
  ExtendedVector estimate = Minimize(set, model, set.parameter.col(start)).cast<Extended>();
  // A sum of squares determines its minimum only to the square root of the rounding error, about eight digits; the
  // gradient is more accurate.
  for (int step = 0; step < 5; ++step) {
    const Linearized near = Linearize(set, model, estimate);
    estimate += near.jacobian.colPivHouseholderQr().solve(near.residual.cast<double>()).cast<Extended>();
  }
  const Linearized at = Linearize(set, model, estimate);
  Solution solution{estimate.cast<double>(), {}, static_cast<double>(at.residual.squaredNorm())};
  std::vector<int> all(static_cast<std::size_t>(model.parameters));
  std::iota(all.begin(), all.end(), 0);
  const InformationInverse inverse = InvertInformation(at.jacobian.transpose() * at.jacobian, all);
  const double variance = solution.sum_of_squares / static_cast<double>(set.response.size() - model.parameters);
  if (inverse.identifiable) solution.deviation = (variance * inverse.matrix.diagonal()).cwiseSqrt();
  return solution;
}

/// The number of digits in which every entry agrees with the certified value.
double Digits(const Eigen::VectorXd& found, const Eigen::VectorXd& certified) {
  if (found.size() != certified.size()) return 0;
  return -std::log10(((found - certified).array() / certified.array()).abs().maxCoeff() + 1e-16);
}

// ---- The 27 sets ----------------------------------------------------------------------------------------------------

struct Case {
  std::string name;
  Model model;
  int first_start = 0;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

template <typename Formula>
Case Of(const std::string& name, int parameters, Formula formula) {
  return {name, {parameters, formula, formula}};
}

/// From the far start, the rise becomes a step and remains a step, because its time constant then has no effect.
Case BoxBod() {
  Case box_bod = Of("BoxBOD", 2, kRise);
  box_bod.first_start = 1;
  return box_bod;
}

class NistRegression : public testing::TestWithParam<Case> {};

TEST_P(NistRegression, HasTheCertifiedEstimatesAndStandardDeviations) {
  DataSet set = ReadDataSet(GetParam().name);
  // The model describes the logarithm.
  if (GetParam().name == "Nelson") set.response = set.response.array().log().eval();
  for (int start = GetParam().first_start; start < 2; ++start) {
    SCOPED_TRACE("start " + std::to_string(start + 1));
    const Solution solution = Solve(set, GetParam().model, start);
    EXPECT_GE(Digits(solution.estimate, set.Certified()), 6);
    EXPECT_GE(Digits(solution.deviation, set.CertifiedDeviation()), 4);
    EXPECT_NEAR(solution.sum_of_squares / set.sum_of_squares, 1, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(
    StatisticalReferenceDatasets, NistRegression,
    testing::Values(Of("Misra1a", 2, kRise), Of("Misra1b", 2, kMisra1b), Of("Misra1c", 2, kMisra1c),
                    Of("Misra1d", 2, kMisra1d), Of("Chwirut1", 3, kChwirut), Of("Chwirut2", 3, kChwirut),
                    Of("DanWood", 2, kDanWood), BoxBod(), Of("MGH09", 4, kMgh09), Of("MGH10", 3, kMgh10),
                    Of("MGH17", 5, kMgh17), Of("Rat42", 3, kRat42), Of("Rat43", 4, kRat43),
                    Of("Eckerle4", 3, kEckerle4), Of("Lanczos1", 6, kLanczos), Of("Lanczos2", 6, kLanczos),
                    Of("Lanczos3", 6, kLanczos), Of("Thurber", 7, kCubics), Of("Hahn1", 7, kCubics),
                    Of("Kirby2", 5, kKirby2), Of("Bennett5", 3, kBennett5), Of("Nelson", 3, kNelson),
                    Of("Roszman1", 4, kRoszman1), Of("Gauss1", 8, kGauss), Of("Gauss2", 8, kGauss),
                    Of("Gauss3", 8, kGauss), Of("ENSO", 9, kEnso)),
    [](const testing::TestParamInfo<Case>& one) { return one.param.name; });

}  // namespace
}  // namespace pendulum::nist_test
