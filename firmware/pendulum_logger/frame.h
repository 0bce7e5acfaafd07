// SPDX-License-Identifier: Apache-2.0
//
// The protocol between the logger and its host, used by both: src/docs/hardware.md, "The protocol". Written in C++11
// without a standard library, because avr-g++ has none.
//
// A frame is a payload of at most kMaxPayload bytes and its CRC, encoded by COBS so that it contains no 0, and a final
// 0. Numbers are little endian. The first byte of the payload identifies the message.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

namespace pendulum_logger {

constexpr uint8_t kProtocol = 1;
constexpr uint16_t kFirmware = 0x0100;  // version 1.0
constexpr uint32_t kTickHz = 2000000;   // Timer 1: 16 MHz / 8
constexpr uint8_t kAdcBits = 10;
constexpr uint8_t kMaxBlock = 16;                     // samples in a frame
constexpr uint8_t kMaxOversample = 64;                // conversions in a sample: their sum fits in 16 bits
constexpr uint16_t kMinPeriod = 250;                  // ticks between conversions; one takes 216
constexpr uint16_t kMaxPeriod = 62500;                // ticks: a late interrupt must be distinguishable from an early
                                                      // one
constexpr uint8_t kMaxPayload = 48;                   // bytes
constexpr uint8_t kMaxEncoded = kMaxPayload + 2 + 1;  // bytes, including the CRC and the overhead of COBS, without
                                                      // the 0

// Frames of the logger, and commands of the host. An Ack answers a command; an Info answers kAskInfo.
constexpr uint8_t kInfo = 'I', kData = 'D', kAck = 'A', kEnd = 'E';
constexpr uint8_t kAskInfo = 'I', kStart = 'S', kStop = 'X', kSetRate = 'R', kStoreCalibration = 'W';

enum Board : uint8_t { kUno = 1, kMega2560 = 2 };

enum AckStatus : uint8_t { kDone = 0, kUnknown = 1, kOutOfRange = 2, kRunning = 3 };

// angle [deg] = offset_deg + deg_per_count * counts, and the covariance of both coefficients; 0 if it is unknown.
struct StraightLine {
  float offset_deg, deg_per_count;
  float offset_variance, covariance, slope_variance;  // deg^2, deg^2 per count, deg^2 per count^2

  template <class Archive>
  void Fields(Archive& archive) {
    archive(offset_deg);
    archive(deg_per_count);
    archive(offset_variance);
    archive(covariance);
    archive(slope_variance);
  }
};

// The logger's properties and settings.
struct Info {
  static constexpr uint8_t kKind = kInfo;
  uint8_t protocol;
  uint16_t firmware;  // major * 256 + minor
  uint8_t board;
  uint8_t reference;  // Arduino's number: EXTERNAL 0, DEFAULT 1 (the supply), INTERNAL 3; on a Mega INTERNAL1V1 2
  uint8_t adc_bits;
  uint32_t tick_hz;
  uint32_t baud;
  uint16_t period;     // ticks between two conversions
  uint8_t oversample;  // conversions added to form a sample
  uint8_t is_running;
  uint16_t run;  // how often it has been started in its lifetime
  uint8_t has_calibration;
  StraightLine calibration;

  template <class Archive>
  void Fields(Archive& archive) {
    archive(protocol);  // first in every protocol version
    archive(firmware);
    archive(board);
    archive(reference);
    archive(adc_bits);
    archive(tick_hz);
    archive(baud);
    archive(period);
    archive(oversample);
    archive(is_running);
    archive(run);
    archive(has_calibration);
    calibration.Fields(archive);
  }
};

// Samples at equal intervals of period * oversample ticks. A sample is the sum of its conversions.
struct Data {
  static constexpr uint8_t kKind = kData;
  uint16_t sequence;  // number of the frame, from 0 at the start, modulo 2^16
  uint32_t tick;      // when the first conversion of the first sample was triggered, modulo 2^32
  uint16_t dropped;   // samples since the start that had no room; 65535 means at least so many
  uint16_t late;      // conversions since the start that could not start in time; 65535 means at least so many
  uint8_t count;
  uint16_t sums[kMaxBlock];

