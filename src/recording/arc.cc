// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/arc.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

using Eigen::VectorXd;

/// Centre and radius.
using Circle = Eigen::Vector3d;

/// Taubin's fit of centred and scaled points as a generalized eigenvalue problem: the smallest singular direction of
/// [(z - z̄) / 2 sqrt(z̄), x, y], z = x² + y² (N. Chernov, Circular and Linear Regression, CRC 2010, section 5.10).
Circle AlgebraicFit(const VectorXd& x, const VectorXd& y) {
  const VectorXd z = x.array().square() + y.array().square();
  const double mean = z.mean();
  Eigen::MatrixX3d basis(x.size(), 3);
  basis << (z.array() - mean) / (2 * std::sqrt(mean)), x, y;
  const Eigen::Matrix3d moments = basis.transpose() * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
  const Eigen::Vector3d direction = solver.eigenvectors().col(0);
  const double a = direction[0] / (2 * std::sqrt(mean));
  const double centre_x = -0.5 * direction[1] / a;
  const double centre_y = -0.5 * direction[2] / a;
  return {centre_x, centre_y, std::sqrt(centre_x * centre_x + centre_y * centre_y + mean)};
}

/// Distances from the circle (N) and their derivatives (N x 3).
VectorXd Distances(const VectorXd& x, const VectorXd& y, const Circle& circle, Eigen::MatrixX3d& jacobian) {
  const VectorXd from_x = x.array() - circle[0];
  const VectorXd from_y = y.array() - circle[1];
  const VectorXd distance = (from_x.array().square() + from_y.array().square()).sqrt();
  jacobian.resize(x.size(), 3);
  jacobian << -from_x.cwiseQuotient(distance), -from_y.cwiseQuotient(distance), -VectorXd::Ones(x.size());
  return distance.array() - circle[2];
}

tl::unexpected<Status> NoArc(const std::string& why, const std::string& otherwise = ", or record a larger swing") {
  return Error(StatusCode::kFailedPrecondition, "the points (x, y) do not determine a circle about a pivot: " + why +
                                                    "; choose one coordinate with --value_column" + otherwise);
}

/// Checks that the middle of the points, which is the origin, is far enough from the centre to show where down is. This
/// is undetermined if the points lie all round the centre: a swing far beyond the horizontal has as many points above
/// the centre as below. Distances are in units of the radius.
Result<void> CheckDownDirection(const VectorXd& y, const Circle& circle) {
  constexpr double kMinDepth = 0.2;  // the middle of a sine of 2 rad is J0(2) = 0.22 radii below the centre
  const double middle = -circle[1] / circle[2];
  const VectorXd height = (y.array() - circle[1]) / (middle < 0 ? -circle[2] : circle[2]);
  if (std::abs(middle) >= kMinDepth && height.maxCoeff() >= -height.minCoeff()) return {};
  return NoArc("the middle of the points is " + NumberText(std::abs(middle), 2) +
                   " radii from the centre of the circle; with less than " + NumberText(kMinDepth, 2) +
                   ", or with points farther away on the other side, the downward direction is unknown",
               ", or leave out the turns over the top");
}

}  // namespace

double Arc::Angle(double point_x, double point_y) const { return std::atan2(point_x - x, down * (point_y - y)); }

Result<Arc> FitArc(const VectorXd& x, const VectorXd& y) {
  constexpr int kMaxSteps = 50;
  constexpr double kConverged = 1e-12;
  constexpr double kLargestError = 0.2;  // of the radius; with a larger error no angle can be trusted
  constexpr Eigen::Index kFewest = 4;    // any three lie on a circle
  if (x.size() < kFewest) return NoArc("there are fewer than " + std::to_string(kFewest));
  const double x_mean = x.mean();
  const double y_mean = y.mean();
  const double scale = std::sqrt(((x.array() - x_mean).square() + (y.array() - y_mean).square()).mean());
  if (!(scale > 0)) return NoArc("all points are the same");
  const VectorXd at_x = (x.array() - x_mean) / scale;
  const VectorXd at_y = (y.array() - y_mean) / scale;
  Circle circle = AlgebraicFit(at_x, at_y);
  Eigen::MatrixX3d jacobian;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  bool has_settled = false;
  for (int step = 0; step < kMaxSteps && circle.allFinite() && !has_settled; ++step) {
    const VectorXd distance = Distances(at_x, at_y, circle, jacobian);
    information = jacobian.transpose() * jacobian;
    const Eigen::Vector3d change = information.ldlt().solve(jacobian.transpose() * distance);
    circle -= change;
    has_settled = change.norm() < kConverged * circle.norm();
  }
  const VectorXd distance = Distances(at_x, at_y, circle, jacobian);
  const double variance = distance.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(x.size() - 3, 1));
  const Eigen::Matrix3d covariance = variance * information.inverse();
  if (!circle.allFinite() || !covariance.allFinite()) return NoArc("the points are on a straight line");
  if (!has_settled || !(circle[2] > 0)) return NoArc("the search for the circle does not converge");
  const double error = std::sqrt(covariance.diagonal().maxCoeff()) / circle[2];
  if (!(error < kLargestError)) {
    return NoArc("the radius would be uncertain by " + NumberText(100 * error, 2) + " %");
  }
  RETURN_IF_ERROR(CheckDownDirection(at_y, circle));
  Arc arc;
  arc.x = x_mean + scale * circle[0];
  arc.y = y_mean + scale * circle[1];
  arc.radius = scale * circle[2];
  arc.down = circle[1] < 0 ? 1 : -1;
  arc.covariance = scale * scale * covariance;
  arc.std_dev = scale * std::sqrt(variance);
  return arc;
}

}  // namespace pendulum
