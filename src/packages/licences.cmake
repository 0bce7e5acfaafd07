# SPDX-License-Identifier: Apache-2.0
# The licences of what is in the tools and libraries besides their own code. pendulum_packages is this folder.

# What is compiled in or linked, but for the compiler's own libraries: these are Debian's packages, each with its copyright
# in /usr/share/doc. licences/ has those that are not to be found there: of the pages' uPlot; of Boost, whose licence Debian
# has among those of thousands of files that are not in use here.
set(pendulum_third_parties
  libceres-dev
  libcsv-dev
  libeigen3-dev
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

# The text of a file with a heading, appended to another file.
function(append_licence file name licence)
  if(NOT EXISTS ${licence})
    message(FATAL_ERROR "The packages need the licence of ${name}: there is no ${licence}.")
  endif()
  file(READ ${licence} text)
  string(REPEAT "=" 80 line)
  file(APPEND ${file} "\n${line}\n${name}\n${line}\n\n${text}")
endfunction()

# Writes the copyright file of a package: ours, then all others'.
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

# Puts the texts that a copyright file refers to into a folder, for systems that are not Debian.
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
