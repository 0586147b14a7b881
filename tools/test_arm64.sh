#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_arm64.sh PYTHON FOLDER MODULE: run the self-test and the Python tests of the core with this native module, in an
# emulator, with the arm64 Python in FOLDER. Needs the wheel of this source tree in build/wheel, whose module it replaces.
set -eu
python=$1
folder=$(realpath "$2")
module=$3
here=$(dirname "$0")
rm -rf "$folder/wheel" "$folder/stiv"
"$python" "$here/portable_wheels.py" build/wheel/*.whl "$folder/wheel" linux_aarch64 "$module"
"$python" -m zipfile --extract "$folder"/wheel/*.whl "$folder/stiv"

# Tests start this program again as sys.executable, which must not be an arm64 file: the kernel cannot run those.
cat >"$folder/usr/bin/python" <<END
#!/bin/sh
exec qemu-aarch64 -0 "\$0" -L "$folder" "$folder/usr/bin/python3.11" "\$@"
END
chmod +x "$folder/usr/bin/python"

export PYTHONPATH="$folder/stiv:$folder/packages" PYTHONDONTWRITEBYTECODE=1
"$folder/usr/bin/python" -m stiv.command_line self-test
"$folder/usr/bin/python" -m pytest -q -p no:cacheprovider -o faulthandler_timeout=3600 -m "not blender" \
    $(cat "$here/core_tests.txt")
