// SPDX-License-Identifier: Apache-2.0
//
// Records a potentiometer at exact intervals, for record_pendulum; src/docs/hardware.md shows the wiring. Timer 1
// starts each conversion in hardware, and the count of Timer 1 is the time stamp of the sample. Delays of the program
// affect neither the conversion nor the time stamp.
//
// analogRead(), Servo and PWM on the pins of Timers 1 and 2 cannot be used at the same time.
#include <Arduino.h>
#include <avr/eeprom.h>

#include "frame.h"

// ---- Settings you may change -------------------------------------------------------------------------------------

#ifndef LOGGER_BAUD
#define LOGGER_BAUD 115200  // 500000 and 1000000 transfer more; then also set record_pendulum --baud
#endif
#ifndef LOGGER_CHANNEL
#define LOGGER_CHANNEL 0  // the wiper is on A0
#endif
#ifndef LOGGER_REFERENCE
#define LOGGER_REFERENCE DEFAULT  // DEFAULT (the supply), EXTERNAL (AREF), INTERNAL; Mega: INTERNAL1V1, INTERNAL2V56
#endif

// ------------------------------------------------------------------------------------------------------------------

#if defined(__AVR_ATmega328P__)
#define LOGGER_BOARD pendulum_logger::kUno
#elif defined(__AVR_ATmega2560__)
#define LOGGER_BOARD pendulum_logger::kMega2560
#else
#error "pendulum_logger needs an ATmega328P (Uno, Nano) or an ATmega2560 (Mega): Timer 1 and the converter of these."
#endif
#if LOGGER_CHANNEL < 0 || LOGGER_CHANNEL > 7
#error "LOGGER_CHANNEL must be 0 to 7."
#endif
#if F_CPU != 16000000UL
#error "pendulum_logger needs a clock of 16 MHz: ticks and the time of a conversion are counted from it."
#endif

using namespace pendulum_logger;

// Called when there is nothing to do until the next interrupt; a simulator may skip the time. The processor must not
// sleep here: falling asleep with the converter on starts an unwanted conversion.
extern "C" __attribute__((noinline, used, externally_visible)) void logger_idle() { __asm__ __volatile__(""); }

// ---- Data shared by the interrupts and the main loop ------------------------------------------------------------

struct Sample {
  uint32_t tick;
  uint16_t sum;
};

static const uint8_t kRoom = 64;  // samples, a power of 2
static Sample ring[kRoom];
static volatile uint8_t ring_head = 0, ring_tail = 0;  // the next index to write and to read

// Keeps the compiler from moving accesses to samples across accesses to these indices.
static inline void Fence() { __asm__ __volatile__("" ::: "memory"); }

static uint16_t period = 10000;  // ticks between conversions: 200 Hz
static uint8_t oversample = 1;
static bool is_running = false;

static uint32_t next_tick;        // when Timer 1 starts the next conversion
static uint32_t conversion_tick;  // when Timer 1 started the current conversion
static uint32_t sample_tick;      // when Timer 1 started the first conversion of this sample
static bool is_converting, is_spoilt;
static uint8_t conversions;  // number in this sample so far
static uint16_t sum;
static volatile uint32_t dropped, late;

static const uint8_t kConverterOn = _BV(ADEN) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0);  // 125 kHz

// Ticks from Timer 1 to next_tick; more than a period once Timer 1 has passed it. Timer 1 wraps around after 32 ms, so
// interrupts must not be blocked longer than 32 ms, or times would be wrong by 32 ms. No code here blocks them long.
static inline uint16_t TicksAhead() { return static_cast<uint16_t>(static_cast<uint16_t>(next_tick) - TCNT1); }

// The compare match has already started a conversion. This records its time and schedules the next one.
ISR(TIMER1_COMPB_vect) {
  if (is_converting) {  // the previous conversion is not finished, so this one did not start
    ++late;
    is_spoilt = true;
  } else {
    conversion_tick = next_tick;
    is_converting = true;
  }
  next_tick += period;
  OCR1B = static_cast<uint16_t>(next_tick);
  while (TicksAhead() > period && !(TIFR1 & _BV(OCF1B))) {  // too late: this match would occur one wrap-around later
    ++late;
    is_spoilt = true;
    next_tick += period;
    OCR1B = static_cast<uint16_t>(next_tick);
  }
}

ISR(ADC_vect) {
  const uint16_t code = ADC;
  if (!is_converting) return;  // after the end of the run
  is_converting = false;
  if (is_spoilt) {  // a sample consists of conversions without a gap
    is_spoilt = false;
    conversions = 0;
    return;
  }
  if (conversions == 0) {
    sample_tick = conversion_tick;
    sum = 0;
  }
  sum += code;
  if (++conversions < oversample) return;
  conversions = 0;
  const uint8_t next = (ring_head + 1) & (kRoom - 1);
  if (next == ring_tail) {
    ++dropped;
    return;
  }
  ring[ring_head].tick = sample_tick;
  ring[ring_head].sum = sum;
  Fence();
  ring_head = next;
}

