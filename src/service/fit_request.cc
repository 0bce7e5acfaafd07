// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/fit_request.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utf8.h"
#include "pendulum/batch/source.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/model/rig_values.h"
#include "pendulum/recording/calibration/calibration_source.h"
#include "pendulum/service/form_data.h"
#include "pendulum/service/media_type.h"
#include "service/escapes.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxFileNameBytes = 200, kMaxNameCharacters = 200, kMaxOptionBytes = 8192;
constexpr std::size_t kMaxUnpackedBytes = std::size_t{1}
                                          << 27;  // Limit for a body that is a zip, a workbook or a MAT-file.
constexpr std::string_view kFormOfJson = R"({"data": "time_s,angle_deg\n...", "rig": {...}, "options": {...}})";

/// The client's name of a file, without folders (old browsers send them) and without control characters.
std::string NameOf(std::string_view filename) {
  const std::size_t slash = filename.find_last_of("/\\");
  if (slash != std::string_view::npos) filename.remove_prefix(slash + 1);
  std::string name;
  while (!filename.empty()) {
    const std::size_t length = std::max<std::size_t>(Utf8Length(filename), 1);
    const std::string_view character = filename.substr(0, length);
    filename.remove_prefix(length);
    if (name.size() + length > kMaxFileNameBytes) break;
    name += Utf8Length(character) == 0 || IsControl(character) ? "_" : character;
  }
  return name.empty() ? kUnnamed : name;
}

bool HasControl(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text);
    if (length == 0 || IsControl(text.substr(0, length))) return true;
    text.remove_prefix(length);
  }
  return false;
}

/// The number of code points of a valid text in UTF-8: all bytes that do not continue one.
std::size_t CharactersOf(std::string_view text) {
  constexpr unsigned kKind = 0xC0, kContinuation = 0x80;
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & kKind) != kContinuation; }));
}

Result<void> CheckName(const std::string& name) {
  if (HasControl(name)) {
    return Error(StatusCode::kInvalidArgument, "name " + Quoted(name) + " has control characters; leave them out");
  }
  const std::size_t characters = CharactersOf(name);
  if (characters > 0 && characters <= kMaxNameCharacters) return {};
  return Error(StatusCode::kInvalidArgument, "name has " + std::to_string(characters) +
                                                 " characters; it must have 1 to " +
                                                 std::to_string(kMaxNameCharacters));
}

/// Adds a flag unless query or body already gave it.
Result<void> AddFlag(const std::string& name, const std::string& text, FlagTexts& flags) {
  if (flags.emplace(name, text).second) return {};
  return Error(StatusCode::kInvalidArgument,
               "--" + name + " is given in the query and in options; leave one of them out");
}

Result<void> AddOptions(const Json& object, FlagTexts& flags) {
  ASSIGN_OR_RETURN(const auto texts, FlagTextsOf(object));
  for (const auto& [name, text] : texts) {
    RETURN_IF_ERROR(AddFlag(name, text, flags));
  }
  return {};
}

/// The query of a request; it is read before the body.
struct Query {
  FlagTexts flags;
  std::string name;  ///< Empty if missing.
};

Result<Query> QueryOf(const RequestTarget& target) {
  Query query;
  for (const auto& [name, value] : target.query) {
    if (name == "name") {
      RETURN_IF_ERROR(CheckName(value));
      query.name = value;
    } else {
      RETURN_IF_ERROR(CheckFlagName(name, RunFlagNames()));
      query.flags.emplace(name, value);
    }
  }
  return query;
}

/// Reads the parts of a form into the request.
class FormReader {
 public:
  explicit FormReader(FitRequest& request) : request_(request) {}

  Result<void> ReadPart(const FormPart& part) {
    if (part.name == "data") {
      request_.data.push_back({NameOf(part.filename), std::string(part.content)});
      return {};
    }
    if (part.name == "rig") return ReadFilePart(part, request_.rig);
    if (part.name == "calibration") return ReadFilePart(part, request_.calibration);
    if (part.name == "sensor") return ReadSensorPart(part);
    if (part.name == "options") return ReadOptionsPart(part);
    return Error(StatusCode::kInvalidArgument, "the form has a part " + Quoted(part.name) +
                                                   "; it may have data, rig, calibration, sensor and options");
  }

 private:
  static Result<void> ReadFilePart(const FormPart& part, SharedFile& file) {
    if (file) return RepeatedPartError(part.name);
    file = Share({part.filename.empty() ? part.name : NameOf(part.filename), std::string(part.content)});
    return {};
  }

