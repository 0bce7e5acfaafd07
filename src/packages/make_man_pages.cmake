# SPDX-License-Identifier: Apache-2.0
# Writes a manual page for each tool into share/man/man1 of an installed folder, from its --help and the sections in
# man/NAME.h2m. pendulum_tools are the built tools, pendulum_packages is this folder.
set(folder $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/man/man1)

# Finds a program, or fails with the name of its Debian package: find_packaging_program(NAME PACKAGE RESULT)
function(find_packaging_program name package result)
  find_program(program ${name} NO_CACHE)
  if(NOT program)
    message(FATAL_ERROR
      "Manual pages need ${name}, which Debian has as ${package}: run scripts/install_dependencies --packages.")
  endif()
  set(${result} ${program} PARENT_SCOPE)
endfunction()

find_packaging_program(help2man help2man help2man)
find_packaging_program(dpkg-parsechangelog dpkg-dev dpkg_parsechangelog)
find_packaging_program(gzip gzip gzip)

# The date of the version, not of the build, so the same sources give the same pages.
execute_process(
  COMMAND ${dpkg_parsechangelog} --file ${pendulum_packages}/debian/changelog --show-field Timestamp
  OUTPUT_VARIABLE date
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(MAKE_DIRECTORY ${folder})
foreach(tool ${pendulum_tools})
  cmake_path(GET tool FILENAME name)
  set(page ${folder}/${name}.1)
  execute_process(
    COMMAND
      ${CMAKE_COMMAND} -E env LC_ALL=C.UTF-8 SOURCE_DATE_EPOCH=${date}
      ${help2man} --locale=C.UTF-8 --no-info --manual=pendulum --include=${pendulum_packages}/man/${name}.h2m
      --output=${page} "'${pendulum_packages}/man/help_for_man' '${tool}'"
    COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE ${page}.gz)
  execute_process(COMMAND ${gzip} --best --no-name ${page} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
