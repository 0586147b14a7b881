#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# portable_modules.sh PYTHON OPENSUBDIV VERSION...: compile the native module for these versions of Python, or all of
# tools/extension_pythons.txt, into build/portable/cmake/native/bindings. The modules need only glibc 2.17 or later: Zig's
# clang (package ziglang of PyPI, installed for PYTHON) compiles them and links its C++ library. The core is compiled once.
set -eu
python=$1
opensubdiv=$(realpath "$2")
here=$(dirname "$0")
shift 2
build=build/portable
echo "$build: compiling the modules of the extension (minutes, the first time)"

headers=
while read -r version suite; do
    [ $# -eq 0 ] || case " $* " in *" $version "*) ;; *) continue ;; esac
    "$here/python_headers.sh" "$version" "$suite" "$build/headers"
    headers="$headers${headers:+;}$version=$PWD/$build/headers/$version"
done <"$here/extension_pythons.txt"
[ -n "$headers" ] || { echo "portable_modules.sh: no Python $* in tools/extension_pythons.txt" >&2; exit 2; }

# Only these system headers may be visible: those of the system's C library have another version.
highway=${STIV_HIGHWAY_INCLUDE:-/usr/include}
mkdir -p "$build/include"
ln -sfn "$highway/hwy" "$build/include/hwy"

mkdir -p "$build"
zig=$("$python" -c 'import pathlib, ziglang; print(pathlib.Path(ziglang.__file__).parent / "zig")')
cat >"$build/compiler.new" <<END
#!/bin/sh
# CMake's test of the compiler is not linked: Zig would compile its C++ library for it with other options.
case "\$*" in *CMakeCXXCompilerId.cpp) set -- -c "\$@" ;; esac
export ZIG_GLOBAL_CACHE_DIR="$PWD/$build/cache" ZIG_LOCAL_CACHE_DIR="$PWD/$build/cache"
exec "$zig" c++ -target x86_64-linux-gnu.2.17 "\$@"
END
chmod +x "$build/compiler.new"
# Replaced only if it differs, because a compiler cache identifies the compiler by this file.
cmp -s "$build/compiler.new" "$build/c++" || mv "$build/compiler.new" "$build/c++"

# Other trial compilations are not linked either.
cmake -S . -B "$build/cmake" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY \
    -DCMAKE_CXX_COMPILER="$PWD/$build/c++" -DSTIV_BUILD_TESTS=OFF -DSTIV_BUILD_PYTHON=OFF -DSTIV_WERROR=ON \
    -DSTIV_HIGHWAY_INCLUDE="$PWD/$build/include" -DSTIV_OPENSUBDIV_SOURCE="$opensubdiv" \
    -Dpybind11_DIR="$("$python" -m pybind11 --cmakedir)" "-DSTIV_PYTHON_HEADERS=$headers" >"$build/cmake.log" 2>&1 ||
    { cat "$build/cmake.log" >&2; exit 1; }
rm -f "$build"/cmake/native/bindings/_native.*.so  # of versions that are not requested
cmake --build "$build/cmake" --target stiv_portable_modules >"$build/build.log" 2>&1 ||
    { cat "$build/build.log" >&2; exit 1; }
