// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/messages.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::messages_test {
namespace {

namespace wire = pendulum_logger;

using testing::ElementsAreArray;
using testing::SizeIs;

using Bytes = std::vector<std::uint8_t>;

/// Bytes from their hexadecimal digits.
Bytes Hex(const std::string& text) {
  std::istringstream digits(text);
  Bytes bytes;
  for (unsigned byte = 0; digits >> std::hex >> byte;) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

Bytes operator+(Bytes first, const Bytes& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

Bytes Text(std::string_view text) { return {text.begin(), text.end()}; }

template <class Message>
Bytes FrameOf(const Message& message) {
  Bytes frame(wire::kMaxEncoded + 1);
  frame.resize(wire::MakeFrame(message, frame.data()));
  return frame;
}

/// A frame of any payload, built from parts that are tested separately.
Bytes FrameOfPayload(Bytes payload) {
  const std::uint16_t crc = wire::Crc16(payload.data(), payload.size());
  payload.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  payload.push_back(static_cast<std::uint8_t>(crc >> 8));
  Bytes frame(payload.size() + 1);
  wire::CobsEncode(payload.data(), payload.size(), frame.data());
  frame.push_back(0);
  return frame;
}

// Each number contains at least one zero byte, so that COBS has to encode something.
constexpr wire::StraightLine kLine = {-135, 0.25F, 0.5F, -0.0009765625F, 9.5367431640625e-7F};
constexpr wire::Info kInfo = {1, 0x0100, 2, 3, 10, 2000000, 115200, 10000, 4, 1, 513, 1, kLine};
constexpr wire::Data kData = {0x1234, 0xFFFFFF00, 5, 65535, 3, {0, 1023, 512}};
constexpr wire::Ack kAck = {'S', wire::kRunning};
constexpr wire::End kEnd = {1000000, 0, 256};

// Frames of these messages by an independent implementation in Python: struct.pack, a bitwise CRC, and COBS by
// splitting at zeros.
const char* const kInfoFrame =
    "03 49 01 08 01 02 03 0A 80 84 1E 01 03 C2 01 08 10 27 04 01 01 02 01 01 03 07 C3 01 03 80 3E 01 01 02 3F 01 "
    "03 80 BA 01 05 80 35 53 07 00";
const char* const kDataFrame = "04 44 34 12 05 FF FF FF 05 04 FF FF 03 01 03 FF 03 04 02 AC A3 00";
const char* const kAckFrame = "06 41 53 03 8E 8D 00";
const char* const kEndFrame = "05 45 40 42 0F 01 01 01 01 01 02 01 01 03 B5 6A 00";

Bytes AllFrames() { return Hex(kInfoFrame) + Hex(kDataFrame) + Hex(kAckFrame) + Hex(kEndFrame); }

// ---- The parts of a frame ----------------------------------------------------------------------------------------

// The check value of CRC-16/IBM-3740 (also CCITT-FALSE) in Greg Cook's catalogue. Without bytes, the
// CRC is the initial value.
TEST(Crc16, MatchesTheCatalogueCheckValue) {
  const Bytes digits = Text("123456789");
  EXPECT_EQ(wire::Crc16(digits.data(), digits.size()), 0x29B1);
  EXPECT_EQ(wire::Crc16(digits.data(), 0), 0xFFFF);
}

struct CobsExample {
  const char *plain, *encoded;  // without the final 0
};

// From Cheshire & Baker 1999 and the table in Wikipedia's article: all examples with fewer than 254 bytes.
const std::vector<CobsExample> kCobsExamples = {
    {"00", "01 01"},
    {"00 00", "01 01 01"},
    {"00 11 00", "01 02 11 01"},
    {"11 22 00 33", "03 11 22 02 33"},
    {"11 22 33 44", "05 11 22 33 44"},
    {"11 00 00 00", "02 11 01 01 01"},
    {"45 00 00 2C 4C 79 00 00 40 06 4F 37", "02 45 01 04 2C 4C 79 01 05 40 06 4F 37"},
};

TEST(Cobs, EncodesTheAuthorsExamples) {
  for (const CobsExample& example : kCobsExamples) {
    const Bytes plain = Hex(example.plain);
    Bytes encoded(plain.size() + 1);
    EXPECT_EQ(wire::CobsEncode(plain.data(), plain.size(), encoded.data()), plain.size() + 1);
    EXPECT_EQ(encoded, Hex(example.encoded)) << example.plain;
  }
}

TEST(Cobs, DecodesTheAuthorsExamples) {
  for (const CobsExample& example : kCobsExamples) {
    Bytes bytes = Hex(example.encoded);
    bytes.resize(wire::CobsDecode(bytes.data(), bytes.size()));
    EXPECT_EQ(bytes, Hex(example.plain));
  }
}

TEST(Cobs, DecodesOnlyWhatItEncodes) {
  for (const char* encoded : {"", "05 11", "03 11", "02 11 05 22", "FF", "01 00", "02 00 02 33 44"}) {
    Bytes bytes = Hex(encoded);
    EXPECT_EQ(wire::CobsDecode(bytes.data(), bytes.size()), 0) << encoded;
  }
}

TEST(MakeFrame, ProducesTheBytesOfTheProtocol) {
  EXPECT_EQ(FrameOf(kInfo), Hex(kInfoFrame));
  EXPECT_EQ(FrameOf(kData), Hex(kDataFrame));
  EXPECT_EQ(FrameOf(kAck), Hex(kAckFrame));
  EXPECT_EQ(FrameOf(kEnd), Hex(kEndFrame));
}

TEST(CommandBytes, AreAZeroAndTheFrame) {
  EXPECT_EQ(CommandBytes(wire::Command<wire::kAskInfo>{}), Hex("00 04 49 1D 38 00"));
  EXPECT_EQ(CommandBytes(wire::Command<wire::kStart>{}), Hex("00 04 53 66 8B 00"));
  EXPECT_EQ(CommandBytes(wire::Command<wire::kStop>{}), Hex("00 04 58 0D 3A 00"));
  EXPECT_EQ(CommandBytes(wire::SetRate{10000, 1}), Hex("00 07 52 10 27 01 A0 D0 00"));
  EXPECT_EQ(CommandBytes(wire::StoreCalibration{kLine}),
            Hex("00 02 57 01 03 07 C3 01 03 80 3E 01 01 02 3F 01 03 80 BA 01 05 80 35 06 A7 00"));
}

TEST(DataFrameSize, IsTheSizeOfAFrame) {
  for (const int count : {1, 3, 16}) {
    wire::Data data = kData;
    data.count = static_cast<std::uint8_t>(count);
    EXPECT_EQ(wire::DataFrameSize(count), FrameOf(data).size());
  }
}

// ---- Messages ----------------------------------------------------------------------------------------------------

// Compares field by field to detect a field that both encoder and decoder forget.
void ExpectInfo(const LoggerMessage& message) {
  const auto* info = std::get_if<wire::Info>(&message);
  ASSERT_NE(info, nullptr);
  EXPECT_EQ(info->protocol, 1);
  EXPECT_EQ(info->firmware, 0x0100);
  EXPECT_EQ(info->board, 2);
  EXPECT_EQ(info->reference, 3);
  EXPECT_EQ(info->adc_bits, 10);
  EXPECT_EQ(info->tick_hz, 2000000);
  EXPECT_EQ(info->baud, 115200);
  EXPECT_EQ(info->period, 10000);
  EXPECT_EQ(info->oversample, 4);
  EXPECT_EQ(info->is_running, 1);
  EXPECT_EQ(info->run, 513);
  EXPECT_EQ(info->has_calibration, 1);
  EXPECT_EQ(info->calibration.offset_deg, -135);
  EXPECT_EQ(info->calibration.deg_per_count, 0.25);
  EXPECT_EQ(info->calibration.offset_variance, 0.5);
  EXPECT_EQ(info->calibration.covariance, -0.0009765625);
  EXPECT_EQ(info->calibration.slope_variance, 9.5367431640625e-7);
}

void ExpectData(const LoggerMessage& message) {
  const auto* data = std::get_if<wire::Data>(&message);
  ASSERT_NE(data, nullptr);
  EXPECT_EQ(data->sequence, 0x1234);
  EXPECT_EQ(data->tick, 0xFFFFFF00);
  EXPECT_EQ(data->dropped, 5);
  EXPECT_EQ(data->late, 65535);
  ASSERT_EQ(data->count, 3);
  EXPECT_EQ(data->sums[0], 0);
  EXPECT_EQ(data->sums[1], 1023);
  EXPECT_EQ(data->sums[2], 512);
}

void ExpectAckAndEnd(const LoggerMessage& first, const LoggerMessage& second) {
  const auto* ack = std::get_if<wire::Ack>(&first);
  ASSERT_NE(ack, nullptr);
  EXPECT_EQ(ack->command, 'S');
  EXPECT_EQ(ack->status, wire::kRunning);
  const auto* end = std::get_if<wire::End>(&second);
  ASSERT_NE(end, nullptr);
  EXPECT_EQ(end->samples, 1000000);
  EXPECT_EQ(end->dropped, 0);
  EXPECT_EQ(end->late, 256);
}

void ExpectAll(const std::vector<LoggerMessage>& messages) {
  ASSERT_THAT(messages, SizeIs(4));
  ExpectInfo(messages[0]);
  ExpectData(messages[1]);
  ExpectAckAndEnd(messages[2], messages[3]);
}

TEST(MessageDecoder, ReadsEveryLoggerMessage) {
  MessageDecoder decoder;
  ExpectAll(decoder.Decode(AllFrames()));
  EXPECT_EQ(decoder.rejected(), 0);
}

TEST(MessageDecoder, ReadsMessagesByteByByte) {
  MessageDecoder decoder;
  std::vector<LoggerMessage> messages;
  for (const std::uint8_t byte : AllFrames()) {
    const auto completed = decoder.Decode({&byte, 1});
    EXPECT_TRUE(byte == 0 || completed.empty());
    messages.insert(messages.end(), completed.begin(), completed.end());
  }
  ExpectAll(messages);
}

TEST(MessageDecoder, ReadsTheLargestBlock) {
  wire::Data data = {65535, 0, 0, 0, 16, {}};
  for (int i = 0; i < 16; ++i) data.sums[i] = static_cast<std::uint16_t>(4095 * i);  // up to 61425
  MessageDecoder decoder;
  const auto messages = decoder.Decode(FrameOf(data));
  ASSERT_THAT(messages, SizeIs(1));
  const auto& read = std::get<wire::Data>(messages[0]);
  EXPECT_EQ(read.sequence, 65535);
  EXPECT_THAT(read.sums, ElementsAreArray(data.sums));
}

TEST(MessageDecoder, ReportsOnlyTheVersionOfAnotherProtocol) {
  MessageDecoder decoder;
  // An Info of protocol 2 with two additional unknown bytes, from the Python implementation above.
  const auto messages = decoder.Decode(Hex("07 49 02 07 08 D4 6F 00"));
  ASSERT_THAT(messages, SizeIs(1));
  ASSERT_TRUE(std::holds_alternative<OtherProtocol>(messages[0]));
  EXPECT_EQ(std::get<OtherProtocol>(messages[0]).version, 2);
  wire::Info old = kInfo;
  old.protocol = 0;
  const auto second = decoder.Decode(FrameOf(old));
  ASSERT_THAT(second, SizeIs(1));
  EXPECT_EQ(std::get<OtherProtocol>(second[0]).version, 0);
}

// ---- Invalid data ------------------------------------------------------------------------------------------------

/// Decodes garbage followed by a valid frame, which must be found. Returns the number of rejected pieces.
int RejectedOf(const Bytes& garbage) {
  MessageDecoder decoder;
  const auto messages = decoder.Decode(garbage + Hex(kAckFrame));
  EXPECT_THAT(messages, SizeIs(1)) << testing::PrintToString(garbage);
  EXPECT_TRUE(messages.size() == 1 && std::holds_alternative<wire::Ack>(messages[0]));
  return decoder.rejected();
}

TEST(MessageDecoder, FindsTheFrameAfterGarbage) {
  EXPECT_EQ(RejectedOf(Text("pendulum_logger: send ? for a reading\r\n") + Hex("00")), 1);
  EXPECT_EQ(RejectedOf(Hex("00 00 00")), 0);
  EXPECT_EQ(RejectedOf(Hex("01 00 02 33 00")), 2);  // too short for a CRC
  EXPECT_EQ(RejectedOf(Hex("FF FF FF FF 00 80 80 80 80 00")), 2);
  EXPECT_EQ(RejectedOf(Hex("01 01 01 00")), 1);  // two zero bytes are not the CRC of an empty payload
}

TEST(MessageDecoder, FindsTheFrameAfterATooLongFrame) {
  for (const std::size_t length : {51, 52, 53, 255, 256, 257, 308, 10000}) {
    EXPECT_EQ(RejectedOf(Bytes(length, 0x55) + Hex("00")), 1) << length;
  }
  // A payload has at most 48 bytes. 48 bytes of 'Z' are a valid frame of an unknown message; 49 bytes are too long.
  EXPECT_EQ(RejectedOf(FrameOfPayload(Bytes(48, 'Z'))), 1);
  EXPECT_EQ(RejectedOf(FrameOfPayload(Bytes(49, 'Z'))), 1);
}

TEST(MessageDecoder, RejectsTruncatedFrames) {
  const Bytes frame = Hex(kDataFrame);
  for (std::size_t cut = 1; cut + 1 < frame.size(); ++cut) {
    const Bytes head(frame.begin(), frame.end() - 1 - static_cast<std::ptrdiff_t>(cut));
    EXPECT_EQ(RejectedOf(head + Hex("00")), 1) << cut;
    EXPECT_EQ(RejectedOf(Bytes(frame.begin() + static_cast<std::ptrdiff_t>(cut), frame.end())), 1) << cut;
  }
}

// A 16-bit CRC detects every single flipped bit. A bit that creates or removes a 0 splits the frame in two or joins it
// to the next one.
TEST(MessageDecoder, RejectsEveryFlippedBit) {
  for (const char* hex : {kInfoFrame, kDataFrame, kAckFrame, kEndFrame}) {
    const Bytes frame = Hex(hex);
    for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
      Bytes flipped = frame;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1 << bit % 8));
      MessageDecoder decoder;
      const auto messages = decoder.Decode(flipped + Hex("00") + Hex(kAckFrame));
      EXPECT_THAT(messages, SizeIs(1)) << hex << ", bit " << bit;
      EXPECT_GE(decoder.rejected(), 1) << hex << ", bit " << bit;
    }
  }
}

