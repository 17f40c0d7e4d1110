"""Pages of the site out of the project's own texts: chapters and cards split apart, links followed to where their aims are now.

A page is markdown under the name it has on the site. Links in the texts are those of the project's folders; what a heading is called there
is counted as GitHub does.
"""
import os
import posixpath
import re
import unicodedata
from dataclasses import dataclass, field
from typing import Dict, List, Tuple

HEADING = re.compile(r"^(#{1,6}) +(.*?) *$")
LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\])\(([^()\s]+)\)")
ITEM = re.compile(r"^\s*([-*]|\d+\.) ")


@dataclass
class Page:
    """`name` on the site, `source` relative to the project, its lines; `title` in the list of pages."""

    name: str
    source: str
    title: str
    lines: List[str] = field(default_factory=list)


def github_anchor(text: str) -> str:
    """What GitHub calls a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"[^\w\- ]", "", text.lower().replace("`", "")).replace(" ", "-")


def site_anchor(text: str) -> str:
    """What Python's markdown calls a heading."""
    text = unicodedata.normalize("NFKD", plain(text)).encode("ascii", "ignore").decode()
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", text).strip().lower())


def plain(text: str) -> str:
    """A heading without its marks."""
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text).replace("`", "")


def headings(lines: List[str]):
    """(line, level, text) of the headings outside of fenced blocks."""
    fenced = False
    for number, line in enumerate(lines):
        if line.startswith("```"):
            fenced = not fenced
        match = None if fenced else HEADING.match(line)
        if match:
            yield number, len(match.group(1)), match.group(2)


def split_manual(path: str, text: str) -> List[Page]:
    """The manual: a page a chapter (##), and one for each card (### `CARD`) with what stands below it."""
    lines = text.splitlines()
    cuts = [(0, "manual/index.md", "The deck manual", 0)]
    for number, level, title in headings(lines):
        if level == 2:
            cuts.append((number, f"manual/{site_anchor(title)}.md", plain(title), 1))
        elif level == 3 and re.fullmatch(r"`[A-Z0-9]+`", title):
            cuts.append((number, f"cards/{title.strip('`').lower()}.md", title.strip("`"), 2))
        elif level == 3 and cuts[-1][3] == 2:
            # what follows the cards of a chapter and is no card
            cuts.append((number, f"manual/{site_anchor(title)}.md", plain(title), 2))
    pages = []
    for k, (start, name, title, deeper) in enumerate(cuts):
        end = cuts[k + 1][0] if k + 1 < len(cuts) else len(lines)
        page = Page(name, path, title)
        fenced = False
        for line in lines[start:end]:
            fenced ^= line.startswith("```")
            page.lines.append(line[deeper:] if HEADING.match(line) and not fenced else line)
        pages.append(page)
    return pages


class Links:
    """Where files and headings of the project are on the site."""

    def __init__(self, pages: List[Page]) -> None:
        self.files: Dict[str, str] = {}                     # source -> page that begins it
        self.places: Dict[Tuple[str, str], Tuple[str, str]] = {}
        self.copies: Dict[str, str] = {}                    # source -> file of the site
        self.lost: List[str] = []
        counts: Dict[Tuple[str, str], int] = {}
        for page in pages:
            self.files.setdefault(page.source, page.name)
            own: Dict[str, int] = {}
            for _, _, text in headings(page.lines):
                anchor, here = github_anchor(text), site_anchor(text)
                n = counts[page.source, anchor] = counts.get((page.source, anchor), -1) + 1
                m = own[here] = own.get(here, -1) + 1
                self.places[page.source, f"{anchor}-{n}" if n else anchor] = (page.name, f"{here}_{m}" if m else here)

    def follow(self, page: Page, target: str, root: str) -> str:
        """A link of a page as the site has it."""
        if re.match(r"[a-z]+:", target):
            return target
        path, _, anchor = target.partition("#")
        source = posixpath.normpath(posixpath.join(posixpath.dirname(page.source), path)) if path else page.source
        if os.path.isdir(os.path.join(root, source)):
            source += "/README.md"
        if anchor:
            if (source, anchor) not in self.places:
                self.lost.append(f"{page.source}: {target}: no such heading")
                return target
            name, place = self.places[source, anchor]
        elif source in self.files:
            name, place = self.files[source], ""
        elif os.path.isfile(os.path.join(root, source)):
            name, place = self.copies.setdefault(source, "project/" + source.lstrip(".")), ""      # MkDocs leaves out what is hidden
        else:
            self.lost.append(f"{page.source}: {target}: no such file")
            return target
        if name == page.name and place:
            return "#" + place
        return posixpath.relpath(name, posixpath.dirname(page.name) or ".") + ("#" + place if place else "")


def finished(page: Page, links: Links, root: str) -> str:
    """The text of a page: links followed; what GitHub reads and Python's markdown does not, written as both do."""
    out, fenced, before = [], False, ""
    for line in page.lines:
        if line.startswith("```"):
            if not fenced and before.strip():
                out.append("")
            fenced = not fenced
            line = re.match(r"```\w*", line).group()
        elif not fenced:
            starts = ITEM.match(line) and not ITEM.match(before) and not before.startswith("  ") or \
                line.startswith("|") and not before.startswith("|")
            if starts and before.strip():
                out.append("")
            if line.startswith("|"):
                line = re.sub(r"`[^`]*`", lambda code: code.group().replace("\\|", "|"), line)
        out.append(line)
        before = line
    # a link may go over two lines
    parts = re.split(r"(^```.*?^```$)", "\n".join(out) + "\n", flags=re.M | re.S)
    parts[::2] = [LINK.sub(lambda one: f"{one.group(1)}({links.follow(page, one.group(2), root)})", part) for part in parts[::2]]
    return "".join(parts)
