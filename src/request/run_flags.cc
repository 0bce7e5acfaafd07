// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/run_flags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <string_view>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/oversampling.h"
#include "pendulum/recording/sensor_statement.h"
#include "pendulum/request/flag_values.h"
#include "pendulum/request/rig_flags.h"

namespace pendulum {
namespace {

Result<int> ParseRelease(const RunFlags& flags) {
  if (flags.release.empty()) return SwingChoice::kMostTelling;
  if (flags.release == "all") return SwingChoice::kAll;
  const auto number = ParseNumber("--release", flags.release, "all, or the number of a release from 1 on");
  if (!number) return tl::unexpected(number.error());
  if (*number >= 1 && *number == std::floor(*number) && *number < 1e6) return static_cast<int>(*number);
  return BadFlag("--release is '" + flags.release + "'; it must be all, or the number of a release from 1 on");
}

/// A word, its meaning, and its label in the form of the service.
template <typename Meaning>
struct Word {
  std::string_view word;
  Meaning meaning;
  std::string_view label = {};
};

template <typename Meaning, std::size_t kWords>
Result<Meaning> ParseWord(std::string_view flag, const std::string& value,
                          const std::array<Word<Meaning>, kWords>& words) {
  std::vector<std::string_view> names;
  for (const auto& [word, meaning, label] : words) {
    if (word == value) return meaning;
    names.push_back(word);
  }
  return BadFlag(std::string(flag) + " is '" + value + "'; it must be one of " + NameList(names));
}

using StartWord = Word<std::optional<StartKind>>;
constexpr std::array<StartWord, 3> kStarts = {{{"auto", std::nullopt, "found in the recording"},
                                               {"release", StartKind::kRelease, "held at rest, then released"},
                                               {"moving", StartKind::kMoving, "already swinging"}}};
using GravityWord = Word<std::optional<Gravity>>;
constexpr std::array<GravityWord, 3> kGravities = {{{"auto", std::nullopt, "gravity, or a spring if one shows"},
                                                    {"sin", Gravity::kSine, "gravity: a pendulum"},
                                                    {"linear", Gravity::kLinear, "a spring, or a torsion wire"}}};
using NoiseWord = Word<std::optional<NoiseFamily>>;
constexpr std::array<NoiseWord, 5> kNoises = {
    {{"auto", std::nullopt, "found in the recording"},
     {"gaussian", NoiseFamily::kGaussian, "even scatter"},
     {"quantized", NoiseFamily::kQuantized, "rounding to the steps of the sensor"},
     {"averaged", NoiseFamily::kAveraged, "means of several readings"},
     {"edges", NoiseFamily::kEdges, "edges of an encoder’s counts"}}};
constexpr std::array<NoiseWord, 3> kLosses = {{{"none", std::nullopt, "there are none"},
                                               {"huber", NoiseFamily::kHuber, "count less (Huber)"},
                                               {"student", NoiseFamily::kStudent, "are expected (Student’s t)"}}};
constexpr std::array<Word<IntervalMethod>, 4> kIntervals = {
    {{"auto", IntervalMethod::kAuto, "chosen by the fit"},
     {"covariance", IntervalMethod::kCovariance, "from the covariance (fast)"},
     {"profile", IntervalMethod::kProfile, "from the likelihood"},
     {"bootstrap", IntervalMethod::kBootstrap, "from simulated repetitions (slow)"}}};
constexpr std::array<Word<Checks>, 3> kChecks = {
    {{"none", Checks::kNone}, {"standard", Checks::kStandard}, {"full", Checks::kFull}}};

constexpr std::array<FlagWord, 20> kReadingUnits = {{{"", "in the column’s name"},
                                                     {"rad", "radians"},
                                                     {"deg", "degrees"},
                                                     {"mrad", "milliradians"},
                                                     {"rev", "revolutions"},
                                                     {"gon", "gon (1/400 of a turn)"},
                                                     {"rad_s", "radians per second"},
                                                     {"deg_s", "degrees per second"},
                                                     {"rpm", "revolutions per minute"},
                                                     {"rev_s", "revolutions per second"},
                                                     {"counts", "counts of a converter"},
                                                     {"volts", "volts"},
                                                     {"mv", "millivolts"},
                                                     {"m_s2", "metres per second squared"},
                                                     {"g", "standard gravity (9.80665 m/s²)"},
                                                     {"mg", "milli-g (a thousandth of g)"},
                                                     {"px", "pixels"},
                                                     {"m", "metres"},
                                                     {"cm", "centimetres"},
                                                     {"mm", "millimetres"}}};

constexpr std::array<FlagWord, 8> kSensorWords = {{{"", "as the recording says or suggests"},
                                                   {"potentiometer", "potentiometer"},
                                                   {"encoder", "encoder"},
                                                   {"gyro", "gyro"},
                                                   {"accelerometer", "accelerometer"},
                                                   {"camera", "camera"},
                                                   {"angle sensor", "another sensor of an angle"},
                                                   {"ideal", "free of errors other than noise"}}};

/// Parses an integer value of a flag, at least `least`.
Result<void> ParseWhole(std::string_view flag, const std::string& value, double least, double& number) {
  if (value.empty()) return {};
  constexpr double kLargest = 1e15;
  const std::string meaning = "a whole number, at least " + NumberText(least);
  ASSIGN_OR_RETURN(const auto parsed, ParseNumber(flag, value, meaning));
  if (parsed < least || parsed != std::floor(parsed) || parsed > kLargest) {
    return BadFlag(std::string(flag) + " is '" + value + "'; it must be " + meaning);
  }
  number = parsed;
  return {};
}

/// Noise family, confidence intervals, seed and threads.
Result<void> ParseNoise(const RunFlags& flags, FitOptions& options) {
  const auto noise = ParseWord("--noise", flags.noise, kNoises);
  if (!noise) return tl::unexpected(noise.error());
  const auto loss = ParseWord("--loss", flags.loss, kLosses);
  if (!loss) return tl::unexpected(loss.error());
  ASSIGN_OR_RETURN(const auto interval, ParseWord("--interval", flags.interval, kIntervals));
  if (*loss && *noise) {
    return BadFlag("--loss " + flags.loss + " and --noise " + flags.noise + " exclude each other; give one of them");
  }
  auto seed = static_cast<double>(options.seed);
  double threads = options.threads;
  RETURN_IF_ERROR(ParseWhole("--seed", flags.seed, 0, seed));
  RETURN_IF_ERROR(ParseWhole("--threads", flags.threads, 0, threads));
  constexpr double kMaxThreads = 1024;
  options.noise = *loss ? *loss : *noise;
  options.interval = interval;
  options.seed = static_cast<std::uint64_t>(seed);
  options.threads = static_cast<int>(std::min(threads, kMaxThreads));
  return {};
}

/// Every parameter that a flag may name: the parameters of all models, and of every possible start and sensor.
std::vector<ParameterInfo> NameableParameters(const std::vector<MotionModel>& models) {
  std::vector<ParameterInfo> infos;
  for (const MotionModel& model : models) {
    for (const ParameterInfo& info : PhysicalParameters(model)) {
      if (std::ranges::find(infos, info.name, &ParameterInfo::name) == infos.end()) infos.push_back(info);
    }
  }
  infos.insert(infos.end(),
               {kReleaseAngle, kReleaseTime, kInitialAngle, kInitialRate, kZeroAngle, kRateBias, kZeroDrift, kBiasDrift,
                kRateScale, kAccelerationBias, kAccelerationScale, kAxis, kRadius, kPivotX, kPivotY, kHysteresis});
  return infos;
}

/// Parses a time if the flag was given.
Result<void> ParseTime(std::string_view flag, const std::string& value, double& time) {
  if (value.empty()) return {};
  ASSIGN_OR_RETURN(const auto number, ParseNumber(flag, value, "a time in seconds on the file's clock"));
  time = number;
  return {};
}

Result<void> ParseWindow(const RunFlags& flags, IdentifyOptions& options) {
  RETURN_IF_ERROR(ParseTime("--from", flags.from, options.swing.from));
  RETURN_IF_ERROR(ParseTime("--to", flags.to, options.swing.to));
  if (options.swing.from >= options.swing.to) {
    return BadFlag("--from " + flags.from + " s does not lie before --to " + flags.to + " s");
  }
  return {};
}

/// A fixed parameter cannot have bounds or a prior.
Result<void> CheckContradictions(const FitOptions& options) {
  for (const auto& [name, value] : options.fixed) {
    const std::string other = options.initial.contains(name)  ? "--init"
                              : options.bounds.contains(name) ? "--bounds"
                              : options.priors.contains(name) ? "--prior"
                                                              : "";
    if (other.empty()) continue;
    return BadFlag(std::string("--fix holds ")
                       .append(name)
                       .append(", and ")
                       .append(other)
                       .append(" names it too; leave one of them out"));
  }
  return {};
}

/// The value of --model.
std::string ModelOf(const RunFlags& flags) { return flags.model.empty() ? std::string(kDefaultModel) : flags.model; }

Result<void> ParseFitOptions(const RunFlags& flags, const std::vector<MotionModel>& models, FitOptions& options) {
  ASSIGN_OR_RETURN(const auto start, ParseWord("--start", flags.start, kStarts));
  const std::vector<ParameterInfo> parameters = NameableParameters(models);
  const std::string model = ModelOf(flags);
  ASSIGN_OR_RETURN(auto fixed, ParseSettings("--fix", flags.fix, model, parameters));
  ASSIGN_OR_RETURN(auto initial, ParseSettings("--init", flags.init, model, parameters));
  ASSIGN_OR_RETURN(auto bounds, ParseRanges("--bounds", flags.bounds, model, parameters));
  ASSIGN_OR_RETURN(auto priors, ParsePriors("--prior", flags.prior, model, parameters));
  options.model = models.front().name;
  options.start = start;
  options.fixed = std::move(fixed);
  options.initial = std::move(initial);
  options.bounds = std::move(bounds);
  options.priors = std::move(priors);
  RETURN_IF_ERROR(ParseNoise(flags, options));
  return CheckContradictions(options);
}

/// Checks contradictions that do not depend on the file.
Result<void> CheckReadFlags(const RunFlags& flags) {
  const bool is_time_chosen = !flags.time_column.empty() && flags.time_column != "none";
  if (is_time_chosen && !flags.sample_rate_hz.empty()) {
    return BadFlag("--time_column and --sample_rate_hz both say what the times are; leave one of them out");
  }
  if (is_time_chosen && flags.time_column == flags.value_column) {
    return BadFlag("--time_column and --value_column are both '" + flags.time_column + "'; choose two columns");
  }
  if (std::ranges::find(kReadingUnits, flags.unit, &FlagWord::word) == kReadingUnits.end()) {
    const auto units = kReadingUnits | std::views::drop(1) | std::views::transform(&FlagWord::word);
    return BadFlag("--unit is '" + flags.unit + "'; it must be one of " + NameList(units));
  }
  if (!flags.calibration.empty() && !flags.unit.empty() && flags.unit != "counts" && flags.unit != "volts") {
    return BadFlag("--calibration turns counts or volts into an angle, and --unit says that the values are in " +
                   flags.unit + "; leave one of them out");
  }
  return {};
}

/// Parses resolution and range of the sensor, in the unit of the file.
Result<void> ParseSensor(const RunFlags& flags, ReadOptions& options) {
  if (!flags.resolution.empty()) {
    const auto resolution = ParseNumber("--resolution", flags.resolution, "a number, 0 or more, in the file's unit");
    if (!resolution) return tl::unexpected(resolution.error());
    if (*resolution < 0) return BadFlag("--resolution is '" + flags.resolution + "'; it must be 0 or more");
    options.resolution = *resolution;
  }
  if (flags.range.empty()) return {};
  const std::string meaning = "two increasing numbers, low,high, in the file's unit";
  const std::vector<std::string> ends = Split(flags.range, ',');
  if (ends.size() != 2) return BadFlag("--range is '" + flags.range + "'; it must be " + meaning);
  ASSIGN_OR_RETURN(const auto low, ParseNumber("--range", ends[0], meaning));
  ASSIGN_OR_RETURN(const auto high, ParseNumber("--range", ends[1], meaning));
  if (low >= high) return BadFlag("--range is '" + flags.range + "'; it must be " + meaning);
  options.range = SensorRange{low, high};
  return {};
}

/// Parses how many readings a row averages, and over which window.
Result<void> ParseAveraging(const RunFlags& flags, ReadOptions& options) {
  const std::string most = std::to_string(kMostOversampling);
  double readings = 0;
  RETURN_IF_ERROR(ParseWhole("--oversample", flags.oversample, 1, readings));
  if (readings > kMostOversampling)
    return BadFlag("--oversample is '" + flags.oversample + "'; it must be a whole number, 1 to " + most);
  options.oversample = static_cast<int>(readings);
  if (flags.window_s.empty()) return {};
  options.averaging_window = ParseAveragingWindow(flags.window_s);
  if (options.averaging_window) return {};
  return BadFlag("--window_s is '" + flags.window_s + "'; it must be " + std::string(kAveragingWindowRule));
}

Result<void> ParseReadOptions(const RunFlags& flags, ReadOptions& options) {
  RETURN_IF_ERROR(CheckReadFlags(flags));
  RETURN_IF_ERROR(ParseSensor(flags, options));
  RETURN_IF_ERROR(ParseAveraging(flags, options));
  options.time_column = flags.time_column;
  options.value_column = flags.value_column;
  options.unit = flags.unit;
  if (flags.sample_rate_hz.empty()) return {};
  ASSIGN_OR_RETURN(const auto rate,
                   ParseNumber("--sample_rate_hz", flags.sample_rate_hz, "a positive number of samples per second"));
  if (rate <= 0) return BadFlag("--sample_rate_hz is '" + flags.sample_rate_hz + "'; it must be positive");
  options.sample_rate_hz = rate;
  return {};
}

constexpr std::string_view kSensorSource = "given by --sensor";

bool IsSensorText(const std::string& text) { return IsSensorKind(text) || text.find('{') != std::string::npos; }

/// Refuses flags that only a fit uses.
Result<void> CheckClosedFormOnly(const RunFlags& flags) {
  if (!flags.closed_form_only) return {};
  RunFlags given = flags, none;
  for (const RunFlag& flag : RunFlagTable()) {
    const auto is_different = [&](auto* value) { return *value != *std::get<decltype(value)>(flag.In(none)); };
    const bool is_given = std::visit(is_different, flag.In(given));
    if (flag.needs_fit && is_given) return NeedsFitError("--" + std::string(flag.name));
  }
  return {};
}

// ---- The table -----------------------------------------------------------------------------------------------------

using Json = nlohmann::ordered_json;

Json TextSchema() { return {{"type", "string"}}; }

template <typename Meaning, std::size_t kWords>
std::vector<FlagWord> WordsOf(const std::array<Word<Meaning>, kWords>& all) {
  std::vector<FlagWord> words;
  for (const auto& [word, meaning, label] : all) words.push_back({word, label});
  return words;
}

Json WordSchema(const RunFlag& flag) {
  Json schema = {{"enum", Json::array()}, {"type", "string"}};
  for (const auto& [word, label] : flag.words) {
    if (!word.empty()) schema["enum"].push_back(word);
  }
  RunFlags none;
  if (const std::string word = *std::get<std::string*>(flag.In(none)); !word.empty()) schema["default"] = word;
  return schema;
}

std::vector<RunFlag> MakeTable() {
  Json model = TextSchema();
  model["default"] = kDefaultModel;
  const Json seed = {{"type", "integer"}, {"minimum", 0}, {"maximum", 1'000'000'000'000'000}, {"default", 1}};
  const Json number = {{"type", "number"}};
  const std::string models =
      "Model of the friction: one of " + MotionModelNames() +
      "; several separated by commas, to compare them; or all; default coulomb. --gravity linear "
      "gives each friction law the restoring torque of a spring.";
  return {
      {.name = "rig",
       .value = &RunFlags::rig,
       .help = "Rig file (JSON, SI units) that gives the gravity torque; default none, with torques in units of the "
               "gravity torque.",
       .label = "What I know of the pendulum",
       .is_local = true},
      {.name = "calibration",
       .value = &RunFlags::calibration,
       .help = "Calibration file (JSON) that converts counts or volts to an angle; default the calibration in the "
               "recording.",
       .label = "Calibration file",
       .is_local = true},
      {.name = "sensor",
       .value = &RunFlags::sensor,
       .help = "What the sensor may do to the readings, which the errors then contain: its kind, " +
               NameList(SensorKinds()) +
               ", or JSON (tools: also the name of a file) with the kind and standard deviations in SI units of gain, "
               "nonlinearity, lag, backlash, drift and clock, 0 if exact; default what the recording states, or "
               "assumed from its unit.",
       .label = "Kind of sensor",
       .words = {kSensorWords.begin(), kSensorWords.end()},
       .schema = TextSchema(),
       .example = "gyro"},
      {.name = "model",
       .value = &RunFlags::model,
       .help = models,
       .label = "Kind of friction",
       .schema = model,
       .example = "viscous,coulomb"},
      {.name = "gravity",
       .value = &RunFlags::gravity,
       .help = "Restoring torque: sin (gravity: a pendulum), linear (a spring: Pohl wheel, torsion wire, mass on a "
               "spring; G is then the stiffness k) or auto (sin; linear if the rig gives a stiffness or, with the "
               "default model, if the recording clearly shows a spring, which is said; in a batch always sin); default "
               "auto.",
       .label = "What pulls it back",
       .words = WordsOf(kGravities)},
      {.name = "start",
       .value = &RunFlags::start,
       .help = "How the recording begins: auto (decided from the data), release or moving; default auto.",
       .label = "How the recording begins",
       .words = WordsOf(kStarts),
       .needs_fit = true},
      {.name = "release",
       .value = &RunFlags::release,
       .help = "Which free swing of a recording to fit: a number from 1, on the command line also all; "
               "default the one that determines the period best, by its length and size.",
       .label = "Which free swing",
       .schema = {{"type", "integer"}, {"minimum", 1}}},
      {.name = "from",
       .value = &RunFlags::from,
       .help = "Start of the window to fit, s on the file's clock; default where the free swing begins.",
       .label = "From",
       .unit = "s",
       .schema = number,
       .example = "1.5"},
      {.name = "to",
       .value = &RunFlags::to,
       .help = "End of the window to fit, s on the file's clock; default where the free swing ends.",
       .label = "To",
       .unit = "s",
       .schema = number,
       .example = "12.5"},
      {.name = "fix",
       .value = &RunFlags::fix,
       .help = "Parameters to fix at a value, name=value,... in SI (rad, s; torques in the unit of the report); "
               "default none.",
       .schema = TextSchema(),
       .example = "zero_angle=0",
       .needs_fit = true},
      {.name = "init",
       .value = &RunFlags::init,
       .help = "Initial values of parameters, name=value,... in the units of --fix; default estimated from the data.",
       .schema = TextSchema(),
       .example = "viscous=0.004",
       .needs_fit = true},
      {.name = "bounds",
       .value = &RunFlags::bounds,
       .help = "Bounds of parameters, name=low:high,... in the units of --fix; low or high may be left out; default "
               "none.",
       .schema = TextSchema(),
       .example = "coulomb=0:0.1",
       .needs_fit = true},
      {.name = "prior",
       .value = &RunFlags::prior,
       .help = "Prior knowledge of parameters, name=mean:std_dev,... in the units of --fix; default none.",
       .schema = TextSchema(),
       .example = "inertia=0.079:0.001",
       .needs_fit = true},
      {.name = "closed_form_only",
       .value = &RunFlags::closed_form_only,
       .help = "Make no fit: compute period, decrement, inertia and friction from the turning points alone. This also "
               "works for counts or volts without a calibration.",
       .schema = {{"type", "boolean"}, {"default", false}}},
      {.name = "time_column",
       .value = &RunFlags::time_column,
       .help = "Column of times: its name, or its number from 1; add :s, :ms or :us if the name has no unit. none: use "
               "--sample_rate_hz instead. Default: found by its name.",
       .label = "Column of times",
       .schema = TextSchema(),
       .example = "1:ms"},
      {.name = "value_column",
       .value = &RunFlags::value_column,
       .help = "Column of the angle or rate: its name, or its number from 1; two separated by a comma: the horizontal "
               "and the vertical coordinate of a point; combined: the rate about the fixed axis that the axes of a "
               "gyro share; default found by its name, its unit and its swing.",
       .label = "Column of the angle",
       .schema = TextSchema(),
       .example = "angle_deg"},
      {.name = "unit",
       .value = &RunFlags::unit,
       .help = "Unit of the values: rad, deg, mrad, rev, gon, rad_s, deg_s, rpm, rev_s, counts, volts, mv, m_s2, g, "
               "mg, px, m, cm or mm; default the unit in the column's name, or the one that the numbers show.",
       .label = "Unit of the values",
       .words = {kReadingUnits.begin(), kReadingUnits.end()}},
      {.name = "sample_rate_hz",
       .value = &RunFlags::sample_rate_hz,
       .help = "Samples per second of a file without times; default the value in its line # sample_rate_hz.",
       .label = "Samples per second",
       .schema = {{"type", "number"}, {"exclusiveMinimum", 0}}},
      {.name = "resolution",
       .value = &RunFlags::resolution,
       .help = "Spacing of the sensor's levels, in the file's unit; 0: no levels; default given in the file, or found "
               "in its values.",
       .schema = {{"type", "number"}, {"minimum", 0}}},
      {.name = "range",
       .value = &RunFlags::range,
       .help = "Smallest and largest value of the sensor, low,high in the file's unit; readings at these ends are "
               "treated as censored.",
       .schema = TextSchema(),
       .example = "0,1023"},
      {.name = "oversample",
       .value = &RunFlags::oversample,
       .help = "Number of readings of the converter whose mean a row is, 1 to 64; default the value in the file's line "
               "# oversample; without it as the values show (means_assumed), or 1.",
       .label = "Readings in a mean",
       .schema = {{"type", "integer"}, {"minimum", 1}, {"maximum", kMostOversampling}}},
      {.name = "window_s",
       .value = &RunFlags::window_s,
       .help =
           "Averaging window of a row: its length in s, 0 to 1, about the time stamp, or its begin,end in s from the "
           "time stamp; default the value in the file's line # window_s, or unknown.",
       .schema = TextSchema(),
       .example = "0,0.0018"},
      {.name = "noise",
       .value = &RunFlags::noise,
       .help = "Noise of the readings: gaussian, quantized (rounded to levels), averaged (means of readings in whole "
               "counts), edges (one row for each change of a count) or auto (edges and averaged for files with such "
               "rows, otherwise quantized if rounding matters); default auto.",
       .label = "Noise of the sensor",
       .words = WordsOf(kNoises),
       .needs_fit = true},
      {.name = "loss",
       .value = &RunFlags::loss,
       .help = "Robust noise model for recordings with outliers: huber, student or none; default none.",
       .label = "Outliers",
       .words = WordsOf(kLosses),
       .needs_fit = true},
      {.name = "interval",
       .value = &RunFlags::interval,
       .help = "Method of the 95 % intervals: covariance, profile, bootstrap or auto (profile near a bound); default "
               "auto.",
       .label = "95 % intervals",
       .words = WordsOf(kIntervals),
       .needs_fit = true},
      {.name = "checks",
       .value = &RunFlags::checks,
       .help = "Which fits are checked against closed forms and for constancy: none, standard (the recommended model; "
               "in a joint fit, the constancy of all models) or full (all models); default standard.",
       .words = WordsOf(kChecks),
       .needs_fit = true},
      {.name = "seed",
       .value = &RunFlags::seed,
       .help = "Seed of the bootstrap and of posterior draws; default 1.",
       .schema = seed,
       .needs_fit = true},
      {.name = "threads",
       .value = &RunFlags::threads,
       .help = "Number of threads, for the bootstrap, long recordings and several recordings; it does not change the "
               "result; default 0, one per core.",
       .needs_fit = true,
       .is_local = true},
  };
}

/// A flag for each key of the rig.
void AddRigFlags(std::vector<RunFlag>& flags) {
  for (std::size_t i = 0; i < RigKeys().size(); ++i) {
    const RigKey& key = RigKeys()[i];
    const std::string example = key.quantity == RigQuantity::kMass     ? "380g"
                                : key.quantity == RigQuantity::kLength ? "43.2+-0.1cm"
                                                                       : "9.81";
    flags.push_back(
        {.name = key.flag,
         .value = RigFlagValue{i},
         .help = std::string(key.help) + " In " + std::string(key.unit) + " unless a unit follows" +
                 (key.quantity == RigQuantity::kMass || key.quantity == RigQuantity::kLength ? ", such as " + example
                                                                                             : "") +
                 "; default the value in --rig.",
         .schema = TextSchema(),
         .example = example});
  }
}

}  // namespace

std::variant<std::string*, bool*> RunFlag::In(RunFlags& flags) const {
  if (const auto* of_rig = std::get_if<RigFlagValue>(&value)) return &flags.rig_values[of_rig->key];
  if (const auto* text = std::get_if<std::string RunFlags::*>(&value)) return &(flags.**text);
  return &(flags.*std::get<bool RunFlags::*>(value));
}

nlohmann::ordered_json GivenFlags(const RunFlags& flags) {
  RunFlags given = flags, none;
  Json json = Json::object();
  for (const RunFlag& flag : RunFlagTable()) {
    std::visit(
        [&](auto* value) {
          if (*value != *std::get<decltype(value)>(flag.In(none))) json[std::string(flag.name)] = *value;
        },
        flag.In(given));
  }
  return json;
}

const std::vector<RunFlag>& RunFlagTable() {
  static const std::vector<RunFlag> table = [] {
    std::vector<RunFlag> flags = MakeTable();
    AddRigFlags(flags);
    for (RunFlag& flag : flags) {
      if (!flag.words.empty() && flag.schema.is_null()) flag.schema = WordSchema(flag);
    }
    return flags;
  }();
  return table;
}

tl::unexpected<Status> NeedsFitError(std::string_view flag) {
  return BadFlag(std::string(flag) + " needs a fit, but --closed_form_only makes none; leave one of them out");
}

Result<std::string> ReadSensorFile(std::string& sensor) {
  if (sensor.empty() || IsSensorText(sensor)) return std::string();
  auto text = ReadFile(sensor, "sensor", kMaxJsonBytes);
  if (!text) {
    text.error().sentence += "; --sensor takes a file or a kind of sensor: " + NameList(SensorKinds());
    return text;
  }
  RETURN_IF_ERROR(ParseSensorStatement(*text, sensor, ""));
  return std::exchange(sensor, *std::move(text));
}

Result<std::optional<SensorStatement>> StatedSensor(const std::string& sensor) {
  if (sensor.empty()) return std::nullopt;
  auto statement = ParseSensorStatement(sensor, "--sensor", std::string(kSensorSource));
  if (!statement) return BadFlag(statement.error().message());
  return *std::move(statement);
}

Result<IdentifyOptions> MakeIdentifyOptions(const RunFlags& flags) {
  RETURN_IF_ERROR(CheckClosedFormOnly(flags));
  IdentifyOptions options;
  options.closed_form_only = flags.closed_form_only;
  ASSIGN_OR_RETURN(const auto checks, ParseWord("--checks", flags.checks, kChecks));
  options.checks = checks;
  ASSIGN_OR_RETURN(const auto gravity, ParseWord("--gravity", flags.gravity, kGravities));
  const auto models = FindMotionModels(ModelOf(flags), gravity);
  if (!models) return Within("--model", models.error());
  options.fit.gravity = gravity;
  options.swing.is_spring =
      std::ranges::all_of(*models, [](const MotionModel& model) { return model.gravity.is_linear(); });
  options.rig_chooses_gravity = !gravity;
  options.fit.may_be_spring = !gravity && flags.model.empty();
  for (const MotionModel& model : *models) options.models.emplace_back(model.name);
  RETURN_IF_ERROR(ParseFitOptions(flags, *models, options.fit));
  RETURN_IF_ERROR(ParseWindow(flags, options));
  ASSIGN_OR_RETURN(const auto release, ParseRelease(flags));
  options.swing.release = release;
  ASSIGN_OR_RETURN(auto rig_values, RigValuesOf(flags.rig_values, options.notes));
  options.rig_values = std::move(rig_values);
  ASSIGN_OR_RETURN(options.sensor, StatedSensor(flags.sensor));
  RETURN_IF_ERROR(ParseReadOptions(flags, options.read));
  return options;
}

}  // namespace pendulum
