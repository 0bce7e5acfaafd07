// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

struct avr_t;
struct avr_irq_t;

namespace pendulum {

/// A board to simulate, and its converter's input.
struct BoardOptions {
  std::string mcu = "atmega328p";        ///< Or atmega2560.
  std::string firmware;                  ///< Path of the ELF file.
  double clock_error = 0;                ///< Relative: 0.003 for a resonator that is 0.3 % too fast.
  std::function<int(double)> counts;     ///< The converter's reading of its input at that time since power-on [s].
  std::function<void(double)> on_start;  ///< Called when the first conversion of a run is sampled [s].
  std::vector<std::uint8_t> eeprom;      ///< From address 0; the rest is erased.
  bool keeps_log = true;                 ///< Whether every conversion is logged, with 16 bytes each.
};

/// A conversion of the hardware.
struct AdcConversion {
  std::uint64_t cycle;  ///< CPU cycle at which it was triggered.
  int counts;
};

/// A byte on the line from board to host.
struct LineByte {
  double time;  ///< s since power-on, at the end of its stop bit.
  std::uint8_t byte;
};

/// Faults that must not happen on a board, although the simulator tolerates them.
struct BoardFaults {
  int sleeps_with_converter_on = 0;  ///< Falling asleep starts a conversion.
  int swallowed_triggers = 0;        ///< The converter was busy.
  int overrun_bytes = 0;             ///< Written to the UART while two were pending.
  int crashes = 0;
};

/// An Uno or Mega 2560 in simavr that runs a firmware file as it would be flashed. This class adds what simavr 1.6
/// lacks. Compare match B of Timer 1 starts the converter, whose readings come from `counts`. The line carries bytes at
/// the baud rate set in the UART. Empty turns of the loop (logger_idle) are skipped up to the next event.
class SimulatedBoard {
 public:
  /// Powers the board on. Throws std::runtime_error if the firmware or the processor does not exist.
  explicit SimulatedBoard(BoardOptions options);
  SimulatedBoard(const SimulatedBoard&) = delete;
  SimulatedBoard& operator=(const SimulatedBoard&) = delete;
  ~SimulatedBoard();

  /// Runs until that time since power-on [s].
  void RunUntil(double time);

  /// Blocks all interrupts for `seconds` from now on, as a library that disables them would.
  void HoldInterrupts(double seconds);

  /// Queues bytes for the board; they go over the line one after the other.
  void Send(const std::vector<std::uint8_t>& bytes);

  /// The bytes received over the line since the last call.
  std::vector<LineByte> TakeBytes();

  double time() const;
  const std::optional<double>& start() const { return start_; }  ///< Time of the present run's first sample [s].
  double ClockHz() const { return 16e6 * (1 + options_.clock_error); }
  /// Conversions triggered by the timer.
  const std::vector<AdcConversion>& conversions() const { return conversions_; }
  const BoardFaults& faults() const { return faults_; }

  /// CPU load since the last call: the share of cycles that were not idle turns of the loop.
  double TakeLoad();

  /// Bytes of RAM between the heap's end and the deepest stack so far.
  int LeastFreeStack() const { return least_stack_ - data_end_; }

  /// The present content of the EEPROM.
  std::vector<std::uint8_t> Eeprom() const;

 private:
  void LoadFirmware();
  void ConnectConverter();
  void ConnectLine();
  void OnTimerMatch(bool is_pending);
  void OnConversion();
  void OnByte(std::uint8_t byte);
  std::uint64_t CyclesPerByte() const;
  void Step(std::uint64_t end);
  void SkipIdle(std::uint64_t end);
  void DeliverByte();

  BoardOptions options_;
  avr_t* avr_ = nullptr;
  avr_irq_t* converter_ = nullptr;  // input of the converter, channel 0
  avr_irq_t* trigger_ = nullptr;    // auto trigger of the converter
  avr_irq_t* input_ = nullptr;      // input of the UART
  std::uint32_t idle_address_ = 0;
  int data_end_ = 0, least_stack_ = 0;
  bool is_match_pending_ = false;
  std::optional<double> start_;
  std::uint64_t first_ = 0;  // cycle of the first trigger of the run
  // Cycles at which the line to the host is free, and at which the next byte may reach the board.
  std::uint64_t line_free_ = 0, next_input_ = 0;
  std::deque<std::uint8_t> to_board_;
  std::vector<LineByte> to_host_;
  std::vector<AdcConversion> conversions_;
  BoardFaults faults_;
  std::uint64_t idle_cycles_ = 0, load_start_ = 0;
};

}  // namespace pendulum
