# SPDX-License-Identifier: Apache-2.0
# Writes the page as a C++ source: cmake -D PAGE=report.html -D SOURCE=page_template.cc -P embed_page.cmake
file(READ ${PAGE} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "((0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,))" "\\1\n" bytes "${bytes}")
file(WRITE ${SOURCE} "#include \"report/page_template.h\"

namespace pendulum {
namespace {

const unsigned char kPage[] = {
${bytes}};

}  // namespace

std::string_view PageTemplate() { return {reinterpret_cast<const char*>(kPage), sizeof kPage}; }

}  // namespace pendulum
")
