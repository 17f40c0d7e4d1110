"""Pieces of the page: escaped text, tables, figures."""
import html
import os
from typing import Iterable, List, Sequence, Tuple

from .picture import Picture

MANY = 7    # columns of a table that is moved under the finger on a narrow screen
Sections = List[Tuple[str, str, str]]    # anchor, heading, content


def escape(value) -> str:
    return html.escape(str(value), quote=True)


def figure(picture: Picture, heading: str) -> str:
    # On a narrow screen a touch shows the picture large, to be moved under the finger: the box is the switch, without a script.
    return (f'<figure><label><input type="checkbox"><img alt="{escape(picture.heading or heading)}: {escape(picture.caption)}" '
            f'src="{picture.data_uri()}"></label>'
            f"<figcaption>{escape(picture.caption)}</figcaption></figure>")


def table(head: Sequence[str], rows: Iterable[Tuple[str, Sequence[str]]]) -> str:
    """Cells are HTML already; each row comes with its class."""
    text = "".join(f"<th>{escape(cell)}</th>" for cell in head)
    many = ' class="many"' if len(head) > MANY else ""
    lines = [f'<div class="wide"><table{many}><thead><tr>{text}</tr></thead><tbody>']
    for look, cells in rows:
        start = f'<tr class="{look}">' if look else "<tr>"
        lines.append(start + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    return "\n".join(lines + ["</tbody></table></div>"])


def joined(body: Sections) -> str:
    """All sections, one after the other."""
    return "\n".join(f'<section id="{anchor}">\n<h2>{escape(heading)}</h2>\n{content}\n</section>' for anchor, heading, content in body)


def document(title: str, header: str, main: str, footer: str) -> str:
    """A whole page that needs nothing else; header, main part and footer are HTML already."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "page.css"), encoding="utf-8") as file:
        style = file.read()
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>
{style}</style>
</head>
<body>
<header>
{header}
</header>
<main>
{main}
</main>
<footer>{footer}</footer>
</body>
</html>
"""