/// The payload of a frame.
Bytes PayloadOf(const char* hex) {
  Bytes bytes = Hex(hex);
  bytes.resize(wire::CobsDecode(bytes.data(), bytes.size() - 1) - 2);
  return bytes;
}

TEST(MessageDecoder, RejectsPayloadsOfTheWrongLength) {
  for (const char* hex : {kInfoFrame, kDataFrame, kAckFrame, kEndFrame}) {
    Bytes payload = PayloadOf(hex);
    EXPECT_EQ(FrameOfPayload(payload), Hex(hex));
    payload.push_back(1);
    EXPECT_EQ(RejectedOf(FrameOfPayload(payload)), 1) << hex;
    payload.resize(payload.size() - 2);
    EXPECT_EQ(RejectedOf(FrameOfPayload(payload)), 1) << hex;
  }
}

TEST(MessageDecoder, RejectsValidFramesOfOtherSenders) {
  EXPECT_EQ(RejectedOf(FrameOfPayload(Text("S"))), 1);      // a command
  EXPECT_EQ(RejectedOf(FrameOfPayload(Text("I"))), 1);      // also a command, not an Info
  EXPECT_EQ(RejectedOf(FrameOfPayload(Text("I\x01"))), 1);  // an Info that ends after its protocol
  EXPECT_EQ(RejectedOf(FrameOfPayload(Text("Zebra"))), 1);
}

