// SPDX-License-Identifier: Apache-2.0
/// Columns without names that are the coordinates of a point or the axes of an accelerometer.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/format.h"
#include "tests/recording/rows.h"

namespace pendulum::unnamed_columns_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kGravity = 9.80665;   // m/s^2
constexpr double kGravityRate = 24.0;  // G/I, 1/s^2
constexpr double kStep = 0.03;         // s

struct Sample {
  double time, angle, rate, acceleration;  // s, rad, rad/s, rad/s^2
};

/// th'' = -24 sin th - 0.08 th', with a hundred steps of the midpoint rule between rows.
std::vector<Sample> Swing(double amplitude, int rows = 600) {
  const auto acceleration = [](double angle, double rate) { return -kGravityRate * std::sin(angle) - 0.08 * rate; };
  std::vector<Sample> swing;
  double angle = amplitude, rate = 0;
  for (int i = 0; i < rows; ++i) {
    swing.push_back({kStep * i, angle, rate, acceleration(angle, rate)});
    for (int k = 0; k < 100; ++k) {
      const double h = kStep / 100;
      const double middle = rate + h / 2 * acceleration(angle, rate);
      rate += h * acceleration(angle + h / 2 * rate, middle);
      angle += h * middle;
    }
  }
  return swing;
}

using Readings = std::function<std::vector<double>(const Sample&)>;

/// Rows of the time and what `readings` returns, with white noise of this standard deviation.
std::string Table(const std::vector<Sample>& swing, const Readings& readings, double noise, char separator = '\t',
                  int digits = 6) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> error(0, noise);
  std::string text;
  for (const Sample& sample : swing) {
    text += NumberText(sample.time, 6);
    for (const double each : readings(sample)) text += separator + NumberText(each + error(random), digits);
    text += "\n";
  }
  return text;
}

Readings PointAt(double radius, double pivot_x, double pivot_y, double down) {
  return [=](const Sample& each) {
    return std::vector{pivot_x + radius * std::sin(each.angle), pivot_y + down * radius * std::cos(each.angle)};
  };
}

/// An accelerometer 0.15 m below the pivot: along the rod and across it, in units of `unit` m/s^2.
Readings AccelerometerIn(double unit) {
  return [=](const Sample& each) {
    constexpr double kRadius = 0.15;
    const double along = kGravity * std::cos(each.angle) + kRadius * each.rate * each.rate;
    const double across = kGravity * std::sin(each.angle) + kRadius * each.acceleration;
    return std::vector{along / unit, across / unit};
  };
}

double LargestError(const Recording& recording, const std::vector<Sample>& swing) {
  double largest = recording.size() == static_cast<Eigen::Index>(swing.size()) ? 0 : INFINITY;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    largest = std::max(largest, std::abs(recording.value[i] - swing[static_cast<std::size_t>(i)].angle));
  }
  return largest;
}

/// The flags that the question proposes.
std::vector<std::string> TryOf(const std::string& text, const ReadOptions& options = {}) {
  const Result<Recording> recording = ParseRecording(text, "run.txt", options);
  EXPECT_FALSE(recording.has_value());
  return recording ? std::vector<std::string>() : recording.error().try_flags;
}

TEST(UnnamedColumns, OnAnArcAreAPoint) {
  const std::vector<Sample> swing = Swing(0.53);
  for (const Readings& point : {PointAt(370, 0, 0, -1), PointAt(300, 500, 40, 1), PointAt(1000, 0, 0, -1)}) {
    for (const char separator : {'\t', ';', ',', ' '}) {
      const Recording recording = RecordingOf(Table(swing, point, 0.5, separator));
      EXPECT_LT(LargestError(recording, swing), 0.02);
      EXPECT_EQ(recording.quantity, Quantity::kAngle);
      EXPECT_THAT(MessageText(recording.warnings.at(0)),
                  HasSubstr("columns 2 and 3 lie on a circle and were used as the "
                            "coordinates of a point; --value_column 2 uses one"));
    }
  }
  const Readings swapped = [](const Sample& each) {
    return std::vector{50 + 300 * std::cos(each.angle), 500 + 300 * std::sin(each.angle)};
  };
  EXPECT_LT(LargestError(RecordingOf(Table(swing, swapped, 0.5)), swing), 0.02);
  std::string commas = Table(swing, PointAt(370, 0, 0, -1), 0.5, ';');
  std::ranges::replace(commas, '.', ',');
  EXPECT_LT(LargestError(RecordingOf(commas), swing), 0.02);
  const Recording in_mm = RecordingOf(Table(swing, PointAt(370, 0, 0, -1), 0.5), Unit("mm"));
  EXPECT_NEAR(in_mm.arc->radius, 0.37, 0.002);  // m
}

