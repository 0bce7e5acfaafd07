// SPDX-License-Identifier: Apache-2.0
#include "tests/firmware/simulated_board.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <simavr/avr_adc.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_interrupts.h>
#include <simavr/sim_io.h>

namespace pendulum {
namespace {

// Addresses in data memory, the same on both processors.
constexpr int kStackPointer = 0x5D, kAdcControlA = 0x7A, kAdcControlB = 0x7B, kUartControlA = 0xC0, kUartBaud = 0xC4;
constexpr std::uint8_t kAdcEnabled = 0x80, kAdcBusy = 0x40, kAdcAutoTrigger = 0x20, kDoubleSpeed = 0x02;
constexpr std::uint8_t kTriggerSources = 0x07, kTimer1MatchB = 0x05;
constexpr int kInterruptFlag = 7;                    // in sreg
constexpr int kDataBase = 0x800000;                  // offset of data memory in the addresses of an ELF file
constexpr std::uint64_t kCyclesPerTick = 8;          // of Timer 1
constexpr int kBitsPerByte = 10;                     // start, eight, stop
constexpr std::uint64_t kSampleDelay = 2 * 128 + 3;  // cycles from the match to the end of sampling (data sheet 24.4)

/// Returns at once instead of waiting for real time to pass.
void NoSleep(avr_t*, avr_cycle_count_t) {}

/// Discards simavr's messages about its own limits, which this file works around.
void NoMessages(avr_t*, int, const char*, va_list) {}

}  // namespace

SimulatedBoard::SimulatedBoard(BoardOptions options) : options_(std::move(options)) {
  avr_global_logger_set(NoMessages);
  avr_ = avr_make_mcu_by_name(options_.mcu.c_str());
  if (avr_ == nullptr) throw std::runtime_error("simavr knows no " + options_.mcu);
  avr_init(avr_);
  LoadFirmware();
  avr_->frequency = 16000000;
  // simavr converts a voltage to mV * 1023 / reference, so with this reference the "voltage" is the reading.
  avr_->vcc = avr_->avcc = avr_->aref = 1023;
  avr_->sleep = NoSleep;  // the caller controls the time
  least_stack_ = avr_->ramend;
  ConnectConverter();
  ConnectLine();
}

SimulatedBoard::~SimulatedBoard() {
  avr_terminate(avr_);
  std::free(avr_);
}

void SimulatedBoard::LoadFirmware() {
  elf_firmware_t firmware;
  std::memset(&firmware, 0, sizeof firmware);
  if (elf_read_firmware(options_.firmware.c_str(), &firmware) != 0) {
    throw std::runtime_error("no firmware in " + options_.firmware);
  }
  for (std::uint32_t i = 0; i < firmware.symbolcount; ++i) {
    const std::string_view name = firmware.symbol[i]->symbol;
    if (name == "logger_idle") idle_address_ = firmware.symbol[i]->addr;
    if (name == "_end" || name == "__heap_start") data_end_ = static_cast<int>(firmware.symbol[i]->addr) - kDataBase;
  }
  if (idle_address_ == 0) throw std::runtime_error("no logger_idle in " + options_.firmware);
  avr_load_firmware(avr_, &firmware);
  std::vector<std::uint8_t> erased(avr_->e2end + 1, 0xFF);
  std::ranges::copy(options_.eeprom, erased.begin());
  avr_eeprom_desc_t eeprom{erased.data(), 0, static_cast<std::uint32_t>(erased.size())};
  avr_ioctl(avr_, AVR_IOCTL_EEPROM_SET, &eeprom);
}

void SimulatedBoard::ConnectConverter() {
  converter_ = avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0);
  trigger_ = avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_IN_TRIGGER);
  avr_irq_register_notify(
      avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER),
      [](avr_irq_t*, std::uint32_t, void* board) { static_cast<SimulatedBoard*>(board)->OnConversion(); }, this);
  const std::uint8_t match_b = options_.mcu == "atmega2560" ? 18 : 12;  // interrupt vector TIMER1_COMPB
  avr_irq_register_notify(
      avr_get_interrupt_irq(avr_, match_b) + AVR_INT_IRQ_PENDING,
      [](avr_irq_t*, std::uint32_t value, void* board) {
        static_cast<SimulatedBoard*>(board)->OnTimerMatch(value != 0);
      },
      this);
}

void SimulatedBoard::ConnectLine() {
  std::uint32_t flags = 0;  // do not sleep while the firmware polls, and do not print its output
  avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  input_ = avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
  avr_irq_register_notify(
      avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
      [](avr_irq_t*, std::uint32_t value, void* board) {
        static_cast<SimulatedBoard*>(board)->OnByte(static_cast<std::uint8_t>(value));
      },
      this);
}

/// The flag's rising edge starts a conversion; a flag that is not cleared starts no more.
void SimulatedBoard::OnTimerMatch(bool is_pending) {
  const bool rises = is_pending && !is_match_pending_;
  is_match_pending_ = is_pending;
  const std::uint8_t control = avr_->data[kAdcControlA];
  if (!rises || (control & kAdcAutoTrigger) == 0) return;
  if ((avr_->data[kAdcControlB] & kTriggerSources) != kTimer1MatchB) return;
  if ((control & kAdcBusy) != 0) {
    ++faults_.swallowed_triggers;
    return;
  }
  avr_raise_irq(trigger_, 1);
}

