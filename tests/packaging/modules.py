# SPDX-License-Identifier: GPL-3.0-or-later
"""Inspection of compiled modules for any system, with binutils and LIEF."""

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path


def lines_of(*command: str | Path) -> list[str]:
    """Output of a command."""
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def exported_names(module: str | Path) -> set[str]:
    """Symbols that other libraries can bind to."""
    rows = [line.split() for line in lines_of("readelf", "--dyn-syms", "--wide", module)]
    return {row[7].split("@")[0] for row in rows if len(row) > 7 and row[4] in {"GLOBAL", "WEAK"} and row[6] != "UND"}


def needed_libraries(module: str | Path) -> set[str]:
    """Shared libraries that the module needs."""
    return {line.split("[")[1].rstrip("]") for line in lines_of("readelf", "-d", module) if "(NEEDED)" in line}


# Functions of the C library whose results differ between systems
INEXACT = re.compile(
    r"_?_?(a?(sin|cos|tan)h?|sincos|atan2|exp|exp2|expm1|log|log2|log10|log1p|pow|hypot|cbrt|fma)[fl]?"
)


def inexact_functions(names: set[str]) -> set[str]:
    """Those of imported names whose results differ between systems."""
    return {name for name in names if INEXACT.fullmatch(name)}


def imported_names(module: str | Path) -> set[str]:
    """Symbols that a Linux module needs from other libraries."""
    rows = [line.split() for line in lines_of("readelf", "--dyn-syms", "--wide", module)]
    return {row[7].split("@")[0] for row in rows if len(row) > 7 and row[6] == "UND"}


def newest_glibc(module: str | Path) -> tuple[int, ...]:
    """The version of the C library that the module needs."""
    found = re.findall(r"GLIBC_(\d+)\.(\d+)", "\n".join(lines_of("readelf", "-V", module)))
    return max((int(major), int(minor)) for major, minor in found)


def windows_interface(module: Path) -> tuple[set[str], set[str]]:
    """Exported names of a Windows module, and the libraries that it needs."""
    import lief

    parsed = lief.PE.parse(str(module))
    return {entry.name for entry in parsed.get_export().entries}, {entry.name for entry in parsed.imports}


@dataclass(frozen=True)
class MacModule:
    """Properties of a module that the loader of macOS reads."""

    processor: str
    exported: set[str]
    libraries: set[str]
    oldest: tuple[int, ...]  # the version of macOS
    signed: bool
    imported: set[str]
    merged: set[str]  # names that the loader may take from another library, such as Blender's


def mac_module(module: Path) -> MacModule:
    """Inspect a macOS module."""
    import lief

    file = lief.MachO.parse(str(module))  # owns what it contains
    parsed = file.at(0)
    names = {str(symbol.name) for symbol in parsed.exported_symbols}
    return MacModule(
        parsed.header.cpu_type.name,
        names - {"__mh_dylib_header", "__mh_bundle_header", "___dso_handle"},  # the linker's own
        {library.name for library in parsed.libraries if library.command == lief.MachO.LoadCommand.TYPE.LOAD_DYLIB},
        tuple(parsed.build_version.minos),
        parsed.has_code_signature,
        {str(symbol.name) for symbol in parsed.imported_symbols},
        {str(bound.symbol.name) for bound in parsed.bindings if bound.weak_import},
    )


def fused_operations(module: Path) -> int:
    """Multiplications with an addition in one rounding, in a module for arm64."""
    code = "\n".join(lines_of("llvm-objdump", "--disassemble", "--no-show-raw-insn", module))
    assert len(re.findall(r"\tfmul\b", code)) > 1000  # it is disassembled
    return len(re.findall(r"\t(?:fn?m(?:add|sub)|fml[as])\b", code))


def oldest_tags(wheel: Path) -> set[str]:
    """The tags of the oldest C libraries that a Linux wheel runs with, as auditwheel finds them."""
    said = " ".join(lines_of(sys.executable, "-m", "auditwheel", "show", wheel))
    return set(re.findall(r'consistent with the following platform tag: "(\w+)"', said))


OTOOL = """#!/bin/sh
# LLVM's otool knows no -m, which only says that names of files may contain brackets.
for argument; do shift; [ "$argument" = -m ] || set -- "$@" "$argument"; done
exec "{}" "$@"
"""


def libraries_by_delocate(wheel: Path, tools: Path) -> set[str]:
    """Shared libraries that a macOS wheel needs, as delocate lists them with LLVM's tools, linked into a new folder."""
    tools.mkdir()
    llvm = sorted(Path("/usr/lib").glob("llvm-*/bin/llvm-otool"))[-1].parent
    (tools / "lipo").symlink_to(llvm / "llvm-lipo")
    (tools / "otool").write_text(OTOOL.format(llvm / "llvm-otool"), encoding="utf-8")
    (tools / "otool").chmod(0o755)
    listing = [sys.executable, "-m", "delocate.cmd.delocate_listdeps", "--all", wheel]
    search = os.environ | {"PATH": f"{tools}:{os.environ['PATH']}"}
    return set(subprocess.run(listing, env=search, capture_output=True, text=True, check=True).stdout.split())
