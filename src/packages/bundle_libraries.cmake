# SPDX-License-Identifier: Apache-2.0
# Completes an installed folder so that it runs from any place. lib/ gets every shared library that the tools need,
# except glibc's; share/doc/ gets their licences and those of code in the tools. pendulum_tools are the built tools,
# pendulum_strip is strip, pendulum_packages this folder.
include(${pendulum_packages}/licences.cmake)
set(prefix $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})
set(glibc "^(ld-linux.*|libc|libm|libmvec|libpthread|libdl|librt|libresolv|libutil)\\.so")

# The Debian package that owns a file, without the architecture; "" if there is none.
function(find_debian_package file result)
  # If /lib is a link to /usr/lib, dpkg knows the file only by the name in its package.
  string(REGEX REPLACE "^/usr/" "/" short ${file})
  foreach(name ${file} ${short})
    execute_process(COMMAND dpkg-query --search ${name} OUTPUT_VARIABLE found ERROR_QUIET RESULT_VARIABLE code)
    if(code EQUAL 0 AND found MATCHES "(^|\n)([a-z0-9.+-]+)(:[a-z0-9]+)?: ")
      set(${result} ${CMAKE_MATCH_2} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  set(${result} "" PARENT_SCOPE)
endfunction()

# The licence of a package, and the texts that it refers to.
function(copy_licence package)
  file(REAL_PATH /usr/share/doc/${package}/copyright licence)
  file(MAKE_DIRECTORY ${prefix}/share/doc/${package})
  file(COPY_FILE ${licence} ${prefix}/share/doc/${package}/copyright)
  copy_common_licences(${licence} ${prefix}/share/doc/common-licenses)
endfunction()

file(MAKE_DIRECTORY ${prefix}/share/doc/pendulum)
write_copyright(${prefix}/share/doc/pendulum/copyright)
copy_common_licences(${prefix}/share/doc/pendulum/copyright ${prefix}/share/doc/common-licenses)

file(GET_RUNTIME_DEPENDENCIES
  EXECUTABLES ${pendulum_tools}
  RESOLVED_DEPENDENCIES_VAR libraries
  PRE_EXCLUDE_REGEXES ${glibc})
file(MAKE_DIRECTORY ${prefix}/lib)
foreach(library ${libraries})
  cmake_path(GET library FILENAME name)
  file(REAL_PATH ${library} file)
  find_debian_package(${file} package)
  if(package STREQUAL "")
    message(FATAL_ERROR "The tarball needs ${file}, whose licence is not known: it is of no Debian package.")
  endif()
  copy_licence(${package})
  # With the name used for loading, and without a RUNPATH, which would disable the tools' RPATH.
  file(COPY_FILE ${file} ${prefix}/lib/${name})
  file(CHMOD ${prefix}/lib/${name} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  file(RPATH_REMOVE FILE ${prefix}/lib/${name})
endforeach()
foreach(tool ${pendulum_tools})
  cmake_path(GET tool FILENAME name)
  execute_process(COMMAND ${pendulum_strip} ${prefix}/bin/${name} COMMAND_ERROR_IS_FATAL ANY)
  # CMake ends the RPATH with an empty element, which would mean the current folder.
  file(RPATH_CHANGE FILE ${prefix}/bin/${name} OLD_RPATH "$ORIGIN/../lib:" NEW_RPATH "$ORIGIN/../lib")
endforeach()
