// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/result_summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "pendulum/analysis/ambiguities.h"
#include "pendulum/analysis/rig_verdict.h"
#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/model/friction/coulomb.h"
#include "pendulum/model/friction/dahl.h"
#include "pendulum/model/friction/stribeck.h"
#include "pendulum/report/budget_sections.h"
#include "pendulum/report/closed_form_quantities.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/fit_sections.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/suspicion_sections.h"
#include "pendulum/report/text_parts.h"
#include "pendulum/trajectory/energy_losses.h"

namespace pendulum {
namespace {

void AddListed(const std::string& item, std::string& list) {
  if (!item.empty()) list += (list.empty() ? "" : ", ") + item;
}

// ---- Quantities -----------------------------------------------------------------------------------------------------

/// x with its trailing zeros, so that its digits say how precise it is.
std::string SignificantText(double x, int digits) {
  return x == 0 || !std::isfinite(x) ? NumberText(x, digits) : RoundedText(x, SignificantRounding(x, digits));
}

constexpr double kMuchWider = 1.5;  // than ± 2 errors is an interval that must be said

std::string ShownUnit(const std::string& unit) { return unit == "1" ? "" : unit; }

SummaryQuantity Quantity(std::string name, std::string symbol, double value, const std::optional<double>& error,
                         const std::string& unit) {
  const Conversion shown = Degrees(unit).value_or(Conversion{unit});
  if (!error || !(*error > 0) || !std::isfinite(*error)) {
    return {std::move(name),
            std::move(symbol),
            NumberText(shown.factor * value, kTextDigits),
            "",
            ShownUnit(std::string(shown.unit)),
            ""};
  }
  ValueAndError text = PdgText(shown.factor * value, shown.factor * *error);
  return {std::move(name),
          std::move(symbol),
          std::move(text.value),
          std::move(text.error),
          ShownUnit(std::string(shown.unit)),
          ""};
}

SummaryQuantity QuantityOf(const ParameterEstimate& parameter, const std::optional<Rig>& rig) {
  const auto total = TotalStdError(parameter.std_error, parameter.systematic);
  SummaryQuantity quantity = Quantity(std::string(parameter.info.name), std::string(parameter.info.symbol),
                                      parameter.estimate, total, parameter.unit);
  if (parameter.std_error) {
    quantity.source = MainSourcesText(*parameter.std_error, parameter.systematic, rig);
  } else {
    quantity.source = parameter.fixed ? "fixed" : parameter.at_bound ? "at its bound" : "no error";
  }
  return quantity;
}

/// What people ask for, and the word for it in a sentence.
struct AskedQuantity {
  std::string_view name, word;
};

constexpr std::array kAskedQuantities = {AskedQuantity{"small_angle_period", "period of small swings"},
                                         AskedQuantity{"decay_time", "decay time"},
                                         AskedQuantity{"quality_factor", "Q"},
                                         AskedQuantity{"gravity", "g"},
                                         AskedQuantity{"effective_length", "effective length"},
                                         AskedQuantity{"stiffness", "stiffness"},
                                         AskedQuantity{"gravity_torque", "gravity torque"},
                                         AskedQuantity{"center_of_mass", "center of mass"}};

struct Interval {
  double lower = 0, upper = 0;
};

/// The total 95 % interval of a ParameterEstimate or DerivedQuantity, in its unit; absent without both ends.
template <typename Estimated>
std::optional<Interval> TotalIntervalOf(const Estimated& quantity) {
  const auto [lower, upper] = TotalInterval95(quantity);
  return lower && upper ? std::optional(Interval{*lower, *upper}) : std::nullopt;
}

/// Whether an interval about an estimate says more than ± 2 errors: it is much wider, because there are few independent
/// samples, or one side is, because a parameter is at its bound.
bool IsTelling(double lower, double estimate, double upper, double total_error) {
  constexpr double kLopsided = 3;
  const auto [shorter, longer] = std::minmax({estimate - lower, upper - estimate});
  return longer > kMuchWider * kNormal95 * total_error || longer > kLopsided * shorter;
}

bool HasTellingInterval(const DerivedQuantity& quantity) {
  if (!quantity.std_error || !quantity.lower95 || !quantity.upper95) return false;
  return IsTelling(*quantity.lower95, quantity.estimate, *quantity.upper95,
                   *TotalStdError(quantity.std_error, quantity.systematic));
}

/// The total 95 % interval in the place of the value. The quantity has one.
SummaryQuantity IntervalOf(const DerivedQuantity& quantity, std::string name) {
  constexpr double kErrors = 4;  // in a 95 % interval
  const Interval interval = TotalIntervalOf(quantity).value();
  const Rounding rounding = PdgRounding(quantity.estimate, (interval.upper - interval.lower) / kErrors);
  std::string value = RoundedText(interval.lower, rounding) + " to " + RoundedText(interval.upper, rounding);
  return {
      std::move(name) + " (95" + std::string(kNoBreak) + "%)", "", std::move(value), "", ShownUnit(quantity.unit), ""};
}

std::vector<SummaryQuantity> DerivedOf(const FitReport& fit) {
  std::vector<SummaryQuantity> derived;
  for (const auto& [name, word] : kAskedQuantities) {
    const auto found = std::ranges::find(fit.derived, name, &DerivedQuantity::name);
    if (found == fit.derived.end()) continue;
    const auto total = TotalStdError(found->std_error, found->systematic);
    const bool is_open = found->lower95.has_value() != found->upper95.has_value();
    const bool is_telling = HasTellingInterval(*found);
    const bool contains_0 = is_telling && TotalIntervalOf(*found)->lower <= 0;
    if (is_open || contains_0 || (total && *total >= std::abs(found->estimate))) continue;  // its divisor may be 0
    derived.push_back(is_telling ? IntervalOf(*found, std::string(word))
                                 : Quantity(std::string(word), "", found->estimate, total, found->unit));
  }
  return derived;
}

// ---- Losses ---------------------------------------------------------------------------------------------------------

/// The total standard error of a share of the losses; std::nullopt if it has none or is rounding.
std::optional<double> ShareError(const DerivedQuantity& share) {
  constexpr double kRounding = 1e-5;
  const auto total = TotalStdError(share.std_error, share.systematic);
  return total && *total > kRounding ? total : std::nullopt;
}

/// "62 ± 3 %".
std::string ShareText(const DerivedQuantity& share) {
  const std::string blank(kNoBreak);
  const ValueAndError text = PdgText(100 * share.estimate, 100 * *ShareError(share));
  return text.value + blank + "±" + blank + text.error + blank + "%";
}

/// The shares of one part of the motion; empty if one of them has no error, as beside a torque at its bound.
std::vector<DerivedQuantity> SharesOf(const FitReport& fit, const std::string& of_what) {
  const std::string ending = "_loss_share" + of_what;
  std::vector<DerivedQuantity> shares;
  for (const std::string& name : LossNames(fit.model)) {
    const auto share = std::ranges::find(fit.derived, name + ending, &DerivedQuantity::name);
    if (share == fit.derived.end() || !ShareError(*share)) return {};
    shares.push_back(*share);
  }
  return shares;
}

/// Whether shares say something: an error of a quarter leaves open which loss is larger.
bool AreDetermined(const std::vector<DerivedQuantity>& shares) {
  constexpr double kLargest = 0.25;
  return !shares.empty() &&
         std::ranges::all_of(shares, [](const DerivedQuantity& share) { return *ShareError(share) < kLargest; });
}

/// "viscous friction", "dry friction".
std::string LossWords(const FitReport& fit, std::string_view name) {
  const ParameterEstimate* const parameter = fit.Find(name);
  return std::string(parameter == nullptr ? kCoulomb.words : parameter->info.words);
}

/// "Viscous friction took 62 ± 3 % of the energy lost, dry friction 38 ± 3 % (first half swing: 71 ± 2 %, 29 ± 2 %)."
std::string LossesText(const FitReport& fit) {
  const std::vector<std::string> names = LossNames(fit.model);
  const std::vector<DerivedQuantity> whole = SharesOf(fit, ""), first = SharesOf(fit, "_first_half_swing");
  if (whole.empty()) return "";
  if (!AreDetermined(whole)) return "The readings do not tell which friction took how much of the energy.";
  std::string text, of_first;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    const std::string words = LossWords(fit, names[k]), share = std::string(kNoBreak) + ShareText(whole[k]);
    AddListed(k == 0 ? Capitalized(words) + " took" + share + " of the energy lost" : words + share, text);
    if (AreDetermined(first)) AddListed(ShareText(first[k]), of_first);
  }
  return text + (of_first.empty() ? "" : " (first half swing: " + of_first + ")") + ".";
}

// ---- Remarks on parameters ------------------------------------------------------------------------------------------

bool IsPhysical(const FitReport& fit, const ParameterEstimate& parameter) {
  const std::vector<ParameterInfo> physical = PhysicalParameters(fit.model);
  return std::ranges::find(physical, parameter.info.name, &ParameterInfo::name) != physical.end();
}

/// "coulomb 0.0016 to 0.0201" if the total 95 % interval says more than ± 2 total errors; otherwise empty.
std::string TellingIntervalText(const ParameterEstimate& parameter) {
  const auto total = TotalStdError(parameter.std_error, parameter.systematic);
  const auto interval = TotalIntervalOf(parameter);
  if (!total || !interval) return "";
  const auto [lower, upper] = *interval;
  if (!IsTelling(lower, parameter.estimate, upper, *total)) return "";
  const Conversion shown = Degrees(parameter.unit).value_or(Conversion{parameter.unit});
  const std::string unit = ShownUnit(std::string(shown.unit));
  const Rounding rounding = PdgRounding(shown.factor * parameter.estimate, shown.factor * *total);
  const auto text = [&](double x) { return RoundedText(shown.factor * x, rounding); };
  return std::string(parameter.info.name) + " " + text(std::max(lower, parameter.info.lower)) + " to " + text(upper) +
         (unit.empty() ? "" : " " + unit);
}

/// Whether a term of friction may be 0: its total 95 % interval contains 0.
bool MayBeZero(const ParameterEstimate& parameter) {
  const bool is_term = parameter.info.name != kInertia.name && parameter.info.name != kStribeckRate.name &&
                       parameter.info.name != kPreslidingAngle.name;
  const auto interval = TotalIntervalOf(parameter);
  return is_term && !parameter.at_bound && interval && interval->lower <= 0 && interval->upper >= 0;
}

/// "viscous 40 %": how far friction of another law that the readings do not show would change an estimate.
std::string UnseenText(const ParameterEstimate& parameter) {
  constexpr int kDigits = 2;
  constexpr double kMost = 10;  // of the estimate: more than this is said as a size, since the estimate may be 0
  const double unseen = *parameter.unseen_friction, size = std::abs(parameter.estimate);
  const std::string blank(kNoBreak), name = std::string(parameter.info.name) + blank;
  if (unseen < kMost * size) return name + SignificantText(100 * unseen / size, kDigits) + blank + "%";
  const std::string unit = ShownUnit(std::string(parameter.unit));
  return name + "by" + blank + SignificantText(unseen, kDigits) + (unit.empty() ? "" : blank + unit);
}

/// What a value ± error does not say.
std::string RemarksText(const FitReport& fit) {
  std::string zero, weak, wide;
  for (const ParameterEstimate& parameter : fit.parameters) {
    if (!IsPhysical(fit, parameter)) continue;
    const std::string name(parameter.info.name);
    const auto known = std::ranges::find(fit.identifiability, name, &Identifiability::parameter);
    if (MayBeZero(parameter)) {
      AddListed(name, zero);
    } else if (!parameter.at_bound && known != fit.identifiability.end() &&
               known->verdict == Identifiability::Verdict::kWeakly) {
      AddListed(name, weak);
    }
    AddListed(TellingIntervalText(parameter), wide);
  }
  std::string text = zero.empty() ? "" : "Not distinguishable from 0: " + zero + ". ";
  if (!weak.empty()) text += "Weakly identifiable: " + weak + ". ";
  if (!wide.empty()) text += "Quote as a 95 % interval: " + wide + ". ";
  std::string unseen;
  for (const ParameterEstimate* const parameter : ChangedByUnseenFriction(fit))
    AddListed(UnseenText(*parameter), unseen);
  if (!unseen.empty()) text += "Unseen friction may change: " + unseen + ". ";
  if (!text.empty()) text.pop_back();
  return text;
}

// ---- Sentences ------------------------------------------------------------------------------------------------------

std::string SamplesText(Eigen::Index used, Eigen::Index all) {
  return used == all ? "all " + std::to_string(all) + " samples"
                     : std::to_string(used) + " of " + std::to_string(all) + " samples";
}

/// "All 2000 samples, 0 s (held, then released) to 19.99 s.", "600 of 1400 samples, 0 s (in motion) to 5.99 s (at
/// rest)."
std::string DataText(const DataSummary& data) {
  std::string text = Capitalized(SamplesText(data.used_samples, data.samples));
  if (data.releases.size() > 1 && data.release > 0) {
    text += " (free swing " + std::to_string(data.release) + " of " + std::to_string(data.releases.size()) + ")";
  }
  const auto [from, to] = SpanTexts(data.from, data.to);
  const auto end = [](const std::string& time, const std::string& why) {
    return time + " s" + (why.empty() ? "" : " (" + why + ")");
  };
  const bool is_whole = data.used_samples == data.samples;  // ends where the recording does
  text += ", " + end(from, data.begins) + " to " + end(to, is_whole ? "" : data.ends) + ".";
  return data.left_out ? text + " Left out: " + Sentence(*data.left_out) + "." : text;
}

std::string JointDataText(const Identification& identification) {
  Eigen::Index used = 0, all = 0;
  std::string names;
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) {
    const DataSummary& data = identification.recordings[k].data;
    used += data.used_samples;
    all += data.samples;
    if (data.path.empty()) continue;
    names += (names.empty() ? "" : ", ") + Printable(data.path);
    if (IsOneOfSeveral(identification, k)) names += " (free swing " + std::to_string(data.release) + ")";
  }
  const std::string samples = Capitalized(SamplesText(used, all));
  return names.empty() ? samples + "." : samples + ": " + names + ".";
}

