// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/column.h"

#include <cmath>
#include <utility>
#include <vector>

namespace pendulum::csv {
namespace {

// ---- Letters -----------------------------------------------------------------------------------------------------

struct Spelling {
  std::string_view letters, plain;
};

/// Letters of other alphabets. The last ones are single bytes of Latin-1, which old programs write. They count only
/// where no character of UTF-8 begins: the second byte of a Cyrillic letter is no degree sign.
constexpr std::array kSpellings = {
    Spelling{"\u00E1", "a"},
    Spelling{"\u00E0", "a"},
    Spelling{"\u00E2", "a"},
    Spelling{"\u00E4", "a"},
    Spelling{"\u00E3", "a"},
    Spelling{"\u00E5", "a"},
    Spelling{"\u0105", "a"},
    Spelling{"\u00E7", "c"},
    Spelling{"\u010D", "c"},
    Spelling{"\u00E9", "e"},
    Spelling{"\u00E8", "e"},
    Spelling{"\u00EA", "e"},
    Spelling{"\u00EB", "e"},
    Spelling{"\u0119", "e"},
    Spelling{"\u00ED", "i"},
    Spelling{"\u00EC", "i"},
    Spelling{"\u0131", "i"},
    Spelling{"\u0142", "l"},
    Spelling{"\u00F1", "n"},
    Spelling{"\u00F3", "o"},
    Spelling{"\u00F2", "o"},
    Spelling{"\u00F4", "o"},
    Spelling{"\u00F6", "o"},
    Spelling{"\u00F5", "o"},
    Spelling{"\u00F8", "o"},
    Spelling{"\u00FA", "u"},
    Spelling{"\u00F9", "u"},
    Spelling{"\u00FC", "u"},
    Spelling{"\u00DF", "ss"},
    Spelling{"\u03B1", "alpha"},
    Spelling{"\u03B8", "theta"},
    Spelling{"\u0398", "theta"},
    Spelling{"\u03D1", "theta"},
    Spelling{"\u03C6", "phi"},
    Spelling{"\u03D5", "phi"},
    Spelling{"\u03A6", "phi"},
    Spelling{"\u03C8", "psi"},
    Spelling{"\u03C9", "omega"},
    Spelling{"\u03C0", "pi"},
    Spelling{"\u0307", " dot"},
    Spelling{"\u0308", " ddot"},
    Spelling{"\u2032", " dot"},
    Spelling{"\u2033", " ddot"},
    Spelling{"''", " ddot"},
    Spelling{"\u00B0", "deg"},
    Spelling{"\u00BA", "deg"},
    Spelling{"\u00B5", "u"},
    Spelling{"\u03BC", "u"},
    Spelling{"\u00B2", "2"},
    Spelling{"\u207B\u00B9", "-1"},
    Spelling{"\u207B\u00B2", "-2"},
    Spelling{"\u00B7", "*"},
    Spelling{"\u22C5", "*"},
    Spelling{"\u65F6\u95F4", "time"},
    Spelling{"\u6642\u9593", "time"},
    Spelling{"\u89D2\u5EA6", "angle"},
    Spelling{"\u0432\u0440\u0435\u043C\u044F", "time"},
    Spelling{"\u0412\u0440\u0435\u043C\u044F", "time"},
    Spelling{"\u0443\u0433\u043E\u043B", "angle"},
    Spelling{"\u0423\u0433\u043E\u043B", "angle"},
    Spelling{"\xB0", "deg"},
    Spelling{"\xB5", "u"},
    Spelling{"\xB2", "2"},
    Spelling{"\xE4", "a"},
    Spelling{"\xF6", "o"},
    Spelling{"\xFC", "u"},
    Spelling{"\xE9", "e"},
    Spelling{"\xF3", "o"},
    Spelling{"\xF1", "n"},
};

/// The number of bytes of the UTF-8 character at the beginning of a text; 0 if none begins there.
std::size_t SizeOfCharacter(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return 1;
  const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || size > text.size()) return 0;
  const auto is_later_byte = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  return std::ranges::all_of(text.substr(1, size - 1), is_later_byte) ? size : 0;
}

constexpr bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool IsLower(char c) { return c >= 'a' && c <= 'z'; }
constexpr bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// Separates `angleDeg` into `angle_Deg`.
std::string SplitCamelCase(std::string_view name) {
  std::string split;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (i > 0 && IsUpper(name[i]) && IsLower(name[i - 1])) split += '_';
    split += name[i];
  }
  return split;
}

bool IsPartOfWord(char c) { return IsLower(c) || IsDigit(c); }

