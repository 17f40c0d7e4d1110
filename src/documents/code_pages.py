"""Pages of the Fortran code, made by FORD from the comments beside it, that fetch nothing from a network."""
import glob
import os
import re
import shutil
import subprocess
from typing import Optional

VERSION = "6.2"     # FORD 7 has its styles from a network
PROJECT = """---
project: LAGAMINE 2D: the code
src_dir: {root}/src
         {root}/remdata
output_dir: {out}
docmark: !
predocmark: >
display: public
preprocess: false
source: false
incl_src: false
graph: false
search: false
quiet: true
sort: alpha
print_creation_date: false
---
Modules, types and procedures of the solver's library and of the remesher, with what is said beside them in the source. What they are for and how they
depend on each other: [the library](../inside/library.html), [the remesher](../inside/remdata.html).
"""


def ford() -> Optional[str]:
    """The program, where there is one of this version."""
    program = shutil.which("ford")
    if not program:
        return None
    said = subprocess.run([program, "--version"], text=True, capture_output=True, check=False)
    return program if f"version {VERSION}" in said.stdout + said.stderr else None


def offline(text: str) -> str:
    """A page of FORD without what it would fetch, and without what is no link: to module procedures, which have no place of their own in the
    pages of interfaces, and to modules of the compiler, which it puts into a link twice."""
    text = re.sub(r"<!--\[if.*?<!\[endif\]-->", "", text, flags=re.S)
    text = re.sub(r"<script[^>]*\ssrc=[\"']https?:[^>]*>\s*</script>", "", text)
    text = re.sub(r"href=(['\"])<a href=\"([^\"]*)\">[^<]*</a>\1", r'href="\2"', text)
    return re.sub(r"(href=[\"'][^\"'#]*)#moduleprocedure-[^\"']*", r"\1", text)


def code_pages(root: str, out: str, program: str) -> bool:
    """Make them in a folder; whether FORD has done it."""
    project = out + ".md"
    os.makedirs(out, exist_ok=True)
    with open(project, "w", encoding="utf-8") as file:
        file.write(PROJECT.format(root=os.path.abspath(root), out=os.path.abspath(out)))
    done = subprocess.run([program, project], text=True, stdout=subprocess.DEVNULL, check=False)
    os.remove(project)
    for path in glob.glob(os.path.join(glob.escape(out), "**", "*.html"), recursive=True):
        with open(path, encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(offline(text))
    return done.returncode == 0 and os.path.exists(os.path.join(out, "index.html"))