std::string WithFullStop(const std::string& text) { return text.empty() || text.ends_with('.') ? text : text + "."; }

constexpr int kRmsDigits = 3;

/// " of 0.285 deg (rms)"; recordings in different units have no common residual.
std::string RmsText(const FitReport& fit) {
  if (fit.reading_unit.empty()) return "";
  const Conversion shown = Degrees(fit.reading_unit).value_or(Conversion{fit.reading_unit});
  return " of " + SignificantText(shown.factor * fit.statistics.rms_residual, kRmsDigits) + " " +
         std::string(shown.unit) + " (rms)";
}

/// Why the residuals are more than noise, or where to look for the reason.
std::string MisfitText(const FitReport& fit, bool is_one_of_several) {
  if (const std::string suspected = SuspectedText(fit, false); !suspected.empty())
    return "Suspected: " + suspected + ".";
  return std::string("Look at them (--report), or try ") + (is_one_of_several ? "" : "other laws (--models all) or ") +
         "another window (--from, --to).";
}

/// Erases the warnings whose code begins with `code`, since the summary says otherwise what they say.
void EraseWarnings(std::string_view code, FitSummary& summary) {
  std::erase_if(summary.warnings, [&](const Warning& warning) { return warning.code.text().starts_with(code); });
}

/// What the law does not describe: "all readings", or "recordings 1, 3"; empty if it describes everything.
std::string UndescribedOf(const Identification& identification, std::size_t index) {
  std::string list;
  for (std::size_t k = 0; identification.is_joint() && k < identification.recordings.size(); ++k) {
    if (identification.FitOf(k, index).HasWarning("lack_of_fit")) AddListed(std::to_string(k + 1), list);
  }
  if (!list.empty()) return (list.find(',') == std::string::npos ? "recording " : "recordings ") + list;
  const bool lacks_fit = identification.fits[index].HasWarning("lack_of_fit") || identification.across[index].lacks_fit;
  return lacks_fit ? "all readings" : "";
}