  /// A statement about the sensor is an option, so that it is stored as one.
  Result<void> ReadSensorPart(const FormPart& part) {
    if (std::exchange(has_sensor_, true)) return RepeatedPartError(part.name);
    return AddFlag("sensor", std::string(part.content), request_.flags);
  }

  Result<void> ReadOptionsPart(const FormPart& part) {
    if (std::exchange(has_options_, true)) return RepeatedPartError(part.name);
    const auto object = ParseJsonObject(part.content, "options", "set of options", R"({"model": "coulomb"})");
    if (!object) return Error(StatusCode::kInvalidArgument, object.error().message());
    return AddOptions(*object, request_.flags);
  }

  static Result<void> RepeatedPartError(const std::string& name) {
    return Error(StatusCode::kInvalidArgument, "the form has two parts " + name + "; leave one of them out");
  }

  FitRequest& request_;
  bool has_options_ = false, has_sensor_ = false;
};

Result<void> ReadForm(std::string_view content_type, const std::string& body, FitRequest& request) {
  ASSIGN_OR_RETURN(const auto parts, ParseFormData(content_type, body));
  FormReader reader(request);
  for (const FormPart& part : parts) {
    RETURN_IF_ERROR(reader.ReadPart(part));
  }
  return {};
}

/// Reads a rig or calibration of a JSON body; null means none.
Result<void> ReadObject(const std::string& name, const Json& value, SharedFile& file) {
  file.reset();
  if (value.is_null()) return {};
  if (!value.is_object()) {
    return Error(StatusCode::kInvalidArgument,
                 name + " is " + JsonForMessage(value) + "; it must be an object or null");
  }
  file = Share({name, JsonText(value)});
  return {};
}

Result<void> ReadMember(const std::string& name, const Json& value, FitRequest& request) {
  if (name == "rig") return ReadObject(name, value, request.rig);
  if (name == "calibration") return ReadObject(name, value, request.calibration);
  if (name == "options" && value.is_object()) return AddOptions(value, request.flags);
  if ((name == "data" || name == "name") && value.is_string()) return {};
  return Error(StatusCode::kInvalidArgument, Quoted(name) + " is " + JsonForMessage(value) +
                                                 "; the body may have data and name (texts), rig, " +
                                                 "calibration and options (objects)");
}

Result<Json> ParseBody(const std::string& body) {
  auto json = ParseJsonObject(body, "the body", "request", kFormOfJson, body.size());
  if (!json) return Error(StatusCode::kInvalidArgument, json.error().message());
  return json;
}

/// `name` receives the recording's name, if given.
Result<void> ReadJson(const std::string& body, FitRequest& request, std::string& name) {
  ASSIGN_OR_RETURN(auto json, ParseBody(body));
  for (const auto& [key, value] : json.items()) {
    RETURN_IF_ERROR(ReadMember(key, value, request));
  }
  if (json.contains("name")) {
    if (!name.empty()) return Error(StatusCode::kInvalidArgument, "name is given in the query and in the body");
    name = json["name"].get<std::string>();
    RETURN_IF_ERROR(CheckName(name));
  }
  if (json.contains("data")) {
    request.data.push_back({kUnnamed, std::move(json["data"].get_ref<std::string&>())});
  }
  return {};
}

tl::unexpected<Problem> WrongKind(std::string_view type, std::string_view wanted) {
  std::string detail = type.empty() ? "the body has no Content-Type" : "the Content-Type is " + Quoted(type);
  if (type == "application/x-www-form-urlencoded") detail += ", the default of curl";
  return Refused(ProblemKind::kUnsupportedMediaType, detail + "; it must be " + std::string(wanted));
}

bool IsRecording(std::string_view type) {
  constexpr std::array<std::string_view, 8> kTypes = {
      "text/csv",
      "text/plain",
      "text/tab-separated-values",
      "application/octet-stream",
      "application/vnd.ms-excel",  // the type of CSV on Windows
      "application/zip",
      "application/x-zip-compressed",  // the type of zip on Windows
      "application/x-matlab-data",
  };
  return std::ranges::find(kTypes, type) != kTypes.end();
}

/// The type of a body in lower case; the unchanged text if it is invalid; empty if it is missing.
std::string TypeOf(const HttpRequest& request) {
  const auto field = request.Field("Content-Type");
  if (!field) return "";
  const auto type = ParseMediaType(*field);
  return type ? type->type : std::string(*field);
}

ResultOrProblem<void> CheckCoding(const HttpRequest& request) {
  const auto coding = request.Field("Content-Encoding");
  if (!coding || LowerCase(WithoutBlanks(*coding)) == "identity") return {};
  return Refused(ProblemKind::kUnsupportedMediaType,
                 "the body has Content-Encoding " + Quoted(*coding) + "; send it as it is, without one");
}

