// SPDX-License-Identifier: Apache-2.0
// Tests the firmware as flashed, on a simulated board, against the events of the simulated hardware. No expected value
// comes from the firmware. PENDULUM_FIRMWARE is the folder of the ELF files.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/firmware/bench.h"
#include "tests/firmware/potentiometer.h"

namespace pendulum::pendulum_logger_test {
namespace {

namespace wire = pendulum_logger;

constexpr double kCyclesPerTick = 8;

/// A decaying oscillation measured by potentiometer and converter.
struct Swing {
  Potentiometer potentiometer{PotentiometerOptions{.noise = 0.6, .nonlinearity = 0.5, .seed = 7}};

  int operator()(double time) {
    return potentiometer.Counts(0.6 * std::exp(-time / 40) * std::cos(2 * kPi * 0.9 * time), time);
  }
};

BoardOptions Board(const std::string& name) {
  BoardOptions options;
  options.mcu = name == "mega" ? "atmega2560" : "atmega328p";
  options.firmware = std::string(PENDULUM_FIRMWARE) + "/pendulum_logger_" + name + ".elf";
  options.counts = Swing();
  return options;
}

SamplingRate Rate(double hz, int oversample = 1) { return NearestRate(hz, oversample).value(); }

void ExpectNoFaults(const SimulatedBoard& board) {
  EXPECT_EQ(board.faults().sleeps_with_converter_on, 0);
  EXPECT_EQ(board.faults().swallowed_triggers, 0);
  EXPECT_EQ(board.faults().overrun_bytes, 0);
}

/// Number of samples of a run that are not the mean of the hardware's conversions at their times.
int WrongSamples(const ReceivedRun& run, const std::vector<AdcConversion>& conversions) {
  constexpr std::uint64_t kLeeway = 16;  // cycles
  const double cycles_per_second = kCyclesPerTick * wire::kTickHz;
  int wrong = 0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const auto cycle = conversions[0].cycle + static_cast<std::uint64_t>(std::lround(run.Time(i) * cycles_per_second));
    auto at = std::ranges::lower_bound(conversions, cycle - kLeeway, {}, &AdcConversion::cycle);
    double sum = 0;
    bool is_there = true;
    for (std::uint64_t k = 0; k < run.rate().oversample; ++k, ++at) {
      const std::uint64_t due = cycle + k * run.rate().period * static_cast<std::uint64_t>(kCyclesPerTick);
      is_there = is_there && at != conversions.end() && at->cycle <= due + kLeeway && at->cycle + kLeeway >= due;
      if (is_there) sum += at->counts;
    }
    wrong += is_there && std::abs(sum / run.rate().oversample - run.Counts(i)) < 1e-9 ? 0 : 1;
  }
  return wrong;
}

/// The largest distance in cycles between a conversion and the schedule given by the first conversion and the period.
double LargestOffset(const std::vector<AdcConversion>& conversions, int period) {
  double largest = 0;
  for (std::size_t k = 0; k < conversions.size(); ++k) {
    const double due = static_cast<double>(k) * period * kCyclesPerTick;
    largest = std::max(largest, std::abs(static_cast<double>(conversions[k].cycle - conversions[0].cycle) - due));
  }
  return largest;
}

class AtRate : public testing::TestWithParam<std::tuple<std::string, double, int>> {};

TEST_P(AtRate, EveryCodeOfAMinuteArrivesAtItsTime) {
  const auto& [board, hz, oversample] = GetParam();
  Bench bench(Board(board));
  const ReceivedRun& run = bench.Record(Rate(hz, oversample), 60);
  const std::vector<AdcConversion> conversions = bench.Conversions();
  EXPECT_GE(run.size(), static_cast<std::size_t>(60 * hz));
  EXPECT_EQ(run.size(), conversions.size() / oversample);
  EXPECT_EQ(WrongSamples(run, conversions), 0);
  // simavr acts after the current instruction, which may take up to 8 cycles; the delays do not add up.
  EXPECT_LE(LargestOffset(conversions, run.rate().period), 8);
  const RunLosses losses = run.Losses();
  EXPECT_EQ(losses.samples, 0);
  EXPECT_EQ(losses.late, 0U);
  EXPECT_EQ(losses.contradicting_frames, 0);
  EXPECT_TRUE(losses.is_end_known);
  EXPECT_LT(bench.load(), 0.5);
  EXPECT_GT(bench.board().LeastFreeStack(), 256);
  ExpectNoFaults(bench.board());
}

INSTANTIATE_TEST_SUITE_P(Boards, AtRate,
                         testing::Combine(testing::Values("uno", "mega"), testing::Values(200.0, 1000.0),
                                          testing::Values(1)));
INSTANTIATE_TEST_SUITE_P(Oversampled, AtRate,
                         testing::Values(std::tuple("uno", 200.0, 16), std::tuple("uno", 1000.0, 8)));

TEST(PendulumLogger, CountsOverloadAndKeepsOtherSamplesRight) {
  Bench bench(Board("uno"));
  const ReceivedRun& run = bench.Record(Rate(4000), 10);
  const std::vector<AdcConversion> conversions = bench.Conversions();
  const RunLosses losses = run.Losses();
  EXPECT_GT(losses.dropped, 1000U);
  EXPECT_EQ(losses.on_line, 0);
  // Every conversion is either a received sample or a counted loss, except possibly the one during the stop.
  EXPECT_NEAR(static_cast<double>(run.size() + losses.dropped), static_cast<double>(conversions.size()), 1);
  EXPECT_EQ(losses.samples, losses.dropped);
  EXPECT_EQ(WrongSamples(run, conversions), 0);
  ExpectNoFaults(bench.board());
}

class OnBadLine : public testing::TestWithParam<bool> {};

TEST_P(OnBadLine, NoWrongSampleIsAcceptedAndLossesAreCounted) {
  constexpr double kProbability = 5e-4;
  Bench bench(Board("uno"));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  bench.set_line([&](std::uint8_t byte) -> std::optional<std::uint8_t> {
    if (uniform(random) > kProbability) return byte;
    if (GetParam()) return std::nullopt;
    return static_cast<std::uint8_t>(byte ^ 1 << random() % 8);
  });
  const ReceivedRun& run = bench.Record(Rate(1000), 60);
  const RunLosses losses = run.Losses();
  EXPECT_GT(losses.samples, 100);
  EXPECT_EQ(WrongSamples(run, bench.Conversions()), 0);
  EXPECT_EQ(static_cast<std::int64_t>(run.size()) + losses.samples,
            static_cast<std::int64_t>(bench.Conversions().size()));
}

INSTANTIATE_TEST_SUITE_P(FlippedAndDropped, OnBadLine, testing::Bool());

TEST(PendulumLogger, KeepsTimesAcrossTheTickOverflow) {
  constexpr double kSeconds = 2200;  // 2³² ticks are 2147 s
  Bench bench(Board("uno"));
  const ReceivedRun& run = bench.Record(Rate(50), kSeconds);
  EXPECT_GE(run.Time(run.size() - 1), kSeconds - 1);
  EXPECT_EQ(run.Losses().samples, 0);
  EXPECT_EQ(run.Losses().contradicting_frames, 0);
  EXPECT_EQ(WrongSamples(run, bench.Conversions()), 0);
}

TEST(PendulumLogger, LosesSamplesButShiftsNoneIfInterruptsAreLate) {
  Bench bench(Board("uno"));
  const auto hold = [&bench] { bench.board().HoldInterrupts(0.0105); };
  const ReceivedRun& run = bench.Record(Rate(1000), 2, hold);
  const RunLosses losses = run.Losses();
  EXPECT_GE(losses.late, 9U);  // ten or eleven matches were due while interrupts were blocked
  EXPECT_GE(losses.samples, 9);
  EXPECT_LE(losses.samples, 13);
  EXPECT_EQ(losses.contradicting_frames, 0);
  EXPECT_EQ(WrongSamples(run, bench.Conversions()), 0);
}

TEST(PendulumLogger, RestartsCompletely) {
  Bench bench(Board("uno"));
  const auto before = bench.Answered<wire::Info>(wire::Command<wire::kAskInfo>{});
  ASSERT_TRUE(before.has_value());
  for (int i = 0; i < 2; ++i) {
    const ReceivedRun& run = bench.Record(Rate(200), 2);
    EXPECT_EQ(run.Losses().samples, 0);
    EXPECT_EQ(WrongSamples(run, bench.Conversions()), 0);
  }
  const auto after = bench.Answered<wire::Info>(wire::Command<wire::kAskInfo>{});
  ASSERT_TRUE(after.has_value());
  EXPECT_EQ(after->run, before->run + 2);
  EXPECT_EQ(after->is_running, 0);
}

TEST(PendulumLogger, IdentifiesItself) {
  for (const std::string name : {"uno", "mega"}) {
    Bench bench(Board(name));
    const auto info = bench.Answered<wire::Info>(wire::Command<wire::kAskInfo>{});
    ASSERT_TRUE(info.has_value()) << name;
    EXPECT_EQ(info->board, name == "mega" ? 2 : 1);
    EXPECT_EQ(info->tick_hz, 2000000U);
    EXPECT_EQ(info->baud, 115200U);
    EXPECT_EQ(info->adc_bits, 10);
    EXPECT_EQ(info->has_calibration, 0);
    EXPECT_EQ(info->reference, 1);
  }
}

TEST(PendulumLogger, RefusesImpossibleCommands) {
  Bench bench(Board("uno"));
  EXPECT_EQ(bench.Status(wire::SetRate{249, 1}), wire::kOutOfRange);
  EXPECT_EQ(bench.Status(wire::SetRate{62501, 1}), wire::kOutOfRange);
  EXPECT_EQ(bench.Status(wire::SetRate{2000, 0}), wire::kOutOfRange);
  EXPECT_EQ(bench.Status(wire::SetRate{2000, 65}), wire::kOutOfRange);
  EXPECT_EQ(bench.Status(wire::SetRate{250, 64}), wire::kDone);
  EXPECT_EQ(bench.Status(wire::Command<'Q'>{}), wire::kUnknown);
  EXPECT_EQ(bench.Status(wire::Command<wire::kSetRate>{}), wire::kUnknown);  // its fields are missing
  EXPECT_EQ(bench.Status(wire::StoreCalibration{{0, 0, 0, 0, 0}}), wire::kOutOfRange);
  EXPECT_EQ(bench.Status(wire::StoreCalibration{{NAN, 1, 0, 0, 0}}), wire::kOutOfRange);
  bench.Ask(wire::Command<wire::kStart>{});
  EXPECT_EQ(bench.Status(wire::SetRate{2000, 1}), wire::kRunning);
  EXPECT_EQ(bench.Status(wire::StoreCalibration{{0, 1, 0, 0, 0}}), wire::kRunning);
  EXPECT_EQ(bench.Status(wire::Command<wire::kStart>{}), wire::kRunning);
  EXPECT_EQ(bench.Status(wire::Command<wire::kStop>{}), wire::kDone);
}

TEST(PendulumLogger, KeepsItsCalibrationWithoutPower) {
  const wire::StraightLine line{-49.6077F, 0.1985F, 1.5F, -4e-3F, 9e-6F};
  Bench bench(Board("uno"));
  EXPECT_EQ(bench.Status(wire::StoreCalibration{line}), wire::kDone);
  BoardOptions again = Board("uno");
  again.eeprom = bench.board().Eeprom();
  Bench later(again);
  const auto info = later.Answered<wire::Info>(wire::Command<wire::kAskInfo>{});
  ASSERT_TRUE(info && info->has_calibration == 1);
  EXPECT_EQ(info->calibration.offset_deg, line.offset_deg);
  EXPECT_EQ(info->calibration.deg_per_count, line.deg_per_count);
  EXPECT_EQ(info->calibration.offset_variance, line.offset_variance);
  EXPECT_EQ(info->calibration.covariance, line.covariance);
  EXPECT_EQ(info->calibration.slope_variance, line.slope_variance);
}

TEST(PendulumLogger, DiscardsADamagedCalibration) {
  Bench bench(Board("uno"));
  ASSERT_EQ(bench.Status(wire::StoreCalibration{{-49.6077F, 0.1985F, 0, 0, 0}}), wire::kDone);
  BoardOptions damaged = Board("uno");
  damaged.eeprom = bench.board().Eeprom();
  damaged.eeprom[17] ^= 4;
  const auto info = Bench(damaged).Answered<wire::Info>(wire::Command<wire::kAskInfo>{});
  ASSERT_TRUE(info.has_value());
  EXPECT_EQ(info->has_calibration, 0);
}

TEST(PendulumLogger, AnswersAQuestionMarkInWords) {
  BoardOptions options = Board("uno");
  options.counts = [](double) { return 437; };
  Bench bench(options);
  ASSERT_EQ(bench.Status(wire::StoreCalibration{{-49.6077F, 0.1985F, 0, 0, 0}}), wire::kDone);
  bench.board().Send({'?', '\r', '\n'});
  bench.RunFor(0.2);
  // 0.1985 · 437 - 49.6077 = 37.1368
  EXPECT_THAT(bench.text(), testing::HasSubstr("A0 = 437 of 1023 counts, 37.14 deg; 200.00 Hz, runs so far: 0\r\n"));
  EXPECT_EQ(bench.Status(wire::Command<wire::kStop>{}), wire::kDone);  // the board still understands commands
}

TEST(SimulatedBoard, DetectsFaultsThatABoardWouldNotTolerate) {
  const auto faults = [](const std::string& name) {
    BoardOptions options = Board("uno");
    options.firmware = std::string(PENDULUM_BAD_FIRMWARE) + "/bad_" + name + ".elf";
    SimulatedBoard board(options);
    board.RunUntil(0.2);
    return std::pair(board.faults(), board.conversions().size());
  };
  EXPECT_GT(faults("SLEEPS").first.sleeps_with_converter_on, 0);
  EXPECT_GT(faults("FLOODS").first.overrun_bytes, 0);
  EXPECT_EQ(faults("FORGETS").second, 1U);  // the flag is never cleared, so it never rises again
}

TEST(SimulatedBoard, GivesRatiometricReadingsIndependentOfTheSupply) {
  PotentiometerOptions rippled{.supply_ripple = 0.01};
  Potentiometer quiet{PotentiometerOptions()}, ratiometric{rippled};
  rippled.is_ratiometric = false;
  Potentiometer absolute{rippled};
  int differing = 0, differing_absolute = 0;
  for (int i = 0; i < 1000; ++i) {
    const double time = 1e-3 * i, angle = 0.4;
    differing += quiet.Counts(angle, time) == ratiometric.Counts(angle, time) ? 0 : 1;
    differing_absolute += quiet.Counts(angle, time) == absolute.Counts(angle, time) ? 0 : 1;
  }
  EXPECT_EQ(differing, 0);
  EXPECT_GT(differing_absolute, 500);
}

}  // namespace
}  // namespace pendulum::pendulum_logger_test
