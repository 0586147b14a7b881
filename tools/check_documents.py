# SPDX-License-Identifier: GPL-3.0-or-later
"""Check the wording of documents and code, and the links and references in them.

Documents: words, length of sentences and lines, links. Code: words of comments, texts and names, and references to
mathematics.md. Usage: check_documents.py prints FILE:LINE: MESSAGE for each finding and exits with 1 if there is
any. check_documents.py --code [PATH...] checks only the words in code, by default in all of it.
"""

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DIALECT = ROOT / "tools/dialect.txt"
WIDTH = 110  # characters of a line, except in tables and code
WORDS = 25  # in a sentence
SOURCES = (".cpp", ".hpp", ".py", ".md")
CODE = (".cpp", ".hpp", ".py", ".pyi", ".js", ".sh", ".cmake", ".toml", ".yml", "CMakeLists.txt", "Makefile", ".ci/run")
BETWEEN = r"(?:[\s_\"#/*]+)"  # between the words of a name, or of a comment or text that continues on the next line
EXEMPT = ("tools/check_documents.py", "tests/packaging/test_documents.py")  # they quote the words
REFERENCE = re.compile(r"(mathematics|experiments)\.md\)?,\s*(?://+\s*)?(?:\"([^\"]+)\"|Eq\. (\d))")

Finding = tuple[int, str]
Passage = tuple[int, str]
Rule = tuple[re.Pattern[str], str]


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


def dialect(lines: str, *sections: str) -> list[Rule]:
    """Patterns of these sections of the word list, and what to write instead."""
    rules = list[Rule]()
    section = ""
    for line in lines.splitlines():
        if line.startswith("["):
            section = line.strip("[]")
        elif section in sections and line and not line.startswith("#"):
            pattern, use = line.split(" => ")
            rules.append((re.compile(in_code(pattern) if section.startswith("code") else in_prose(pattern)), use))
    return rules


def in_prose(pattern: str) -> str:
    """A pattern of whole words, unless it specifies its own start."""
    return pattern if "(?:^" in pattern else rf"\b(?:{pattern})\b"


def in_code(pattern: str) -> str:
    """A pattern of whole words in comments, texts and names, across lines, underscores and capitals."""
    return rf"(?i)(?<![a-z])(?:{pattern.replace(' ', BETWEEN)})(?![a-z])"


def code_wording(text: str, rules: list[Rule]) -> Iterator[Finding]:
    """Words of the old dialect in the comments, texts and names of a source."""
    spaced = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", text)
    for pattern, use in rules:
        for found in pattern.finditer(spaced):
            words = re.sub(BETWEEN, " ", found[0]).strip()
            yield spaced.count("\n", 0, found.start()) + 1, f'"{words}": write {use}'


def wording(text: str, rules: list[Rule]) -> Iterator[Finding]:
    """Words of the old dialect; text in italics, such as labels of the interface, is exempt."""
    for number, passage in passages(text):
        plain = re.sub(r"(?<!\*)\*[^*]+\*(?!\*)|\*\*", "", spoken(passage))
        for pattern, use in rules:
            for found in pattern.finditer(plain):
                yield number, f'"{found[0].strip()}": write {use}'


def long_sentences(text: str) -> Iterator[Finding]:
    """Sentences with too many words."""
    for number, passage in passages(text):
        for sentence in re.split(r"(?<=[.!?:;])[*)\"]*\s+", spoken(passage)):
            count = len(sentence.split())
            if count > WORDS:
                yield number, f"{count} words in a sentence, more than {WORDS}: {sentence[:40]}..."


def long_lines(text: str) -> Iterator[Finding]:
    """Lines that are too long to read in a diff and can be wrapped."""
    inside = re.sub(r"^```.*?^```", lambda found: "\n" * found[0].count("\n"), text, flags=re.DOTALL | re.MULTILINE)
    for number, line in enumerate(inside.split("\n"), 1):
        if len(line) > WIDTH and not line.startswith(("|", "    ")) and " " in line[:WIDTH].strip():
            yield number, f"{len(line)} characters, more than {WIDTH}"


def broken_links(path: Path) -> Iterator[Finding]:
    """Links to missing files."""
    for number, line in enumerate(blanked(path.read_text(encoding="utf-8")).split("\n"), 1):
        for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", line):
            if "://" not in target and not (path.parent / target).exists():
                yield number, f"there is no {target}"


def broken_references(text: str, folder: Path) -> Iterator[Finding]:
    """References to missing sections and equations of mathematics.md and experiments.md."""
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


def of_document(path: Path, rules: list[Rule]) -> Iterator[Finding]:
    """All findings in one document."""
    text = path.read_text(encoding="utf-8")
    yield from wording(text, rules)
    yield from long_sentences(text)
    yield from long_lines(text)
    yield from broken_links(path)


def words_in_code(names: list[str]) -> list[tuple[Path, Finding]]:
    """Words of the dialect in these files and folders."""
    lines = DIALECT.read_text(encoding="utf-8")
    rules = {ending: dialect(lines, "code", *more) for ending, more in ((False, ()), (True, ("code: C++",)))}
    found = list[tuple[Path, Finding]]()
    for path in files(*CODE):
        name = path.relative_to(ROOT).as_posix()
        if name not in EXEMPT and name.startswith(tuple(names)):
            text = path.read_text(encoding="utf-8")
            findings = sorted(code_wording(text, rules[path.suffix in (".cpp", ".hpp")]))
            found += [(path, finding) for finding in findings]
    return found


def main(arguments: list[str]) -> int:
    """Check everything, or list the words in code; the exit code."""
    if arguments[:1] == ["--code"]:
        findings = words_in_code(arguments[1:] or [""])
    else:
        rules = dialect(DIALECT.read_text(encoding="utf-8"), "documents")
        findings = [(path, finding) for path in files(".md") for finding in of_document(path, rules)]
        findings += words_in_code([""])
        for path in files(*SOURCES):
            text = path.read_text(encoding="utf-8")
            findings += [(path, finding) for finding in broken_references(text, ROOT / "docs")]
    for path, (number, message) in findings:
        print(f"{path.relative_to(ROOT)}:{number}: {message}")
    return 1 if findings else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