/// The words of a plain name.
std::vector<std::string_view> WordsIn(std::string_view plain) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < plain.size();) {
    if (!IsPartOfWord(plain[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < plain.size() && IsPartOfWord(plain[end])) ++end;
    words.push_back(plain.substr(i, end - i));
    i = end;
  }
  return words;
}

// ---- Units -------------------------------------------------------------------------------------------------------

struct UnitWord {
  std::string_view word, suffix;
};

/// Spellings of units without blanks, dots and ^.
constexpr std::array kUnitWords = {
    UnitWord{"sec", "s"},
    UnitWord{"secs", "s"},
    UnitWord{"second", "s"},
    UnitWord{"seconds", "s"},
    UnitWord{"sek", "s"},
    UnitWord{"sekunde", "s"},
    UnitWord{"sekunden", "s"},
    UnitWord{"segundo", "s"},
    UnitWord{"segundos", "s"},
    UnitWord{"seconde", "s"},
    UnitWord{"secondes", "s"},
    UnitWord{"secondi", "s"},
    UnitWord{"msec", "ms"},
    UnitWord{"msecs", "ms"},
    UnitWord{"millis", "ms"},
    UnitWord{"millisecond", "ms"},
    UnitWord{"milliseconds", "ms"},
    UnitWord{"millisekunden", "ms"},
    UnitWord{"milisegundos", "ms"},
    UnitWord{"millisecondes", "ms"},
    UnitWord{"millisecondi", "ms"},
    UnitWord{"usec", "us"},
    UnitWord{"usecs", "us"},
    UnitWord{"micros", "us"},
    UnitWord{"microsecond", "us"},
    UnitWord{"microseconds", "us"},
    UnitWord{"mikrosekunden", "us"},
    UnitWord{"microsegundos", "us"},
    UnitWord{"nsec", "ns"},
    UnitWord{"nanos", "ns"},
    UnitWord{"nanosecond", "ns"},
    UnitWord{"nanoseconds", "ns"},
    UnitWord{"mins", "min"},
    UnitWord{"minute", "min"},
    UnitWord{"minutes", "min"},
    UnitWord{"minuten", "min"},
    UnitWord{"minutos", "min"},
    UnitWord{"rads", "rad"},
    UnitWord{"bogenmass", "rad"},
    UnitWord{"radian", "rad"},
    UnitWord{"radians", "rad"},
    UnitWord{"radiant", "rad"},
    UnitWord{"radianti", "rad"},
    UnitWord{"radianes", "rad"},
    UnitWord{"radianos", "rad"},
    UnitWord{"radiani", "rad"},
    UnitWord{"degs", "deg"},
    UnitWord{"degree", "deg"},
    UnitWord{"degrees", "deg"},
    UnitWord{"grad", "deg"},
    UnitWord{"grado", "deg"},
    UnitWord{"grados", "deg"},
    UnitWord{"gradi", "deg"},
    UnitWord{"graus", "deg"},
    UnitWord{"degre", "deg"},
    UnitWord{"degres", "deg"},
    UnitWord{"graden", "deg"},
    UnitWord{"grader", "deg"},
    UnitWord{"stopnie", "deg"},
    UnitWord{"revs", "rev"},
    UnitWord{"revolutions", "rev"},
    UnitWord{"turns", "rev"},
    UnitWord{"rot", "rev"},
    UnitWord{"cycles", "rev"},
    UnitWord{"gons", "gon"},
    UnitWord{"grads", "gon"},
    UnitWord{"gradians", "gon"},
    UnitWord{"millirad", "mrad"},
    UnitWord{"milliradians", "mrad"},
    UnitWord{"rev/s", "rev_s"},
    UnitWord{"rps", "rev_s"},
    UnitWord{"umdrehungen", "rev"},
    UnitWord{"rad/s", "rad_s"},
    UnitWord{"rad/sec", "rad_s"},
    UnitWord{"radian/s", "rad_s"},
    UnitWord{"radians/s", "rad_s"},
    UnitWord{"radians/sec", "rad_s"},
    UnitWord{"radians/second", "rad_s"},
    UnitWord{"rads-1", "rad_s"},
    UnitWord{"rad*s-1", "rad_s"},
    UnitWord{"rad_sec", "rad_s"},
    UnitWord{"rad_per_s", "rad_s"},
    UnitWord{"rad_per_sec", "rad_s"},
    UnitWord{"radps", "rad_s"},
    UnitWord{"rads_s", "rad_s"},
    UnitWord{"1/s", "rad_s"},
    UnitWord{"s-1", "rad_s"},
    UnitWord{"deg/s", "deg_s"},
    UnitWord{"deg/sec", "deg_s"},
    UnitWord{"degree/s", "deg_s"},
    UnitWord{"degrees/s", "deg_s"},
    UnitWord{"degrees/sec", "deg_s"},
    UnitWord{"degrees/second", "deg_s"},
    UnitWord{"grad/s", "deg_s"},
    UnitWord{"degs-1", "deg_s"},
    UnitWord{"deg*s-1", "deg_s"},
    UnitWord{"deg_sec", "deg_s"},
    UnitWord{"deg_per_s", "deg_s"},
    UnitWord{"deg_per_sec", "deg_s"},
    UnitWord{"dps", "deg_s"},
    UnitWord{"degps", "deg_s"},
    UnitWord{"u/min", "rpm"},
    UnitWord{"tr/min", "rpm"},
    UnitWord{"1/min", "rpm"},
    UnitWord{"rev/min", "rpm"},
    UnitWord{"count", "counts"},
    UnitWord{"cnt", "counts"},
    UnitWord{"cnts", "counts"},
    UnitWord{"adc", "counts"},
    UnitWord{"lsb", "counts"},
    UnitWord{"tick", "counts"},
    UnitWord{"step", "counts"},
    UnitWord{"steps", "counts"},
    UnitWord{"pulse", "counts"},
    UnitWord{"pulses", "counts"},
    UnitWord{"impulse", "counts"},
    UnitWord{"impulses", "counts"},
    UnitWord{"ticks", "counts"},
    UnitWord{"inc", "counts"},
    UnitWord{"increments", "counts"},
    UnitWord{"volt", "volts"},
    UnitWord{"v", "volts"},
    UnitWord{"millivolt", "mv"},
    UnitWord{"millivolts", "mv"},
    UnitWord{"m/s2", "m_s2"},
    UnitWord{"m/s/s", "m_s2"},
    UnitWord{"ms-2", "m_s2"},
    UnitWord{"m*s-2", "m_s2"},
    UnitWord{"m/sec2", "m_s2"},
    UnitWord{"mps2", "m_s2"},
    UnitWord{"millig", "mg"},
    UnitWord{"milli-g", "mg"},
    UnitWord{"pixel", "px"},
    UnitWord{"pixels", "px"},
    UnitWord{"pix", "px"},
    UnitWord{"meter", "m"},
    UnitWord{"meters", "m"},
    UnitWord{"metre", "m"},
    UnitWord{"metres", "m"},
    UnitWord{"metros", "m"},
    UnitWord{"metri", "m"},
    UnitWord{"centimeter", "cm"},
    UnitWord{"centimeters", "cm"},
    UnitWord{"centimetre", "cm"},
    UnitWord{"centimetres", "cm"},
    UnitWord{"millimeter", "mm"},
    UnitWord{"millimeters", "mm"},
    UnitWord{"millimetre", "mm"},
    UnitWord{"millimetres", "mm"},
};

/// Units of other quantities.
constexpr std::array<std::string_view, 42> kOtherUnits = {
    "degc", "celsius", "c",      "k",      "degf",   "n",      "mn",   "a",    "ma",  "hz",   "khz",
    "%",    "w",       "mw",     "pa",     "hpa",    "kpa",    "mbar", "bar",  "lux", "lx",   "db",
    "ut",   "mt",      "gauss",  "nm",     "n*m",    "j",      "kg",   "m/s",  "m_s", "cm/s", "mm/s",
    "px/s", "km/h",    "rad/s2", "rad_s2", "deg/s2", "deg_s2", "ohm",  "ms-1", "mps"};

/// A text without blanks, dots and ^, in plain letters.
std::string UnitLetters(std::string_view text) {
  std::string letters;
  for (const char c : PlainName(Trim(text))) {
    if (!IsBlank(c) && c != '^' && c != '.' && c != '"') letters += c;
  }
  if (letters.starts_with('(') && letters.ends_with(')') && letters.size() > 2) {
    letters = letters.substr(1, letters.size() - 2);
  }
  return letters;
}

bool IsOtherUnit(std::string_view letters) { return std::ranges::find(kOtherUnits, letters) != kOtherUnits.end(); }

const Unit* UnitOfLetters(std::string_view letters) {
  if (const Unit* unit = UnitOfSuffix(letters)) return unit;
  const auto* const found = std::ranges::find(kUnitWords, letters, &UnitWord::word);
  return found == kUnitWords.end() ? nullptr : UnitOfSuffix(found->suffix);
}

// ---- Words -------------------------------------------------------------------------------------------------------

/// What a word in a name means. kAngular makes a velocity a rate; kOther is no quantity of a swing.
enum class Sense { kTime, kAngle, kRate, kRaw, kAcceleration, kLength, kVelocity, kAngular, kOther, kSecondary };

struct Word {
  std::string_view word;
  Sense sense;
};

constexpr std::array kWords = {
    Word{"t", Sense::kTime},
    Word{"time", Sense::kTime},
    Word{"times", Sense::kTime},
    Word{"tout", Sense::kTime},
    Word{"timestamp", Sense::kTime},
    Word{"timestamps", Sense::kTime},
    Word{"stamp", Sense::kTime},
    Word{"elapsed", Sense::kTime},
    Word{"clock", Sense::kTime},
    Word{"datetime", Sense::kTime},
    Word{"epoch", Sense::kTime},
    Word{"unixtime", Sense::kTime},
    Word{"zeit", Sense::kTime},
    Word{"uhrzeit", Sense::kTime},
    Word{"zeitstempel", Sense::kTime},
    Word{"tiempo", Sense::kTime},
    Word{"hora", Sense::kTime},
    Word{"tempo", Sense::kTime},
    Word{"ora", Sense::kTime},
    Word{"temps", Sense::kTime},
    Word{"heure", Sense::kTime},
    Word{"horodatage", Sense::kTime},
    Word{"tijd", Sense::kTime},
    Word{"tid", Sense::kTime},
    Word{"aika", Sense::kTime},
    Word{"czas", Sense::kTime},
    Word{"cas", Sense::kTime},
    Word{"zaman", Sense::kTime},
    Word{"theta", Sense::kAngle},
    Word{"th", Sense::kAngle},
    Word{"phi", Sense::kAngle},
    Word{"psi", Sense::kAngle},
    Word{"alpha", Sense::kAngle},
    Word{"angle", Sense::kAngle},
    Word{"angles", Sense::kAngle},
    Word{"ang", Sense::kAngle},
    Word{"winkel", Sense::kAngle},
    Word{"angulo", Sense::kAngle},
    Word{"angolo", Sense::kAngle},
    Word{"vinkel", Sense::kAngle},
    Word{"hoek", Sense::kAngle},
    Word{"kulma", Sense::kAngle},
    Word{"kat", Sense::kAngle},
    Word{"uhel", Sense::kAngle},
    Word{"aci", Sense::kAngle},
    Word{"yaw", Sense::kAngle},
    Word{"pitch", Sense::kAngle},
    Word{"roll", Sense::kAngle},
    Word{"tilt", Sense::kAngle},
    Word{"inclination", Sense::kAngle},
    Word{"neigung", Sense::kAngle},
    Word{"inclinaison", Sense::kAngle},
    Word{"inclinacion", Sense::kAngle},
    Word{"heading", Sense::kAngle},
    Word{"encoder", Sense::kAngle},
    Word{"enc", Sense::kAngle},
    Word{"position", Sense::kAngle},
    Word{"pos", Sense::kAngle},
    Word{"posicion", Sense::kAngle},
    Word{"posizione", Sense::kAngle},
    Word{"deflection", Sense::kAngle},
    Word{"rotation", Sense::kAngle},
    Word{"swing", Sense::kAngle},
    Word{"pendulum", Sense::kAngle},
    Word{"omega", Sense::kRate},
    Word{"gyro", Sense::kRate},
    Word{"gyroscope", Sense::kRate},
    Word{"gyroskop", Sense::kRate},
    Word{"gyr", Sense::kRate},
    Word{"gir", Sense::kRate},
    Word{"giroscopio", Sense::kRate},
    Word{"rate", Sense::kRate},
    Word{"winkelgeschwindigkeit", Sense::kRate},
    Word{"thetadot", Sense::kRate},
    Word{"dtheta", Sense::kRate},
    Word{"phidot", Sense::kRate},
    Word{"dphi", Sense::kRate},
    Word{"angvel", Sense::kRate},
    Word{"dot", Sense::kRate},
    Word{"punkt", Sense::kRate},
    Word{"diff", Sense::kRate},
    Word{"drehrate", Sense::kRate},
    Word{"gx", Sense::kRate},
    Word{"gy", Sense::kRate},
    Word{"gz", Sense::kRate},
    Word{"wx", Sense::kRate},
    Word{"wy", Sense::kRate},
    Word{"wz", Sense::kRate},
    Word{"ddot", Sense::kOther},
    Word{"dotdot", Sense::kOther},
    Word{"punktpunkt", Sense::kOther},
    Word{"dd", Sense::kOther},
    Word{"adc", Sense::kRaw},
    Word{"counts", Sense::kRaw},
    Word{"count", Sense::kRaw},
    Word{"raw", Sense::kRaw},
    Word{"analog", Sense::kRaw},
    Word{"voltage", Sense::kRaw},
    Word{"spannung", Sense::kRaw},
    Word{"tension", Sense::kRaw},
    Word{"voltaje", Sense::kRaw},
    Word{"tensione", Sense::kRaw},
    Word{"pot", Sense::kRaw},
    Word{"potentiometer", Sense::kRaw},
    Word{"poti", Sense::kRaw},
    Word{"potenciometro", Sense::kRaw},
    Word{"acc", Sense::kAcceleration},
    Word{"ax", Sense::kAcceleration},
    Word{"ay", Sense::kAcceleration},
    Word{"az", Sense::kAcceleration},
    Word{"accel", Sense::kAcceleration},
    Word{"acceleration", Sense::kAcceleration},
    Word{"accelerometer", Sense::kAcceleration},
    Word{"beschleunigung", Sense::kAcceleration},
    Word{"accelerazione", Sense::kAcceleration},
    Word{"aceleracion", Sense::kAcceleration},
    Word{"acceleratie", Sense::kAcceleration},
    Word{"x", Sense::kLength},
    Word{"y", Sense::kLength},
    Word{"displacement", Sense::kLength},
    Word{"auslenkung", Sense::kLength},
    Word{"spot", Sense::kLength},
    Word{"velocity", Sense::kVelocity},
    Word{"vel", Sense::kVelocity},
    Word{"speed", Sense::kVelocity},
    Word{"geschwindigkeit", Sense::kVelocity},
    Word{"velocidad", Sense::kVelocity},
    Word{"vitesse", Sense::kVelocity},
    Word{"velocita", Sense::kVelocity},
    Word{"angular", Sense::kAngular},
    Word{"angulaire", Sense::kAngular},
    Word{"angolare", Sense::kAngular},
    Word{"rotational", Sense::kAngular},
    Word{"rot", Sense::kAngular},
    Word{"temperature", Sense::kOther},
    Word{"temperatur", Sense::kOther},
    Word{"temperatura", Sense::kOther},
    Word{"temp", Sense::kOther},
    Word{"force", Sense::kOther},
    Word{"kraft", Sense::kOther},
    Word{"fuerza", Sense::kOther},
    Word{"forza", Sense::kOther},
    Word{"pressure", Sense::kOther},
    Word{"druck", Sense::kOther},
    Word{"humidity", Sense::kOther},
    Word{"battery", Sense::kOther},
    Word{"illuminance", Sense::kOther},
    Word{"light", Sense::kOther},
    Word{"lux", Sense::kOther},
    Word{"magnetic", Sense::kOther},
    Word{"magnetfeld", Sense::kOther},
    Word{"sound", Sense::kOther},
    Word{"mass", Sense::kOther},
    Word{"masse", Sense::kOther},
    Word{"gewicht", Sense::kOther},
    Word{"weight", Sense::kOther},
    Word{"energy", Sense::kOther},
    Word{"energie", Sense::kOther},
    Word{"energia", Sense::kOther},
    Word{"power", Sense::kOther},
    Word{"momentum", Sense::kOther},
    Word{"torque", Sense::kOther},
    Word{"latitude", Sense::kOther},
    Word{"longitude", Sense::kOther},
    Word{"altitude", Sense::kOther},
    Word{"setpoint", Sense::kSecondary},
    Word{"target", Sense::kSecondary},
    Word{"ref", Sense::kSecondary},
    Word{"reference", Sense::kSecondary},
    Word{"cmd", Sense::kSecondary},
    Word{"command", Sense::kSecondary},
    Word{"desired", Sense::kSecondary},
    Word{"error", Sense::kSecondary},
    Word{"err", Sense::kSecondary},
    Word{"std", Sense::kSecondary},
    Word{"sigma", Sense::kSecondary},
    Word{"uncertainty", Sense::kSecondary},
    Word{"fit", Sense::kSecondary},
    Word{"fitted", Sense::kSecondary},
    Word{"model", Sense::kSecondary},
    Word{"predicted", Sense::kSecondary},
    Word{"residual", Sense::kSecondary},
};

/// The sense of a word, also with a number or an axis at its end: theta1, gyrox.
std::optional<Sense> SenseOf(std::string_view word) {
  const auto find = [](std::string_view each) -> std::optional<Sense> {
    const auto* const found = std::ranges::find(kWords, each, &Word::word);
    return found == kWords.end() ? std::nullopt : std::optional(found->sense);
  };
  if (const auto sense = find(word)) return sense;
  while (!word.empty() && IsDigit(word.back())) word.remove_suffix(1);
  if (const auto sense = find(word)) return sense;
  constexpr std::size_t kLongEnough = 4;
  if (word.size() < kLongEnough || std::string_view("xyz").find(word.back()) == std::string_view::npos) return {};
  return find(word.substr(0, word.size() - 1));
}

/// Whether a name is the letter of an axis: `x_mg` without its unit.
bool IsAxis(std::string_view stem) {
  const std::vector<std::string_view> words = WordsIn(stem);
  return words.size() == 1 && (words[0] == "x" || words[0] == "y" || words[0] == "z");
}

/// The kind that the words of a name say.
struct WordMeaning {
  std::optional<Kind> kind;
  bool is_of_other_quantity = false;  // A linear speed, an angular acceleration, a temperature.
  bool is_secondary = false;
};

WordMeaning MeaningOfWords(std::string_view stem) {
  WordMeaning meaning;
  std::array<bool, static_cast<std::size_t>(Sense::kSecondary) + 1> has{};
  std::optional<Sense> last;
  const std::vector<std::string_view> words = WordsIn(stem);
  const bool is_split_axis = words.size() == 2 && words[0] == "a" && IsAxis(words[1]);  // a_x, aX
  for (const std::string_view word : words) {
    const std::optional<Sense> sense = is_split_axis ? Sense::kAcceleration : SenseOf(word);
    if (sense) has.at(static_cast<std::size_t>(*sense)) = true;
    last = sense;
  }
  const auto says = [&](Sense sense) { return has.at(static_cast<std::size_t>(sense)); };
  meaning.is_secondary = says(Sense::kSecondary);
  const bool is_angular = says(Sense::kAngular) || says(Sense::kAngle);
  const bool is_velocity = says(Sense::kVelocity);
  const bool has_quantity =
      says(Sense::kAngle) || says(Sense::kRate) || says(Sense::kRaw) || says(Sense::kAcceleration) || is_velocity;
  const bool is_linear_speed = is_velocity && !is_angular && !says(Sense::kAcceleration) && !says(Sense::kRate);
  if (says(Sense::kOther) || (is_linear_speed && last != Sense::kTime)) {
    meaning.is_of_other_quantity = true;
  } else if (says(Sense::kTime) && (last == Sense::kTime || !has_quantity)) {
    meaning.kind = Kind::kTime;
  } else if (says(Sense::kAcceleration)) {
    meaning.is_of_other_quantity = says(Sense::kAngular);
    if (!meaning.is_of_other_quantity) meaning.kind = Kind::kAcceleration;
  } else if (says(Sense::kRate) || (is_velocity && is_angular)) {
    meaning.kind = Kind::kRate;
  } else if (says(Sense::kRaw)) {
    meaning.kind = Kind::kRaw;
  } else if (says(Sense::kAngle)) {
    meaning.kind = Kind::kAngle;
  } else if (says(Sense::kLength)) {
    meaning.kind = Kind::kLength;
  }
  return meaning;
}

// ---- The unit in a name ------------------------------------------------------------------------------------------

/// A name divided into its unit and the rest.
struct Division {
  const Unit* unit = nullptr;
  std::string stem;  // In plain letters.
  bool has_other_unit = false;
};

/// The text in the last brackets of a name; empty if there are none.
std::string_view InBrackets(std::string_view name) {
  const std::size_t open = name.find_last_of("([");
  if (open == std::string_view::npos) return "";
  const std::size_t close = name.find(name[open] == '(' ? ')' : ']', open);
  return close == std::string_view::npos ? "" : Trim(name.substr(open + 1, close - open - 1));
}

/// `10 ms`, `x0.1 deg`, `1/25 s`, `s x 10`, `pi rad`: a multiple of a unit.
bool IsMultiple(std::string_view text) {
  const std::string letters = UnitLetters(text);
  if (UnitOfLetters(letters) != nullptr || IsOtherUnit(letters)) return false;
  bool has_factor = letters.find_first_of("0123456789") != std::string::npos, has_unit = false;
  const std::string plain = PlainName(text);
  for (std::string_view word : WordsIn(plain)) {
    has_factor |= word == "pi";
    while (!word.empty() && IsDigit(word.front())) word.remove_prefix(1);
    has_unit |= UnitOfLetters(word) != nullptr;
  }
  return has_factor && has_unit;
}

/// Whether a text in brackets may be a unit: one short word that says nothing else.
bool IsLikeUnit(std::string_view text) {
  constexpr std::size_t kMostLetters = 8;
  constexpr std::array<std::string_view, 14> kRemarks = {"raw",      "left",   "right",     "top",  "bottom",
                                                         "filtered", "abs",    "rel",       "data", "measured",
                                                         "sensor",   "camera", "unwrapped", "mean"};
  const std::string plain = PlainName(text);
  const bool is_word = plain.find_first_of(" ,;:_") == std::string::npos && plain.size() <= kMostLetters &&
                       plain.find_first_not_of("0123456789xyz") != std::string::npos;
  return is_word && std::ranges::find(kRemarks, plain) == kRemarks.end() && !MeaningOfWords(plain).kind;
}

/// `Angle (deg)`, `Angle [deg] left`.
std::optional<Division> DivideAtBrackets(std::string_view name) {
  for (std::size_t open = name.find_last_of("(["); open != std::string_view::npos && open < name.size();) {
    const std::size_t close = name.find(name[open] == '(' ? ')' : ']', open);
    if (close != std::string_view::npos) {
      const std::string letters = UnitLetters(name.substr(open + 1, close - open - 1));
      std::string stem = PlainName(SplitCamelCase(Trim(name.substr(0, open)))) + " " +
                         PlainName(SplitCamelCase(Trim(name.substr(close + 1))));
      if (const Unit* unit = UnitOfLetters(letters)) return Division{unit, std::move(stem)};
      if (IsOtherUnit(letters)) return Division{nullptr, std::move(stem), true};
    }
    if (open == 0) break;
    open = name.find_last_of("([", open - 1);
  }
  return std::nullopt;
}

/// `phi / deg`, `angle in deg`.
std::optional<Division> DivideAt(std::string_view name, std::string_view mark) {
  for (std::size_t at = name.find(mark); at != std::string_view::npos; at = name.find(mark, at + 1)) {
    const std::string letters = UnitLetters(name.substr(at + mark.size()));
    const std::string_view before = Trim(name.substr(0, at));
    if (before.empty() || letters.empty()) continue;
    if (const Unit* unit = UnitOfLetters(letters)) return Division{unit, PlainName(SplitCamelCase(before))};
    if (IsOtherUnit(letters)) return Division{nullptr, PlainName(SplitCamelCase(before)), true};
  }
  return std::nullopt;
}

/// Whether a short word at the end of a name is its unit and not an index or an abbreviation: `theta_min`, `pos_g`.
bool IsUnitAfter(std::string_view word, const std::string& stem) {
  const std::optional<Kind> kind = MeaningOfWords(stem).kind;
  if (word == "min") return kind == Kind::kTime;
  if (word == "g") return kind == Kind::kAcceleration;
  if (word == "mg") return kind == Kind::kAcceleration || IsAxis(stem);
  if (word == "v") return kind != Kind::kAngle && kind != Kind::kRate;
  if (word == "rev" || word == "turns") return kind == Kind::kAngle;
  return true;
}

/// `angle_deg`, `Gyro rad/s`: the last words are the unit.
std::optional<Division> DivideAtSuffix(const std::string& plain) {
  const std::vector<std::string_view> words = WordsIn(plain);
  constexpr std::size_t kMostWords = 3;
  for (std::size_t count = std::min(kMostWords, words.size()); count > 0; --count) {
    const std::string_view first = words[words.size() - count];
    const auto at = static_cast<std::size_t>(first.data() - plain.data());
    if (at == 0) continue;
    const std::string stem = plain.substr(0, at);
    std::string letters;
    for (std::size_t i = words.size() - count; i < words.size(); ++i) {
      letters += (letters.empty() ? "" : "_") + std::string(words[i]);
    }
    const Unit* unit = UnitOfLetters(letters);
    if (unit == nullptr) unit = UnitOfLetters(UnitLetters(std::string_view(plain).substr(at)));
    if (unit != nullptr && IsUnitAfter(letters, stem)) return Division{unit, stem};
    if (count > 1 && IsOtherUnit(letters)) return Division{nullptr, stem, true};
  }
  return std::nullopt;
}

Division DivideName(std::string_view name) {
  const std::string letters = UnitLetters(name);
  const bool is_ambiguous = letters == "min" || letters == "g" || letters == "mg" || letters == "m";
  if (const Unit* unit = is_ambiguous ? nullptr : UnitOfLetters(letters)) return {unit, ""};
  if (IsMultiple(InBrackets(name)))
    return {nullptr, PlainName(SplitCamelCase(name.substr(0, name.find_last_of("(["))))};
  if (auto found = DivideAtBrackets(name)) return *std::move(found);
  if (auto found = DivideAt(name, "/")) return *std::move(found);
  if (auto found = DivideAt(name, " in ")) return *std::move(found);
  if (auto found = DivideAtSuffix(PlainName(name))) return *std::move(found);
  const std::string split = PlainName(SplitCamelCase(name));
  if (auto found = DivideAtSuffix(split)) return *std::move(found);
  return {nullptr, split};
}

/// The unit among the words of a time: `seconds_elapsed`, `millis since start`.
const Unit* TimeUnitAmong(std::string_view stem) {
  for (const std::string_view word : WordsIn(stem)) {
    const Unit* unit = word.size() > 1 ? UnitOfLetters(word) : nullptr;
    if (unit != nullptr && unit->kind == Kind::kTime) return unit;
  }
  return nullptr;
}

}  // namespace

