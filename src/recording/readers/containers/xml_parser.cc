// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/xml_parser.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <system_error>
#include <utility>

#include <expat.h>

namespace pendulum {

std::string_view LocalName(std::string_view name) { return name.substr(name.find(':') + 1); }  // npos + 1 is 0

std::string_view XmlAttributes::operator[](std::string_view name) const {
  for (const char** pair = pairs_; *pair != nullptr; pair += 2) {
    if (LocalName(*pair) == name) return pair[1];
  }
  return {};
}

bool XmlAttributes::Has(std::string_view name, std::string_view value) const {
  for (const char** pair = pairs_; *pair != nullptr; pair += 2) {
    if (LocalName(*pair) == name && pair[1] == value) return true;
  }
  return false;
}

std::size_t XmlAttributes::Number(std::string_view name, std::size_t missing) const {
  constexpr std::size_t kMax = std::size_t{1} << 31;
  const std::string_view text = (*this)[name];
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc::result_out_of_range) return kMax;
  return error != std::errc() || end != text.data() + text.size() ? missing : std::min(number, kMax);
}

XmlParser::XmlParser(XmlHandlers handlers) : handlers_(std::move(handlers)), parser_(XML_ParserCreate(nullptr)) {
  XML_SetUserData(parser_.get(), this);
  XML_SetElementHandler(
      parser_.get(),
      [](void* self, const char* name, const char** attributes) {
        auto& parser = *static_cast<XmlParser*>(self);
        if (parser.handlers_.start) parser.handlers_.start(LocalName(name), XmlAttributes(attributes));
      },
      [](void* self, const char* name) {
        auto& parser = *static_cast<XmlParser*>(self);
        if (parser.handlers_.end) parser.handlers_.end(LocalName(name));
      });
  XML_SetCharacterDataHandler(parser_.get(), [](void* self, const char* text, int size) {
    auto& parser = *static_cast<XmlParser*>(self);
    if (parser.handlers_.text) parser.handlers_.text({text, static_cast<std::size_t>(size)});
  });
  XML_SetStartDoctypeDeclHandler(parser_.get(), [](void* self, const char*, const char*, const char*, int) {
    static_cast<XmlParser*>(self)->RefuseDocumentType();
  });
}

XmlParser::~XmlParser() = default;

void XmlParser::Free::operator()(XML_ParserStruct* parser) const { XML_ParserFree(parser); }

void XmlParser::Stop() {
  is_stopped_ = true;
  XML_StopParser(parser_.get(), XML_FALSE);
}

void XmlParser::RefuseDocumentType() {
  has_document_type_ = true;
  Stop();
}

bool XmlParser::Add(std::string_view text, bool is_last) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // expat counts bytes in an int.
  if (is_stopped_ || !fault_.empty()) return false;
  do {
    const std::string_view piece = text.substr(0, kPiece);
    text.remove_prefix(piece.size());
    const bool is_end = is_last && text.empty();
    if (XML_Parse(parser_.get(), piece.data(), static_cast<int>(piece.size()), is_end ? 1 : 0) == XML_STATUS_OK) {
      continue;
    }
    if (is_stopped_ && !has_document_type_) return false;
    fault_ = "line " + std::to_string(XML_GetCurrentLineNumber(parser_.get())) + ", column " +
             std::to_string(XML_GetCurrentColumnNumber(parser_.get()) + 1) + ": " +
             (has_document_type_ ? "a document type" : XML_ErrorString(XML_GetErrorCode(parser_.get())));
    return false;
  } while (!text.empty());
  return true;
}

std::string ParseXml(std::string_view text, XmlHandlers handlers) {
  XmlParser parser(std::move(handlers));
  parser.Add(text, true);
  return parser.fault();
}

}  // namespace pendulum