  template <class Archive>
  void Fields(Archive& archive) {
    archive(sequence);
    archive(tick);
    archive(dropped);
    archive(late);
    archive(count);
    if (count > kMaxBlock) archive.Fail();
    for (uint8_t i = 0; i < count && i < kMaxBlock; ++i) archive(sums[i]);
  }
};

// Size in bytes of a frame with `count` samples: payload, CRC, COBS overhead, and the 0.
constexpr int DataFrameSize(int count) { return 12 + 2 * count + 2 + 1 + 1; }

// Number of samples in a frame if samples come every `step` ticks: about 25 frames per second, if the samples fit.
constexpr int BlockSize(uint32_t step) {
  return kTickHz / 25 / step < 1           ? 1
         : kTickHz / 25 / step > kMaxBlock ? kMaxBlock
                                           : static_cast<int>(kTickHz / 25 / step);
}

// The end of a run: how much was sent, so that the host can detect losses at the end.
struct End {
  static constexpr uint8_t kKind = kEnd;
  uint32_t samples, dropped, late;  // samples sent; the others as in Data, but not limited to 65535

  template <class Archive>
  void Fields(Archive& archive) {
    archive(samples);
    archive(dropped);
    archive(late);
  }
};

struct Ack {
  static constexpr uint8_t kKind = kAck;
  uint8_t command, status;

  template <class Archive>
  void Fields(Archive& archive) {
    archive(command);
    archive(status);
  }
};

struct SetRate {
  static constexpr uint8_t kKind = kSetRate;
  uint16_t period;  // as in Info
  uint8_t oversample;

  template <class Archive>
  void Fields(Archive& archive) {
    archive(period);
    archive(oversample);
  }
};

struct StoreCalibration {
  static constexpr uint8_t kKind = kStoreCalibration;
  StraightLine calibration;

  template <class Archive>
  void Fields(Archive& archive) {
    calibration.Fields(archive);
  }
};

// A payload that consists only of its first byte: kAskInfo, kStart, kStop.
template <uint8_t kCommand>
struct Command {
  static constexpr uint8_t kKind = kCommand;

  template <class Archive>
  void Fields(Archive&) {}
};

// CRC-16/IBM-3740: polynomial 0x1021, initial value 0xFFFF, most significant bit first; 0x29B1 for "123456789".
inline uint16_t Crc16(const uint8_t* bytes, size_t count) {
  uint16_t crc = 0xFFFF;
  for (size_t i = 0; i < count; ++i) {
    crc = static_cast<uint16_t>((crc >> 8) | (crc << 8));
    crc = static_cast<uint16_t>(crc ^ bytes[i]);
    crc = static_cast<uint16_t>(crc ^ ((crc & 0xFF) >> 4));
    crc = static_cast<uint16_t>(crc ^ (crc << 12));
    crc = static_cast<uint16_t>(crc ^ ((crc & 0xFF) << 5));
  }
  return crc;
}

// Writes fields one after the other while there is room.
class Writer {
 public:
  Writer(uint8_t* bytes, size_t room) : bytes_(bytes), room_(room) {}

  template <class T>
  void operator()(const T& field) {
    uint32_t bits = 0;
    Bits(field, bits);
    for (size_t i = 0; i < sizeof(T) && size_ < room_; ++i) bytes_[size_++] = static_cast<uint8_t>(bits >> (8 * i));
  }

  void Fail() {}
  size_t size() const { return size_; }

 private:
  template <class T>
  static void Bits(const T& field, uint32_t& bits) {
    bits = field;
  }
  static void Bits(float field, uint32_t& bits) { memcpy(&bits, &field, sizeof bits); }

  uint8_t* bytes_;
  size_t room_, size_ = 0;
};

// Reads the fields back. Fields beyond the end keep their values.
class Reader {
 public:
  Reader(const uint8_t* bytes, size_t size) : bytes_(bytes), size_(size) {}

  template <class T>
  void operator()(T& field) {
    if (size_ - at_ < sizeof(T)) Fail();
    if (!is_good_) return;
    uint32_t bits = 0;
    for (size_t i = 0; i < sizeof(T); ++i) bits |= static_cast<uint32_t>(bytes_[at_++]) << (8 * i);
    Assign(bits, field);
  }

  void Fail() { is_good_ = false; }

  // All fields were present, and nothing else.
  bool IsComplete() const { return is_good_ && at_ == size_; }

 private:
  template <class T>
  static void Assign(uint32_t bits, T& field) {
    field = static_cast<T>(bits);
  }
  static void Assign(uint32_t bits, float& field) { memcpy(&field, &bits, sizeof field); }

