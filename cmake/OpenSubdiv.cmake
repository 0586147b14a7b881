# The parts of OpenSubdiv that evaluate subdivision surfaces on the CPU (far, with vtr and sdc), compiled into the core
# without visible symbols: Blender loads its own OpenSubdiv, which must not interfere with this one.
# STIV_OPENSUBDIV_SOURCE is the folder of its source (see dependencies.cmake).

file(GLOB opensubdiv_sources
  "${STIV_OPENSUBDIV_SOURCE}/opensubdiv/far/*.cpp"
  "${STIV_OPENSUBDIV_SOURCE}/opensubdiv/sdc/*.cpp"
  "${STIV_OPENSUBDIV_SOURCE}/opensubdiv/vtr/*.cpp")

add_library(stiv_opensubdiv OBJECT ${opensubdiv_sources})
target_include_directories(stiv_opensubdiv SYSTEM PUBLIC "${STIV_OPENSUBDIV_SOURCE}")
target_include_directories(stiv_opensubdiv PRIVATE ${PROJECT_SOURCE_DIR}/native/src)

set_target_properties(stiv_opensubdiv PROPERTIES
  CXX_STANDARD 14
  POSITION_INDEPENDENT_CODE ON
  CXX_VISIBILITY_PRESET hidden
  VISIBILITY_INLINES_HIDDEN ON
  EXPORT_COMPILE_COMMANDS OFF)
# -w only for these files, whose warnings are not ours to fix. Contraction is off as in our own code.
target_compile_options(stiv_opensubdiv PRIVATE -w -ffp-contract=off
  "SHELL:-include \"${PROJECT_SOURCE_DIR}/native/src/deformation/subdivision/opensubdiv_math.hpp\"")
if(STIV_SANITIZE)
  # These checks would end the program, because it takes addresses of elements of empty vectors, which is harmless.
  target_compile_options(stiv_opensubdiv PRIVATE -fno-sanitize=undefined -U_GLIBCXX_ASSERTIONS)
endif()
