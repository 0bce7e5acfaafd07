// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/json.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

/// Watches the parser. It records the key of the outermost object that is being read, a repeated key, and whether the
/// object exceeds kMaxJsonDepth or kMaxJsonKeys.
class JsonKeyChecker {
 public:
  /// Whether the parser should keep the value.
  bool ShouldKeep(int depth, Json::parse_event_t event, const Json& parsed) {
    if (depth > kMaxJsonDepth || seen_ > kMaxJsonKeys) exceeds_limits_ = true;
    if (!exceeds_limits_) Note(depth, event, parsed);
    return !exceeds_limits_;
  }

  std::string outermost_key() const { return keys_.empty() || keys_[0].empty() ? "" : keys_[0].back(); }
  const std::optional<std::string>& repeated() const { return repeated_; }
  bool exceeds_limits() const { return exceeds_limits_; }

 private:
  void Note(int depth, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) {
      keys_.resize(std::max<std::size_t>(keys_.size(), depth + 1));
      keys_[depth].clear();
    } else if (event == Json::parse_event_t::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      std::vector<std::string>& keys = keys_[depth - 1];
      if (!repeated_ && std::ranges::find(keys, key) != keys.end()) repeated_ = key;
      keys.push_back(key);
      ++seen_;
    }
  }

  std::vector<std::vector<std::string>> keys_;  // For each depth, the keys of the open object.
  std::optional<std::string> repeated_;
  int seen_ = 0;  // Number of keys.
  bool exceeds_limits_ = false;
};

/// Converts the parser's byte offset into line and column.
tl::unexpected<Status> NotJson(std::string_view text, const std::string& name, const Json::parse_error& error) {
  const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0: the first line.
  const std::string_view what = error.what();
  const std::size_t dash = what.find(" - ");
  std::string_view reason = dash == std::string_view::npos ? "syntax error" : what.substr(dash + 3);
  reason = reason.substr(0, reason.find("; last read"));
  return Fault(name + ":" + std::to_string(std::ranges::count(before, '\n') + 1) + ":" +
                   std::to_string(before.size() - line_begin + 1),
               "this is not JSON (" + std::string(reason) + "); correct it here");
}

}  // namespace

Result<Json> ParseJsonObject(std::string_view text, const std::string& name, std::string_view kind,
                             std::string_view form, std::size_t max_bytes) {
  const std::string what(kind);
  if (text.size() > max_bytes) {
    return Fault(name, "this is longer than " + std::to_string(max_bytes / 1024) + " KiB, so it is not a " + what +
                           "; name a " + what + " file");
  }
  JsonKeyChecker watch;
  const auto see = [&watch](int depth, Json::parse_event_t event, const Json& parsed) {
    return watch.ShouldKeep(depth, event, parsed);
  };
  try {
    Json json = Json::parse(text, see);
    if (watch.exceeds_limits()) {
      return Fault(name, "this has more than " + std::to_string(kMaxJsonKeys) + " keys, or more than " +
                             std::to_string(kMaxJsonDepth) + " nested brackets, so it is not a " + what);
    }
    if (!json.is_object()) {
      return Fault(name,
                   "the " + what + " is " + JsonForMessage(json) + "; it must be an object: " + std::string(form));
    }
    if (watch.repeated()) {
      return Fault(name, "the key " + Quoted(*watch.repeated()) + " is given twice; keep one of them");
    }
    return json;
  } catch (const Json::parse_error& error) {
    return NotJson(text, name, error);
  } catch (const Json::exception&) {  // A number is too large for a double.
    return Fault(name, Quoted(watch.outermost_key()) + " is larger than a number can be (about 1e308); correct it");
  }
}

std::string JsonForMessage(const Json& value) {
  if (value.is_string()) return Quoted(value.get_ref<const std::string&>());
  if (value.is_structured()) return value.is_array() ? "an array" : "an object";
  return value.dump();
}

std::string JsonText(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace pendulum
