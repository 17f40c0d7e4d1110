#!/usr/bin/env python3
"""Patch tests: five distorted 8-node quadrilaterals, boundary nodes driven by a linear field, hold it exactly inside.

usage: run_patch.py [-v] [-k]

The five elements of MacNeal and Harder (Finite Elem. Anal. Des. 1 (1985) 3-20), three times: `straight` sides with centred middles;
`sliding`, the middles inside moved along their straight sides; `curved`, moved off them too, boundary middles along theirs. The exact
fields: u = H x plane strain; u_r = c r, u_z = d z axisymmetric. Stresses are Hooke's, or one radial return in small strain (strain is
proportional, so the steps do not matter); for LOG they are tau/J, tau of ln(b)/2, b = F F^T for ELA, and the same return step by step,
b = f exp(2 e) f^T, for EPLA; for JAUMANN the elastic strain is carried with Hughes and Winget's matrices, step by step.

With r in the integrals, 2 x 2 points integrate constant stress exactly over straight sides with centred middles only; where the
middles are moved the axisymmetric patch needs 9 points, and only 9 are asked to pass it there.
"""
import sys

sys.dont_write_bytecode = True
from patch_support import STRESS, Checks, Run, hooke, np, num  # noqa: E402

YOUNG, NU, YIELD, HARDENING = 1.0e6, 0.25, 2.0e3, 5.0e4
TOLERANCE = 1.0e-10
OUTER = [(0.0, 0.0), (0.24, 0.0), (0.24, 0.12), (0.0, 0.12)]
INNER = [(0.04, 0.02), (0.18, 0.03), (0.16, 0.08), (0.08, 0.08)]
ELEMENTS = [(4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
# Middle of each side: where it lies along the side (0 ... 1) when moved, and how far off it (share of its length) when curved.
MOVED = {(4, 5): (0.46, 0.03), (5, 6): (0.55, -0.05), (6, 7): (0.54, 0.04), (7, 4): (0.45, -0.06), (0, 4): (0.54, 0.04),
         (1, 5): (0.46, -0.04), (2, 6): (0.55, 0.05), (3, 7): (0.46, -0.03),
         (0, 1): (0.52, 0.0), (1, 2): (0.46, 0.0), (2, 3): (0.48, 0.0), (3, 0): (0.55, 0.0)}


def patch(shape, shift=0.0):
    """Nodes (20, 2), elements of 8 from 0, and which nodes are on the boundary."""
    nodes = [np.array(x) + (shift, 0.0) for x in OUTER + INNER]
    edge = [True]*4 + [False]*4
    middles, elements = {}, []
    for corners in ELEMENTS:
        element = list(corners)
        for a, b in zip(corners, corners[1:] + corners[:1]):
            key = (a, b) if (a, b) in MOVED else (b, a)
            if key not in middles:
                along, off = MOVED[key]
                outside = key[0] < 4 and key[1] < 4
                if shape == "straight" or (shape == "sliding" and outside):
                    along = 0.5
                side = nodes[key[1]] - nodes[key[0]]
                place = nodes[key[0]] + along*side
                if shape == "curved":
                    place = place + off*np.array([-side[1], side[0]])
                middles[key] = len(nodes)
                nodes.append(place)
                edge.append(outside)
            element.append(middles[key])
        elements.append(element)
    return np.array(nodes), elements, np.array(edge)


def law_card(law):
    """The LAW card."""
    rows = f"LAW m {law}\n   {num(YOUNG, NU)}\n"
    return rows + (f"   LINEAR {num(YIELD, HARDENING)}\n" if law == "EPLA" else "")


# Forces of a body at rest in itself are round-off: nothing finer than the program's own norms can be asked for.
TIGHT, AT_REST = "NORMS FORCE 1.E-13 DISPL 1.E-11 STRAIN 1.\n", "NORMS STRAIN 1.\n"
# Nodes that turn in so many steps go along chords, with strains that a shorter step would follow.
IN_THESE_STEPS = "PATH 0 RATE 0\n"


def deck(state, kinem, law, npoint, mesh, loads, step=1.0, end=1.0, norms=TIGHT):
    """The scene around the loads."""
    nodes, elements, _ = mesh
    text = f"TITLE patch\nSTATE {state}\nKINEM {kinem}\nNODES\n"
    text += "".join(f"   {k + 1} {num(*x)}\n" for k, x in enumerate(nodes))
    text += f"PL8LS p {npoint} m\n"
    text += "".join(f"   {k + 1} " + " ".join(str(n + 1) for n in element) + "\n" for k, element in enumerate(elements))
    text += law_card(law) + loads
    text += norms + f"STRAT {num(step, step/64, step)} 4 3\nSTOP {num(end)}\nEND\n"
    return text


def driven(mesh, gradient, shift=(0.0, 0.0)):
    """Boundary nodes driven by u = H x + shift, linear in time."""
    nodes, _, edge = mesh
    field = nodes @ np.array(gradient).T + shift
    text = "LIC t\n   0. 0.   1. 1.\n"
    for k in np.flatnonzero(edge):
        text += "".join(f"MOVE NODE {k + 1} {c} t {num(u)}\n" for c, u in zip("XY", field[k]))
    return text, field


def returned(strain, plastic, spent=0.0):
    """Stress and elastic strain after the radial return from trial elastic `strain` (xx, yy, xy, zz)."""
    stress = hooke(strain, YOUNG, NU)
    if not plastic:
        return stress, strain, spent
    mean = (stress[0] + stress[1] + stress[3])/3
    deviator = stress - mean*np.array([1, 1, 0, 1])
    q = np.sqrt(1.5*(deviator @ deviator + deviator[2]**2))
    mu = YOUNG/(2*(1 + NU))
    more = max(0.0, (q - YIELD - HARDENING*spent)/(3*mu + HARDENING))
    flow = 1.5*more*deviator/q if q > 0 else 0*deviator
    return stress - 2*mu*flow, strain - flow, spent + more


def function_of(tensor, function):
    """A function of a symmetric tensor xx, yy, xy, zz, by its eigenvectors."""
    values, vectors = np.linalg.eigh([[tensor[0], tensor[2]], [tensor[2], tensor[1]]])
    plane = vectors @ np.diag(function(values)) @ vectors.T
    return np.array([plane[0, 0], plane[1, 1], plane[0, 1], function(tensor[3])])


def exact_stress(kinem, law, gradient, hoop, times):
    """Stress xx, yy, xy, zz reached by the linear field growing in proportion to time at the steps' ends."""
    plastic = law == "EPLA"
    gradient = np.array(gradient)
    if kinem == "SMALL":
        strain = np.array([gradient[0, 0], gradient[1, 1], (gradient[0, 1] + gradient[1, 0])/2, hoop])
        return returned(strain, plastic)[0]
    elastic, spent = np.zeros(4), 0.0
    before, before_hoop = np.eye(2), 1.0
    for time in (times if plastic or kinem == "JAUMANN" else [1.0]):
        now, now_hoop = np.eye(2) + time*gradient, 1 + time*hoop
        f = now @ np.linalg.inv(before)
        if kinem == "JAUMANN":
            trial = carried(elastic, f, now_hoop/before_hoop)
            stress, elastic, spent = returned(trial, plastic, spent)
            before, before_hoop = now, now_hoop
            continue
        b = function_of(elastic, lambda e: np.exp(2*e))
        plane = f @ np.array([[b[0], b[2]], [b[2], b[1]]]) @ f.T
        trial = function_of([plane[0, 0], plane[1, 1], plane[0, 1], b[3]*(now_hoop/before_hoop)**2], lambda x: 0.5*np.log(x))
        tau, elastic, spent = returned(trial, plastic, spent)
        before, before_hoop = now, now_hoop
    return stress if kinem == "JAUMANN" else tau/(np.linalg.det(before)*before_hoop)


def carried(elastic, f, hoop):
    """Elastic strain carried by Hughes and Winget's rotation, with the strain of mid-step turned by its half."""
    one = np.eye(2)
    g = 2*(f - one) @ np.linalg.inv(f + one)
    spin = (g - g.T)/2
    turn = np.linalg.inv(one - spin/2) @ (one + spin/2)
    angle = np.arctan2(turn[1, 0], turn[0, 0])/2
    half = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    e = turn @ [[elastic[0], elastic[2]], [elastic[2], elastic[1]]] @ turn.T + half @ (g + g.T) @ half.T/2
    return np.array([e[0, 0], e[1, 1], e[0, 1], elastic[3] + 2*(hoop - 1)/(hoop + 1)])


def compare(checks, run, field, stress, scale=None):
    """All points have this stress, all nodes this displacement, to the tolerance."""
    found = run.state("p", *STRESS)
    scale = scale or np.abs(stress).max()
    checks.small(np.abs(found - stress).max()/scale, TOLERANCE, f"{run.name}: stress at all points")
    size = np.abs(field).max()
    checks.small(np.abs(run.displacement() - field).max()/size, TOLERANCE, f"{run.name}: displacement of all nodes")


PLANE = {"SMALL": [("all", [[2e-3, 1.5e-3], [-4e-4, -3e-3]], (1e-3, 2e-3)), ("shear", [[0.0, 5e-3], [0.0, 0.0]], (0.0, 0.0)),
                   ("dilate", [[1e-3, 0.0], [0.0, 1e-3]], (0.0, 0.0))],
         "LOG": [("all", [[0.25, 0.4], [-0.1, -0.2]], (0.1, -0.3)), ("shear", [[0.0, 0.6], [0.0, 0.0]], (0.0, 0.0)),
                 ("stretch", [[0.5, 0.0], [0.0, -0.3]], (0.0, 0.0))]}
PLANE["JAUMANN"] = PLANE["LOG"]
ROUND = {"SMALL": [("both", [[2e-3, 0.0], [0.0, -3e-3]]), ("radial", [[3e-3, 0.0], [0.0, 0.0]])],
         "LOG": [("both", [[0.3, 0.0], [0.0, -0.35]]), ("squeezed", [[-0.2, 0.0], [0.0, 0.5]])]}
ROUND["JAUMANN"] = ROUND["LOG"]


def linear_fields(checks):
    """Every linear field: kinematics, laws, points, shapes, states."""
    for kinem in ("SMALL", "LOG", "JAUMANN"):
        for law in ("ELA", "EPLA"):
            step = 0.25 if law == "EPLA" or kinem != "SMALL" else 1.0
            for npoint in (4, 9):
                for shape in ("straight", "sliding", "curved") if kinem != "JAUMANN" else ("curved",):
                    mesh = patch(shape)
                    for name, gradient, shift in PLANE[kinem]:
                        loads, field = driven(mesh, gradient, shift)
                        run = Run(checks, f"plane-{kinem}-{law}-{npoint}-{shape}-{name}",
                                  deck("PLSTN", kinem, law, npoint, mesh, loads, step))
                        if run.ok:
                            compare(checks, run, field, exact_stress(kinem, law, gradient, 0.0, run.history["time"]))
                    if shape != "straight" and npoint == 4:
                        continue
                    # The second patch touches no axis.
                    for shift in (0.0, 0.1):
                        mesh = patch(shape, shift)
                        for name, gradient in ROUND[kinem]:
                            loads, field = driven(mesh, gradient)
                            run = Run(checks, f"axisym{shift}-{kinem}-{law}-{npoint}-{shape}-{name}",
                                      deck("AXISYM", kinem, law, npoint, mesh, loads, step))
                            if run.ok:
                                compare(checks, run, field,
                                        exact_stress(kinem, law, gradient, gradient[0][0], run.history["time"]))


def rigid_motions(checks):
    """Translations, small and whole rotations make no stress; a whole turn brings a stress back."""
    for kinem in ("SMALL", "LOG"):
        for npoint in (4, 9):
            mesh = patch("curved")
            for state, gradient, shift in (("PLSTN", [[0, 0], [0, 0]], (0.3, -0.2)), ("AXISYM", [[0, 0], [0, 0]], (0.0, 0.5)),
                                           ("PLSTN", [[0, -2e-3], [2e-3, 0]], (0.0, 0.0))):
                if kinem == "LOG" and gradient[1][0]:
                    continue
                loads, field = driven(mesh, gradient, shift)
                run = Run(checks, f"rigid-{state}-{kinem}-{npoint}-{'turn' if gradient[1][0] else 'shift'}",
                          deck(state, kinem, "ELA", npoint, mesh, loads, norms=AT_REST))
                # Stress per modulus is the round-off of displacements of this size over the patch.
                if run.ok:
                    compare(checks, run, field, np.zeros(4), YOUNG*1e-3)
    for npoint in (4, 9):
        for law, stretch in (("ELA", 0.0), ("ELA", 0.1), ("EPLA", 0.1)):
            turning(checks, "LOG", npoint, law, stretch)
        turning(checks, "JAUMANN", npoint, "EPLA", 0.1)


def turning(checks, kinem, npoint, law, stretch):
    """Stretched by U in one step, then turned by R in 24 steps, a whole circle, x = R U X."""
    mesh = patch("curved")
    nodes, _, edge = mesh
    u_matrix = np.array([[1 + stretch, 0.5*stretch], [0.5*stretch, 1 - stretch]])
    angles = np.linspace(0, 2*np.pi, 25)
    loads, moved = "", nodes @ (u_matrix - np.eye(2)).T
    for k in np.flatnonzero(edge):
        places = [[0.0, 0.0]]
        for angle in angles:
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            places.append(turn @ u_matrix @ nodes[k] - nodes[k])
        for c, name in enumerate("XY"):
            if not np.abs(np.array(places)[:, c]).max() > 0:
                loads += f"FIXED NODE {k + 1} {name}\n"
                continue
            loads += f"LIC t{k}{name}\n" + "".join(f"   {time}. {num(place[c])}\n" for time, place in enumerate(places))
            loads += f"MOVE NODE {k + 1} {name} t{k}{name}\n"
    run = Run(checks, f"circle-{kinem}-{law}-{npoint}-{stretch}", deck("PLSTN", kinem, law, npoint, mesh, loads, 1.0, 25.0,
                                                                          (TIGHT if stretch else AT_REST).replace("\n", " " + IN_THESE_STEPS)))
    if not run.ok:
        return
    stress = exact_stress(kinem, law, u_matrix - np.eye(2), 0.0, [1.0])
    found = run.state("p", *STRESS)
    checks.small(np.abs(found - stress).max()/max(np.abs(stress).max(), 1e-3*YOUNG), TOLERANCE, f"{run.name}: stress after a whole turn")
    checks.small(np.abs(run.displacement() - moved).max()/0.24, TOLERANCE, f"{run.name}: places after a whole turn")
    checks.that(run.history["step"][-1] == 25, f"{run.name}: no step was cut back", run.history["step"][-1])


def loaded_sides(checks):
    """Constant stress from tractions or pressure on all sides, held as little as can be: forces of sides and elements agree."""
    stress = {"tract": np.array([1000.0, -600.0, 0.0]), "shear": np.array([300.0, 200.0, 400.0]), "pressure": np.array([-500.0, -500.0, 0.0])}
    normals = {"below": (0, -1), "right": (1, 0), "above": (0, 1), "left": (-1, 0)}
    sides = "".join(f"SIDES {name}\n   {k + 2} 1\n" for k, name in enumerate(normals))
    for shape in ("straight", "curved"):
        mesh = patch(shape)
        for npoint in (4, 9):
            for name, s in stress.items():
                loads = "LIC t\n   0. 0.   1. 1.\n" + sides + "FIXED NODE 1 XY\nFIXED NODE 2 Y\n"
                for place, n in normals.items():
                    if name == "pressure":
                        loads += f"PRES2D {place} 3 {num(-s[0])} t\n"
                        continue
                    for c, t in zip("XY", (s[0]*n[0] + s[2]*n[1], s[2]*n[0] + s[1]*n[1])):
                        loads += f"TRACT {place} {c} {num(t)} t\n" if t else ""
                run = Run(checks, f"loaded-{name}-{npoint}-{shape}", deck("PLSTN", "SMALL", "ELA", npoint, mesh, loads))
                if not run.ok:
                    continue
                exx, eyy = (1 + NU)/YOUNG*((1 - NU)*s[0] - NU*s[1]), (1 + NU)/YOUNG*((1 - NU)*s[1] - NU*s[0])
                gamma = 2*(1 + NU)/YOUNG*s[2]
                # Node 2 keeps its height, so that the shear turns x = const.
                field = mesh[0] @ np.array([[exx, gamma], [0.0, eyy]]).T
                compare(checks, run, field, np.array([*s, NU*(s[0] + s[1])]))


def main():
    checks = Checks()
    linear_fields(checks)
    rigid_motions(checks)
    loaded_sides(checks)
    checks.end()


if __name__ == "__main__":
    main()