std::string PlainName(std::string_view name) {
  std::string plain;
  while (!name.empty()) {
    const std::size_t size = SizeOfCharacter(name);
    const auto* const found = std::ranges::find_if(kSpellings, [&](const Spelling& each) {
      return name.starts_with(each.letters) && (size == 0 || each.letters.size() > 1);
    });
    const char c = name.front();
    if (found != kSpellings.end()) {
      plain += found->plain;
      name.remove_prefix(found->letters.size());
    } else if (size == 2 && c == '\xC3' && static_cast<unsigned char>(name[1]) < 0x9F) {
      plain += PlainName(std::string{c, static_cast<char>(name[1] + ('a' - 'A'))});  // a capital letter with an accent
      name.remove_prefix(2);
    } else if (size > 1) {
      plain += name.substr(0, size);
      name.remove_prefix(size);
    } else {
      plain += IsUpper(c) ? static_cast<char>(c - 'A' + 'a') : c;
      name.remove_prefix(1);
    }
  }
  return plain;
}

bool NameMeaning::Has(std::string_view word) const {
  const std::vector<std::string_view> words = WordsIn(stem);
  return std::ranges::find(words, word) != words.end();
}

std::optional<std::size_t> ColumnOfNumber(std::string_view text, std::size_t count) {
  double number = 0;
  const bool is_column =
      ParseNumber(text, number) && number >= 1 && number <= static_cast<double>(count) && number == std::floor(number);
  return is_column ? std::optional(static_cast<std::size_t>(number) - 1) : std::nullopt;
}

