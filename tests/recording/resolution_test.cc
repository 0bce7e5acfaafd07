// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/resolution.h"

#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::resolution_test {
namespace {

using Eigen::Index;

/// Simulates a seeded, decaying swing at 100 Hz with noise.
class Lab {
 public:
  explicit Lab(std::uint64_t seed) : generator_(seed) {}

  /// In [0, 1), the same on every platform.
  double Uniform() { return std::ldexp(static_cast<double>(generator_() >> 11), -53); }
  double Between(double low, double high) { return low + (high - low) * Uniform(); }

  /// Nearly normal: the sum of twelve uniform draws.
  double Noise() {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += Uniform();
    return sum;
  }

  Eigen::VectorXd Swing(Index count, double amplitude, double noise) {
    const double rate = Between(3, 9);
    const double decay = Between(0.5, 2) / (0.01 * static_cast<double>(count));
    const double phase = Between(0, 2 * kPi);
    Eigen::VectorXd value(count);
    for (Index i = 0; i < count; ++i) {
      const double t = 0.01 * static_cast<double>(i);
      value[i] = amplitude * std::exp(-decay * t) * std::cos(rate * t + phase) + (noise > 0 ? noise * Noise() : 0);
    }
    return value;
  }

 private:
  std::mt19937_64 generator_;
};

/// The readings of a sensor with levels offset + q k.
Eigen::VectorXd Quantized(const Eigen::VectorXd& value, double q, double offset = 0) {
  return (offset + q * ((value.array() - offset) / q).round()).matrix();
}

Eigen::VectorXd Printed(const Eigen::VectorXd& value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  return ((value.array() * unit).round() / unit).matrix();
}

Eigen::VectorXd EachRepeated(const Eigen::VectorXd& value, Index times) {
  Eigen::VectorXd repeated(value.size() * times);
  for (Index i = 0; i < repeated.size(); ++i) repeated[i] = value[i / times];
  return repeated;
}

/// The number of 200 recordings whose resolution is wrong by at least a quarter of a step over their span.
template <typename Record>
int WrongOf200(double q, const Record& record) {
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Lab lab(seed);
    const Eigen::VectorXd value = record(lab);
    const double steps = (value.maxCoeff() - value.minCoeff()) / q;
    wrong += std::abs(FindResolution(value) / q - 1) * steps < 0.25 ? 0 : 1;
  }
  return wrong;
}

/// The number of 200 continuous recordings for which a resolution is found.
template <typename Record>
int InventedOf200(const Record& record) {
  int invented = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Lab lab(seed);
    invented += FindResolution(record(lab)) == 0 ? 0 : 1;
  }
  return invented;
}

// ---- Sensors with levels --------------------------------------------------------------------------------------------

constexpr double kPotentiometer = 0.1985;  // deg per count of a 10-bit converter
constexpr double kZero = -49.6077;         // deg at count 0

TEST(FindResolution, IsTheCountOfACalibratedConverter) {
  EXPECT_EQ(
      WrongOf200(kPotentiometer, [](Lab& lab) { return Quantized(lab.Swing(2000, 40, 0.1), kPotentiometer, kZero); }),
      0);
}

TEST(FindResolution, IsFoundAfterConversionToRadians) {
  constexpr double kRadian = kPotentiometer * kPi / 180;
  EXPECT_EQ(WrongOf200(kRadian,
                       [](Lab& lab) -> Eigen::VectorXd {
                         return Quantized(lab.Swing(2000, 40, 0.1), kPotentiometer, kZero) * (kPi / 180);
                       }),
            0);
}

TEST(FindResolution, IsTheSensorsStepNotThePrintedStep) {
  for (const int decimals : {2, 3, 4, 6}) {
    SCOPED_TRACE(decimals);
    EXPECT_EQ(WrongOf200(kPotentiometer,
                         [&](Lab& lab) {
                           return Printed(Quantized(lab.Swing(2000, 40, 0.1), kPotentiometer, kZero), decimals);
                         }),
              0);
  }
}

