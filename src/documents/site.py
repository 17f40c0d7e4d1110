#!/usr/bin/env python3
"""The documents as a site (MkDocs, no network): manual by chapters and cards, tutorial, recipes, decks, laws, programs, results.

usage: site.py --root PROJECT --programs BIN --out DIR [--pages-only]
DIR/pages are the texts, made of those of the project; DIR/html the site. Any link that leads nowhere, and any warning of MkDocs, is an error.
Pages of the code are in it where FORD is installed (`pip install FORD==6.2.5`).
"""
import argparse
import glob
import json
import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from urllib.parse import unquote, urlparse

sys.dont_write_bytecode = True
from code_pages import code_pages, ford  # noqa: E402
from help_text import ask  # noqa: E402
from site_text import Links, Page, finished, split_manual  # noqa: E402

TEXTS = [("README.md", "index.md", "LAGAMINE 2D"), ("decks/SCOPE.md", "scope.md", "What it can and cannot do"),
         ("decks/TUTORIAL.md", "tutorial.md", "Tutorial"), ("decks/RECIPES.md", "recipes.md", "Recipes"), ("decks/GLOSSARY.md", "glossary.md", "Glossary"),
         ("decks/RESULTS.md", "results.md", "Files of results, Python"), ("src/README.md", "inside/library.md", "The library"),
         ("remdata/README.md", "inside/remdata.md", "The remesher"), ("tests/README.md", "inside/tests.md", "Tests"),
         ("tests/bench/README.md", "inside/measured.md", "Measured"), (".github/CONTRIBUTING.md", "inside/contributing.md", "Contributing")]
CODE = "code/index.html"
PROGRAMS = ("lagamine", "lagacycle", "remdata", "lagareport", "lagaimport", "lagastudy")


def read(root, source):
    with open(os.path.join(root, source), encoding="utf-8") as file:
        return file.read()


def deck_pages(root):
    """A page a deck, and one with the pictures of all."""
    pages, gallery = [], ["# Gallery", ""]
    for path in sorted(glob.glob(os.path.join(root, "decks", "*", "README.md"))):
        name = os.path.basename(os.path.dirname(path))
        text = read(root, f"decks/{name}/README.md")
        title = re.match(r"# (.*)", text).group(1)
        pages.append(Page(f"decks/{name}.md", f"decks/{name}/README.md", title, text.splitlines()))
        gallery += [f"## [{title}]({name}/README.md)"]
        gallery += [f"![{title}]({name}/{os.path.basename(picture)})" for picture in sorted(glob.glob(os.path.join(root, "decks", name, "picture_*.png")))]
        gallery.append("")
    return [Page("decks/index.md", "decks/GALLERY", "Gallery", gallery), *pages]


def block_page(name, title, text):
    """A page of what a program prints."""
    return Page(name, name, title, [f"# {title}", "", "```", *text.splitlines(), "```"])


def pages_of(root, programs, with_code):
    """All pages, by sections."""
    texts = {source: Page(name, source, title, read(root, source).splitlines()) for source, name, title in TEXTS}
    manual = split_manual("decks/README.md", read(root, "decks/README.md"))
    lagamine = os.path.join(programs, "lagamine")
    laws = [block_page("laws/index.md", "Laws", ask(lagamine, "--law"))]
    for line in ask(lagamine, "--law").splitlines():
        law = line.split()[0]
        laws.append(block_page(f"laws/{law.lower()}.md", law, ask(lagamine, "--law", law)))
    called = [block_page(f"programs/{one}.md", one, ask(os.path.join(programs, one), "--help")) for one in PROGRAMS
              if os.path.exists(os.path.join(programs, one))]
    order = [source for source, _, _ in TEXTS]
    code = [Page("inside/code.md", "CODE", "The code", ["# The code", "", f'<a href="../{CODE}">Modules, types and procedures</a>, from the comments in the source.'])] \
        if with_code else []
    return {"": [texts[source] for source in order[:5]], "Decks": deck_pages(root),
            "Manual": [page for page in manual if page.name.startswith("manual/")], "Cards": [page for page in manual if page.name.startswith("cards/")],
            "Laws": laws, "Programs": [*called, texts["decks/RESULTS.md"]], "Inside": [*(texts[source] for source in order[6:]), *code]}


