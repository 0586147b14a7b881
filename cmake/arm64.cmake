# SPDX-License-Identifier: GPL-3.0-or-later
# Toolchain for arm64 on another architecture: Debian's cross compiler, and Debian's emulator for its programs.
# Header-only libraries fit every architecture; they are passed to the compiler one by one, because the C library's
# headers in the same folder do not.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu)

set(header_libraries "${CMAKE_BINARY_DIR}/header_libraries")
file(MAKE_DIRECTORY "${header_libraries}")
foreach(library doctest hwy)
  file(CREATE_LINK "/usr/include/${library}" "${header_libraries}/${library}" SYMBOLIC)
endforeach()
set(CMAKE_CXX_FLAGS_INIT "-isystem ${header_libraries}")