TEST(UnnamedColumns, OnAShortOrNoisyArcAreAskedFor) {
  for (const auto& [amplitude, noise] : {std::pair(0.1, 0.3), {0.53, 8.0}}) {
    const std::vector<Sample> swing = Swing(amplitude);
    const std::string text = Table(swing, PointAt(300, 500, 40, 1), noise);
    EXPECT_THAT(FaultOf(text), HasSubstr("columns 2 and 3 may be the coordinates of a point"));
    EXPECT_THAT(TryOf(text), ElementsAre("--value_column 2,3"));
    EXPECT_LT(LargestError(RecordingOf(text, TimeAndValue("", "2,3")), swing), 5 * noise / 300 + 0.02);
  }
}

TEST(UnnamedColumns, OfOtherQuantitiesAreNoPoint) {
  const std::vector<Sample> swing = Swing(0.53, 1200);
  const auto degrees = [](const Sample& each) { return each.angle / kDegree; };
  const Readings rate = [&](const Sample& each) { return std::vector{degrees(each), each.rate / kDegree}; };
  const Readings warming = [&](const Sample& each) { return std::vector{degrees(each), 22 + each.time / 10}; };
  const Readings tension = [&](const Sample& each) {  // of a string, N
    return std::vector{degrees(each), 2 * std::cos(each.angle) + 2 * each.rate * each.rate / kGravityRate};
  };
  EXPECT_THAT(TryOf(Table(swing, rate, 0.1)), ElementsAre("--value_column 2"));
  EXPECT_THAT(TryOf(Table(swing, tension, 0.003)), ElementsAre("--value_column 2"));
  EXPECT_LT(LargestError(RecordingOf(Table(swing, warming, 0.1)), swing), 0.02);
  // A tension that hardly decays lies on a parabola, which a circle resembles.
  const Readings parabola = [](const Sample& each) {
    return std::vector{each.angle, 0.4 - 0.6 * each.angle * each.angle};
  };
  EXPECT_THAT(TryOf(Table(swing, parabola, 0.003)), ElementsAre("--value_column 2", "--unit rad"));
}

// The names are of a point a, which lies on a circle far from the origin, as accelerations do not.
TEST(UnnamedColumns, OfShortNamesMayBeAPoint) {
  const std::vector<Sample> swing = Swing(0.53);
  const std::string rows = Table(swing, PointAt(400, 1200, 300, 1), 0.3, ',');
  for (const std::string names : {"t,a_x,a_y\n", "t,ax,ay\n", "t,aX,aY\n"}) {
    EXPECT_THAT(FaultOf(names + rows),
                HasSubstr("lie on a circle, as the coordinates of a point do and accelerations"));
    const std::vector<std::string> flags = TryOf(names + rows);
    ASSERT_THAT(flags, SizeIs(1));
    const Recording recording = RecordingOf(names + rows, TimeAndValue("", flags[0].substr(flags[0].find(' ') + 1)));
    EXPECT_EQ(recording.quantity, Quantity::kAngle);
    EXPECT_LT(LargestError(recording, swing), 0.02);
  }
}

TEST(UnnamedColumns, AzAloneMayBeAnAzimuth) {
  const Readings azimuth = [](const Sample& each) { return std::vector{each.angle / kDegree}; };
  const std::string text = "t,az\n" + Table(Swing(0.53), azimuth, 0.1, ',');
  EXPECT_THAT(FaultOf(text), HasSubstr("it may be an acceleration or an azimuth"));
  EXPECT_THAT(TryOf(text), ElementsAre("--unit deg"));
}

