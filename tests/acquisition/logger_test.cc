// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/logger.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/scripted_logger.h"

namespace pendulum::logger_test {
namespace {

namespace wire = pendulum_logger;

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr wire::StraightLine kLine = {-135, 0.25F, 0.04F, -6e-5F, 1.25e-7F};

/// A scripted logger and a Logger connected to it.
struct Connection {
  explicit Connection(LoggerScript script = {}) : board(std::move(script)), logger(board, stop) {}

  ScriptedLogger board;
  std::atomic<bool> stop = false;
  Logger logger;
};

std::vector<std::uint8_t> Bytes(std::string_view text) { return {text.begin(), text.end()}; }

/// The message of an error; expects the code kDataLoss.
template <class T>
std::string FaultOf(const Result<T>& result) {
  EXPECT_FALSE(result);
  if (result) return "";
  EXPECT_EQ(result.error().code, StatusCode::kDataLoss) << result.error().message();
  return result.error().message();
}

// ---- Connect -----------------------------------------------------------------------------------------------------

TEST(Logger, ConnectsToALoggerThatAnswersAtOnce) {
  LoggerScript script;
  script.info.firmware = 0x0102;
  script.info.has_calibration = 1;
  script.info.calibration = kLine;
  Connection connection(script);
  const auto info = connection.logger.Connect();
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(connection.board.Time(), 0);
  EXPECT_EQ(info->firmware, 0x0102);
  EXPECT_EQ(info->run, 41);
  EXPECT_EQ(info->calibration.deg_per_count, 0.25);
  EXPECT_EQ(connection.board.Heard(), "XI");
}

TEST(Logger, ConnectsAfterInvalidData) {
  LoggerScript script;
  script.greeting = Bytes("\xFF\x80 half a fra");
  const std::string_view hello("me\r\npendulum_logger: send ? for a reading\r\n\0", 44);
  script.greeting.insert(script.greeting.end(), hello.begin(), hello.end());
  Connection connection(script);
  EXPECT_TRUE(connection.logger.Connect(2));
}

TEST(Logger, WaitsForABootLoader) {
  LoggerScript script;
  script.deaf_seconds = 1.2;
  Connection connection(script);
  const auto info = connection.logger.Connect();
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(connection.board.Time(), 1.5);  // it asks every half second
}

TEST(Logger, StopsARunOfAnEarlierProgram) {
  LoggerScript script;
  script.begins_running = true;
  Connection connection(script);
  ASSERT_TRUE(connection.board.Read(0.1));  // data are already arriving
  const auto info = connection.logger.Connect(2);
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(info->is_running, 0);
}

TEST(Logger, RejectsALoggerThatKeepsRunning) {
  LoggerScript script;
  script.begins_running = true;
  script.refused = {{'X', wire::kUnknown}};
  Connection connection(script);
  FaultOf(connection.logger.Connect(0.6));
}

TEST(Logger, RepeatsACommandIfTheAnswerIsLost) {
  LoggerScript script;
  script.lost_answers['I'] = 1;
  Connection connection(script);
  EXPECT_TRUE(connection.logger.Connect(3));
  EXPECT_EQ(connection.board.Heard(), "XIXI");
}

TEST(Logger, ReportsAnotherProtocol) {
  LoggerScript script;
  script.info.protocol = 3;
  Connection connection(script);
  EXPECT_THAT(FaultOf(connection.logger.Connect(2)), AllOf(HasSubstr("version 3 of the protocol"),
                                                           HasSubstr("version 1"), HasSubstr(connection.board.path())));
}

// Times and counts rely on the ticks and bits of protocol 1.
TEST(Logger, ReportsAnotherClockOrConverter) {
  LoggerScript other_clock, other_converter;
  other_clock.info.tick_hz = 1000000;
  other_converter.info.adc_bits = 12;
  Connection first(other_clock), second(other_converter);
  EXPECT_THAT(FaultOf(first.logger.Connect(2)), AllOf(HasSubstr("1000000"), HasSubstr("2000000")));
  EXPECT_THAT(FaultOf(second.logger.Connect(2)), AllOf(HasSubstr("12 bits"), HasSubstr("10")));
}

TEST(Logger, ReportsSilence) {
  LoggerScript script;
  script.is_mute = true;
  Connection connection(script);
  EXPECT_THAT(FaultOf(connection.logger.Connect(0.6)), StartsWith("no logger answers on " + connection.board.path()));
  EXPECT_EQ(connection.board.Time(), 1);  // two tries of half a second
}

TEST(Logger, ReportsADeviceThatIsNotALogger) {
  LoggerScript script;
  script.is_mute = true;
  script.chatter = Bytes("$GPGGA,123519,4807.038,N,01131.000,E,1,08*47\r\n");
  Connection connection(script);
  EXPECT_THAT(FaultOf(connection.logger.Connect(0.6)), HasSubstr("is not a pendulum_logger"));
  EXPECT_EQ(connection.board.Time(), 1);
}

TEST(Logger, GivesUpWhenItIsStopped) {
  LoggerScript script;
  script.is_mute = true;
  Connection connection(script);
  connection.board.At(0.1, [&] { connection.stop = true; });
  const auto info = connection.logger.Connect(60);
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().code, StatusCode::kTryAgain);
  EXPECT_EQ(connection.board.Time(), 0.1);
}

// ---- Commands ----------------------------------------------------------------------------------------------------

TEST(Logger, SetsTheRate) {
  Connection connection;
  ASSERT_TRUE(connection.logger.SetRate({1250, 16}));
  const auto info = connection.logger.Connect();
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(info->period, 1250);
  EXPECT_EQ(info->oversample, 16);
}

TEST(Logger, RepeatsACommandWhoseAnswerIsLost) {
  LoggerScript script;
  script.lost_answers['R'] = 1;
  Connection connection(script);
  EXPECT_TRUE(connection.logger.SetRate({10000, 1}));
  EXPECT_EQ(connection.board.Heard(), "RR");
}

// For example an answer to a command of an earlier program.
TEST(Logger, IgnoresAnswersToOtherCommands) {
  LoggerScript script;
  script.greeting.resize(wire::kMaxEncoded + 1);
  script.greeting.resize(wire::MakeFrame(wire::Ack{'X', wire::kUnknown}, script.greeting.data()));
  Connection connection(script);
  const auto set = connection.logger.SetRate({10000, 1});
  EXPECT_TRUE(set) << set.error().message();
}

TEST(Logger, ReportsAnUnansweredCommand) {
  LoggerScript script;
  script.is_mute = true;
  Connection connection(script);
  EXPECT_THAT(FaultOf(connection.logger.SetRate({10000, 1})), HasSubstr("but does not answer 'R'"));
}

TEST(Logger, ReportsRefusals) {
  LoggerScript script;
  script.refused = {{'R', wire::kOutOfRange}, {'W', wire::kRunning}, {'S', wire::kUnknown}};
  Connection connection(script);
  EXPECT_THAT(FaultOf(connection.logger.SetRate({10000, 1})),
              AllOf(HasSubstr("200 Hz"), HasSubstr("out of its range")));
  EXPECT_THAT(FaultOf(connection.logger.StoreCalibration(kLine)),
              AllOf(HasSubstr("calibration"), HasSubstr("it is recording")));
  EXPECT_THAT(FaultOf(connection.logger.Start()), HasSubstr("does not know the command"));
  EXPECT_EQ(connection.board.Heard(), "RWS");  // a refusal counts as an answer
}

TEST(Logger, StoresACalibrationAndReadsItBack) {
  Connection connection;
  const auto info = connection.logger.StoreCalibration(kLine);
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(info->has_calibration, 1);
  EXPECT_EQ(info->calibration.offset_deg, -135);
  EXPECT_EQ(info->calibration.slope_variance, 1.25e-7F);
}

TEST(Logger, ReportsAnEepromThatKeepsNothing) {
  LoggerScript script;
  script.forgets_calibration = true;
  Connection empty(script);
  EXPECT_THAT(FaultOf(empty.logger.StoreCalibration(kLine)), HasSubstr("EEPROM"));
  script.info.has_calibration = 1;
  script.info.calibration = kLine;
  script.info.calibration.covariance = 0;
  Connection other(script);
  EXPECT_THAT(FaultOf(other.logger.StoreCalibration(kLine)), HasSubstr("EEPROM"));
}

// ---- A run -------------------------------------------------------------------------------------------------------

/// The next message of one kind within a second; other messages are skipped.
template <class Message>
std::optional<Message> Next(Logger& logger) {
  for (int i = 0; i < 200; ++i) {
    const auto received = logger.Receive(1);
    EXPECT_TRUE(received) << received.error().message();
    if (!received || !*received) return std::nullopt;
    if (const auto* message = std::get_if<Message>(&(*received)->message)) return *message;
  }
  return std::nullopt;
}

TEST(Logger, ReturnsTheDataOfARunInOrder) {
  LoggerScript script;
  script.counts = [](double time) { return 100 + static_cast<int>(time * 200 + 0.5); };
  Connection connection(script);
  ASSERT_TRUE(connection.logger.Start());
  for (int i = 0; i < 20; ++i) {
    const auto data = Next<wire::Data>(connection.logger);
    ASSERT_TRUE(data);
    EXPECT_EQ(data->sequence, i);
    EXPECT_EQ(data->sums[0], 100 + 8 * i);
  }
  ASSERT_TRUE(connection.logger.RequestStop());
  const auto end = Next<wire::End>(connection.logger);
  ASSERT_TRUE(end);
  EXPECT_GE(end->samples, 160);
  EXPECT_EQ(connection.logger.RejectedFrames(), 0);
}

TEST(Logger, ReportsTheArrivalTimeOfAMessage) {
  Connection connection;
  ASSERT_TRUE(connection.board.Read(1));
  ASSERT_TRUE(connection.logger.Start());
  const auto received = connection.logger.Receive(2);
  ASSERT_TRUE(received && *received);
  EXPECT_EQ((*received)->host_time, 1.04);
}

// Arriving samples show that the logger has started.
TEST(Logger, StartsIfTheFirstAnswerIsLost) {
  LoggerScript script;
  script.lost_answers['S'] = 1;
  Connection connection(script);
  const auto started = connection.logger.Start();
  ASSERT_TRUE(started) << started.error().message();
  EXPECT_TRUE(Next<wire::Data>(connection.logger));
  EXPECT_EQ(connection.board.Heard(), "S");  // the samples also count as an answer
}

TEST(Logger, CountsOnlyTheRunsInvalidFrames) {
  LoggerScript script;
  script.greeting = Bytes(std::string_view("no frame\0nor this\0", 18));
  Connection connection(script);
  ASSERT_TRUE(connection.logger.Connect());
  ASSERT_TRUE(connection.logger.Start());
  EXPECT_TRUE(Next<wire::Data>(connection.logger));
  EXPECT_EQ(connection.logger.RejectedFrames(), 0);
}

TEST(Logger, ReturnsNothingIfNothingArrived) {
  Connection connection;
  const auto received = connection.logger.Receive(0.1);
  ASSERT_TRUE(received) << received.error().message();
  EXPECT_FALSE(*received);
  EXPECT_EQ(connection.board.Time(), 0.1);
}

TEST(Logger, ReportsALostPort) {
  LoggerScript script;
  script.frames = 3;
  script.then = LoggerScript::Then::kUnplugged;
  Connection connection(script);
  ASSERT_TRUE(connection.logger.Start());
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(Next<wire::Data>(connection.logger));
  EXPECT_THAT(FaultOf(connection.logger.Receive(5)), HasSubstr("was disconnected"));
  EXPECT_THAT(FaultOf(connection.logger.RequestStop()), HasSubstr("was disconnected"));
}

}  // namespace
}  // namespace pendulum::logger_test