ResultOrProblem<void> CheckSize(const NamedBytes& data, const RequestLimits& limits) {
  const auto lines = static_cast<std::size_t>(std::ranges::count(data.bytes, '\n'));
  if (data.bytes.size() > kMaxRecordingBytes) {
    return Refused(ProblemKind::kTooLarge, data.name + ": the recording is larger than " +
                                               SizeText(kMaxRecordingBytes) +
                                               "; send a part of it, or use fit_pendulum");
  }
  if (lines <= limits.max_samples) return {};
  return Refused(ProblemKind::kTooLarge, data.name + ": the recording has " + std::to_string(lines) +
                                             " lines, but this service accepts at most " +
                                             std::to_string(limits.max_samples) +
                                             " samples; send a part of it, or use fit_pendulum");
}

/// Limits the options, because each run of a batch stores them.
ResultOrProblem<void> CheckOptions(const FlagTexts& flags) {
  const std::size_t bytes = JsonText(JsonOf(flags)).size();
  if (bytes <= kMaxOptionBytes) return {};
  return Refused(ProblemKind::kTooLarge, "the options have " + std::to_string(bytes) + " bytes, but may have only " +
                                             std::to_string(kMaxOptionBytes) + "; leave some out");
}

/// Makes the options and checks the limits.
ResultOrProblem<FitRequest> Finish(FitRequest request, const RequestLimits& limits) {
  RETURN_IF_ERROR(CheckOptions(request.flags));
  auto options = IdentifyOptionsOf(request.flags, request.calibration);
  if (!options) return Refused(options.error());
  if (request.rig) {
    std::vector<Warning> ignored;  // Reading the recording gives them.
    const auto rig = ParseRigWith(options->rig_values, request.rig->bytes, request.rig->name, ignored);
    if (!rig) return Refused(rig.error());
  }
  if (request.calibration) {
    const auto calibration = CalibrationFromText(request.calibration->bytes, request.calibration->name);
    if (!calibration) return Refused(calibration.error());
  }
  request.options = *std::move(options);
  for (const NamedBytes& data : request.data) {
    RETURN_IF_ERROR(CheckSize(data, limits));
  }
  return request;
}

ResultOrProblem<FitRequest> Begin(const HttpRequest& http, const RequestTarget& target, std::string& name) {
  RETURN_IF_ERROR(CheckCoding(http));
  auto query = QueryOf(target);
  if (!query) return Refused(query.error());
  FitRequest request;
  request.flags = std::move(query->flags);
  name = std::move(query->name);
  return request;
}

}  // namespace

