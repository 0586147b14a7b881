#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# portable_modules.sh PYTHON OPENSUBDIV PLATFORM [TARGET...]: compile the native modules for a platform of
# tools/platforms.txt, or other targets, into build/portable/PLATFORM. Zig's clang (package ziglang of PyPI, installed for
# PYTHON) compiles them and links its C++ library, with nothing of this system but the headers of header-only libraries.
# The core is compiled once. STIV_PYTHONS: fewer versions of Python than the platform's, or none.
set -eu
python=$1
opensubdiv=$(realpath "$2")
platform=$3
shift 3
here=$(dirname "$0")
build=build/portable/$platform
row=$(sed -n "s/^$platform  *//p" "$here/platforms.txt")
[ -n "$row" ] || { echo "portable_modules.sh: no platform $platform in tools/platforms.txt" >&2; exit 2; }
read -r target system processor suffix _ pythons <<END
$row
END
echo "$build: compiling (minutes, the first time)"

mkdir -p "$build/include" "$build/doctest"
zig=$("$python" -c 'import pathlib, ziglang; print(pathlib.Path(ziglang.__file__).parent / "zig")')
zig_cache=$PWD/build/portable/zig-cache
export ZIG_GLOBAL_CACHE_DIR="$zig_cache" ZIG_LOCAL_CACHE_DIR="$zig_cache"

headers=
for version in ${STIV_PYTHONS-$pythons}; do
    suite=$(sed -n "s/^$version  *//p" "$here/extension_pythons.txt")
    case "$system" in
    Windows) folder=build/portable/windows-headers && "$here/windows_headers.sh" "$version" "$suite" "$folder" "$zig" ;;
    *) folder=build/portable/headers && "$here/python_headers.sh" "$version" "$suite" "$folder" ;;
    esac
    headers="$headers${headers:+;}$version=$PWD/$folder/$version"
done

# Only these system headers may be visible: those of the system's C library are for another version or system. Debian's
# configuration of doctest would make all of them visible.
ln -sfn "${STIV_HIGHWAY_INCLUDE:-/usr/include}/hwy" "$build/include/hwy"
ln -sfn /usr/include/doctest "$build/include/doctest"
cat >"$build/doctest/doctestConfig.cmake" <<END
add_library(doctest::doctest INTERFACE IMPORTED)
set_target_properties(doctest::doctest PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "$PWD/$build/include")
END

cat >"$build/compiler.new" <<END
#!/bin/sh
# CMake's test of the compiler is not linked: Zig would compile its C++ library for it with other options.
case "\$*" in *CMakeCXXCompilerId.cpp) set -- -c "\$@" ;; esac
export ZIG_GLOBAL_CACHE_DIR="$zig_cache" ZIG_LOCAL_CACHE_DIR="$zig_cache"
exec "$zig" c++ -target $target "\$@" -Wno-c2y-extensions  # doctest's __COUNTER__
END
for tool in ar ranlib; do
    printf '#!/bin/sh\nexec "%s" %s "$@"\n' "$zig" $tool >"$build/$tool"
done
chmod +x "$build/compiler.new" "$build/ar" "$build/ranlib"
# Replaced only if it differs, because a compiler cache identifies the compiler by this file.
cmp -s "$build/compiler.new" "$build/c++" || mv "$build/compiler.new" "$build/c++"

# Other trial compilations are not linked either.
cmake -S . -B "$build/cmake" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY \
    -DCMAKE_SYSTEM_NAME="$system" -DCMAKE_SYSTEM_PROCESSOR="$processor" -DCMAKE_INSTALL_NAME_TOOL=true \
    -DCMAKE_CXX_COMPILER="$PWD/$build/c++" -DCMAKE_AR="$PWD/$build/ar" -DCMAKE_RANLIB="$PWD/$build/ranlib" \
    -DEigen3_DIR="${Eigen3_DIR:-/usr/share/eigen3/cmake}" -Ddoctest_DIR="$PWD/$build/doctest" \
    -DSTIV_BUILD_PYTHON=OFF -DSTIV_WERROR=ON -DSTIV_MODULE_SUFFIX="$suffix" \
    -DSTIV_HIGHWAY_INCLUDE="$PWD/$build/include" -DSTIV_OPENSUBDIV_SOURCE="$opensubdiv" \
    -Dpybind11_DIR="$("$python" -m pybind11 --cmakedir)" "-DSTIV_PYTHON_HEADERS=$headers" >"$build/cmake.log" 2>&1 ||
    { cat "$build/cmake.log" >&2; exit 1; }
[ $# -gt 0 ] || rm -f "$build"/cmake/native/bindings/_native.*  # of versions that are not requested
cmake --build "$build/cmake" ${STIV_JOBS:+-j$STIV_JOBS} --target "${@:-stiv_portable_modules}" >"$build/build.log" 2>&1 ||
    { cat "$build/build.log" >&2; exit 1; }
