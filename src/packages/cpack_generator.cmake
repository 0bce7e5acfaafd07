# SPDX-License-Identifier: Apache-2.0
# cpack reads this once for each generator: it selects the components of its packages.
if(CPACK_GENERATOR STREQUAL "TGZ")
  set(CPACK_COMPONENTS_ALL relocatable)
  set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
  set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
else()
  set(CPACK_COMPONENTS_ALL tools debian_tools development debian_development)
  set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
endif()