/// Whether the law describes the readings. What it says is no warning any more.
void SetVerdict(const FitReport& fit, const Constancy* constancy, const std::string& undescribed,
                bool is_one_of_several, FitSummary& summary) {
  const auto is_said = [&](std::string_view code) { EraseWarnings(code, summary); };
  const std::string law = "The law " + std::string(fit.model.name);
  if (fit.termination != Termination::kConverged) {
    summary.verdict = "No result with " + std::string(fit.model.name) + " (" +
                      std::string(TerminationName(fit.termination)) + "): " + WithFullStop(Printable(fit.reason));
    summary.emphasis = Emphasis::kAlarm;
    const Warning* const why = fit.ReasonWarning();
    std::erase_if(summary.warnings, [&](const Warning& warning) {
      return warning.code == "at_bound" || (why != nullptr && warning == *why);
    });
    if (undescribed.starts_with("recording")) {  // one warning for all of them
      is_said("lack_of_fit");
      summary.warnings.push_back({.code = "lack_of_fit", .finding = "the law does not describe " + undescribed});
    }
    return;
  }
  if (!undescribed.empty() || !SuspectedText(fit, false).empty()) {
    summary.verdict = law + " does not describe " + (undescribed.empty() ? "all readings" : undescribed) +
                      ": residuals" + RmsText(fit) + " exceed the noise. " + MisfitText(fit, is_one_of_several);
    summary.emphasis = Emphasis::kCaution;
    is_said("lack_of_fit");
  } else if (constancy != nullptr && !constancy->verdict.empty() && !constancy->constant()) {
    summary.verdict = law + " describes the readings, but not with constant parameters: " +
                      WithFullStop(Printable(constancy->verdict));
    summary.emphasis = Emphasis::kCaution;
    is_said("not_constant");
  } else if (fit.noise.autocorrelation.kind != Autocorrelation::Kind::kWhite) {
    summary.verdict = law + " describes the readings; autocorrelated noise" + RmsText(fit) +
                      " remains, and the errors allow for that.";
  } else {
    summary.verdict = law + " describes the readings; noise" + RmsText(fit) + " remains.";
  }
  is_said("suspected_");
  if (fit.noise.autocorrelation.kind != Autocorrelation::Kind::kWhite) is_said("correlated_residuals");
  const std::string corrected = SuspectedText(fit, true);
  if (corrected.empty()) return;
  summary.verdict += " The readings were corrected for " + corrected + ".";
  summary.emphasis = Emphasis::kCaution;
}

