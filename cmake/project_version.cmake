# SPDX-License-Identifier: GPL-3.0-or-later
# STIV_VERSION: the version in pyproject.toml, the only file that contains it.
set(STIV_PYPROJECT ${CMAKE_CURRENT_LIST_DIR}/../pyproject.toml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${STIV_PYPROJECT})
file(STRINGS ${STIV_PYPROJECT} STIV_VERSION REGEX "^version = \"[0-9.]+\"$")
if(NOT STIV_VERSION MATCHES "^version = \"([0-9]+\\.[0-9]+\\.[0-9]+)\"$")
  message(FATAL_ERROR "pyproject.toml: needs exactly one line such as version = \"1.2.3\"")
endif()
set(STIV_VERSION ${CMAKE_MATCH_1})
