# SPDX-License-Identifier: Apache-2.0
# Writes the completions of each tool for bash, zsh and fish into an installed folder, where these shells look for them.
# The tools print them (--completion). pendulum_tools are the built tools.
set(folder $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share)
set(zsh_folder site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL /usr AND EXISTS /etc/debian_version)
  set(zsh_folder vendor-completions)  # Debian's zsh looks for site-functions only below /usr/local
endif()
foreach(tool ${pendulum_tools})
  cmake_path(GET tool FILENAME name)
  foreach(place bash:bash-completion/completions/${name} zsh:zsh/${zsh_folder}/_${name}
                fish:fish/vendor_completions.d/${name}.fish)
    string(REGEX MATCH "^([a-z]+):(.*)$" whole ${place})
    set(shell ${CMAKE_MATCH_1})
    set(file ${folder}/${CMAKE_MATCH_2})
    cmake_path(GET file PARENT_PATH parent)
    file(MAKE_DIRECTORY ${parent})
    execute_process(COMMAND ${tool} --completion ${shell} OUTPUT_FILE ${file} COMMAND_ERROR_IS_FATAL ANY)
    file(CHMOD ${file} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  endforeach()
endforeach()