/// Says that the rig's own inertia contradicts the fit, in the place of the warning.
void SetRigVerdict(const std::optional<RigVerdict>& rig, FitSummary& summary) {
  if (!rig || !rig->differs() || summary.emphasis == Emphasis::kAlarm) return;
  summary.verdict += " " + WithFullStop(rig->brief);
  summary.emphasis = Emphasis::kCaution;
  std::erase_if(summary.warnings, [](const Warning& warning) { return warning.code == "inertia_differs_from_rig"; });
}

/// What is unknown of a recording that is too short for a test of constancy.
std::string UntestedText(const Constancy* constancy, const FitReport& fit) {
  if (constancy == nullptr || !constancy->is_too_short_for_halves()) return "";
  const bool has_law_error = std::ranges::any_of(fit.parameters, [](const ParameterEstimate& parameter) {
    return parameter.systematic.Of(ErrorSource::kFrictionLaw) > 0;
  });
  return "Constancy is not tested (" + std::to_string(*constancy->half_swings) + " half swings are too few)" +
         (has_law_error ? "; the errors allow for another friction law."
                        : ": another recording may differ by more than these errors.");
}

/// The parameters that change by more than their standard errors; the total errors include that.
std::string ChangingText(const FitReport& fit) {
  std::string names;
  for (const ParameterEstimate& parameter : fit.parameters) {
    if (parameter.systematic.Of(ErrorSource::kInconstancy) > 0) AddListed(std::string(parameter.info.name), names);
  }
  return names.empty() ? "" : "Not constant (the errors include that): " + names + ".";
}

