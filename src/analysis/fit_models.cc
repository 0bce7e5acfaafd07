// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/fit_models.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "pendulum/model/nesting.h"

namespace pendulum {
namespace {

/// Names of inertia and friction, without those of the start, which every model has.
std::set<std::string, std::less<>> NamesOf(const std::string& model) {
  std::set<std::string, std::less<>> names;
  const Result<MotionModel> found = FindMotionModel(model);
  if (!found) return names;
  for (const ParameterInfo& info : PhysicalParameters(*found)) names.emplace(info.name);
  return names;
}

/// The model that determines the window: the model with the most parameters among those with the default gravity, if
/// there are any.
std::size_t Richest(const std::vector<std::string>& models) {
  std::size_t richest = 0;
  std::pair<bool, std::size_t> most;  // whether the gravity is the default, number of parameters
  for (std::size_t i = 0; i < models.size(); ++i) {
    const Result<MotionModel> model = FindMotionModel(models[i]);
    if (!model) continue;
    // A model with a parameter that has no meaning in some recordings is the last choice.
    const std::size_t parameters = FindOrderedPair(*model).larger >= 0 ? 1 : PhysicalParameters(*model).size();
    const std::pair size{model->gravity == Gravity(), parameters};
    if (size <= most) continue;
    most = size;
    richest = i;
  }
  return richest;
}

FitReport FailedFit(const std::string& model, const FitReport& like, const Status& status) {
  FitReport fit;
  fit.model = *FindMotionModel(model);
  fit.termination = Termination::kFailed;
  fit.reason = status.sentence;  // the report is of this recording
  fit.start = like.start;
  fit.quantity = like.quantity;
  fit.reading_unit = like.reading_unit;
  return fit;
}

/// Warnings of the richest law that hold for every model. If the recording is not a pendulum's swing, or its zero
/// jumps, no fit counts as converged. Whether an acceleration contains gravity is only said.
void ApplySharedWarnings(const FitReport& richest_fit, FitReport& fit) {
  const Warning* const of_gravity = FindWarning(richest_fit.warnings, "gravity_in_readings");
  if (of_gravity != nullptr && !fit.HasWarning("gravity_in_readings"))
    fit.warnings.insert(fit.warnings.begin(), *of_gravity);
  const auto said = std::ranges::find_if(richest_fit.warnings, [](const Warning& warning) {
    return warning.code == "not_a_pendulum" || warning.code == "offset_jumps";
  });
  if (said == richest_fit.warnings.end() || fit.termination == Termination::kFailed) return;
  const char* const without_errors = said->code == "offset_jumps" ? "the zero jumps" : "not a pendulum";
  Reject(Termination::kNotConverged, MessageText(*said), without_errors, fit);
  fit.reason_code = said->code;
}

/// Reports that the fit of a model begins. A model that is fitted again has no place in the count.
void ReportFit(const FitOptions& options, const std::vector<std::string>& models, std::size_t model, std::size_t done) {
  const bool is_counted = done < models.size();
  ReportProgress(options.progress, "fitting " + models[model], is_counted ? static_cast<int>(done) : 0,
                 is_counted ? static_cast<int>(models.size()) : 0);
}

/// The fits of one call of FitModels.
class SharedFits {
 public:
  SharedFits(SwingFit richest_fit, std::size_t richest_index, FitOptions options,
             const std::vector<std::string>& models)
      : options_(std::move(options)),
        models_(models),
        result_{std::move(richest_fit.used), std::move(richest_fit.swing), {}} {
    options_.start = OptionsLike(richest_fit.fit, options_).start;
    options_.search.may_correct = options_.search.may_correct && models.size() == 1;
    result_.fits.resize(models.size());
    const bool is_corrected = richest_fit.fit.correction.size() > 0;
    result_.fits[richest_index] = std::move(richest_fit.fit);
    if (is_corrected && models.size() > 1) FitAgain(richest_index, FitReport(result_.fits[richest_index]));
    for (std::size_t i = 0; i < models.size(); ++i) {
      if (i != richest_index) Fit(i, result_.fits[richest_index]);
    }
    ShareNoise(richest_index);
  }

  FittedRecording Take() && { return std::move(result_); }

 private:
  void Fit(std::size_t i, const FitReport& richest_fit) {
    ReportFit(options_, models_, i, done_++);
    auto [options, ignored] = ForModel(options_, models_[i], models_);
    Result<FitReport> fit = FitRecording(result_.used, options);
    result_.fits[i] = fit ? *std::move(fit) : FailedFit(models_[i], richest_fit, fit.error());
    ApplySharedWarnings(richest_fit, result_.fits[i]);
  }

  /// Fits model i again and keeps what the former fit said of the window.
  void FitAgain(std::size_t i, const FitReport& richest_fit) {
    std::vector<Warning> said = std::move(result_.fits[i].warnings);
    Fit(i, richest_fit);
    std::vector<Warning>& warnings = result_.fits[i].warnings;
    for (Warning& warning : said) {
      constexpr std::array<WarningCode, 10> kOfWindow = {
          "ends_trimmed", "larger_motion_outside", "not_a_pendulum", "lost_counts",   "offset_jumps", "presliding",
          "vibration",    "ambiguous_frequency",   "hold_left_out",  "hold_disagrees"};
      const bool of_window = std::ranges::find(kOfWindow, warning.code) != kOfWindow.end();
      if (of_window && !HasWarning(warnings, warning.code)) warnings.push_back(std::move(warning));
    }
  }

