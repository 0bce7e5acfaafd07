# SPDX-License-Identifier: Apache-2.0
# Writes a page as a C++ source that defines the function NAME of report/HEADER:
#   cmake -D PAGE=report.html -D HEADER=page_template.h -D NAME=PageTemplate -D SOURCE=page_template.cc -P embed_page.cmake
file(READ ${PAGE} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "((0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,))" "\\1\n" bytes "${bytes}")
file(WRITE ${SOURCE} "#include \"report/${HEADER}\"

namespace pendulum {
namespace {

const unsigned char kPage[] = {
${bytes}};

}  // namespace

std::string_view ${NAME}() { return {reinterpret_cast<const char*>(kPage), sizeof kPage}; }

}  // namespace pendulum
")
