"""The billet of decks/upsetting for CalculiX: 8-node axisymmetric elements with 2x2 points, ends that stick to the die."""
import os

RADIUS, HEIGHT, TRAVEL = 10.0, 15.0, 9.0
YOUNG, POISSON, YIELD, HARDENING, LARGEST_STRAIN = 200000.0, 0.3, 700.0, 300.0, 3.0
# First step, length, least and largest step: those of the deck.
STEPS = "0.01, 1., 1.E-5, 0.05"
# CalculiX makes a wedge of 2 degrees of an axisymmetric body and reports the forces on that.
WEDGES = 180


def input_deck(nx, ny):
    """The text of the .inp file. The upper end follows the die: u_r = 0, u_z = -travel; no contact of the side."""
    label, coordinates = {}, []
    for j in range(2 * ny + 1):
        for i in range(2 * nx + 1):
            if i % 2 and j % 2:
                continue
            label[i, j] = len(label) + 1
            coordinates.append(f"{label[i, j]}, {RADIUS * i / (2 * nx):.12g}, {HEIGHT * j / (2 * ny):.12g}, 0.")
    corners = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    elements = [f"{1 + i + nx * j}, " + ", ".join(str(label[2 * i + a, 2 * j + b]) for a, b in corners)
                for j in range(ny) for i in range(nx)]
    top = [label[i, 2 * ny] for i in range(2 * nx + 1)]
    middle = [label[i, 0] for i in range(2 * nx + 1)]
    axis = [label[0, j] for j in range(2 * ny + 1)]
    cards = ["*NODE, NSET=ALL", *coordinates, "*ELEMENT, TYPE=CAX8R, ELSET=BILLET", *elements]
    for name, nodes in (("TOP", top), ("MIDDLE", middle), ("AXIS", axis)):
        cards += [f"*NSET, NSET={name}", *(f"{node}," for node in nodes)]
    cards += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}", "*PLASTIC", f"{YIELD}, 0.",
              f"{YIELD + HARDENING * LARGEST_STRAIN}, {LARGEST_STRAIN}", "*SOLID SECTION, ELSET=BILLET, MATERIAL=STEEL",
              "*BOUNDARY", "MIDDLE, 2, 2", "AXIS, 1, 1", "TOP, 1, 1",
              "*STEP, NLGEOM, INC=10000", "*STATIC", STEPS, "*BOUNDARY", f"TOP, 2, 2, {-TRAVEL}",
              "*NODE PRINT, NSET=TOP, TOTALS=ONLY", "RF", "*END STEP"]
    return "\n".join(cards) + "\n"


def read_answer(folder):
    """Accepted increments, iterations (those of increments tried in vain too), cutbacks, and the force [N] in time."""
    answer = {"steps": 0, "iterations": 0, "cutbacks": 0, "times": [0.0], "forces": [0.0]}
    for words in table(os.path.join(folder, "billet.sta")):
        # step, increment, attempt (with U when in vain), iterations, total time, ...
        answer["iterations"] += int(words[3])
        if words[2].endswith("U"):
            answer["cutbacks"] += 1
        else:
            answer["steps"] += 1
    iterations = len(table(os.path.join(folder, "billet.cvg")))
    answer["iterations"] = max(iterations, answer["iterations"])
    now = None
    try:
        with open(os.path.join(folder, "billet.dat"), encoding="utf-8") as file:
            for line in file:
                if "total force" in line:
                    now = float(line.split()[-1])
                elif now is not None and line.strip():
                    answer["times"].append(now)
                    answer["forces"].append(WEDGES * abs(float(line.split()[1])))
                    now = None
    except OSError:
        pass
    return answer


def table(path):
    """Rows of a table that begin with a number."""
    try:
        with open(path, encoding="utf-8") as file:
            return [line.split() for line in file if line.split() and line.split()[0].isdigit()]
    except OSError:
        return []
