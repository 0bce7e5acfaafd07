// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/frequency_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/period.h"
#include "pendulum/closed_form/turning_points.h"

namespace pendulum {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

/// Difference in phase [rad] between neighbouring frequencies at the end of the scanned part.
constexpr double kPhaseStep = 0.6;

/// The first samples determine the frequency well enough for the solver, which then uses the remaining ones.
constexpr Index kMaxScanSamples = 150;

/// A linear oscillation describes the first periods of a pendulum well enough to find the sensor's scale.
constexpr Index kMaxOscillationSamples = 60;

constexpr std::size_t kMaxStarts = 12;

/// Decay of the amplitude over the scanned part: to a share `end` of its first value, exponentially (viscous friction)
/// or linearly (dry friction). If a linear `end` is below 0, the motion stops earlier.
struct Envelope {
  bool exponential;
  double end;

  /// Amplitude after the share `part` of the scanned time, divided by the first amplitude.
  double At(double part) const {
    constexpr double kMinAmplitude = 0.02;  // a pendulum at rest has no phase
    return std::max(exponential ? std::pow(end, part) : 1 - (1 - end) * part, kMinAmplitude);
  }
};

constexpr std::array kEnvelopes = {Envelope{true, 0.95}, Envelope{true, 0.75},  Envelope{true, 0.5},
                                   Envelope{true, 0.25}, Envelope{true, 0.08},  Envelope{false, 0.5},
                                   Envelope{false, 0.1}, Envelope{false, -0.5}, Envelope{false, -2.0}};

/// A least-squares fit at one frequency.
struct Candidate {
  double frequency = 0;  ///< rad/s
  Envelope envelope = kEnvelopes[0];
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();  ///< Of A cos φ, A sin φ and 1; A = 1 at the first sample.
  double rss = kUnbounded;

  /// Amplitude of the reading at the first sample.
  double amplitude() const { return std::hypot(coefficients[0], coefficients[1]); }
};

/// The samples to scan.
class Scan {
 public:
  Scan(const Recording& recording, Gravity gravity, Index max_samples, const std::stop_token& stop)
      : quantity_(recording.quantity),
        gravity_(gravity),
        time_(recording.clock_scale *
              (recording.time.head(std::min(recording.size(), max_samples)).array() - recording.time[0])),
        value_(recording.value.head(time_.size())),
        stop_(stop) {}

  double duration() const { return time_[time_.size() - 1]; }
  double half_range() const { return 0.5 * (value_.maxCoeff() - value_.minCoeff()); }

  /// The best envelope at each frequency, for a first reading amplitude of about `amplitude`. Incomplete after a stop
  /// request.
  std::vector<Candidate> At(const std::vector<double>& frequencies, double amplitude) const {
    std::vector<Candidate> best(frequencies.size());
    for (const Envelope& envelope : kEnvelopes) {
      const ArrayXd decay = (time_ / duration()).unaryExpr([&](double part) { return envelope.At(part); });
      ArrayXd warped;
      for (std::size_t i = 0; i < frequencies.size() && !stop_.stop_requested(); ++i) {
        // For a rate, the angle's amplitude depends on the frequency; for an angle it does not.
        if (i == 0 || quantity_ == Quantity::kRate) warped = WarpedTime(amplitude * decay, frequencies[i]);
        Candidate trial{frequencies[i], envelope};
        Solve(decay, frequencies[i] * warped, trial);
        if (trial.rss < best[i].rss) best[i] = trial;
      }
    }
    return best;
  }

 private:
  /// ∫ dt / PeriodRatio [s]: the phase at 1 rad/s. `amplitude` is in units of the reading.
  ArrayXd WarpedTime(const ArrayXd& amplitude, double frequency) const {
    if (gravity_.is_linear()) return time_;
    const ArrayXd speed = amplitude.unaryExpr([&](double reading) {
      return 1 / gravity_.PeriodRatio(AngleAmplitude(quantity_, reading, frequency, gravity_));
    });
    ArrayXd warped = ArrayXd::Zero(time_.size());
    for (Index i = 1; i < time_.size(); ++i) {
      warped[i] = warped[i - 1] + 0.5 * (speed[i] + speed[i - 1]) * (time_[i] - time_[i - 1]);
    }
    return warped;
  }

  void Solve(const ArrayXd& decay, const ArrayXd& phase, Candidate& candidate) const {
    constexpr double kRidge = 1e-6;  // if sampled once per cycle, two columns are equal
    Eigen::MatrixX3d basis(time_.size(), 3);
    basis << decay * phase.cos(), decay * phase.sin(), ArrayXd::Ones(time_.size());
    Eigen::Matrix3d normal = basis.transpose() * basis;
    normal.diagonal() *= 1 + kRidge;
    candidate.coefficients = normal.ldlt().solve(basis.transpose() * value_);
    candidate.rss = (value_ - basis * candidate.coefficients).squaredNorm();
  }

