#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_arm64.sh PYTHON FOLDER: run the self-test and the Python tests of the core in an emulator, with the arm64 Python in
# FOLDER and the wheel in FOLDER/wheel. Two processes run them, with a tenth of the random examples: an emulator needs
# about ten times as long.
set -eu
python=$1
folder=$(realpath "$2")
here=$(dirname "$0")
rm -rf "$folder/stiv"
"$python" -m zipfile --extract "$folder"/wheel/*.whl "$folder/stiv"

# Tests start this program again as sys.executable, which must not be an arm64 file: the kernel cannot run those.
cat >"$folder/usr/bin/python" <<END
#!/bin/sh
exec qemu-aarch64 -0 "\$0" -L "$folder" "$folder/usr/bin/python3.11" "\$@"
END
chmod +x "$folder/usr/bin/python"

export PYTHONPATH="$folder/stiv:$folder/packages" PYTHONDONTWRITEBYTECODE=1
"$folder/usr/bin/python" -m stiv.command_line self-test
STIV_EXAMPLES=${STIV_EXAMPLES:-0.1} "$folder/usr/bin/python" -m pytest -q -p no:cacheprovider -n 2 --dist worksteal \
    -o faulthandler_timeout=3600 -m "not blender" $(cat "$here/core_tests.txt")