const Unit* UnitOfText(std::string_view text) { return UnitOfLetters(UnitLetters(text)); }

NameMeaning MeaningOf(std::string_view name) {
  NameMeaning meaning;
  Division division = DivideName(Trim(name));
  const WordMeaning words = MeaningOfWords(division.stem);
  meaning.is_secondary = words.is_secondary;
  meaning.unit = division.unit;
  meaning.has_other_unit = division.has_other_unit;
  meaning.stem = std::move(division.stem);
  if (meaning.unit != nullptr) {
    if (const auto before = DivideAtSuffix(meaning.stem); before && before->unit != nullptr) {
      meaning.second = before->unit->kind == Kind::kTime ? nullptr : before->unit;
    }
  }
  const bool is_gram = meaning.unit != nullptr && (meaning.unit->suffix == "g" || meaning.unit->suffix == "mg");
  if (is_gram && words.is_of_other_quantity) {
    meaning.unit = nullptr;
    meaning.has_other_unit = true;
  }
  const bool is_time_unit = meaning.unit != nullptr && meaning.unit->kind == Kind::kTime;
  if (is_time_unit) {
    if (WordsIn(meaning.stem).empty() || words.kind == Kind::kTime) meaning.kind = Kind::kTime;
    meaning.has_other_unit = !meaning.kind;
  } else if (meaning.unit != nullptr) {
    meaning.kind = meaning.unit->kind;
  } else if (!meaning.has_other_unit) {
    meaning.kind = words.kind;
    meaning.has_other_unit = words.is_of_other_quantity;
    const std::string_view text = InBrackets(name);
    if (IsMultiple(text) || IsLikeUnit(text)) meaning.unknown_unit = text;
    if (meaning.kind == Kind::kTime) meaning.unit = TimeUnitAmong(meaning.stem);
  }
  return meaning;
}

}  // namespace pendulum::csv