def write_pages(root, sections, out):
    """The texts and what they link to; links that lead nowhere."""
    pages = [page for section in sections.values() for page in section]
    links = Links(pages)
    for page in pages:
        path = os.path.join(out, page.name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(finished(page, links, root))
    for source, name in links.copies.items():
        os.makedirs(os.path.dirname(os.path.join(out, name)), exist_ok=True)
        shutil.copyfile(os.path.join(root, source), os.path.join(out, name))
    return links.lost


def configuration(sections, folder):
    """mkdocs.yml, in the part of YAML that is JSON."""
    nav = [{page.title: page.name} for page in sections[""]]
    nav += [{title: [{page.title: page.name} for page in section]} for title, section in sections.items() if title]
    return json.dumps({
        "site_name": "LAGAMINE 2D", "docs_dir": os.path.join(folder, "pages"), "site_dir": os.path.join(folder, "html"),
        "use_directory_urls": False, "theme": {"name": "mkdocs", "highlightjs": False, "nav_style": "light"},
        "markdown_extensions": ["tables", "fenced_code", {"toc": {"permalink": False}}], "plugins": ["search"], "nav": nav}, indent=1)


class Anchors(HTMLParser):
    """Links and anchors of a page."""

    def __init__(self):
        super().__init__()
        self.aims, self.anchors = [], set()

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        self.anchors |= {found[key] for key in ("id", "name") if found.get(key)}
        self.aims += [found[key] for key in ("href", "src") if found.get(key) and not (tag == "a" and key == "src")]


def dead_links(folder):
    """Links of the finished site that lead nowhere, and what it would fetch from a network."""
    parsed = {}
    for path in glob.glob(os.path.join(folder, "**", "*.html"), recursive=True):
        parsed[path] = Anchors()
        with open(path, encoding="utf-8") as file:
            text = file.read()
        parsed[path].feed(text)
        yield from (f"{path}: fetches {what}" for what in re.findall(r"<(?:script|link|img)[^>]*(?:src|href)=\"(https?:[^\"]*)", text))
    for path, page in parsed.items():
        if path.endswith("404.html"):
            continue        # its links are those of a server's root
        for aim in page.aims:
            url = urlparse(aim)
            if url.scheme or aim.startswith("//"):
                continue
            target = os.path.normpath(os.path.join(os.path.dirname(path), unquote(url.path))) if url.path else path
            if os.path.isdir(target):
                target = os.path.join(target, "index.html")
            if not os.path.isfile(target):
                yield f"{os.path.relpath(path, folder)}: {aim}: no such file"
            elif url.fragment and target in parsed and not {url.fragment, unquote(url.fragment)} & parsed[target].anchors:
                yield f"{os.path.relpath(path, folder)}: {aim}: no such place"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("--root", "--programs", "--out"):
        parser.add_argument(name, required=True)
    parser.add_argument("--pages-only", action="store_true")
    options = parser.parse_args()
    out = os.path.abspath(options.out)
    for part in ("pages", "html"):
        shutil.rmtree(os.path.join(out, part), ignore_errors=True)
    with_code = None if options.pages_only else ford()
    if with_code and not code_pages(options.root, os.path.join(out, "pages", os.path.dirname(CODE)), with_code):
        print("FORD has not made the pages of the code", file=sys.stderr)
        return 1
    sections = pages_of(options.root, options.programs, with_code)
    lost = write_pages(options.root, sections, os.path.join(out, "pages"))
    with open(os.path.join(out, "mkdocs.yml"), "w", encoding="utf-8") as file:
        file.write(configuration(sections, out))
    count = sum(map(len, sections.values()))
    if not options.pages_only and not lost:
        if not shutil.which("mkdocs"):
            print("mkdocs is not installed (Debian: apt install mkdocs)", file=sys.stderr)
            return 5
        if subprocess.run(["mkdocs", "build", "--strict", "--quiet", "-f", os.path.join(out, "mkdocs.yml")], check=False).returncode != 0:
            return 1
        lost = sorted(set(dead_links(os.path.join(out, "html"))))
    for line in lost:
        print(line, file=sys.stderr)
    if not lost:
        code = "" if options.pages_only else ", those of the code beside them" if with_code else "; none of the code: FORD 6.2 is not installed"
        print(f"{count} pages in {os.path.join(out, 'pages' if options.pages_only else 'html')}{code}")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main())
