"""The page of a deck before any run: its picture, what drives what, and what `lagamine --check` prints."""
import os
from typing import List

from .deck_scene import COMPONENTS, DISPLACEMENT, Scene
from .markup import Sections, document, escape, figure, joined, table
from .picture import Picture
from .words import brief


def deck_page(scene: Scene, picture: Picture, deck: str, version: str) -> str:
    """The whole page as text."""
    body: Sections = [("deck", "The scene at the start", figure(picture, "Deck")),
                      ("drives", "Motions and loads", table(("what", "component", "farthest", "at time", "multiplier"), _drives(scene))),
                      ("check", "What the solver reads", f"<pre>{escape(scene.words)}</pre>")]
    body = [part for part, there in zip(body, (True, _drives(scene), scene.words)) if there]
    header = (f"<h1>{escape(scene.title)}</h1>\n"
              '<p class="reason"><span class="status open">not run</span><span>a deck as it is read, before any run</span></p>')
    footer = f"lagareport {escape(version)}, from {escape(os.path.basename(deck))}. Lengths, forces and stresses are in the units of the deck."
    return document(scene.title, header, joined(body), footer)


def _drives(scene: Scene) -> List:
    """Rows: what is moved, held or loaded."""
    rows = []
    held = scene.held

    def row(name: str, item: dict, component: str) -> None:
        driven = scene.driven(item)
        rows.append(("", tuple(map(escape, (name, component, brief(driven.value) if driven.multiplier else "", brief(driven.time) if driven.multiplier else "",
                                            driven.multiplier)))))
    for kind, word in (("die_motions", "motion of"), ("die_forces", "force on")):
        for item in held[kind]:
            free = kind == "die_forces" and item["multiplier"] == 0
            row(("free: " if free else word + " ") + held["dies"][item["die"] - 1]["name"], item, COMPONENTS[item["component"]])
    for item in held["fixations"]:
        row(item["place"], item, COMPONENTS[item["component"]] if item["field"] == DISPLACEMENT else "")
    for group in scene.groups:
        if group["role"] in ("side load", "volume load"):
            row(f"{group['elem']} {group['name']}", group, COMPONENTS.get(group.get("direction", 0), ""))
    return rows