TEST(UnnamedColumns, PairsMustBeLengthsInOneUnit) {
  const std::vector<Sample> swing = Swing(0.53);
  const std::string text = Table(swing, PointAt(370, 0, 0, -1), 0.5, ',');
  EXPECT_LT(LargestError(RecordingOf("t,x,y\n" + text, TimeAndValue("", "x,y", "mm")), swing), 0.02);
  EXPECT_LT(LargestError(RecordingOf("t,x (mm),y (mm)\n" + text, TimeAndValue("", "2,3")), swing), 0.02);
  EXPECT_THAT(WrongFlag(text, TimeAndValue("", "2,3", "deg")),
              HasSubstr("but column 2 is in deg; both must be lengths"));
  EXPECT_THAT(WrongFlag("t,x (mm),y (cm)\n" + text, TimeAndValue("", "2,3")), HasSubstr("column \"y (cm)\" is in cm"));
  EXPECT_THAT(WrongFlag("t,x,y\n" + text, TimeAndValue("", "x,t")), HasSubstr("column \"t\" is no length"));
  EXPECT_THAT(WrongFlag(text, TimeAndValue("", "2,4")), HasSubstr("--value_column is \"2,4\", which is none of the 3"));
}

TEST(UnnamedColumns, OfTheSizeOfGravityMayBeAccelerations) {
  const std::vector<Sample> swing = Swing(0.9);
  for (const auto& [unit, name, written] :
       {std::tuple(kGravity / 1000, "mg", "mg"), {kGravity, "g", "g"}, {1.0, "m_s2", "m/s^2"}}) {
    const std::string text = Table(swing, AccelerometerIn(unit), 0.02 / unit);
    EXPECT_THAT(FaultOf(text), HasSubstr(std::string("together they have the size of gravity in ") + written));
    EXPECT_THAT(TryOf(text), ElementsAre("--value_column 3", std::string("--unit ") + name));
    for (const Recording& recording : {RecordingOf(text, Unit(name)), RecordingOf(text, TimeAndValue("", "3", name))}) {
      EXPECT_EQ(recording.quantity, Quantity::kAcceleration);
      EXPECT_NEAR(recording.value[0], kGravity * std::sin(0.9) - 0.15 * kGravityRate * std::sin(0.9), 0.1);  // m/s^2
    }
  }
}

// In s, this swing would take ten minutes.
TEST(UnnamedColumns, BesideAnAccelerometerTimesAreInMs) {
  std::vector<Sample> swing = Swing(0.9);
  for (Sample& sample : swing) sample.time *= 500;  // of a period of 1.28 s
  EXPECT_NEAR(RecordingOf("t,ax,ay\n" + Table(swing, AccelerometerIn(kGravity), 0.02, ',')).time[599], 599 * 0.015,
              1e-9);
}

TEST(UnnamedColumns, AxesOfAnAccelerometerHaveTheUnitThatTheirSizeShows) {
  const std::vector<Sample> swing = Swing(0.9);
  for (const std::string names : {"timestamp;ax;ay\n", "timestamp;a_x;a_y\n", "timestamp;aX;aY\n", "t;accX;accY\n"}) {
    for (const auto& [unit, written] : {std::pair(kGravity / 1000, "mg"), {kGravity, "g"}, {1.0, "m_s2"}}) {
      const Recording recording = RecordingOf(names + Table(swing, AccelerometerIn(unit), 0.02 / unit, ';'));
      EXPECT_EQ(recording.quantity, Quantity::kAcceleration);
      EXPECT_NEAR(recording.value[0], kGravity * std::sin(0.9) - 0.15 * kGravityRate * std::sin(0.9), 0.1) << written;
    }
  }
  // One axis across the rod does not show gravity; counts of a sensor are no unit.
  const Readings across = [](const Sample& each) { return std::vector{AccelerometerIn(kGravity / 1000)(each)[1]}; };
  EXPECT_THAT(TryOf("t,ay\n" + Table(swing, across, 2, ',')), ElementsAre("--unit mg"));
  const std::string raw = "t,ax,ay\n" + Table(swing, AccelerometerIn(kGravity / 16384), 20, ',');
  EXPECT_THAT(FaultOf(raw), HasSubstr("column \"ay\" does not give its unit, and is too large for m/s^2, g and mg"));
  EXPECT_THAT(TryOf(raw), IsEmpty());
}

}  // namespace
}  // namespace pendulum::unnamed_columns_test
