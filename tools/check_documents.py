# SPDX-License-Identifier: GPL-3.0-or-later
"""Check the documents: words, length of sentences and lines, links, and the references of the code to mathematics.md.

Words and sentences are checked in documents alone; sources are exempt until their names and comments are rewritten.
Usage: check_documents.py. Prints FILE:LINE: MESSAGE for each finding; the exit code is 1 if there are any.
"""

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DIALECT = ROOT / "tools/dialect.txt"
WIDTH = 110  # characters of a line, except in tables and code
WORDS = 30  # in a sentence; the aim is 25
SOURCES = (".cpp", ".hpp", ".py", ".md")
REFERENCE = re.compile(r"(mathematics|experiments)\.md\)?,\s*(?://+\s*)?(?:\"([^\"]+)\"|Eq\. (\d))")

Finding = tuple[int, str]
Passage = tuple[int, str]


def blanked(text: str) -> str:
    """A document without code blocks, display equations and comments; its lines keep their numbers."""
    parts = r"^```.*?^```|\$\$.*?\$\$|<!--.*?-->|^    \S.*?$"
    return re.sub(parts, lambda found: "\n" * found[0].count("\n"), text, flags=re.DOTALL | re.MULTILINE)


def passages(text: str) -> Iterator[Passage]:
    """Paragraphs, items of lists and cells of tables, each with the number of its first line."""
    first, lines = 0, list[str]()
    for number, line in enumerate([*blanked(text).split("\n"), ""], 1):
        item = re.match(r"\s*([-*]|\d+\.) ", line)
        whole = not line.strip() or line.lstrip().startswith(("|", "#", "!["))
        if lines and (item or whole):
            yield first, " ".join(lines)
            lines = []
        if line.startswith("|"):
            yield from ((number, cell.strip()) for cell in line.strip("|").split("|"))
        elif not whole:
            first = first if lines else number
            lines.append(line[item.end() :] if item else line.strip())


def spoken(passage: str) -> str:
    """A passage without code, formulas, citations and the addresses of links."""
    passage = re.sub(r"`[^`]*`|\$[^$]*\$", "x", passage)
    passage = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", passage)
    return re.sub(r" ?\[[A-Z][^\]]*\]", "", passage)


def dialect(lines: str) -> list[tuple[re.Pattern[str], str]]:
    """Patterns of the word list, and what to write instead."""
    rules = [line.split(" => ") for line in lines.splitlines() if line and not line.startswith("#")]
    return [(re.compile(pattern if "(?:^" in pattern else rf"\b(?:{pattern})\b"), use) for pattern, use in rules]


def wording(text: str, rules: list[tuple[re.Pattern[str], str]]) -> Iterator[Finding]:
    """Words of the old dialect; what stands in italics, as labels of the interface do, is exempt."""
    for number, passage in passages(text):
        plain = re.sub(r"(?<!\*)\*[^*]+\*(?!\*)|\*\*", "", spoken(passage))
        for pattern, use in rules:
            for found in pattern.finditer(plain):
                yield number, f'"{found[0].strip()}": write {use}'


def long_sentences(text: str) -> Iterator[Finding]:
    """Sentences of too many words."""
    for number, passage in passages(text):
        for sentence in re.split(r"(?<=[.!?:;])[*)\"]*\s+", spoken(passage)):
            count = len(sentence.split())
            if count > WORDS:
                yield number, f"{count} words in a sentence, more than {WORDS}: {sentence[:40]}..."


def long_lines(text: str) -> Iterator[Finding]:
    """Lines that are too long for reading a difference, where they can be broken."""
    inside = re.sub(r"^```.*?^```", lambda found: "\n" * found[0].count("\n"), text, flags=re.DOTALL | re.MULTILINE)
    for number, line in enumerate(inside.split("\n"), 1):
        if len(line) > WIDTH and not line.startswith(("|", "    ")) and " " in line[:WIDTH].strip():
            yield number, f"{len(line)} characters, more than {WIDTH}"


def broken_links(path: Path) -> Iterator[Finding]:
    """Links to files that are not there."""
    for number, line in enumerate(blanked(path.read_text(encoding="utf-8")).split("\n"), 1):
        for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", line):
            if "://" not in target and not (path.parent / target).exists():
                yield number, f"there is no {target}"


def broken_references(text: str, folder: Path) -> Iterator[Finding]:
    """Sections and equations of mathematics.md and experiments.md that are named and not there."""
    for found in REFERENCE.finditer(text):
        document, section, equation = found.groups()
        target = (folder / f"{document}.md").read_text(encoding="utf-8")
        section = section and re.sub(r"\s*\n\s*/*\s*", " ", section)
        known = f"\\tag{{{equation}}}" in target if equation else re.search(rf"^#+ {re.escape(section)}$", target, re.M)
        if not known:
            yield text.count("\n", 0, found.start()) + 1, f"{document}.md has no {section or f'equation {equation}'}"


def files(*endings: str) -> list[Path]:
    """Files of the repository with these endings."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True
    ).stdout
    return [ROOT / name for name in listed.splitlines() if name.endswith(endings) and (ROOT / name).is_file()]


def of_document(path: Path, rules: list[tuple[re.Pattern[str], str]]) -> Iterator[Finding]:
    """All findings in one document."""
    text = path.read_text(encoding="utf-8")
    yield from wording(text, rules)
    yield from long_sentences(text)
    yield from long_lines(text)
    yield from broken_links(path)


def main() -> int:
    """Check everything; the exit code."""
    rules = dialect(DIALECT.read_text(encoding="utf-8"))
    findings = [(path, finding) for path in files(".md") for finding in of_document(path, rules)]
    for path in files(*SOURCES):
        text = path.read_text(encoding="utf-8")
        findings += [(path, finding) for finding in broken_references(text, ROOT / "docs")]
    for path, (number, message) in findings:
        print(f"{path.relative_to(ROOT)}:{number}: {message}")
    return 1 if findings else 0


if __name__ == "__main__":
    raise SystemExit(main())
