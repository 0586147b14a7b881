# SPDX-License-Identifier: GPL-3.0-or-later
"""The user guide as a web page that needs only its pictures and films."""

import re
from pathlib import Path

from markdown_it import MarkdownIt

DOCS = Path(__file__).resolve().parent.parent / "docs"
STYLE = """
body { font: 16px/1.5 sans-serif; max-width: 52em; margin: 2em auto; padding: 0 1em; color: #222; background: #fff }
table { border-collapse: collapse } th, td { border: 1px solid #ccc; padding: .3em .6em; text-align: left }
img, video { max-width: 100% } code { background: #f2f2f2; padding: 0 .2em } a[id] { scroll-margin-top: 1em }
@media (prefers-color-scheme: dark) {
  body { color: #ddd; background: #1e1e1e } th, td { border-color: #555 } code { background: #333 }
}
"""


def page(name: str = "user_guide") -> str:
    """One page of the documentation as HTML, with its anchors."""
    text = (DOCS / f"{name}.md").read_text()
    body = MarkdownIt("commonmark", {"html": True}).enable("table").render(text)
    found = re.search(r"^# (.*)$", text, re.MULTILINE)
    title = found[1] if found else name
    head = f'<meta charset="utf-8"><title>{title}</title><style>{STYLE}</style>'
    return f'<!doctype html>\n<html lang="en"><head>{head}</head><body>\n{body}</body></html>\n'


def files() -> dict[str, bytes]:
    """The page with its pictures and films by name."""
    text = page()
    pictures = sorted(set(re.findall(r'src="((?:images|films)/[^"]+)"', text)))
    return {"user_guide.html": text.encode()} | {name: (DOCS / name).read_bytes() for name in pictures}


if __name__ == "__main__":
    folder = Path("build/guide")
    for name, data in files().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    print(folder / "user_guide.html")
