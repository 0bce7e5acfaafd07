// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/arc.h"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::arc_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

/// Points at angles from -half to half about (640, 120) at distance 400, y downwards, with noise of the given standard
/// deviation.
struct Points {
  Points(double half, double noise, unsigned seed) : x(kCount), y(kCount) {
    std::mt19937_64 generator(seed);
    boost::random::normal_distribution<double> draw(0, 1);
    for (Eigen::Index i = 0; i < kCount; ++i) {
      const double angle = half * std::sin(0.37 * static_cast<double>(i));
      x[i] = 640 + 400 * std::sin(angle) + noise * draw(generator);
      y[i] = 120 + 400 * std::cos(angle) + noise * draw(generator);
    }
  }

  static constexpr Eigen::Index kCount = 500;
  Eigen::VectorXd x, y;
};

TEST(FitArc, FindsTheCircleOfExactPoints) {
  const Points points(0.3, 0, 1);
  const Result<Arc> arc = FitArc(points.x, points.y);
  ASSERT_TRUE(arc) << arc.error().message();
  EXPECT_THAT(arc->x, DoubleNear(640, 1e-6));
  EXPECT_THAT(arc->y, DoubleNear(120, 1e-6));
  EXPECT_THAT(arc->radius, DoubleNear(400, 1e-6));
  EXPECT_EQ(arc->down, 1);
  EXPECT_THAT(arc->Angle(640 + 400 * std::sin(0.2), 120 + 400 * std::cos(0.2)), DoubleNear(0.2, 1e-8));
}

TEST(FitArc, DetectsTheDirectionOfY) {
  const Points points(0.3, 0, 1);
  const Result<Arc> arc = FitArc(points.x, -points.y);
  ASSERT_TRUE(arc) << arc.error().message();
  EXPECT_EQ(arc->down, -1);
  EXPECT_THAT(arc->Angle(640 + 400 * std::sin(0.2), -120 - 400 * std::cos(0.2)), DoubleNear(0.2, 1e-8));
}

/// Over 300 seeds the squared distance to the truth, weighted with the covariance, is χ² with 3 degrees of freedom. Its
/// mean is 3 ± 0.14.
TEST(FitArc, HasErrorsThatMatchTheCovariance) {
  double sum = 0;
  constexpr int kSeeds = 300;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Points points(0.5, 0.5, seed);
    const Result<Arc> arc = FitArc(points.x, points.y);
    ASSERT_TRUE(arc) << arc.error().message();
    const Eigen::Vector3d error(arc->x - 640, arc->y - 120, arc->radius - 400);
    sum += error.dot(arc->covariance.inverse() * error);
  }
  EXPECT_THAT(sum / kSeeds, DoubleNear(3, 0.5));
}

/// The middle of a sine of amplitude A is J0(A) radii below the pivot (DLMF 10.9.1): 0.28 for 1.9, 0.00 for 2.4. For 3
/// it is 0.26 radii above the pivot.
/// As of two columns that never have a number in the same row.
TEST(FitArc, RefusesTooFewPoints) {
  for (const Eigen::Index count : {0, 1, 3}) {
    const Points points(0.3, 0, 1);
    const Result<Arc> arc = FitArc(points.x.head(count), points.y.head(count));
    ASSERT_FALSE(arc) << count;
    EXPECT_THAT(arc.error().message(), HasSubstr("there are fewer than 4"));
  }
}

TEST(FitArc, RefusesPointsWithoutADownDirection) {
  EXPECT_TRUE(FitArc(Points(1.9, 0, 1).x, Points(1.9, 0, 1).y));
  for (const double half : {2.4, 3.0, 30.0}) {
    const Points points(half, 0.5, 1);
    const Result<Arc> arc = FitArc(points.x, points.y);
    ASSERT_FALSE(arc) << half;
    EXPECT_EQ(arc.error().code, StatusCode::kFailedPrecondition);
    EXPECT_THAT(arc.error().message(), HasSubstr("the downward direction is unknown; choose one coordinate with"));
  }
}

TEST(FitArc, RefusesPointsThatDetermineNoPivot) {
  const Points points(0.02, 1, 1);
  const Result<Arc> arc = FitArc(points.x, points.y);
  ASSERT_FALSE(arc);
  EXPECT_EQ(arc.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(arc.error().message(), HasSubstr("do not determine a circle about a pivot"));
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(100, 0, 1);
  EXPECT_FALSE(FitArc(line, 2 * line));
  EXPECT_FALSE(FitArc(Eigen::VectorXd::Ones(100), Eigen::VectorXd::Ones(100)));
}

}  // namespace
}  // namespace pendulum::arc_test
