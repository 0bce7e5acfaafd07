# SPDX-License-Identifier: Apache-2.0
# The files that Debian requires in share/doc of a package. pendulum_package is its name, pendulum_packages this folder.
include(${pendulum_packages}/licences.cmake)
set(folder $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/doc/${pendulum_package})
write_copyright(${folder}/copyright)
configure_file(${pendulum_packages}/debian/changelog ${folder}/changelog COPYONLY)
file(REMOVE ${folder}/changelog.gz)
execute_process(COMMAND gzip --best --no-name ${folder}/changelog COMMAND_ERROR_IS_FATAL ANY)