// ---- The converter -----------------------------------------------------------------------------------------------

static uint16_t ConvertOnce() {
  ADCSRA = kConverterOn | _BV(ADSC);
  while (ADCSRA & _BV(ADSC)) {
  }
  return ADC;
}

static void SetUpConverter() {
  TCCR2A = TCCR2B = 0;  // switches off the core's PWM
#if defined(TCCR3A)
  TCCR3A = TCCR3B = TCCR4A = TCCR4B = TCCR5A = TCCR5B = 0;
#endif
  TCCR1A = 0;
  TCCR1B = _BV(CS11);  // normal mode, 16 MHz / 8
  ADMUX = static_cast<uint8_t>(LOGGER_REFERENCE << 6 | LOGGER_CHANNEL);
  ADCSRB = 0;
  DIDR0 = static_cast<uint8_t>(1 << LOGGER_CHANNEL);
  ConvertOnce();
}

static void StartSampling() {
  ring_head = ring_tail = 0;
  conversions = 0;
  dropped = late = 0;
  is_converting = is_spoilt = false;
  is_running = true;
  ConvertOnce();                     // the first conversion after the converter is switched on takes twice as long
  ADCSRB = _BV(ADTS2) | _BV(ADTS0);  // compare match B of Timer 1 starts conversions
  noInterrupts();
  next_tick = static_cast<uint32_t>(TCNT1) + 1000;
  OCR1B = static_cast<uint16_t>(next_tick);
  TIFR1 = _BV(OCF1B);
  TIMSK1 = _BV(OCIE1B);
  ADCSRA = kConverterOn | _BV(ADATE) | _BV(ADIF) | _BV(ADIE);
  interrupts();
}

static void StopSampling() {
  TIMSK1 = 0;
  delayMicroseconds(150);  // lets the current conversion finish
  ADCSRA = kConverterOn;
  ADCSRB = 0;
}

// ---- EEPROM ------------------------------------------------------------------------------------------------------

static uint16_t* const kRunAddress = reinterpret_cast<uint16_t*>(0);
static uint8_t* const kCalibrationAddress = reinterpret_cast<uint8_t*>(16);
static const size_t kCalibrationBytes = 20;

static uint16_t CountedRuns() {
  const uint16_t runs = eeprom_read_word(kRunAddress);
  return runs == 0xFFFF ? 0 : runs;  // a new EEPROM
}

static bool ReadCalibration(StraightLine& line) {
  uint8_t bytes[kCalibrationBytes + 2];
  eeprom_read_block(bytes, kCalibrationAddress, sizeof bytes);
  Reader reader(bytes, kCalibrationBytes);
  line.Fields(reader);
  return Crc16(bytes, kCalibrationBytes) ==
         static_cast<uint16_t>(bytes[kCalibrationBytes] | bytes[kCalibrationBytes + 1] << 8);
}

static void WriteCalibration(StraightLine& line) {
  uint8_t bytes[kCalibrationBytes + 2];
  Writer writer(bytes, sizeof bytes);
  line.Fields(writer);
  writer(Crc16(bytes, kCalibrationBytes));
  eeprom_update_block(bytes, kCalibrationAddress, sizeof bytes);
}

// ---- Messages ----------------------------------------------------------------------------------------------------

static Data block;          // the frame being filled
static uint8_t block_size;  // number of samples at which the frame is sent
static uint32_t sent_samples;

static void Send(const Frame& frame) { Serial.write(frame.bytes, frame.size); }

static void SendInfo() {
  Info info;
  info.protocol = kProtocol;
  info.firmware = kFirmware;
  info.board = LOGGER_BOARD;
  info.reference = LOGGER_REFERENCE;
  info.adc_bits = kAdcBits;
  info.tick_hz = kTickHz;
  info.baud = LOGGER_BAUD;
  info.period = period;
  info.oversample = oversample;
  info.is_running = is_running;
  info.run = CountedRuns();
  info.has_calibration = ReadCalibration(info.calibration);
  Send(Frame(info));
}

static void SendAck(uint8_t command, AckStatus status) {
  Ack ack;
  ack.command = command;
  ack.status = status;
  Send(Frame(ack));
}

static uint16_t Saturated(uint32_t count) { return count > 0xFFFF ? 0xFFFF : static_cast<uint16_t>(count); }

static void SendBlock() {
  noInterrupts();
  block.dropped = Saturated(dropped);
  block.late = Saturated(late);
  interrupts();
  Send(Frame(block));
  sent_samples += block.count;
  ++block.sequence;
  block.count = 0;
}

// Whether a sample of that tick fits into the block: there is room, and it follows one step after the last sample.
static bool Continues(uint32_t tick) {
  const uint32_t step = static_cast<uint32_t>(period) * oversample;
  return block.count == 0 || (block.count < block_size && tick == block.tick + step * block.count);
}