  Quantity quantity_;
  Gravity gravity_;
  ArrayXd time_;
  Eigen::VectorXd value_;
  const std::stop_token& stop_;
};

std::vector<double> Grid(const FrequencyRange& range, double duration) {
  // A grid that would need more is made coarser: such recordings do not determine a frequency.
  constexpr double kMaxFrequencies = 20'000;
  const double step = std::max(kPhaseStep / duration, (range.high - range.low) / kMaxFrequencies);
  const auto count = static_cast<std::size_t>(std::ceil(std::max(range.high - range.low, 0.0) / step));
  std::vector<double> grid;
  for (std::size_t i = 0; i <= count; ++i) {
    const double share = count == 0 ? 0.0 : static_cast<double>(i) / static_cast<double>(count);
    grid.push_back(range.low + share * (range.high - range.low));
  }
  return grid;
}

/// Local minima over frequency, the best first; at most kMaxStarts.
std::vector<Candidate> LocalMinima(const std::vector<Candidate>& candidates) {
  std::vector<Candidate> minima;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool falls = i == 0 || candidates[i].rss < candidates[i - 1].rss;
    const bool rises = i + 1 == candidates.size() || candidates[i].rss <= candidates[i + 1].rss;
    if (falls && rises) minima.push_back(candidates[i]);
  }
  std::ranges::sort(minima, {}, &Candidate::rss);
  if (minima.size() > kMaxStarts) minima.resize(kMaxStarts);
  return minima;
}

/// The turning points that a candidate predicts, relative to its zero, without their times.
TurningPointTable TurnsOf(const Candidate& candidate, Quantity quantity, double duration) {
  constexpr double kMaxHalfSwings = 200;
  TurningPointTable table;
  table.quantity = quantity;
  const double half_swings = std::clamp(candidate.frequency * duration / kPi, 2.0, kMaxHalfSwings);
  const double step = kPi / candidate.frequency / duration;
  const auto reading = [&](double turns) { return candidate.amplitude() * candidate.envelope.At(turns * step); };
  table.points.push_back({.value = reading(0)});
  for (double i = 0; i < half_swings; ++i) table.points.push_back({.value = reading(i + 1), .continues = true});
  return table;
}

/// Angle and rate at the first sample from the reading and its slope there, as in EstimateStartValues.
std::array<double, 2> InitialState(const Candidate& candidate, Quantity quantity, Gravity gravity, double amplitude) {
  const double ratio = gravity.PeriodRatio(amplitude);
  const double reading = candidate.coefficients[0];
  const double slope = candidate.coefficients[1] * candidate.frequency / ratio;
  if (quantity == Quantity::kAngle) return {reading, slope};
  const double square = candidate.frequency * candidate.frequency;
  const double torque = -slope / square;  // θ'' = -ω0² g(θ)
  const double peak = candidate.amplitude();
  return {gravity.AngleAt(torque, (peak * peak - reading * reading) / (2 * square)), reading};
}

StartValues StartAt(const Candidate& candidate, const Recording& recording, const MotionModel& model, double duration) {
  const TurningPointTable table = TurnsOf(candidate, recording.quantity, duration);
  StartValues values;
  values.start = StartKind::kMoving;
  values.natural_frequency = candidate.frequency;
  values.amplitude = AngleAmplitude(recording.quantity, candidate.amplitude(), candidate.frequency, model.gravity);
  values.energy_balance = BalanceEnergy(model, table, candidate.frequency).front();
  values.parameters = {1 / (candidate.frequency * candidate.frequency)};
  const std::vector<double> friction = FrictionFrom(values.energy_balance);
  values.parameters.insert(values.parameters.end(), friction.begin(), friction.end());
  const auto state = InitialState(candidate, recording.quantity, model.gravity, values.amplitude);
  values.parameters.insert(values.parameters.end(), {state[0], state[1], candidate.coefficients[2]});
  return values;
}

}  // namespace

/// Scans twice. The first scan uses an amplitude from the range of the samples, the second uses the amplitude of the
/// best fit.
std::vector<StartValues> ScanFrequencies(const Recording& recording, const MotionModel& model,
                                         const FrequencyRange& range, const std::stop_token& stop) {
  constexpr double kMaxAmplitude = 3;  // in half ranges of the samples; the true amplitude is rarely larger
  const Scan scan(recording, model.gravity, kMaxScanSamples, stop);
  const std::vector<double> frequencies = Grid(range, scan.duration());
  const std::vector<Candidate> rough = scan.At(frequencies, scan.half_range());
  const Candidate& best = *std::ranges::min_element(rough, {}, &Candidate::rss);
  const double amplitude = std::min(best.amplitude(), kMaxAmplitude * scan.half_range());
  const std::vector<Candidate> fine = scan.At(frequencies, amplitude);
  if (stop.stop_requested()) return {};
  std::vector<StartValues> starts;
  for (const Candidate& candidate : LocalMinima(fine)) {
    starts.push_back(StartAt(candidate, recording, model, scan.duration()));
  }
  return starts;
}

std::vector<Oscillation> ScanOscillations(const Recording& view, const FrequencyRange& range,
                                          const std::stop_token& stop) {
  constexpr double kNearlyAsWell = 4;  // times the smallest sum of squares; other minima are side lobes
  const Scan scan(view, Gravity::kLinear, kMaxOscillationSamples, stop);
  const std::vector<Candidate> minima = LocalMinima(scan.At(Grid(range, scan.duration()), scan.half_range()));
  std::vector<Oscillation> oscillations;
  for (const Candidate& candidate : minima) {
    if (candidate.rss > kNearlyAsWell * minima.front().rss) break;
    oscillations.push_back({candidate.coefficients[2], candidate.amplitude(), candidate.frequency});
  }
  return oscillations;
}

}  // namespace pendulum
