// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/json_value.h"

#include <algorithm>
#include <limits>

#include <nlohmann/json.hpp>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

/// Receives the parts of a text from nlohmann's parser. The names of its functions are those the parser calls.
class JsonBuilder {
 public:
  JsonBuilder(JsonKeys& keys, JsonValue& root, JsonFault& fault) : keys_(keys), root_(root), fault_(fault) {}

  bool null() { return Add(nullptr); }
  bool boolean(bool value) { return Add(value); }
  bool number_integer(std::int64_t value) { return Add(value); }
  bool number_unsigned(std::uint64_t value) {
    constexpr std::uint64_t kMax = std::numeric_limits<std::int64_t>::max();
    return value > kMax ? Add(static_cast<double>(value)) : Add(static_cast<std::int64_t>(value));
  }
  bool number_float(double value, const std::string&) { return Add(value); }
  bool string(std::string& value) { return Add(std::make_unique<std::string>(std::move(value))); }
  static bool binary(std::vector<std::uint8_t>&) { return false; }
  bool start_object(std::size_t) { return Begin(std::make_unique<JsonObject>()); }
  bool start_array(std::size_t) { return Begin(std::make_unique<JsonArray>()); }
  bool key(std::string& key) {
    key_ = &*keys_.insert(std::move(key)).first;
    return true;
  }
  bool end_object() { return End(); }
  bool end_array() { return End(); }

  bool parse_error(std::size_t byte, const std::string&, const nlohmann::detail::exception& error) {
    const std::string_view what = error.what();
    const std::size_t dash = what.find(" - ");
    std::string_view reason = dash == std::string_view::npos ? "a number is out of range" : what.substr(dash + 3);
    fault_ = {byte > 0 ? byte - 1 : 0, std::string(reason.substr(0, reason.find("; last read")))};
    return false;
  }

 private:
  bool Add(JsonValue value) {
    Place() = std::move(value);
    return true;
  }

  template <typename Container>
  bool Begin(std::unique_ptr<Container> container) {
    constexpr std::size_t kMaxDepth = 32;
    if (open_.size() == kMaxDepth) {
      fault_ = {0, "more than " + std::to_string(kMaxDepth) + " nested brackets"};
      return false;
    }
    JsonValue& place = Place();
    place = std::move(container);
    open_.push_back(&place);
    return true;
  }

  bool End() {
    open_.pop_back();
    return true;
  }

  /// Where the next value belongs. The addresses of open containers stay valid, because only the last one grows.
  JsonValue& Place() {
    if (open_.empty()) return root_;
    if (const auto* array = std::get_if<std::unique_ptr<JsonArray>>(open_.back())) {
      return (*array)->items.emplace_back();
    }
    auto& members = std::get<std::unique_ptr<JsonObject>>(*open_.back())->members;
    return members.emplace_back(key_, nullptr).second;
  }

  JsonKeys& keys_;
  JsonValue& root_;
  JsonFault& fault_;
  const std::string* key_ = nullptr;
  std::vector<JsonValue*> open_;
};

/// Replaces the words NaN and Infinity outside of strings by empty strings, keeping all positions.
std::string WithoutNaN(std::string_view text) {
  std::string plain(text);
  bool is_quoted = false;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (plain[i] == '"') is_quoted = !is_quoted;
    if (is_quoted && plain[i] == '\\') ++i;
    if (is_quoted || (plain[i] != '-' && plain[i] != 'I' && plain[i] != 'N')) continue;
    for (const std::string_view word : {"-Infinity", "Infinity", "NaN"}) {
      if (text.substr(i, word.size()) != word) continue;
      plain.replace(i, word.size(), "\"\"" + std::string(word.size() - 2, ' '));
      ++i;
      break;
    }
  }
  return plain;
}

struct JsonLineWriter {
  std::string& line;

  void operator()(std::nullptr_t) const { line += "null"; }
  void operator()(bool value) const { line += value ? "true" : "false"; }
  void operator()(double value) const { line += NumberText(value); }
  void operator()(std::int64_t value) const { line += std::to_string(value); }
  void operator()(const std::unique_ptr<std::string>& text) const {
    line += nlohmann::json(*text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  void operator()(const std::unique_ptr<JsonArray>& array) const {
    char separator = '[';
    for (const JsonValue& item : array->items) {
      line += separator;
      separator = ',';
      std::visit(*this, item);
    }
    line += separator == '[' ? "[]" : "]";
  }
  void operator()(const std::unique_ptr<JsonObject>& object) const {
    char separator = '{';
    for (const auto& [key, value] : object->members) {
      line += separator;
      separator = ',';
      (*this)(std::make_unique<std::string>(*key));
      line += ':';
      std::visit(*this, value);
    }
    line += separator == '{' ? "{}" : "}";
  }
};

}  // namespace

JsonFault ParseJson(std::string_view text, JsonKeys& keys, JsonValue& value) {
  JsonFault fault;
  JsonBuilder builder(keys, value, fault);
  const bool has_words = text.find("NaN") != std::string_view::npos || text.find("Infinity") != std::string_view::npos;
  const std::string plain = has_words ? WithoutNaN(text) : "";
  const std::string_view parsed = has_words ? std::string_view(plain) : text;
  nlohmann::json::sax_parse(parsed.begin(), parsed.end(), &builder);
  return fault;
}

std::string JsonLine(const JsonValue& value) {
  std::string line;
  std::visit(JsonLineWriter{line}, value);
  return line;
}

const JsonValue* FindMember(const JsonObject& object, std::string_view key) {
  const auto found = std::ranges::find_if(object.members, [&](const auto& member) { return *member.first == key; });
  return found == object.members.end() ? nullptr : &found->second;
}

}  // namespace pendulum