// One step of passing samples on, without waiting for the line. Returns false if there is nothing to do yet.
static bool PassOn() {
  const uint8_t tail = ring_tail;
  const bool is_waiting = tail != ring_head;
  Fence();
  if (is_waiting && Continues(ring[tail].tick)) {
    if (block.count == 0) block.tick = ring[tail].tick;
    block.sums[block.count++] = ring[tail].sum;
    Fence();
    ring_tail = (tail + 1) & (kRoom - 1);
    return true;
  }
  if (!is_waiting && block.count < block_size) return false;
  if (Serial.availableForWrite() < DataFrameSize(block.count)) return false;
  SendBlock();
  return true;
}

// ---- Commands ----------------------------------------------------------------------------------------------------

static void Start() {
  if (is_running) return SendAck(kStart, kRunning);
  eeprom_update_word(kRunAddress, CountedRuns() + 1);
  eeprom_busy_wait();
  block_size = static_cast<uint8_t>(BlockSize(static_cast<uint32_t>(period) * oversample));
  block.sequence = 0;
  block.count = 0;
  sent_samples = 0;
  SendAck(kStart, kDone);
  StartSampling();
}

static void Stop() {
  if (is_running) {
    StopSampling();
    while (PassOn() || ring_tail != ring_head) {
    }
    if (block.count > 0) SendBlock();
    is_running = false;
    End end;
    end.samples = sent_samples;
    end.dropped = dropped;
    end.late = late;
    Send(Frame(end));
  }
  SendAck(kStop, kDone);
}

static AckStatus TakeRate(const SetRate& rate) {
  if (is_running) return kRunning;
  if (rate.period < kMinPeriod || rate.period > kMaxPeriod) return kOutOfRange;
  if (rate.oversample < 1 || rate.oversample > kMaxOversample) return kOutOfRange;
  period = rate.period;
  oversample = rate.oversample;
  return kDone;
}

static AckStatus TakeCalibration(StoreCalibration& store) {
  if (is_running) return kRunning;
  const StraightLine& line = store.calibration;
  const float all = line.offset_deg + line.deg_per_count + line.offset_variance + line.covariance + line.slope_variance;
  if (all - all != 0 || line.deg_per_count == 0) return kOutOfRange;  // at least one is not finite
  WriteCalibration(store.calibration);
  return kDone;
}

static void Obey(const Receiver& receiver) {
  SetRate rate;
  StoreCalibration store;
  const uint8_t kind = receiver.payload()[0];
  if (receiver.size() == 1 && kind == kAskInfo) return SendInfo();
  if (receiver.size() == 1 && kind == kStart) return Start();
  if (receiver.size() == 1 && kind == kStop) return Stop();
  if (receiver.Read(rate)) return SendAck(kind, TakeRate(rate));
  if (receiver.Read(store)) return SendAck(kind, TakeCalibration(store));
  SendAck(kind, kUnknown);
}

// Called after text for people, so that the text is not taken for the beginning of a frame.
static void EndText() { Serial.write(static_cast<uint8_t>(0)); }

// The answer to ? in the Serial Monitor.
static void TellReading() {
  if (is_running) return;  // a manual conversion would end the timer's conversions
  const uint16_t counts = ConvertOnce();
  StraightLine line;
  Serial.print(F("pendulum_logger "));
  Serial.print(kFirmware >> 8);
  Serial.print('.');
  Serial.print(kFirmware & 0xFF);
  Serial.print(F(": A"));
  Serial.print(LOGGER_CHANNEL);
  Serial.print(F(" = "));
  Serial.print(counts);
  Serial.print(F(" of 1023 counts"));
  if (ReadCalibration(line)) {
    Serial.print(F(", "));
    Serial.print(line.offset_deg + line.deg_per_count * counts);
    Serial.print(F(" deg"));
  }
  Serial.print(F("; "));
  Serial.print(static_cast<float>(kTickHz) / (static_cast<uint32_t>(period) * oversample));
  Serial.print(F(" Hz, runs so far: "));
  Serial.println(CountedRuns());
  EndText();
}

static void TakeCommands() {
  static Receiver receiver;
  while (Serial.available() > 0) {
    const uint8_t byte = static_cast<uint8_t>(Serial.read());
    if (byte == '?' && receiver.IsAtLineStart()) {  // no frame starts with '?' (63): it would have more than 62 bytes
      receiver.Take(0);
      TellReading();
    } else if (receiver.Take(byte) == Receiver::kFrame) {
      Obey(receiver);
    }
  }
}

void setup() {
  Serial.begin(LOGGER_BAUD);
  SetUpConverter();
  Serial.println(F("pendulum_logger: send ? for a reading"));
  EndText();
  SendInfo();
}

void loop() {
  TakeCommands();
  if (is_running && PassOn()) return;
  logger_idle();
}
