# SPDX-License-Identifier: GPL-3.0-or-later
"""Fuzz the readers of mesh files, edit scripts, jobs and baselines: they must name the files that they
reject.

    python tests/long/file_fuzzing.py [--seconds 30] [--formats .obj .npz ...] [--seed 1] [--corpus FOLDER]

The readers are written in Python, so libFuzzer cannot trace them. This program does the same with the
interpreter's own tracing: it mutates inputs, and adds those that reach a new pair of lines to the corpus.
Meshes that can be read also run through the exact test. The exit code is 1, and the input is saved, if a
reader raises anything but InputError with the file's name, or takes longer than ten seconds. Memory is
limited to 4 GB.
"""

import argparse
import faulthandler
import io
import sys
import time
import traceback
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS / "faults")]

import numpy as np  # noqa: E402
from test_hostile_files import CORPUS, VALID  # noqa: E402

import stiv  # noqa: E402
from stiv.mesh_files import Mesh  # noqa: E402

PACKAGE = str(Path(stiv.__file__).parent)
HANG = 10  # seconds
MOST_BYTES = 4096
MEMORY = 4 * 2**30
MOST_FACES = 2000  # faces of meshes that run through the exact test

Arc = tuple[str, int, int]
Chance = np.random.Generator

WORDS: dict[str, list[bytes]] = {
    "number": rb"0|-1|1e308|-1e999|nan|inf|2147483648|99999999999999999999|1e-320|0x1".split(b"|"),
    ".obj": [b"v ", b"f ", b"l ", b"o ", b"g ", b"\nf 1 2 3", b"/", b"//", b"\\\n", b"#", b"\r", b"p 1"],
    ".ply": [
        *(b"element vertex ", b"element face ", b"element edge 3\n", b"comment ", b"end_header\n"),
        *(b"property float x\n", b"property list uchar int vertex_indices\n", b"property list double double a\n"),
        *(b"format binary_little_endian 1.0\n", b"format binary_big_endian 1.0\n"),
    ],
    ".npz": rb"'fortran_order': True|'descr': '<U0'|'descr': '|'|O'|'<f2'|'<f16'|(3, 3)|(-1, 3)|'>i8'".split(b"|"),
    "json": [
        *(b"{}", b"[]", b"null", b"true", b'""', b'"\\u0000"', b'"\\ud800"', b"Infinity", b"NaN", b"[[", b'{"', b","),
        *(b'"..":', b'"repeat": 0', b'"points": [0]', b'"mode": "EDIT"', b'"rotate"', b'"scale"', b'"values"'),
        *(b'"check"', b'"repair"', b'"resolve"', b'"frames": "1:5"', b'"output": "a.blend"', b'"report": "a"'),
        *(b'"hold": ["a"]', b'"time_limit": 1'),
    ],
}


@dataclass
class Target:
    """A file format: its reader, the corpus, and the pairs of lines reached so far."""

    suffix: str
    reader: Callable[[Path], object]
    inputs: list[bytes]
    reached: set[Arc] = field(default_factory=set)
    executions: int = 0


class FindingError(Exception):
    """A forbidden outcome of a reader."""


def traced(call: Callable[[], object]) -> tuple[object, set[Arc]]:
    """The result of a call, and the pairs of consecutive lines of the package that it executed."""
    arcs: set[Arc] = set()

    def follow(frame: FrameType) -> Callable:
        file, last = frame.f_code.co_filename, 0

        def line(frame: FrameType, event: str, argument: object) -> Callable:
            nonlocal last
            arcs.add((file, last, frame.f_lineno))
            last = frame.f_lineno
            return line

        return line

    def enter(frame: FrameType, event: str, argument: object) -> Callable | None:
        return follow(frame) if frame.f_code.co_filename.startswith(PACKAGE) else None

    sys.settrace(enter)
    try:
        return call(), arcs
    finally:
        sys.settrace(None)


def execute(target: Target, data: bytes, path: Path) -> set[Arc]:
    """Read one input. Raises FindingError."""
    path.write_bytes(data)
    target.executions += 1

    def read() -> object:
        try:
            return target.reader(path)
        except stiv.InputError as error:
            if str(path) not in str(error):
                raise FindingError(f"the file is not named: {error}") from error
            return None

    faulthandler.dump_traceback_later(HANG, exit=True)
    try:
        read_object, arcs = traced(read)
        if isinstance(read_object, Mesh) and len(read_object.triangles) <= MOST_FACES:
            stiv.find_intersections(read_object.vertices, read_object.triangles)
    except FindingError:
        raise
    except Exception as error:
        raise FindingError(traceback.format_exc()) from error
    finally:
        faulthandler.cancel_dump_traceback_later()
    return arcs


