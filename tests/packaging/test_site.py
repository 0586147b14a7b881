# SPDX-License-Identifier: GPL-3.0-or-later
"""The documentation site: its pages, and in `make test-docs` its links, formulas, reference and search, as built."""

import json
import os
import re
import shutil
import subprocess
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from tools import site_pages

ROOT = Path(__file__).resolve().parents[2]
SITE = Path(os.environ.get("STIV_SITE", "")).resolve()
CONFIGURATION = (ROOT / "docs/site/mkdocs.yml").read_text(encoding="utf-8")
PAGES = re.findall(r": (\S+\.md)$", CONFIGURATION, re.MULTILINE)
BROWSER = shutil.which("chromium")

built = pytest.mark.skipif("STIV_SITE" not in os.environ, reason="the site was not built (make test-docs)")


def test_every_document_is_in_the_navigation(tmp_path: Path) -> None:
    site_pages.collect(tmp_path)
    assert {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.md")} == set(PAGES)
    assert len(PAGES) == len(set(PAGES))


def test_every_link_of_a_document_leads_to_a_file_of_the_site(tmp_path: Path) -> None:
    site_pages.collect(tmp_path)
    links = [
        (page, target)
        for page in PAGES
        for target in re.findall(r'(?:\]\(|src=")([^)#"\s]+)', (tmp_path / page).read_text(encoding="utf-8"))
        if "://" not in target
    ]
    assert len(links) > 60
    assert not [each for each in links if not (tmp_path / each[0]).parent.joinpath(each[1]).exists()]


@pytest.mark.parametrize("package", site_pages.PACKAGES)
def test_the_reference_names_every_public_object(package: str) -> None:
    page = site_pages.reference(package)
    names = site_pages.public_names(package)
    assert len(names) > 50
    assert sorted(re.findall(r"^::: \S+?\.(\w+)$", page, re.MULTILINE)) == sorted(names)
    assert f"::: {package}." in page


class Page(HTMLParser):
    """Links and anchors of a page, and files that it loads."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links, self.anchors, self.loaded = list[str](), set[str](), list[str]()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        """Note the attributes of a tag."""
        values = {name: value or "" for name, value in attributes}
        self.anchors |= {values[name] for name in ("id", "name") if name in values}
        if "href" in values:
            (self.loaded if tag == "link" else self.links).append(values["href"])
        if "src" in values:
            self.loaded.append(values["src"])


@cache
def parsed(path: Path) -> Page:
    return Page(path)


def broken(path: Path, address: str) -> bool:
    """Does an address of the site lead nowhere?"""
    parts = urlsplit(address)
    if parts.scheme or parts.netloc or address.startswith("javascript:"):
        return False
    target = path.parent / unquote(parts.path) if parts.path else path
    if target.is_dir():
        target /= "index.html"
    if not target.is_file():
        return True
    anchor = unquote(parts.fragment)
    return bool(anchor) and target.suffix == ".html" and anchor not in parsed(target).anchors | {"__top"}


@built
def test_every_link_and_anchor_of_the_site_leads_somewhere() -> None:
    pages = [path for path in SITE.rglob("*.html") if path.name != "404.html"]  # that page has absolute links
    assert len(pages) > 100
    links = [(path, address) for path in pages for address in [*parsed(path).links, *parsed(path).loaded]]
    assert not [f"{path.relative_to(SITE)}: {address}" for path, address in links if broken(path, address)]


@built
def test_no_page_loads_anything_from_another_host() -> None:
    pages = [path for path in SITE.rglob("*.html") if "cpp" not in path.relative_to(SITE).parts]
    assert not [address for path in pages for address in parsed(path).loaded if urlsplit(address).netloc]


@built
def test_every_public_object_is_described() -> None:
    for package in site_pages.PACKAGES:
        text = (SITE / "api" / f"{package.replace('.', '_')}.html").read_text(encoding="utf-8")
        for name in site_pages.public_names(package):
            entry = text.partition(f'id="{site_pages.path_of(package, name)}"')[2]
            description = entry.partition('class="doc doc-contents')[2].partition("</div>")[0]
            assert "<p>" in description, f"{package}.{name} has no description"


@built
def test_the_search_finds_operators_and_functions() -> None:
    entries = json.loads((SITE / "search/search_index.json").read_text(encoding="utf-8"))["docs"]
    for words, page in (("Collision Move", "docs/user_guide.html"), ("find_intersections", "api/stiv.html")):
        assert [each for each in entries if words in each["title"] + each["text"] and each["location"].startswith(page)]


@built
@pytest.mark.skipif(BROWSER is None, reason="no chromium")
def test_a_browser_sets_every_formula() -> None:
    page = SITE / "docs/mathematics.html"
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=10000", "--dump-dom"]
    shown = subprocess.run([*command, page.as_uri()], capture_output=True, text=True, check=True, timeout=120).stdout
    formulas = page.read_text(encoding="utf-8").count('class="arithmatex"')
    assert formulas > 400
    assert shown.count('<span class="katex">') == formulas
    assert "katex-error" not in shown
