// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// A kind of warning. A serious one may mean that numbers are wrong: no output leaves it out or only names it.
struct WarningKind {
  std::string_view code;
  bool is_serious = false;
};

/// All kinds of warnings; src/docs/reference.md says what they mean. A code does not change between versions.
inline constexpr std::array kWarningKinds = {
    // The file.
    WarningKind{"averaging_disagrees", true},
    WarningKind{"axes_combined"},
    WarningKind{"calibration_bent", true},
    WarningKind{"calibration_from_table"},
    WarningKind{"empty_cells"},
    WarningKind{"event_driven"},
    WarningKind{"gravity_assumed"},
    WarningKind{"host_time"},
    WarningKind{"incomplete_row"},
    WarningKind{"lost_samples", true},
    WarningKind{"many_spikes"},
    WarningKind{"means_assumed"},
    WarningKind{"means_possible"},
    WarningKind{"member_assumed"},
    WarningKind{"metadata_not_applied"},
    WarningKind{"notes_left_out"},
    WarningKind{"range_disagrees"},
    WarningKind{"rate_disagrees", true},
    WarningKind{"resolution_disagrees", true},
    WarningKind{"rig_overridden"},
    WarningKind{"rig_unit_assumed"},
    WarningKind{"rows_repeated"},
    WarningKind{"sample_rate_from_text"},
    WarningKind{"second_table"},
    WarningKind{"sensor_replaced"},
    WarningKind{"sensor_unknown"},
    WarningKind{"spikes"},
    WarningKind{"stale_values", true},
    WarningKind{"stray_lines"},
    WarningKind{"text_below_table"},
    WarningKind{"time_bursts"},
    WarningKind{"time_column_assumed"},
    WarningKind{"time_not_increasing"},
    WarningKind{"time_outside_window"},
    WarningKind{"time_repeated"},
    WarningKind{"time_rounded"},
    WarningKind{"time_unit_assumed"},
    WarningKind{"time_wrapped"},
    WarningKind{"times_of_day"},
    WarningKind{"uncalibrated"},
    WarningKind{"unequal_columns", true},
    WarningKind{"unit_overridden"},
    WarningKind{"unreadable_member"},
    WarningKind{"unwrapped"},
    WarningKind{"value_column_assumed"},
    WarningKind{"value_unit_assumed"},
    // Sampling and window.
    WarningKind{"aliased", true},
    WarningKind{"ambiguous_frequency", true},
    WarningKind{"clock_unproven", true},
    WarningKind{"ends_trimmed"},
    WarningKind{"few_counts"},
    WarningKind{"frequency_differs_from_rig", true},
    WarningKind{"gaps"},
    WarningKind{"hold_disagrees", true},
    WarningKind{"hold_left_out"},
    WarningKind{"inertia_differs_from_rig", true},
    WarningKind{"jitter"},
    WarningKind{"larger_motion_outside"},
    WarningKind{"linear_restoring_torque"},
    WarningKind{"nearly_aliased"},
    WarningKind{"presliding"},
    WarningKind{"rig_errors_assumed"},
    WarningKind{"rig_exact"},
    WarningKind{"rig_implausible", true},
    WarningKind{"samples_near_period", true},
    WarningKind{"saturated"},
    WarningKind{"slow_sampling"},
    WarningKind{"unit_questioned"},
    WarningKind{"vibration"},
    WarningKind{"whole_turns_removed"},
    // The fit.
    WarningKind{"ambiguous_sensor"},
    WarningKind{"another_minimum", true},
    WarningKind{"at_bound", true},
    WarningKind{"closed_forms_differ", true},
    WarningKind{"correlated_residuals", true},
    WarningKind{"gravity_in_readings", true},
    WarningKind{"ignored_parameter"},
    WarningKind{"lack_of_fit", true},
    WarningKind{"lost_counts", true},
    WarningKind{"noise_below_resolution", true},
    WarningKind{"not_a_pendulum"},
    WarningKind{"not_constant", true},
    WarningKind{"offset_jumps"},
    WarningKind{"offset_unsteady", true},
    WarningKind{"prior_conflict", true},
    WarningKind{"recordings_disagree", true},
    WarningKind{"separate_fit_not_converged"},
    WarningKind{"suspected_backlash"},
    WarningKind{"suspected_drift"},
    WarningKind{"suspected_friction_law"},
    WarningKind{"suspected_gain"},
    WarningKind{"suspected_hold"},
    WarningKind{"suspected_lag"},
    WarningKind{"suspected_nonlinearity"},
    WarningKind{"suspected_position_friction"},
    WarningKind{"suspected_presliding"},
    WarningKind{"suspected_push"},
    WarningKind{"trajectory_accuracy", true},
    WarningKind{"uncertain_stop", true},
    WarningKind{"zero_drift", true},
    // The recorder.
    WarningKind{"clock_implausible"},
    WarningKind{"contradicting_frames"},
    WarningKind{"end_message_missing"},
    WarningKind{"part_file_not_written"},
    WarningKind{"recording_interrupted"},
    // A store.
    WarningKind{"former_models"},
    WarningKind{"incomplete"},
    WarningKind{"mixed_versions"},
    WarningKind{"no_order"},
    WarningKind{"not_in_the_manifest"},
    WarningKind{"pending"},
    WarningKind{"same_data"},
    WarningKind{"several_cpus"},
    WarningKind{"stale"},
};