/// Whether several recordings agree. Without a test nothing is known of that.
void SetAgreement(const Homogeneity& homogeneity, FitSummary& summary) {
  summary.agreement = WithFullStop(Capitalized(Printable(homogeneity.verdict)));
  if (!homogeneity.p || homogeneity.matters) summary.agreement_emphasis = Emphasis::kCaution;
  if (summary.emphasis == Emphasis::kAlarm) return;
  const bool is_mixed = homogeneity.has_different_rigs();  // which explains what the law does not describe
  const bool has_doubts = !is_mixed && summary.emphasis == Emphasis::kCaution;
  if (summary.agreement_emphasis == Emphasis::kCaution) summary.emphasis = Emphasis::kCaution;
  const auto warning =
      std::ranges::find_if(summary.warnings, [](const Warning& each) { return each.code == "recordings_disagree"; });
  if (warning == summary.warnings.end()) return;
  summary.verdict =
      WithFullStop(Capitalized(summary.TextOf(*warning))) + (has_doubts ? " " + summary.verdict : std::string());
  if (is_mixed) summary.emphasis = summary.agreement_emphasis = Emphasis::kAlarm;
  summary.warnings.erase(warning);
}

/// What the formula assumes, or what disturbs it.
std::string CauseWords(DifferenceCause cause) {
  switch (cause) {
    case DifferenceCause::kFormula: return "it assumes viscous friction alone";
    case DifferenceCause::kDrift: return "it assumes a constant zero";
    case DifferenceCause::kAmplitude: return "it assumes small angles";
    case DifferenceCause::kSampling: return "few samples at turning points";
    case DifferenceCause::kResolution: return "coarse readings";
    case DifferenceCause::kRecording: return "noise, or another law";
  }
  return "";
}