void SimulatedBoard::OnConversion() {
  const bool is_run = (avr_->data[kAdcControlA] & kAdcAutoTrigger) != 0;
  const bool is_first = is_run && !start_;
  std::uint64_t trigger = avr_->cycle;
  if (is_first) first_ = trigger;
  // simavr acts some cycles late, after the current instruction; the match was on a tick.
  if (is_run) trigger = first_ + (trigger - first_ + kCyclesPerTick / 2) / kCyclesPerTick * kCyclesPerTick;
  const double sampled = static_cast<double>(trigger + kSampleDelay) / ClockHz();
  if (!is_run) {
    start_.reset();
  } else if (is_first) {
    start_ = sampled;
    if (options_.on_start) options_.on_start(sampled);
  }
  const int counts = options_.counts ? options_.counts(sampled) : 0;
  if (options_.keeps_log && is_run) conversions_.push_back({avr_->cycle, counts});
  avr_raise_irq(converter_, static_cast<std::uint32_t>(counts));
}

std::uint64_t SimulatedBoard::CyclesPerByte() const {
  const int divider = avr_->data[kUartBaud] | (avr_->data[kUartBaud + 1] & 0x0F) << 8;
  const int clocks = (avr_->data[kUartControlA] & kDoubleSpeed) != 0 ? 8 : 16;
  return static_cast<std::uint64_t>(kBitsPerByte) * clocks * (divider + 1);
}

void SimulatedBoard::OnByte(std::uint8_t byte) {
  const std::uint64_t duration = CyclesPerByte();
  line_free_ = std::max<std::uint64_t>(line_free_, avr_->cycle) + duration;
  if (line_free_ - avr_->cycle > 2 * duration) ++faults_.overrun_bytes;  // one in the shift register, one waiting
  to_host_.push_back({static_cast<double>(line_free_) / ClockHz(), byte});
}

void SimulatedBoard::DeliverByte() {
  avr_raise_irq(input_, to_board_.front());
  to_board_.pop_front();
  next_input_ = avr_->cycle + CyclesPerByte();
}

void SimulatedBoard::SkipIdle(std::uint64_t end) {
  if (avr_->pc != idle_address_ || avr_->interrupt_state != 0) return;
  std::uint64_t next = end;
  if (avr_->cycle_timers.timer != nullptr) next = std::min<std::uint64_t>(next, avr_->cycle_timers.timer->when);
  if (!to_board_.empty()) next = std::min(next, next_input_);
  if (next <= avr_->cycle + 1) return;
  idle_cycles_ += next - 1 - avr_->cycle;
  avr_->cycle = next - 1;
}

void SimulatedBoard::Step(std::uint64_t end) {
  SkipIdle(end);
  if (!to_board_.empty() && avr_->cycle >= next_input_) DeliverByte();
  const int state = avr_run(avr_);
  if (state == cpu_Sleeping && (avr_->data[kAdcControlA] & kAdcEnabled) != 0) ++faults_.sleeps_with_converter_on;
  if (state == cpu_Crashed || state == cpu_Done) {
    ++faults_.crashes;
    throw std::runtime_error("the simulated processor stopped");
  }
  least_stack_ = std::min(least_stack_, avr_->data[kStackPointer] | avr_->data[kStackPointer + 1] << 8);
}

void SimulatedBoard::RunUntil(double time) {
  const auto end = static_cast<std::uint64_t>(std::llround(time * ClockHz()));
  while (avr_->cycle < end) Step(end);
}

void SimulatedBoard::HoldInterrupts(double seconds) {
  const auto end = avr_->cycle + static_cast<std::uint64_t>(std::llround(seconds * ClockHz()));
  while (avr_->sreg[kInterruptFlag] == 0 || avr_->pc != idle_address_) Step(end);
  while (avr_->cycle < end) {
    avr_->sreg[kInterruptFlag] = 0;
    avr_run(avr_);
  }
  avr_->sreg[kInterruptFlag] = 1;
  avr_->interrupt_state = 1;
}

void SimulatedBoard::Send(const std::vector<std::uint8_t>& bytes) {
  next_input_ = std::max<std::uint64_t>(next_input_, avr_->cycle);
  to_board_.insert(to_board_.end(), bytes.begin(), bytes.end());
}

std::vector<LineByte> SimulatedBoard::TakeBytes() {
  const double now = time();
  const auto arrived = std::ranges::find_if(to_host_, [now](const LineByte& each) { return each.time > now; });
  std::vector<LineByte> taken(to_host_.begin(), arrived);
  to_host_.erase(to_host_.begin(), arrived);
  return taken;
}

double SimulatedBoard::time() const { return static_cast<double>(avr_->cycle) / ClockHz(); }

double SimulatedBoard::TakeLoad() {
  const std::uint64_t total = avr_->cycle - load_start_;
  const double load = total == 0 ? 0 : 1 - static_cast<double>(idle_cycles_) / static_cast<double>(total);
  load_start_ = avr_->cycle;
  idle_cycles_ = 0;
  return load;
}

std::vector<std::uint8_t> SimulatedBoard::Eeprom() const {
  avr_eeprom_desc_t eeprom{nullptr, 0, 0};
  avr_ioctl(avr_, AVR_IOCTL_EEPROM_GET, &eeprom);
  return {eeprom.ee, eeprom.ee + avr_->e2end + 1};
}

}  // namespace pendulum
