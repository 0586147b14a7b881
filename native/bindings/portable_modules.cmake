# One module for each version of Python in STIV_PYTHON_HEADERS, a list of VERSION=FOLDER, all with the same core. A module
# needs only the headers of its Python, and on Windows the import library of its DLL.
if(NOT TARGET pybind11::headers)
  set(PYBIND11_NOPYTHON ON)
  find_package(pybind11 CONFIG REQUIRED)
endif()

# The ends of the names that each Python looks for: cpython-311-x86_64-linux-gnu.so, cpython-311-darwin.so, and
# cp311-win_amd64.pyd.
set(STIV_MODULE_SUFFIX "${CMAKE_SYSTEM_PROCESSOR}-linux-gnu.so" CACHE STRING "End of the names of the portable modules")
set(python_name cpython-)
if(WIN32)
  set(python_name cp)
endif()

if(APPLE)
  set(CMAKE_SHARED_MODULE_CREATE_CXX_FLAGS -shared)  # Zig's linker makes no bundles; Python loads a library just as well
endif()

add_custom_target(stiv_portable_modules)
foreach(entry IN LISTS STIV_PYTHON_HEADERS)
  string(REGEX MATCH "^3\\.([0-9]+)=(.+)$" matched "${entry}")
  if(NOT matched)
    message(FATAL_ERROR "STIV_PYTHON_HEADERS: \"${entry}\" is not VERSION=FOLDER, such as 3.13=build/python-headers/3.13")
  endif()
  set(minor ${CMAKE_MATCH_1})
  set(folder "${CMAKE_MATCH_2}")
  add_library(_native_cp3${minor} MODULE EXCLUDE_FROM_ALL ${stiv_bindings})
  # Debian's pyconfig.h includes another one in a subfolder named after the processor.
  target_include_directories(_native_cp3${minor} SYSTEM PRIVATE "${folder}/python3.${minor}" "${folder}")
  target_link_libraries(_native_cp3${minor} PRIVATE pybind11::headers)
  stiv_link_module(_native_cp3${minor})
  target_compile_options(_native_cp3${minor} PRIVATE -O1)  # they only translate, and are compiled several times
  set_target_properties(_native_cp3${minor} PROPERTIES
    PREFIX "" IMPORT_PREFIX "" OUTPUT_NAME "_native.${python_name}3${minor}-${STIV_MODULE_SUFFIX}" SUFFIX "")
  # Without debug information, nine tenths of the file.
  target_link_options(_native_cp3${minor} PRIVATE -s)
  if(WIN32 OR APPLE)  # elsewhere, the list of exports hides them
    target_compile_definitions(_native_cp3${minor} PRIVATE PYBIND11_EXPORT_EXCEPTION=)
  endif()
  if(APPLE)
    target_sources(_native_cp3${minor} PRIVATE ${stiv_portable_mac_bindings})
    target_compile_options(_native_cp3${minor} PRIVATE -fvisibility-global-new-delete=force-hidden)
  endif()
  if(WIN32)  # elsewhere, the process that loads the module provides the symbols
    target_link_libraries(_native_cp3${minor} PRIVATE "${folder}/libpython3${minor}.a")
  endif()
  add_dependencies(stiv_portable_modules _native_cp3${minor})
endforeach()