  /// Fits all models with the noise family of the fit with the smallest residuals, because likelihoods can be compared
  /// only within one family.
  void ShareNoise(std::size_t richest_index) {
    const auto best = std::ranges::min_element(result_.fits, {}, [](const FitReport& fit) {
      return fit.termination == Termination::kFailed ? kUnbounded : fit.statistics.rms_residual;
    });
    const NoiseFamily family = best->noise.family;
    options_.noise = OptionsLike(*best, options_).noise;
    const FitReport richest_fit = result_.fits[richest_index];
    for (std::size_t i = 0; i < models_.size(); ++i) {
      const FitReport& fit = result_.fits[i];
      if (fit.termination != Termination::kFailed && fit.noise.family != family) FitAgain(i, richest_fit);
    }
  }

  FitOptions options_;
  const std::vector<std::string>& models_;
  FittedRecording result_;
  std::size_t done_ = 1;
};

/// For an undersampled swing: each model searches aliased frequencies itself. A model that chose another noise family
/// than the model with the smallest residuals is fitted again with the family of that model.
Result<FittedRecording> FitEach(const Recording& recording, const FreeSwing& swing, FitOptions options,
                                const std::vector<std::string>& models) {
  options.search.may_correct = options.search.may_correct && models.size() == 1;
  std::vector<Result<SwingFit>> fits;
  fits.reserve(models.size());
  for (std::size_t i = 0; i < models.size(); ++i) {
    ReportFit(options, models, i, i);
    fits.push_back(FitSwing(recording, swing, ForModel(options, models[i], models).options));
  }
  const auto best = std::ranges::min_element(fits, {}, [](const Result<SwingFit>& fit) {
    const bool is_fitted = fit && fit->fit.termination != Termination::kFailed;
    return is_fitted ? fit->fit.statistics.rms_residual : kUnbounded;
  });
  if (!*best) return tl::unexpected(fits.front().error());
  const FitReport like = (*best)->fit;
  FitOptions shared = options;
  shared.noise = OptionsLike(like, options).noise;
  FittedRecording fitted{(*best)->used, (*best)->swing, {}};
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (fits[i] && fits[i]->fit.noise.family != like.noise.family) {
      fits[i] = FitSwing(recording, swing, ForModel(shared, models[i], models).options);
    }
    fitted.fits.push_back(fits[i] ? fits[i]->fit : FailedFit(models[i], like, fits[i].error()));
  }
  return fitted;
}

void WarnOfIgnored(const FitOptions& options, const std::vector<std::string>& models, FittedRecording& fitted) {
  for (FitReport& fit : fitted.fits) {
    const std::string model(fit.model.name);
    for (const std::string& name : ForModel(options, model, models).ignored) {
      std::string finding = "model ";
      finding.append(model).append(" has no ").append(name);
      fit.warnings.push_back({.code = "ignored_parameter",
                              .finding = std::move(finding),
                              .explanation = "its options are ignored for this model",
                              .about = {.parameters = {name}}});
    }
  }
}

}  // namespace

OptionsForModel ForModel(const FitOptions& options, const std::string& model, const std::vector<std::string>& models) {
  OptionsForModel own{options, {}};
  own.options.model = model;
  const auto names = NamesOf(model);
  std::set<std::string, std::less<>> others;
  for (const std::string& other : models) others.merge(NamesOf(other));
  std::set<std::string> ignored;
  const auto narrow = [&](auto& map) {
    std::erase_if(map, [&](const auto& entry) {
      const bool only_others = others.contains(entry.first) && !names.contains(entry.first);
      if (only_others) ignored.insert(entry.first);
      return only_others;
    });
  };
  narrow(own.options.fixed);
  narrow(own.options.initial);
  narrow(own.options.bounds);
  narrow(own.options.priors);
  own.ignored.assign(ignored.begin(), ignored.end());
  return own;
}

std::vector<std::string> PhysicalNames(const std::vector<std::string>& models) {
  std::vector<std::string> names;
  for (const std::string& name : models) {
    const Result<MotionModel> model = FindMotionModel(name);
    if (!model) continue;
    for (const ParameterInfo& info : PhysicalParameters(*model)) {
      if (std::ranges::find(names, info.name) == names.end()) names.emplace_back(info.name);
    }
  }
  return names;
}

Result<void> CheckModels(const Recording& recording, const FreeSwing& swing, const FitOptions& options,
                         const std::vector<std::string>& models) {
  return CheckSwing(recording, swing, ForModel(options, models[Richest(models)], models).options);
}

Result<FittedRecording> FitModels(Recording recording, const FreeSwing& swing, const FitOptions& options,
                                  const std::vector<std::string>& models) {
  Result<FittedRecording> fitted;
  if (swing.undersampled) {
    fitted = FitEach(recording, swing, options, models);
  } else {
    const std::size_t richest_index = Richest(models);
    ReportFit(options, models, richest_index, 0);
    const FitOptions richest_options = ForModel(options, models[richest_index], models).options;
    ASSIGN_OR_RETURN(SwingFit richest_fit, FitSwing(std::move(recording), swing, richest_options));
    fitted = SharedFits(std::move(richest_fit), richest_index, options, models).Take();
  }
  if (options.stop.stop_requested()) return FitStopped();
  if (!fitted) return fitted;
  if (models.size() > 1) WarnOfIgnored(options, models, *fitted);
  return fitted;
}

}  // namespace pendulum