def words_for(suffix: str) -> list[bytes]:
    """Tokens of files of this format."""
    return WORDS["number"] + WORDS["json" if suffix.endswith(".json") else suffix]


def mutated_bytes(chance: Chance, data: bytes, words: list[bytes], other: bytes) -> bytes:
    """One change: a byte, a token, a piece removed, duplicated or moved, or the tail of another input."""
    at = int(chance.integers(len(data) + 1))
    end = at + int(chance.integers(1, 20))
    word = words[chance.integers(len(words))]
    begin, piece, rest = data[:at], data[at:end], data[end:]
    return [
        lambda: begin + chance.bytes(1) + data[at + 1 :],
        lambda: begin + word + data[at:],
        lambda: begin + word + rest,
        lambda: begin + rest,
        lambda: begin + piece + piece + rest,
        lambda: begin + other[int(chance.integers(len(other) + 1)) :],
    ][chance.integers(6)]()


def mutated_archive(chance: Chance, data: bytes, words: list[bytes], other: bytes) -> bytes:
    """An archive whose members are mutated before packing, so that their checksums are valid."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
    except Exception:
        return mutated_bytes(chance, data, words, other)
    stream = io.BytesIO()
    chosen = list(members)[chance.integers(len(members))] if members else ""
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED if chance.integers(2) else zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            changed = mutated_bytes(chance, content, words, content) if name == chosen else content
            archive.writestr(name, changed)
    return stream.getvalue()


def mutated(chance: Chance, target: Target) -> bytes:
    """An input of the corpus with a few changes."""
    data, words = target.inputs[chance.integers(len(target.inputs))], words_for(target.suffix)
    for _ in range(2 ** int(chance.integers(4))):
        other = target.inputs[chance.integers(len(target.inputs))]
        packed = target.suffix == ".npz" and chance.integers(4) > 0
        data = (mutated_archive if packed else mutated_bytes)(chance, data, words, other)
    return data[:MOST_BYTES]


def fuzz(target: Target, seconds: float, chance: Chance, folder: Path) -> None:
    """Read mutated inputs for this long, and extend the corpus. Raises FindingError."""
    path = folder / f"input{target.suffix}"
    for data in target.inputs:
        target.reached |= execute(target, data, path)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        data = mutated(chance, target)
        arcs = execute(target, data, path)
        if not arcs <= target.reached:
            target.reached |= arcs
            target.inputs.append(data)
    path.unlink(missing_ok=True)


def keep(target: Target, corpus: Path) -> int:
    """Write a minimal corpus that reaches the same pairs of lines, small inputs first; returns its size."""
    path = corpus / f"input{target.suffix}"
    left, number = set(target.reached), 0
    for old in corpus.glob(f"[0-9]*{target.suffix}"):
        old.unlink()
    for data in sorted(target.inputs, key=len):
        arcs = execute(target, data, path)
        if arcs & left:
            left -= arcs
            (corpus / f"{number:03}{target.suffix}").write_bytes(data)
            number += 1
    path.unlink(missing_ok=True)
    return number


def limit_memory() -> None:
    """Limit the memory, so that endless allocation fails in this process only."""
    try:
        import resource
    except ImportError:  # not a POSIX system
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def main() -> int:
    """Fuzz all formats in turn."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=30, help="for each format (default 30)")
    parser.add_argument("--formats", nargs="+", choices=list(VALID), default=list(VALID))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--corpus", type=Path, help="write the inputs that reach all there is to reach to this folder")
    parser.add_argument(
        "--findings", type=Path, default=Path("build/fuzz-files"), help="where an input that fails stays"
    )
    chosen = parser.parse_args()
    chosen.findings.mkdir(parents=True, exist_ok=True)
    limit_memory()
    for suffix in chosen.formats:
        reader, valid = VALID[suffix]
        target = Target(suffix, reader, [valid, *(p.read_bytes() for p in sorted(CORPUS.glob(f"[0-9]*{suffix}")))])
        try:
            fuzz(target, chosen.seconds, np.random.default_rng(chosen.seed), chosen.findings)
        except FindingError as finding:
            print(f"{suffix}: after {target.executions} files, {chosen.findings}/input{suffix}:\n{finding}")
            return 1
        counts = f"{target.executions} files read, {len(target.reached)} pairs of lines reached"
        print(f"{suffix}: {counts}, {len(target.inputs)} inputs kept, no finding", flush=True)
        if chosen.corpus:
            chosen.corpus.mkdir(parents=True, exist_ok=True)
            print(f"{suffix}: {keep(target, chosen.corpus)} of them written to {chosen.corpus}", flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