/// "I_O 0.0445 (1.6 % more: it assumes small angles)".
std::string FormulaText(const ClosedFormRow& row, std::string_view symbol) {
  constexpr int kDigits = 4;
  const std::string text = std::string(symbol) + " " + SignificantText(row.closed_form, kDigits);
  const double ratio = row.closed_form / row.fit;
  constexpr double kNear = 0.1;
  if (row.agrees.value_or(true)) {
    return text + (std::abs(ratio - 1) < kNear ? " (agrees)" : " (agrees within the errors)");
  }
  constexpr double kTimes = 1.5, kMost = 100;  // more is said as a factor, far more only as "far more"
  const std::string size = !(ratio > 0 && ratio < kMost) ? "far from the fit's value"
                           : ratio > kTimes
                               ? SignificantText(ratio, 2) + " times as large"
                               : SignificantText(100 * std::abs(ratio - 1), 2) + (ratio > 1 ? " % more" : " % less");
  return text + " (" + size + (row.cause ? ": " + CauseWords(*row.cause) : "") + ")";
}

/// What log decrement and small angles give.
std::string TextbookText(const ClosedFormCheck* check) {
  if (check == nullptr) return "";
  constexpr std::array kFormulas = {std::pair{"inertia_small_angle", "I_O"}, std::pair{"viscous_log_decrement", "b"}};
  std::string text;
  for (const auto& [quantity, symbol] : kFormulas) {
    const auto row = std::ranges::find(check->rows, quantity, &ClosedFormRow::quantity);
    if (row == check->rows.end()) continue;
    text += (text.empty() ? "The textbook's log decrement gives " : ", ") + FormulaText(*row, symbol);
  }
  return text.empty() ? "" : text + ".";
}

/// The warnings that are no assumptions, serious ones first.
std::vector<Warning> WithoutAssumptions(std::vector<Warning> warnings) {
  std::erase_if(warnings, [](const Warning& warning) { return !warning.assumed.empty(); });
  std::ranges::stable_partition(warnings, [](const Warning& warning) { return warning.code.is_serious(); });
  return warnings;
}

// ---- Assumptions ----------------------------------------------------------------------------------------------------

/// Adds an assumption if it is not among them.
void AddOnce(std::string text, std::vector<std::string>& assumptions) {
  if (!text.empty() && std::ranges::find(assumptions, text) == assumptions.end())
    assumptions.push_back(std::move(text));
}

/// What was assumed of sensors and clocks, if errors follow from it.
void AddSensors(const Identification& identification, std::vector<std::string>& assumptions) {
  for (const IdentifiedRecording& recording : identification.recordings) {
    for (const std::string& assumed : SensorAssumptions(recording.data.sensor)) AddOnce(assumed, assumptions);
  }
}

/// What one swing cannot tell, unless the rig's own inertia agrees or disagrees with the fit.
std::string UntoldText(const std::optional<RigVerdict>& rig, bool is_spring) {
  if (rig && rig->z) return "";
  return std::string("firm support, ") + (is_spring ? "" : "no spring, ") + "no gear (else an effective inertia)";
}

std::vector<std::string> AssumptionsOf(const std::vector<Warning>& warnings) {
  std::vector<std::string> assumptions;
  for (const Warning& warning : warnings) {
    AddOnce(Printable(warning.assumed), assumptions);
  }
  return assumptions;
}

// ---- Comparison -----------------------------------------------------------------------------------------------------

