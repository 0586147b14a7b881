# SPDX-License-Identifier: GPL-3.0-or-later
# Libraries that the core is compiled with: headers of Eigen and Highway, and the source of OpenSubdiv. The module also
# needs the headers of Python. One message lists everything that is missing, and the ways to get it.
set(STIV_OPENSUBDIV_SOURCE "" CACHE PATH "Folder of OpenSubdiv's source (with opensubdiv/far inside)")
set(missing "")

find_package(Eigen3 3.4 QUIET NO_MODULE)
if(NOT Eigen3_FOUND)
  string(APPEND missing
    "* Eigen 3.4 (headers). Debian, Ubuntu: apt-get install libeigen3-dev. Elsewhere: "
    "-DEigen3_DIR=FOLDER, which contains Eigen3Config.cmake.\n")
endif()

# Vector code uses Highway's headers (see native/src/vector/foreach_target.hpp), but not its library.
find_path(STIV_HIGHWAY_INCLUDE hwy/highway.h DOC "Folder of Highway's headers (with hwy/highway.h inside)")
if(NOT STIV_HIGHWAY_INCLUDE)
  string(APPEND missing
    "* Highway 1.0 (headers). Debian, Ubuntu: apt-get install libhwy-dev. Elsewhere: "
    "-DSTIV_HIGHWAY_INCLUDE=FOLDER, which contains hwy/highway.h.\n")
endif()

if(STIV_BUILD_PYTHON)
  find_package(Python QUIET COMPONENTS Interpreter Development.Module)
  if(NOT Python_FOUND)
    string(APPEND missing
      "* The headers of Python. Debian, Ubuntu: apt-get install python3-dev. Elsewhere: "
      "-DPython_ROOT_DIR=FOLDER, a Python with its headers.\n")
  endif()
endif()

# pip has no folder to name, so its build downloads the source from Debian, without privileges.
if(NOT STIV_OPENSUBDIV_SOURCE AND SKBUILD)
  set(STIV_OPENSUBDIV_SOURCE "${PROJECT_BINARY_DIR}/opensubdiv")
  find_program(STIV_SHELL sh)
  mark_as_advanced(STIV_SHELL)
  if(STIV_SHELL)
    execute_process(COMMAND "${CMAKE_COMMAND}" -E env "CMAKE=${CMAKE_COMMAND}"
      "${STIV_SHELL}" "${PROJECT_SOURCE_DIR}/tools/opensubdiv_source.sh" "${STIV_OPENSUBDIV_SOURCE}")
  endif()
endif()
if(NOT EXISTS "${STIV_OPENSUBDIV_SOURCE}/opensubdiv/far/stencilTable.h")
  string(APPEND missing
    "* The source of OpenSubdiv 3.5 (there is no opensubdiv/far/stencilTable.h in \"${STIV_OPENSUBDIV_SOURCE}\"). Debian: "
    "tools/opensubdiv_source.sh FOLDER downloads it. Elsewhere: unpack a release of "
    "https://github.com/PixarAnimationStudios/OpenSubdiv. Then: -DSTIV_OPENSUBDIV_SOURCE=FOLDER.\n")
endif()

if(missing)
  message(FATAL_ERROR
    "STIV cannot be compiled yet. Missing:\n${missing}"
    "With pip, pass an option -DNAME=VALUE as --config-settings=cmake.define.NAME=VALUE. "
    "docs/installing.md describes the build.")
endif()