  const uint8_t* bytes_;
  size_t size_, at_ = 0;
  bool is_good_ = true;
};

// Consistent overhead byte stuffing (Cheshire & Baker, IEEE/ACM Trans. Networking 7(2), 1999) of fewer than 254 bytes:
// replaces each 0 by the distance to the next one. `encoded` must have room for count + 1 bytes. Returns their number.
inline size_t CobsEncode(const uint8_t* bytes, size_t count, uint8_t* encoded) {
  size_t code = 0;  // position for the distance to the next 0
  for (size_t i = 0; i < count; ++i) {
    encoded[i + 1] = bytes[i];
    if (bytes[i] != 0) continue;
    encoded[code] = static_cast<uint8_t>(i + 1 - code);
    code = i + 1;
  }
  encoded[code] = static_cast<uint8_t>(count + 1 - code);
  return count + 1;
}

// Inverse of CobsEncode, in place. Returns the number of decoded bytes; 0 if CobsEncode cannot have produced the input.
inline size_t CobsDecode(uint8_t* bytes, size_t count) {
  size_t code = 0;
  while (code < count && bytes[code] != 0 && code + bytes[code] <= count) {
    const size_t next = code + bytes[code];
    bytes[code] = 0;
    code = next;
  }
  if (code != count || count == 0) return 0;
  memmove(bytes, bytes + 1, count - 1);
  return count - 1;
}

// Builds the frame of a message. `frame` must have room for kMaxEncoded + 1 bytes. Returns the number of bytes.
template <class Message>
size_t MakeFrame(Message message, uint8_t* frame) {
  uint8_t payload[kMaxPayload + 2];
  payload[0] = Message::kKind;
  Writer writer(payload + 1, kMaxPayload - 1);
  message.Fields(writer);
  const size_t size = 1 + writer.size();
  const uint16_t crc = Crc16(payload, size);
  payload[size] = static_cast<uint8_t>(crc);
  payload[size + 1] = static_cast<uint8_t>(crc >> 8);
  const size_t encoded = CobsEncode(payload, size + 2, frame);
  frame[encoded] = 0;
  return encoded + 1;
}

// A message as it is sent over the line.
struct Frame {
  uint8_t bytes[kMaxEncoded + 1];
  size_t size;

  template <class Message>
  explicit Frame(const Message& message) : size(MakeFrame(message, bytes)) {}
};

// Finds frames in a stream of bytes that may contain other data. After an error it continues after the next 0.
class Receiver {
 public:
  enum Event : uint8_t { kNothing, kFrame, kRejected };

  // kFrame: payload() belongs to a frame with the right CRC. kRejected: the bytes before this 0 are not a frame.
  Event Take(uint8_t byte) {
    if (byte != 0) {
      if (received_ <= kMaxEncoded)
        bytes_[received_++] = byte;  // one byte beyond the limit marks the frame as too
                                     // long
      return kNothing;
    }
    const uint8_t received = received_;
    received_ = 0;
    if (received == 0) return kNothing;
    if (received > kMaxEncoded) return kRejected;
    const size_t decoded = CobsDecode(bytes_, received);
    if (decoded < 3) return kRejected;
    size_ = static_cast<uint8_t>(decoded - 2);
    const uint16_t crc = static_cast<uint16_t>(bytes_[size_] | bytes_[size_ + 1] << 8);
    return crc == Crc16(bytes_, size_) ? kFrame : kRejected;
  }

  // Bytes of the last frame, valid until the next byte is taken. The first byte identifies the message.
  const uint8_t* payload() const { return bytes_; }
  uint8_t size() const { return size_; }

  // Reads the payload as this message. Returns false if it is another message.
  template <class Message>
  bool Read(Message& message) const {
    if (bytes_[0] != Message::kKind) return false;
    Reader reader(bytes_ + 1, size_ - 1u);
    message.Fields(reader);
    return reader.IsComplete();
  }

  // Only line ends have arrived since the last 0.
  bool IsAtLineStart() const {
    for (uint8_t i = 0; i < received_; ++i) {
      if (bytes_[i] != '\r' && bytes_[i] != '\n') return false;
    }
    return true;
  }

 private:
  uint8_t bytes_[kMaxEncoded + 1];
  uint8_t received_ = 0, size_ = 0;
};

}  // namespace pendulum_logger
