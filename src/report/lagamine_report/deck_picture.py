"""The picture of a deck: bodies with their meshes, dies hatched, motions, supports, loads, sets and zones."""
from typing import List, Tuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from .deck_scene import COMPONENTS, DISPLACEMENT, Driven, Scene, side_label
from .geometry import all_sides, die_curve, element_thickness, hatching, line3, part_thickness, side_curves
from .parabolas import elements_patch, sides_patch
from .picture import Picture
from .style import BODIES, DIE_LINE, DIE_SHARE, INK, LINE_SHARE, LINES, POINTS, SOFT, figure
from .words import brief

MOTION, SUPPORT, LOAD, HEAT, CONTACT, ZONE = LINES[1], LINES[2], LINES[6], LINES[4], LINES[0], LINES[3]
MOST_MARKS = 14         # symbols along a place
UNIT = {1: np.array([1.0, 0.0]), 2: np.array([0.0, 1.0])}


class DeckView:
    """Draws a scene; keeps the axes, the size of the part and what the legend has."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        points = [scene.x] + [pieces.reshape(-1, 2) for pieces, _, _ in scene.contours.values()]
        every = np.vstack(points)
        self.low, self.high = every.min(axis=0), every.max(axis=0)
        self.size = float((self.high - self.low).max())
        self.legend: List = []
        self.fig, self.axes = self._axes()
        self.thin = self._thickness()
        self.paper_width = self.paper * self.thin

    def _thickness(self) -> float:
        """How thin the thinnest body is."""
        found = [self.size]
        for group in self.scene.bodies():
            if group["name"] in self.scene.contours:
                pieces = self.scene.contours[group["name"]][0]
                curve, after = pieces[:, 0], pieces[:, 2]
                found.append(abs((curve[:, 0] * after[:, 1] - curve[:, 1] * after[:, 0]).sum()) / max(np.hypot(*(after - curve).T).sum(), 1e-300))
            elif len(group["nodes"]):
                found.append(part_thickness(self.scene.x, group["nodes"], all_sides(group["nodes"])[1]))
        return min(found)

    def width(self, usual: float, share: float = LINE_SHARE, least: float = 0.0) -> float:
        """Of a line [point]: of a thin body no more than a share of what it is on paper."""
        return min(usual, max(least, share * self.paper_width))

    def _axes(self) -> Tuple[object, Axes]:
        """Equal scales; room for dies and motions around the part."""
        margin = 0.24 * self.size if self.scene.held["die_motions"] or self.scene.held["die_forces"] else 0.16 * self.size
        low, high = self.low - margin, self.high + margin
        for _, _, _, pieces in self.scene.dies:        # of dies, what is near
            x = pieces.reshape(-1, 2)
            near = x[(x > self.low - 0.5 * self.size).all(axis=1) & (x < self.high + 0.5 * self.size).all(axis=1)]
            if len(near):
                low, high = np.minimum(low, near.min(axis=0) - 0.05 * self.size), np.maximum(high, near.max(axis=0) + 0.05 * self.size)
        if self.scene.axisymmetric:
            low[0] = max(low[0], -0.12 * self.size)
        width, height = high - low
        scale = min(9.2 / width, 7.2 / height)
        self.paper = POINTS * scale     # points of paper per length
        fig, panels = figure(1, 1, (max(width * scale, 3.2) + 0.7, max(height * scale, 1.6) + 0.6), grid=False)
        axes = panels[0, 0]
        axes.set_aspect("equal")
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        if self.scene.axisymmetric:
            axes.axvline(0, color=SOFT, lw=0.8, dashes=(9, 3, 2, 3), zorder=0.5)
        self.box = low, high
        return fig, axes

    def key(self, colour: str, words: str, **look) -> None:
        self.legend.append(Line2D([], [], color=colour, label=words, **look))

    def inside(self, x: np.ndarray) -> np.ndarray:
        """Which points (n, 2) are in the picture."""
        return ((x >= self.box[0]) & (x <= self.box[1])).all(axis=1)

    # ---- bodies and sets ----

    def bodies(self) -> None:
        names = []
        for k, group in enumerate(self.scene.bodies()):
            colour = BODIES[k % len(BODIES)]
            law = f", {group['law']}" if "law" in group else ""
            names.append(group["name"])
            if group["name"] in self.scene.contours:
                pieces, rows, loops = self.scene.contours[group["name"]]
                curves = [np.einsum("pk,skd->spd", line3(np.linspace(-1, 1, 17)), pieces[loops == loop]).reshape(-1, 2) for loop in np.unique(loops)]
                self.axes.add_artist(PathPatch(Path.make_compound_path(*[Path(curve, closed=True) for curve in curves]), color=colour, lw=0))
                for curve in curves:
                    self.axes.plot(*curve.T, color=INK, lw=self.width(1.2), zorder=3)
                for row in np.unique(rows):
                    self._number(str(row), pieces[rows == row])
                words = f"{group['name']}: by its contour, no mesh yet{law}"
            else:
                self.axes.add_artist(elements_patch(self.scene.x, group["nodes"], facecolor=colour))
                words = f"{group['name']}: {len(group['nodes'])} {group['elem']}{law}"
            self.legend.append(Patch(color=colour, label=words))
        nodes = [group["nodes"] for group in self.scene.bodies() if len(group["nodes"])]
        if nodes:
            every, outline = all_sides(np.concatenate(nodes))
            width = min(0.5 if len(every) < 3000 else 0.2, LINE_SHARE * self.paper * element_thickness(self.scene.x, np.concatenate(nodes)))
            self.axes.add_artist(sides_patch(self.scene.x[every], edgecolor="#8aa0b5", linewidth=width, zorder=1.5))
            self.axes.add_artist(sides_patch(self.scene.x[outline], edgecolor=INK, linewidth=self.width(1.1), zorder=3))
            ends = {tuple(side) for side in np.sort(outline[:, [0, 2]], axis=1).tolist()}
            for name, sides in self.scene.sides.items():
                free = [tuple(sorted((int(side[0]), int(side[2])))) in ends for side in sides]
                if any(free):
                    self._number(side_label(name, names)[0], self.scene.x[sides[free]])

    def _number(self, text: str, sides: np.ndarray) -> None:
        """Number or name of a set of sides (side, 3, 2), inside of its middle, or of the side next to it that has no point of a zone with its name; outside where
        the body is thin and the number would stand beyond its other side."""
        taken = np.array(list(self.scene.zone_places().values())).reshape(-1, 2)
        clear = [np.hypot(*(taken - side[1]).T).min(initial=np.inf) > 0.08 * self.size for side in sides]
        side = sides[min(range(len(sides)), key=lambda k: (not clear[k], abs(k - len(sides) // 2)))]
        way = side[2] - side[0]
        left = np.array([-way[1], way[0]]) / max(np.hypot(*way), 1e-300)
        inwards = 0.022 * self.size
        if self.thin < min(2 * inwards, 0.25 * np.hypot(*(sides[:, 2] - sides[:, 0]).T).sum()):
            inwards = -inwards
        self.axes.text(*(side[1] + inwards * left), text, fontsize=8.5, ha="center", va="center", color=LINES[0], zorder=6, fontweight="bold",
                       bbox={"boxstyle": "round,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.65})

    def contacts(self) -> None:
        found = [group for group in self.scene.groups if group["role"] == "contact"]
        for group in found:
            curves = side_curves(self.scene.x, group["nodes"]) if len(group["nodes"]) else side_curves_of(self.scene.place(group["name"].split("/")[0]))
            self.axes.add_collection(LineCollection(curves, colors=CONTACT, linewidths=self.width(3.4, 0.5, 1.0), alpha=0.35, zorder=3.2))
        if found:
            self.key(CONTACT, "contact: " + ", ".join(group["name"] for group in found), lw=3.4, alpha=0.35)

    # ---- dies ----

    def dies(self) -> None:
        rigid = False
        for name, deformable, _, pieces in self.scene.dies:
            curve = die_curve(pieces, np.zeros(3))
            if deformable:
                self.axes.plot(*curve.T, color=DIE_LINE, lw=2.2, dashes=(2, 1.2), zorder=4)
            else:
                rigid = True
                self.axes.plot(*curve.T, color=DIE_LINE, lw=self.width(1.6, DIE_SHARE, 0.4), zorder=4, solid_joinstyle="round")
                strokes = hatching(curve, 0.016 * self.size, 0.026 * self.size)
                self.axes.add_collection(LineCollection(strokes[self.inside(strokes[:, 0])], colors=SOFT, linewidths=0.7, zorder=0.8))
            at, outward = self._on_die(curve)
            along = np.array([-outward[1], outward[0]])       # beside the arrow of its motion
            self.axes.text(*(at + self.size * (0.055 * outward + 0.1 * along)), name, fontsize=9.5, ha="center", va="center", color=DIE_LINE, fontweight="bold", zorder=6,
                           bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.8})
        if rigid:
            self.key(DIE_LINE, "die, its body hatched", lw=1.6)
        if any(deformable for _, deformable, _, _ in self.scene.dies):
            self.key(DIE_LINE, "die of sides of a body", lw=2.2, dashes=(2, 1.2))

    def _on_die(self, curve: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """The middle of what is seen of a die's curve, and the direction to its body there."""
        chord = np.diff(curve, axis=0)
        fine = np.linspace(0, 1, 400)
        along = np.concatenate([[0], np.cumsum(np.hypot(*chord.T))]) / np.hypot(*chord.T).sum()
        x = np.stack([np.interp(fine, along, curve[:, k]) for k in range(2)], axis=1)
        seen = np.flatnonzero(self.inside(x))
        k = int(seen[len(seen) // 2]) if len(seen) else 200
        k = min(max(k, 1), len(x) - 2)
        way = x[k + 1] - x[k - 1]
        return x[k], np.array([way[1], -way[0]]) / max(np.hypot(*way), 1e-300)

    def die_motions(self) -> None:
        where = [self._on_die(die_curve(pieces, np.zeros(3))) for _, _, _, pieces in self.scene.dies]
        shown = False
        for kind in ("die_motions", "die_forces"):
            for item in self.scene.held[kind]:
                driven = self.scene.driven(item)
                at, outward = where[item["die"] - 1]
                colour = MOTION if kind == "die_motions" else LOAD
                word = "" if kind == "die_motions" else "force " if item["component"] < 3 else "moment "
                if kind == "die_forces" and driven.value == 0:
                    self._words(at + 0.1 * self.size * outward, f"free {COMPONENTS[item['component']]}", colour)
                elif driven.value != 0:
                    shown = True
                    self._arrow(at + 0.1 * self.size * outward, driven, colour, word)
        if shown:
            self.key(MOTION, "motion (LIC: farthest)", lw=1.8)

    def _arrow(self, at: np.ndarray, driven: Driven, colour: str, word: str = "") -> None:
        """An arrow along x or y, a turn in words; the farthest value beside it."""
        text = f"{word}{COMPONENTS[driven.component]} {brief(driven.value)}"
        if driven.component not in UNIT:
            self._words(at, "↺ " + text if driven.value > 0 else "↻ " + text, colour)
            return
        length = np.clip(abs(driven.value), 0.07 * self.size, 0.16 * self.size) if not word else 0.1 * self.size
        step = np.sign(driven.value) * length * UNIT[driven.component]
        self.axes.annotate("", at + step / 2, at - step / 2, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.8, "shrinkA": 0, "shrinkB": 0}, zorder=7)
        side = np.array([0.012, 0.0]) if driven.component == 2 else np.array([0.0, 0.025])
        self._words(at + self.size * side, text, colour, "left" if driven.component == 2 else "center")

    def _words(self, at: np.ndarray, text: str, colour: str, align: str = "center") -> None:
        self.axes.text(*at, text, fontsize=8.5, color=colour, ha=align, va="center", zorder=7, clip_on=False)

    # ---- supports and loads ----

    def fixations(self) -> None:
        held, moved, heated = {}, False, False
        for item in self.scene.held["fixations"]:
            x = self._places(item)
            if not len(x):
                continue
            driven = self.scene.driven(item)
            if item["field"] != DISPLACEMENT:
                heated = True
                self.axes.plot(*x.T, ls="none", marker="o", ms=4, color=HEAT, zorder=5)
                self._words(x[len(x) // 2] + 0.03 * self.size, f"{item['place'].split()[0]} {brief(driven.value)}", HEAT, "left")
            elif driven.value != 0:
                moved = True
                self._arrow(x[len(x) // 2] + 0.06 * self.size * np.sign(driven.value) * UNIT[item["component"]], driven, MOTION)
            else:
                for at in thinned(x, MOST_MARKS):
                    held.setdefault(tuple(at), set()).add(item["component"])
        marks = {frozenset((1,)): ">", frozenset((2,)): "^", frozenset((1, 2)): "s"}
        words = {">": "held along X", "^": "held along Y", "s": "held along X and Y"}
        for components in sorted({frozenset(c) for c in held.values()}, key=sorted):
            x = np.array([at for at, c in held.items() if frozenset(c) == components])
            mark = marks[components]
            shift = {">": (-0.014, 0.0), "^": (0.0, -0.014), "s": (0.0, 0.0)}[mark]
            self.axes.plot(*(x + self.size * np.array(shift)).T, ls="none", marker=mark, ms=5.5, mfc="white", mec=SUPPORT, mew=1.3, zorder=5, clip_on=False)
            self.key(SUPPORT, words[mark], ls="none", marker=mark, ms=5.5, mfc="white", mew=1.3)
        if moved and not self.scene.held["die_motions"]:
            self.key(MOTION, "motion (LIC: farthest)", lw=1.8)
        if heated:
            self.key(HEAT, "given temperature", ls="none", marker="o", ms=4)

    def _places(self, item: dict) -> np.ndarray:
        """Points of a fixation: its nodes, or the sides of a contour that its label names."""
        if item["nodes"]:
            return self.scene.x[np.array(item["nodes"]) - 1]
        words = item["place"].split()
        pieces = self.scene.place(words[1]) if len(words) > 1 else np.zeros((0, 3, 2))
        if not len(pieces):
            return np.zeros((0, 2))
        return np.einsum("pk,skd->spd", line3(np.linspace(-1, 1, 9)), pieces).reshape(-1, 2)

    def loads(self) -> None:
        for group in self.scene.groups:
            if group["role"] == "side load" and len(group["nodes"]):
                self._side_load(group)
            elif group["role"] == "volume load":
                driven = self.scene.driven(group)
                body = self.scene.groups[group["host"] - 1]
                centre = self.scene.x[body["nodes"]].reshape(-1, 2).mean(axis=0) if len(body["nodes"]) else 0.5 * (self.low + self.high)
                if group["direction"] in UNIT and driven.value != 0:
                    step = np.sign(driven.value) * 0.1 * self.size * UNIT[group["direction"]]
                    self.axes.annotate("", centre + step / 2, centre - step / 2, arrowprops={"arrowstyle": "-|>", "color": LOAD, "lw": 2.2}, zorder=7)
                self._words(centre + np.array([0.015, 0.0]) * self.size, f"{group['elem']} {brief(driven.value)}", LOAD, "left")
        forces = [item for item in self.scene.held["forces"] if item["field"] == DISPLACEMENT and self.scene.driven(item).value != 0]
        if forces:
            largest = max(abs(self.scene.driven(item).value) for item in forces)
            for item in forces:
                driven = self.scene.driven(item)
                step = 0.1 * self.size * driven.value / largest * UNIT[item["component"]]
                end = self.scene.x[item["node"] - 1]
                self.axes.annotate("", end, end - step, arrowprops={"arrowstyle": "-|>", "color": LOAD, "lw": 1.1, "shrinkA": 0, "shrinkB": 0}, zorder=7)
            self.key(LOAD, f"forces on nodes, the largest {brief(largest)}", lw=1.4)

    def _side_load(self, group: dict) -> None:
        """Arrows of a pressure on the part; a line where heat passes."""
        driven = self.scene.driven(group)
        curves = side_curves(self.scene.x, group["nodes"])
        if group["elem"] != "PRES2D":
            self.axes.add_collection(LineCollection(curves, colors=HEAT, linewidths=4.5, alpha=0.45, zorder=3.1))
            self.key(HEAT, group["name"], lw=4.5, alpha=0.45)
            return
        ends = self.scene.x[group["nodes"]]
        middle, way = ends[:, 1], ends[:, 2] - ends[:, 0]
        inward = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(*way.T)[:, None]
        sign = 1.0 if driven.value >= 0 else -1.0
        for k in thinned(np.arange(len(middle)), MOST_MARKS):
            tail = middle[k] - 0.06 * self.size * inward[k]
            head, start = (middle[k], tail) if sign > 0 else (tail, middle[k])
            self.axes.annotate("", head, start, arrowprops={"arrowstyle": "-|>", "color": LOAD, "lw": 1.0, "shrinkA": 0, "shrinkB": 0}, zorder=5)
        self.key(LOAD, f"pressure {group['name']}: {brief(driven.value)}", lw=1.4)

    def zones(self) -> None:
        places = self.scene.zone_places()
        for zone in self.scene.held["zones"]:
            if all(point in places for point in zone["points"]):
                corners = np.array([places[point] for point in zone["points"]])
                self.axes.plot(*np.vstack([corners, corners[:1]]).T, color=ZONE, lw=1.3, dashes=(5, 3), zorder=3.6)
                self._words(corners.mean(axis=0), zone["name"], ZONE)
        for k, at in places.items():
            self.axes.plot(*at, marker="D", ms=4, color=ZONE, zorder=6)
            self._words(at + 0.018 * self.size, self.scene.held["zone_points"][k - 1]["name"], ZONE, "left")
        if places:
            self.key(ZONE, "zones of new meshes, at the start", lw=1.3, dashes=(5, 3), marker="D", ms=4)


def side_curves_of(pieces: np.ndarray) -> np.ndarray:
    """Points along parabolas (side, point, 2)."""
    return np.einsum("pk,skd->spd", line3(np.linspace(-1, 1, 9)), pieces)


def thinned(items, most: int) -> list:
    """At most so many of a list, at equal distances, first and last among them."""
    if len(items) <= most:
        return list(items)
    return [items[k] for k in np.unique(np.linspace(0, len(items) - 1, most).round().astype(int))]


def deck_picture(scene: Scene) -> Picture:
    """All that a deck says of geometry, in one picture."""
    view = DeckView(scene)
    view.bodies()
    view.contacts()
    view.dies()
    view.die_motions()
    view.fixations()
    view.loads()
    view.zones()
    view.axes.legend(handles=view.legend, loc="upper left", bbox_to_anchor=(0.0, -0.07), ncols=2, handlelength=2.2)
    view.axes.set_title(scene.title)
    number = sum(len(group["nodes"]) for group in scene.bodies())
    return Picture("deck", "the scene at the start" + (f": {number} elements" if number else ""), view.fig, vector=number < 4000)