/// The last cell of a law in the comparison.
std::string VerdictOf(const ComparisonRow& row, bool is_recommended) {
  if (is_recommended) return row.lack_of_fit ? "recommended, with lack of fit" : "recommended";
  return row.lack_of_fit ? "lack of fit" : "";
}

/// Why a law has no result, without what follows from that.
std::string ShortReason(const Identification& identification, const ComparisonRow& row) {
  const auto fit =
      std::ranges::find(identification.fits, row.model, [](const FitReport& each) { return each.model.name; });
  const Warning* const why = fit == identification.fits.end() ? nullptr : fit->ReasonWarning();
  return why == nullptr ? row.reason : std::string(TerminationName(fit->termination)) + ": " + ShortText(*why);
}

void SetComparison(const Identification& identification, ResultSummary& summary) {
  const Comparison& comparison = *identification.comparison;
  const bool recommends = !comparison.recommended.empty();
  const std::string reason = WithFullStop(Printable(comparison.reason));
  summary.comparison = recommends ? "Recommended: " + comparison.recommended + ": " + reason : Capitalized(reason);
  const Conversion shown = Degrees(identification.unit).value_or(Conversion{identification.unit});
  for (const ComparisonRow& row : comparison.rows) {
    if (!row.judged) {
      summary.without_result += (summary.without_result.empty() ? "No result with " : " No result with ") + row.model +
                                ": " + WithFullStop(Printable(ShortReason(identification, row)));
      continue;
    }
    SummaryLaw law{row.model, SignificantText(shown.factor * row.rms, kRmsDigits) + " " + std::string(shown.unit),
                   row.delta_bic && std::isfinite(*row.delta_bic) ? FixedText(*row.delta_bic, 1) : "",
                   VerdictOf(row, row.model == comparison.recommended)};
    summary.laws.push_back(std::move(law));
  }
}

// ---- Without a fit --------------------------------------------------------------------------------------------------

/// What the linear formulas give.
FitSummary SummarizeClosedForms(const Identification& identification) {
  FitSummary summary;
  summary.path = identification.path();
  summary.assumptions = AssumptionsOf(AllWarnings(identification));
  summary.warnings = WithoutAssumptions(AllWarnings(identification));
  summary.verdict = "Nothing was fitted: these are formulas of the linear pendulum, with standard errors from noise.";
  const std::optional<ClosedForms>& known = identification.recordings.front().closed_forms;
  if (!known || !known->linear) return summary;
  const ClosedForms& forms = *known;
  for (const ReportedEstimate& reported : LinearEstimates(*forms.linear, forms.gravity, identification.si_rig())) {
    summary.parameters.push_back(
        Quantity(reported.name, reported.symbol, reported.estimate.value, reported.estimate.std_error, reported.unit));
    summary.parameters.back().source = "noise";
  }
  return summary;
}

}  // namespace

std::string TitleOf(const Identification& identification, const std::string& without_name) {
  const std::size_t count = identification.recordings.size();
  if (count > 1) return std::to_string(count) + " recordings of one rig";
  return identification.path().empty() ? without_name : Printable(identification.path());
}

std::string FitSummary::TextOf(const Warning& warning) const { return Printable(ShortText(warning, path)); }

