// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

struct XML_ParserStruct;  // expat's parser

namespace pendulum {

/// The attributes of an element, by name without prefix.
class XmlAttributes {
 public:
  explicit XmlAttributes(const char** pairs) : pairs_(pairs) {}

  /// The value, or an empty text if there is no such attribute.
  std::string_view operator[](std::string_view name) const;

  /// True if one of the attributes with this name has this value; names with different prefixes are equal.
  bool Has(std::string_view name, std::string_view value) const;

  /// A whole number from 0 to 2^31, or `missing`.
  std::size_t Number(std::string_view name, std::size_t missing) const;

 private:
  const char** pairs_;
};

/// A name without its prefix: "cell" for "table:cell".
std::string_view LocalName(std::string_view name);

/// Called for each start and end of an element (by its name without prefix) and for text in pieces.
struct XmlHandlers {
  std::function<void(std::string_view name, const XmlAttributes& attributes)> start;
  std::function<void(std::string_view name)> end;
  std::function<void(std::string_view text)> text;
};

/// Parses an XML text that arrives in pieces, with expat. A document type, which could define entities, is a fault.
class XmlParser {
 public:
  explicit XmlParser(XmlHandlers handlers);
  XmlParser(const XmlParser&) = delete;
  XmlParser(XmlParser&&) = delete;
  XmlParser& operator=(const XmlParser&) = delete;
  XmlParser& operator=(XmlParser&&) = delete;
  ~XmlParser();

  /// False after a fault or Stop.
  bool Add(std::string_view text, bool is_last = false);

  /// Ends parsing; handlers may call it.
  void Stop();

  /// "line 3, column 5: not well-formed (invalid token)"; empty if there is none, also after Stop.
  const std::string& fault() const { return fault_; }

 private:
  struct Free {
    void operator()(XML_ParserStruct* parser) const;
  };

  void RefuseDocumentType();

  XmlHandlers handlers_;
  std::unique_ptr<XML_ParserStruct, Free> parser_;
  std::string fault_;
  bool is_stopped_ = false;
  bool has_document_type_ = false;
};

/// Parses a whole text. Returns the fault, or an empty text.
std::string ParseXml(std::string_view text, XmlHandlers handlers);

}  // namespace pendulum
