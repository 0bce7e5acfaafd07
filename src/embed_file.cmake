# SPDX-License-Identifier: Apache-2.0
# Writes a file as a C++ source that defines the function NAME of HEADER, which gives its bytes:
#   cmake -D FILE=report.html -D HEADER=report/page_template.h -D NAME=PageTemplate -D SOURCE=page_template.cc -P embed_file.cmake
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