FitSummary SummarizeFit(const Identification& identification, std::size_t index) {
  FitSummary summary;
  summary.path = identification.path();
  const FitReport& fit = identification.fits[index];
  const std::vector<Warning> warnings = WarningsOfFit(identification, index);
  summary.assumptions = AssumptionsOf(warnings);
  summary.warnings = WithoutAssumptions(warnings);
  summary.law = fit.model.name;
  if (!identification.is_joint()) {  // the ends of the window say it
    for (const std::string_view code : {"ends_trimmed", "presliding"}) EraseWarnings(code, summary);
  }
  const AcrossRecordings& across = identification.across[index];
  const IdentifiedRecording* const only = identification.is_joint() ? nullptr : &identification.recordings.front();
  const Constancy* const constancy = only == nullptr ? nullptr : only->ConstancyOf(index);
  SetVerdict(fit, constancy, UndescribedOf(identification, index), identification.fits.size() > 1, summary);
  if (across.homogeneity) SetAgreement(*across.homogeneity, summary);
  if (fit.termination != Termination::kConverged) return summary;
  for (const ParameterEstimate& parameter : fit.parameters) {
    summary.parameters.push_back(QuantityOf(parameter, identification.rig));
    summary.has_systematic = summary.has_systematic || parameter.systematic.Total().has_value();
  }
  if (summary.has_systematic) AddSensors(identification, summary.assumptions);
  const std::optional<RigVerdict> verdict = JudgeInertia(identification.rig, fit);
  if (!identification.is_joint()) SetRigVerdict(verdict, summary);
  summary.untold = UntoldText(verdict, fit.model.gravity.is_linear());
  summary.remarks = RemarksText(fit);
  summary.advice = LargestErrorText(fit);
  if (const std::string untested = UntestedText(constancy, fit); !untested.empty()) {
    summary.remarks += (summary.remarks.empty() ? "" : " ") + untested;
  }
  if (const std::string changing = ChangingText(fit);
      !changing.empty() && HasWarning(summary.warnings, "not_constant")) {
    summary.remarks += (summary.remarks.empty() ? "" : " ") + changing;
    EraseWarnings("not_constant", summary);
  }
  summary.losses = LossesText(fit);
  summary.derived = DerivedOf(fit);
  if (identification.SharesMotion(index)) {
    summary.equation = WithoutZeroTerms(FittedEquation(fit, identification.si_rig(), EquationDigits::kOfTotalError));
  }
  if (!identification.si_rig()) {
    summary.units = fit.model.gravity.is_linear()
                        ? "In units of the stiffness k; a known stiffness (--stiffness) gives SI."
                        : "In units of the gravity torque G; masses and length (--rig) give SI.";
  }
  if (only != nullptr) summary.textbook = TextbookText(only->CheckOf(index));
  return summary;
}

ResultSummary SummarizeResult(const Identification& identification) {
  ResultSummary summary;
  summary.title = TitleOf(identification, "Recording");
  summary.data =
      identification.is_joint() ? JointDataText(identification) : DataText(identification.recordings.front().data);
  if (identification.comparison) SetComparison(identification, summary);
  summary.fit = identification.fits.empty() ? SummarizeClosedForms(identification)
                                            : SummarizeFit(identification, identification.MainFit());
  return summary;
}

std::string QuietText(const Identification& identification) {
  constexpr int kDigits = 10, kErrorDigits = 3;
  if (identification.fits.empty()) return "";
  std::string text;
  for (const ParameterEstimate& parameter : identification.fits[identification.MainFit()].parameters) {
    const auto total = TotalStdError(parameter.std_error, parameter.systematic);
    text += std::string(parameter.info.name) + " " + NumberText(parameter.estimate, kDigits) + " " +
            (total ? NumberText(*total, kErrorDigits) : "-") + " " + parameter.unit + "\n";
  }
  return text;
}

namespace {

nlohmann::ordered_json QuantitiesJson(const std::vector<SummaryQuantity>& quantities) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const SummaryQuantity& quantity : quantities) {
    array.push_back({{"name", WithBlanks(quantity.name)},
                     {"symbol", quantity.symbol},
                     {"value", quantity.value},
                     {"error", quantity.error},
                     {"unit", quantity.unit},
                     {"source", quantity.source}});
  }
  return array;
}

}  // namespace

nlohmann::ordered_json FitSummaryJson(const FitSummary& summary) {
  const std::string level = summary.emphasis == Emphasis::kAlarm     ? "bad"
                            : summary.emphasis == Emphasis::kCaution ? "caution"
                                                                     : "good";
  nlohmann::ordered_json messages = nlohmann::ordered_json::array();
  for (const Warning& warning : summary.warnings) messages.push_back(summary.TextOf(warning));
  std::vector<std::string> assumptions = summary.assumptions;
  AddOnce(summary.untold, assumptions);
  return {{"verdict", summary.verdict},
          {"level", level},
          {"agreement", summary.agreement},
          {"parameters", QuantitiesJson(summary.parameters)},
          {"derived", QuantitiesJson(summary.derived)},
          {"equation", summary.equation},
          {"units", summary.units},
          {"textbook", summary.textbook},
          {"losses", WithBlanks(summary.losses)},
          {"remarks", WithBlanks(summary.remarks)},
          {"advice", WithBlanks(summary.advice)},
          {"assumptions", std::move(assumptions)},
          {"warnings", messages}};
}

}  // namespace pendulum
