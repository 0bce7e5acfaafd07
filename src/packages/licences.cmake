# SPDX-License-Identifier: Apache-2.0
# The licences of third-party code in the tools and libraries. pendulum_packages is this folder.

# Third-party code that is compiled in or linked, except the compiler's own libraries. These are Debian packages, each
# with its copyright in /usr/share/doc. licences/ has those that are missing there: for uPlot and uqr in the pages, and for
# Boost, whose licence in Debian is one among those of thousands of unused files.
set(pendulum_third_parties
  libceres-dev
  libeigen3-dev
  libexpat1-dev
  libexpected-dev
  libgflags-dev
  libgoogle-glog-dev
  libhdf5-dev
  libmatio-dev
  libsqlite3-dev
  libsqlitecpp-dev
  libssl-dev
  libzip4
  nlohmann-json3-dev
  prometheus-cpp-dev
  zlib1g-dev)

# Appends the text of a file, with a heading, to another file.
function(append_licence file name licence)
  if(NOT EXISTS ${licence})
    message(FATAL_ERROR "The packages need the licence of ${name}: there is no ${licence}.")
  endif()
  file(READ ${licence} text)
  string(REPEAT "=" 80 line)
  file(APPEND ${file} "\n${line}\n${name}\n${line}\n\n${text}")
endfunction()

# Writes the copyright file of a package: our licence, then all others.
function(write_copyright file)
  configure_file(${pendulum_packages}/copyright.in ${file} COPYONLY)
  file(GLOB texts ${pendulum_packages}/licences/*)
  foreach(text ${texts})
    cmake_path(GET text FILENAME name)
    append_licence(${file} ${name} ${text})
  endforeach()
  foreach(package ${pendulum_third_parties})
    append_licence(${file} ${package} /usr/share/doc/${package}/copyright)
  endforeach()
endfunction()

# Copies the texts that a copyright file refers to into a folder, for systems other than Debian.
function(copy_common_licences copyright folder)
  file(READ ${copyright} text)
  string(REGEX MATCHALL "/usr/share/common-licenses/[A-Za-z0-9]+(-[0-9]+(\\.[0-9]+)*)?" paths "${text}")
  file(MAKE_DIRECTORY ${folder})
  foreach(path ${paths})
    file(REAL_PATH ${path} file)
    cmake_path(GET path FILENAME name)
    file(COPY_FILE ${file} ${folder}/${name} ONLY_IF_DIFFERENT)
  endforeach()
endfunction()