/// A Data payload that announces `count` samples and contains `sums` of them.
Bytes DataPayload(std::uint8_t count, std::size_t sums) {
  Bytes payload = Hex("44 00 00 00 00 00 00 00 00 00 00");
  payload.push_back(count);
  payload.resize(payload.size() + 2 * sums, 1);
  return payload;
}

TEST(MessageDecoder, RejectsDataWithoutTheStatedSamples) {
  MessageDecoder decoder;
  EXPECT_THAT(decoder.Decode(FrameOfPayload(DataPayload(4, 4))), SizeIs(1));
  EXPECT_EQ(RejectedOf(FrameOfPayload(DataPayload(4, 3))), 1);
  EXPECT_EQ(RejectedOf(FrameOfPayload(DataPayload(4, 5))), 1);
  EXPECT_EQ(RejectedOf(FrameOfPayload(DataPayload(0, 0))), 1);
  EXPECT_EQ(RejectedOf(FrameOfPayload(DataPayload(17, 16))), 1);
  EXPECT_EQ(RejectedOf(FrameOfPayload(DataPayload(17, 17))), 1);
  EXPECT_EQ(RejectedOf(FrameOfPayload(DataPayload(255, 18))), 1);
}

// 100 000 random bytes contain some 390 zeros. A piece between two zeros is a valid frame by chance in 1 of 65 536
// cases.
TEST(MessageDecoder, FindsNothingInNoise) {
  std::mt19937 random(7);
  Bytes noise(100000);
  std::ranges::generate(noise, [&] { return static_cast<std::uint8_t>(random()); });
  MessageDecoder decoder;
  EXPECT_THAT(decoder.Decode(noise), SizeIs(0));
  EXPECT_GT(decoder.rejected(), 200);
  EXPECT_THAT(decoder.Decode(Hex("00") + Hex(kAckFrame)), SizeIs(1));
}