TEST(FindResolution, IgnoresOutliersOffTheLevels) {
  const auto with_outliers = [](Index count) {
    return [count](Lab& lab) {
      Eigen::VectorXd value = Quantized(lab.Swing(count, 40, 0.1), kPotentiometer, kZero);
      for (Index i = 0; i < count; i += 100) value[i] = lab.Between(-60, 60);
      return value;
    };
  };
  EXPECT_EQ(WrongOf200(kPotentiometer, with_outliers(300)), 0);
  EXPECT_EQ(WrongOf200(kPotentiometer, with_outliers(5000)), 0);
}

TEST(FindResolution, IsTheSpacingOfAFewLevels) {
  EXPECT_EQ(WrongOf200(1, [](Lab& lab) { return Quantized(lab.Swing(1000, 3.4, 0.01), 1); }), 0);   // 7 or 8 levels
  EXPECT_EQ(WrongOf200(1, [](Lab& lab) { return Quantized(lab.Swing(1000, 10.4, 0.01), 1); }), 0);  // 20
}

TEST(FindResolution, IsFoundInFiftyReadingsWithAdjacentLevels) {
  EXPECT_EQ(WrongOf200(0.3, [](Lab& lab) { return Quantized(lab.Swing(50, 20, 0.1), 0.3); }), 0);  // 130 levels
}

TEST(FindResolution, IsOneCountForAnEncoderThatSkipsLevels) {
  constexpr double kCount = 2 * kPi / 4096;
  EXPECT_EQ(WrongOf200(kCount, [](Lab& lab) { return Quantized(lab.Swing(1000, 1.5, 0), kCount); }), 0);
}

TEST(FindResolution, IsTheFinerSpacingOfAveragedReadings) {
  EXPECT_EQ(WrongOf200(0.5,
                       [](Lab& lab) -> Eigen::VectorXd {
                         const Eigen::VectorXd value = Quantized(lab.Swing(4001, 40, 0.3), 1);
                         return (value.head(4000) + value.tail(4000)) / 2;
                       }),
            0);
}

TEST(FindResolution, UsesASampleOfFiveMillionReadings) {
  const Eigen::VectorXd value = Quantized(Lab(1).Swing(5'000'000, 2, 0), 1e-3);
  EXPECT_NEAR(FindResolution(value), 1e-3, 1e-9);
}

// ---- Continuous readings --------------------------------------------------------------------------------------------

TEST(FindResolution, IsZeroForNoise) {
  for (const Index count : {50, 300, 1500}) {
    SCOPED_TRACE(count);
    EXPECT_EQ(InventedOf200([&](Lab& lab) { return lab.Swing(count, 20, 0.3); }), 0);
    EXPECT_EQ(InventedOf200([&](Lab& lab) { return lab.Swing(count, 0, 1); }), 0);
  }
}

TEST(FindResolution, IsZeroForASmoothSwing) {
  for (const Index count : {50, 300, 1500}) {
    SCOPED_TRACE(count);
    EXPECT_EQ(InventedOf200([&](Lab& lab) { return lab.Swing(count, 1, 0); }), 0);
  }
}

TEST(FindResolution, IsZeroForRepeatedReadings) {
  EXPECT_EQ(InventedOf200([](Lab& lab) { return EachRepeated(lab.Swing(17, 1, 0.01), 3); }), 0);
  EXPECT_EQ(InventedOf200([](Lab& lab) { return EachRepeated(lab.Swing(500, 1, 0.01), 3); }), 0);
  EXPECT_EQ(InventedOf200([](Lab& lab) {
              Eigen::VectorXd value = lab.Swing(1000, 1, 0.01);
              for (Index i = 0; i < 1000; ++i) value[i] = i % 100 < 50 ? value[i - i % 100] : value[i];  // freezes
              return value;
            }),
            0);
}

TEST(FindResolution, IsZeroForARampOrAConstant) {
  EXPECT_EQ(FindResolution(Eigen::VectorXd::LinSpaced(1000, 0, 7)), 0);
  EXPECT_EQ(FindResolution(Eigen::VectorXd::Constant(1000, 0.3)), 0);
  EXPECT_EQ(FindResolution(Eigen::VectorXd()), 0);
}

TEST(FindResolution, IsThePrintedStepOrZeroForNoise) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const double found = FindResolution(Printed(Lab(seed).Swing(1000, 20, 0.3), 2));
    EXPECT_TRUE(found == 0 || std::abs(found - 0.01) < 1e-6) << seed << ": " << found;
  }
}

}  // namespace
}  // namespace pendulum::resolution_test