Result<FlagTexts> FlagTextsOf(const Json& object) {
  FlagTexts flags;
  for (const auto& [name, value] : object.items()) {
    if (value.is_structured() || value.is_null()) {
      return Error(StatusCode::kInvalidArgument,
                   "--" + name + " is " + JsonForMessage(value) + "; it must be a text, a number, true or false");
    }
    flags.emplace(name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return flags;
}

Json JsonOf(const FlagTexts& flags) {
  Json object = Json::object();
  for (const auto& [name, text] : flags) object[name] = text;
  return object;
}

Result<IdentifyOptions> IdentifyOptionsOf(const FlagTexts& flags, const SharedFile& calibration) {
  ASSIGN_OR_RETURN(auto run_flags, RunFlagsOf(flags));
  if (calibration) run_flags.calibration = calibration->name;
  auto options = MakeIdentifyOptions(run_flags);
  if (!options) return options;
  if (options->swing.release == SwingChoice::kAll) {
    return Error(
        StatusCode::kInvalidArgument,
        "--release all gives several results for a recording, but a request has one; give the number of a release");
  }
  options->read.most_unpacked_bytes = kMaxUnpackedBytes;
  options->fit.threads = 1;  // parallelism comes from concurrent requests
  return options;
}

Result<FlagTexts> FlagsOf(const FitOrder& order) {
  ASSIGN_OR_RETURN(const auto json, ParseJsonObject(order.flags, "flags", "set of flags", "{}"));
  return FlagTextsOf(json);
}

Result<IdentifyOptions> OptionsOf(const FitOrder& order) {
  ASSIGN_OR_RETURN(const auto flags, FlagsOf(order));
  return IdentifyOptionsOf(flags, order.files.calibration);
}

ResultOrProblem<void> CheckKind(const HttpRequest& request, std::span<const std::string_view> types) {
  RETURN_IF_ERROR(CheckCoding(request));
  const std::string type = TypeOf(request);
  if (std::ranges::find(types, type) != types.end()) return {};
  return WrongKind(type, NameList(types));
}

ResultOrProblem<FitRequest> ParseFitRequest(const HttpRequest& http, const RequestTarget& target,
                                            const RequestLimits& limits) {
  std::string name;
  auto request = Begin(http, target, name);
  if (!request) return request;
  const std::string type = TypeOf(http);
  Result<void> read;
  if (type == "multipart/form-data") {
    read = ReadForm(*http.Field("Content-Type"), http.body, *request);
  } else if (type == "application/json") {
    read = ReadJson(http.body, *request, name);
  } else if (IsRecording(type)) {
    request->data.push_back({kUnnamed, http.body});
  } else {
    return WrongKind(type, "text/csv, multipart/form-data or application/json");
  }
  if (!read) return Refused(read.error());
  if (request->data.size() != 1) {
    return Refused(ProblemKind::kWrongRequest,
                   "the request has " + std::to_string(request->data.size()) +
                       " recordings (parts data), but a fit has one; use POST /v1/batches for several");
  }
  NamedBytes& data = request->data.front();
  if (!name.empty() && data.name == kUnnamed) data.name = NameOf(name);
  request->name = std::move(name);
  return Finish(*std::move(request), limits);
}

ResultOrProblem<std::string> ParseNameRequest(const HttpRequest& http) {
  constexpr std::array<std::string_view, 2> kTypes = {"application/json", "application/merge-patch+json"};
  RETURN_IF_ERROR(CheckKind(http, kTypes));
  auto json = ParseJsonObject(http.body, "the body", "change", R"({"name": "Heavy bob"})", http.body.size());
  if (!json) return Refused(ProblemKind::kWrongRequest, json.error().message());
  if (json->size() != 1 || !json->contains("name") || !(*json)["name"].is_string()) {
    return Refused(ProblemKind::kWrongRequest,
                   "the body is " + JsonForMessage(*json) + "; it must have one member, name, a text");
  }
  auto name = (*json)["name"].get<std::string>();
  if (name.empty()) return name;
  if (auto checked = CheckName(name); !checked) return Refused(checked.error());
  return name;
}

ResultOrProblem<FitRequest> ParseBatchRequest(const HttpRequest& http, const RequestTarget& target,
                                              const RequestLimits& limits) {
  std::string name;
  auto request = Begin(http, target, name);
  if (!request) return request;
  const std::string type = TypeOf(http);
  if (type != "multipart/form-data") return WrongKind(type, "multipart/form-data");
  if (auto read = ReadForm(*http.Field("Content-Type"), http.body, *request); !read) return Refused(read.error());
  if (!name.empty())
    return Refused(ProblemKind::kWrongRequest, "name is for a single fit; in a batch each part has a name");
  if (request->data.empty())
    return Refused(ProblemKind::kWrongRequest, "the form has no part data; a batch needs at least one");
  if (request->data.size() > limits.max_runs) {
    return Refused(ProblemKind::kTooLarge, "the batch has " + std::to_string(request->data.size()) +
                                               " recordings, but this service accepts at most " +
                                               std::to_string(limits.max_runs) + "; send several batches");
  }
  return Finish(*std::move(request), limits);
}

ResultOrProblem<FitRequest> ParseRefitRequest(const HttpRequest& http, const RequestTarget& target, FlagTexts flags,
                                              RunFiles files) {
  std::string name;
  auto changes = Begin(http, target, name);
  if (!changes) return changes;
  FitRequest& request = *changes;
  request.rig = std::move(files.rig);
  request.calibration = std::move(files.calibration);
  if (!http.body.empty()) {
    const std::string type = TypeOf(http);
    if (type != "application/json") return WrongKind(type, "application/json, or the body must be empty");
    if (auto read = ReadJson(http.body, request, name); !read) return Refused(read.error());
  }
  if (!request.data.empty()) {
    return Refused(ProblemKind::kWrongRequest, "a refit uses the stored recording; leave data out");
  }
  if (request.flags.contains("models") || request.flags.contains("model")) {
    flags.erase("model");
    flags.erase("models");
  }
  for (const auto& [flag, text] : request.flags) flags.insert_or_assign(flag, text);
  std::erase_if(flags, [](const auto& flag) { return flag.second.empty(); });
  request.flags = std::move(flags);
  request.data.push_back(std::move(files.data));
  request.name = std::move(name);
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  return Finish(std::move(request), {.max_samples = kAny, .max_runs = kAny});
}

}  // namespace pendulum