// ---- Texts for people --------------------------------------------------------------------------------------------

wire::Info Of(std::uint8_t board, std::uint8_t reference) {
  wire::Info info = kInfo;
  info.board = board;
  info.reference = reference;
  return info;
}

TEST(BoardName, GivesTheProductNameOrTheNumberOfAnUnknownBoard) {
  EXPECT_EQ(BoardName(Of(1, 1)), "Arduino Uno");
  EXPECT_EQ(BoardName(Of(2, 1)), "Arduino Mega 2560");
  EXPECT_EQ(BoardName(Of(9, 1)), "board 9");
}

TEST(FirmwareVersion, IsMajorAndMinor) {
  wire::Info info = kInfo;
  EXPECT_EQ(FirmwareVersion(info), "version 1.0");
  info.firmware = 256 * 12 + 34;
  EXPECT_EQ(FirmwareVersion(info), "version 12.34");
}

// Values of Arduino.h of the AVR core: EXTERNAL 0, DEFAULT 1, INTERNAL 3; on a Mega INTERNAL1V1 2, INTERNAL2V56 3.
TEST(ReferenceName, DependsOnTheBoard) {
  EXPECT_EQ(ReferenceName(Of(1, 0)), "external voltage (AREF)");
  EXPECT_EQ(ReferenceName(Of(2, 1)), "supply voltage (AVcc)");
  EXPECT_EQ(ReferenceName(Of(1, 3)), "internal voltage (1.1 V)");
  EXPECT_EQ(ReferenceName(Of(2, 2)), "internal voltage (1.1 V)");
  EXPECT_EQ(ReferenceName(Of(2, 3)), "internal voltage (2.56 V)");
  EXPECT_EQ(ReferenceName(Of(1, 2)), "voltage 2");
}

}  // namespace
}  // namespace pendulum::messages_test