/// One of kWarningKinds. A text that is none of them does not compile.
class WarningCode {
 public:
  consteval WarningCode(const char* code)  // NOLINT(google-explicit-constructor): it stands for the text.
      : kind_(kWarningKinds.data() +
              (std::ranges::find(kWarningKinds, std::string_view(code), &WarningKind::code) - kWarningKinds.begin())) {
    if (kind_ == kWarningKinds.data() + kWarningKinds.size()) UnknownWarningCode();
  }

  constexpr std::string_view text() const { return kind_->code; }
  constexpr bool is_serious() const { return kind_->is_serious; }

  friend constexpr bool operator==(const WarningCode& code, std::string_view text) { return code.text() == text; }
  template <std::same_as<WarningCode> Same>
  friend constexpr bool operator==(const Same& a, const Same& b) {
    return a.kind_ == b.kind_;
  }

 private:
  static void UnknownWarningCode();  // It has no body: a call is no constant expression.

  const WarningKind* kind_;
};

/// What a warning is about. What is empty or 0 it does not name.
struct WarningSubject {
  static constexpr int kEachRecording = -1;

  std::string file = {};            ///< Path of the recording.
  std::size_t line = 0;             ///< Line of this file, from 1.
  std::string law = {};             ///< The law that was fitted, if the warning does not hold for all.
  int recording = 0;                ///< Number of the recording of a joint fit, from 1, or kEachRecording.
  std::string recording_name = {};  ///< "recording 2 (b.csv)"; empty for kEachRecording.
  std::vector<std::string> parameters = {};

  bool operator==(const WarningSubject&) const = default;
};

/// Something a user should know about a valid result. Each text is one clause or several, begins with a lower-case
/// letter and ends without a full stop.
struct Warning {
  WarningCode code;
  std::string finding;                  ///< What is the matter.
  std::string explanation = {};         ///< What it follows from, and what follows from it.
  std::string advice = {};              ///< What to do.
  std::vector<std::string> flags = {};  ///< The flags that finding and advice name, without dashes.
  /// If numbers rest on an assumption: what was assumed and the flag that says otherwise, in a few words:
  /// "times in s (--time_column t:ms)".
  std::string assumed = {};
  WarningSubject about = {};

  bool operator==(const Warning&) const = default;
};

/// "recording 2 (b.csv): coulomb: b.csv:118: finding; explanation; advice".
std::string MessageText(const Warning& warning);

/// The same without the law, for a list below its name: "recording 2 (b.csv): b.csv:118: finding; explanation; advice".
std::string TextWithoutLaw(Warning warning);

/// What is found, and the advice if it has flags: "line 118: finding. Advice". Of the file only what `recording`, the
/// path that the reader knows, does not say: "run2.csv, line 118" of a zip file.
std::string ShortText(const Warning& warning, const std::string& recording = "");

/// The first warning of this code; nullptr if there is none.
const Warning* FindWarning(const std::vector<Warning>& warnings, WarningCode code);

/// Whether one of the warnings has this code.
bool HasWarning(const std::vector<Warning>& warnings, WarningCode code);

}  // namespace pendulum
