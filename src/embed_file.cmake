# SPDX-License-Identifier: Apache-2.0
# Writes the bytes of FILE as a C++ source, which defines the function NAME of HEADER that returns them:
#   cmake -D FILE=report.html -D HEADER=web/report_page_template.h -D NAME=ReportPageTemplate -D SOURCE=page.cc -P embed_file.cmake
file(READ ${FILE} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "((0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,))" "\\1\n" bytes "${bytes}")
file(WRITE ${SOURCE} "#include \"${HEADER}\"

namespace pendulum {
namespace {

const unsigned char kBytes[] = {
${bytes}};

}  // namespace

std::string_view ${NAME}() { return {reinterpret_cast<const char*>(kBytes), sizeof kBytes}; }

}  // namespace pendulum
")
