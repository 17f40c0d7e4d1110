#!/usr/bin/env python3
"""Plane stress and generalised plane strain: patches, and bars, a beam and a cylinder against closed forms.

usage: run_section.py [-v] [-k]

Patches as in run_patch.py: u = H x on the boundary, in plane stress with the strain across that makes sigma_zz vanish (Hooke:
e_zz = -nu/(1-nu) (e_xx + e_yy), logarithmic strains where large; after yielding by bisection), in generalised plane strain with a
strain E of the section that is imposed, or free (then sigma_zz = 0: plane stress again).
Bars: Hencky's law in tension, tau = E ln(lambda), lateral ln = -nu ln(lambda), force tau A0/lambda; after yielding ln(lambda) =
tau/E + p, tau = RE + H p. The beam bends by moments: sigma_zz = E (e + KX x + KY y), u_x = -nu (e x + KX (x^2 - y^2)/2 + KY x y),
and so on: quadratic, so met exactly; beyond yield it gives the same answer in mm and in m. The cylinder is Lame's with free ends:
u_r of plane stress, e_z = -2 nu p a^2/(E (b^2 - a^2)).
"""
import sys

sys.dont_write_bytecode = True
from patch_support import STRESS, Checks, Run, np, num  # noqa: E402
from run_patch import HARDENING, NU, TOLERANCE, YIELD, YOUNG, deck, driven, exact_stress, law_card, patch  # noqa: E402

# In one step: the stresses expected are those of a straight path of strain.
TIGHT = "NORMS FORCE 1.E-12 DISPL 1.E-10 STRAIN 2. PATH 0 RATE 0\n"
SECTION = ("E", "KX", "KY")


def sections(e="HELD", kx="HELD", ky="HELD"):
    """The three cards SECTN."""
    return "".join(f"SECTN {name} {way}\n" for name, way in zip(SECTION, (e, kx, ky)))


def free_hoop(kinem, law, gradient):
    """Elongation across that leaves no stress there, for one step from rest."""
    gradient = np.array(gradient)
    if law == "ELA":
        if kinem == "SMALL":
            return -NU/(1 - NU)*np.trace(gradient)
        return np.linalg.det(np.eye(2) + gradient)**(-NU/(1 - NU)) - 1
    low, high = -0.6, 1.5
    for _ in range(200):
        middle = 0.5*(low + high)
        if exact_stress(kinem, law, gradient, middle, [1.0])[3] > 0:
            high = middle
        else:
            low = middle
    return middle


FIELDS = {"SMALL": ([[2e-3, 1.5e-3], [-4e-4, -3e-3]], [[0.0, 5e-3], [0.0, 0.0]]),
          "LOG": ([[0.25, 0.4], [-0.1, -0.2]], [[0.5, 0.0], [0.0, -0.3]])}


def patches(checks):
    """Linear fields in both states: kinematics, laws, points, thickness."""
    mesh = patch("curved")
    for kinem, fields in FIELDS.items():
        strain = 2e-3 if kinem == "SMALL" else 0.3
        for law in ("ELA", "EPLA"):
            for npoint in (4, 9):
                for number, gradient in enumerate(fields):
                    loads, field = driven(mesh, gradient)
                    free = free_hoop(kinem, law, gradient)
                    for state, more, hoop in (("PLSTS", "", free), ("PLSTS 2.5", "", free),
                                              ("GPLSTN 0.5", sections(f"MOVE t {strain}"), strain), ("GPLSTN", sections("FREE"), free)):
                        name = f"{state.replace(' ', '')}{'free' if 'FREE' in more else ''}-{kinem}-{law}-{npoint}-{number}"
                        run = Run(checks, name, deck(state, kinem, law, npoint, mesh, loads + more, norms=TIGHT))
                        if not run.ok:
                            continue
                        stress = exact_stress(kinem, law, gradient, hoop, [1.0])
                        found = run.state("p", *STRESS)
                        checks.small(np.abs(found - stress).max()/np.abs(stress).max(), TOLERANCE, f"{name}: stress at all points")
                        checks.small(np.abs(run.displacement() - field).max()/np.abs(field).max(), TOLERANCE, f"{name}: displacement")
                        if state.startswith("GPLSTN"):
                            area = 0.24*0.12*(np.linalg.det(np.eye(2) + np.array(gradient)) if kinem == "LOG" else 1)
                            checks.small(abs(run.history["section_force"][-1] - stress[3]*area)/(np.abs(stress).max()*area), TOLERANCE,
                                         f"{name}: force on the section")
                            checks.small(abs(run.history["section_strain"][-1] - hoop)/np.abs(gradient).max(), TOLERANCE, f"{name}: strain")


WIDTH, HEIGHT = 3.0, 2.0


def bar(state, kinem, loads, law="ELA", npoint=4, origin=(0.0, 0.0), steps=1):
    """A rectangle of 3 x 2 elements, held against sliding and turning."""
    x, y = origin
    corners = num(x, y, x + WIDTH, y, x + WIDTH, y + HEIGHT, x, y + HEIGHT)
    return (f"TITLE bar\nSTATE {state}\nKINEM {kinem}\nBLOCK p PL8LS {npoint} m\n   {corners}\n   3 1.5 2 1.\n" + law_card(law)
            + "LIC t\n   0. 0.   1. 1.\n" + loads + TIGHT + f"STRAT {1/steps} 1.E-3 {1/steps} 4 3\nSTOP 1.\nEND\n")


SYMMETRIC = "FIXED p 1 Y\nFIXED p 4 X\nPROBE side REACT X p 4\nPROBE right NODE UX 3. 0.\nPROBE up NODE UY 0. 2.\n"


def close(checks, found, exact, what, bound=1e-9):
    """Relative agreement."""
    checks.small(abs(found/exact - 1), bound, what)


def bars(checks):
    """Tension in the plane and across it, by force, by strain, by pressure; the thickness in the forces."""
    tau = 0.4*YOUNG
    stretch = np.exp(tau/YOUNG)
    for state, more in (("PLSTS 1.", ""), ("PLSTS 2.", ""), ("GPLSTN 2.", sections("FREE")), ("GPLSTN 2.", sections("FREE", "FREE", "FREE"))):
        thickness = float(state.split()[1])
        name = f"pulled-{state[:6].strip()}-{thickness:.0f}{more.count('FREE')}"
        run = Run(checks, name, bar(state, "LOG", SYMMETRIC + more + f"MOVE p 2 X t {num(WIDTH*(stretch - 1))}\n", steps=4))
        if run.ok:
            close(checks, run.history["side"][-1], -tau*HEIGHT*thickness/stretch, f"{name}: force")
            close(checks, run.history["up"][-1], HEIGHT*(stretch**-NU - 1), f"{name}: contraction")
            checks.small(np.abs(run.state("p", "stress_zz")).max()/tau, 1e-10, f"{name}: no stress across")
            if "GPLSTN" in state:
                close(checks, run.history["section_strain"][-1], stretch**-NU - 1, f"{name}: strain of the section")
            else:
                close(checks, run.state("p", "stretch_zz")[0, 0], stretch**-NU, f"{name}: stretch across")

    # Pushed by a load that keeps its size, free across: the same motion in both states.
    ends = []
    for state, more in (("PLSTS", ""), ("GPLSTN", sections("FREE", "FREE", "FREE"))):
        run = Run(checks, f"pushed-{state}", bar(state, "LOG", SYMMETRIC + more + f"TRACT p 2 X {num(-0.1*YOUNG)} t\n", steps=2))
        if run.ok:
            ends.append(run.displacement())
    if len(ends) == 2:
        checks.small(np.abs(ends[0] - ends[1]).max()/WIDTH, 1e-9, "pushed: generalised plane strain with free ends is plane stress")

    # A pressure acts on the thickness of now in generalised plane strain, on that of the start in plane stress.
    for state, more in (("PLSTS", ""), ("GPLSTN", sections("FREE", "FREE", "FREE"))):
        run = Run(checks, f"pressed-{state}", bar(state, "LOG", SYMMETRIC + more + f"PRES2D p 2 3 {num(0.1*YOUNG)} t\n", steps=2))
        if run.ok:
            stress = run.state("p", *STRESS)
            across = run.state("p", "stretch_zz")[0, 0] if state == "PLSTS" else 1.0
            checks.small(np.abs(stress*across - [-0.1*YOUNG, 0, 0, 0]).max()/(0.1*YOUNG), 1e-9, f"{run.name}: uniaxial stress")

    # Across the plane: a force on the section, whatever the thickness; then a strain.
    area = WIDTH*HEIGHT
    for thickness in (1.0, 2.0):
        force = tau*area/stretch
        run = Run(checks, f"force-{thickness}", bar(f"GPLSTN {thickness}", "LOG", SYMMETRIC + sections(f"FORCE {num(force)} t"), steps=4))
        if run.ok:
            close(checks, run.history["section_strain"][-1], stretch - 1, f"{run.name}: strain of the section")
            close(checks, run.history["right"][-1], WIDTH*(stretch**-NU - 1), f"{run.name}: contraction")
            close(checks, run.history["section_force"][-1], force, f"{run.name}: force reported")
            close(checks, run.history["external_work"][-1], run.history["elastic_energy"][-1], f"{run.name}: work by trapezoids", 0.02)
    plastic = 0.5
    tau = YIELD + HARDENING*plastic
    stretch = np.exp(tau/YOUNG + plastic)
    moments = sections(f"MOVE t {num(stretch - 1)}")
    run = Run(checks, "strain-plastic", bar("GPLSTN", "LOG", SYMMETRIC + moments, "EPLA", steps=10))
    if run.ok:
        close(checks, run.history["section_force"][-1], tau*area/stretch, "strain-plastic: force")
        close(checks, run.state("p", "plastic_strain").max(), plastic, "strain-plastic: plastic strain")
        close(checks, run.history["section_moment_x"][-1], tau/stretch*area*0.5*WIDTH*np.exp(tau/YOUNG*(0.5 - NU) - 0.5*np.log(stretch)),
              "strain-plastic: moment about the origin")


def beams(checks):
    """Bending about both axes, by curvature and by moment, centred and not."""
    ix, iy, area = HEIGHT*WIDTH**3/12, WIDTH*HEIGHT**3/12, WIDTH*HEIGHT
    kx, ky = 2e-3, -3e-3
    for way in ("curvature", "moment"):
        for npoint in (4, 9):
            for thickness in (1.0, 2.0):
                drive = ([f"MOVE t {kx}", f"MOVE t {ky}"] if way == "curvature"
                         else [f"FORCE {num(YOUNG*ix*kx)} t", f"FORCE {num(YOUNG*iy*ky)} t"])
                loads = "FIXED POINT 0. 0. XY\nFIXED POINT -1.5 0. Y\n" + sections("FREE", *drive)
                name = f"bent-{way}-{npoint}-{thickness:.0f}"
                run = Run(checks, name, bar(f"GPLSTN {thickness}", "SMALL", loads, npoint=npoint, origin=(-WIDTH/2, -HEIGHT/2)).replace(
                    "3 1.5 2 1.", "4 1. 2 1."))
                if not run.ok:
                    continue
                nodes = run.mesh()[0]
                x, y = nodes.T
                u = -NU*np.stack([kx*(x*x - y*y)/2 + ky*x*y, ky*(y*y - x*x)/2 + kx*x*y], axis=-1)
                # The point on the left keeps its height: u turns with it.
                left = np.array([-WIDTH/2, 0.0])
                turn = -NU*ky*(-left[0]**2)/2/left[0]
                u -= turn*np.stack([-y, x], axis=-1)
                checks.small(np.abs(run.displacement() - u).max()/np.abs(u).max(), 1e-9, f"{name}: displacement")
                close(checks, run.history["section_moment_x"][-1], YOUNG*ix*kx, f"{name}: moment x")
                close(checks, run.history["section_moment_y"][-1], YOUNG*iy*ky, f"{name}: moment y")
                close(checks, run.history["section_curvature_x"][-1], kx, f"{name}: curvature x")
                close(checks, run.history["section_curvature_y"][-1], ky, f"{name}: curvature y")
                checks.small(abs(run.history["section_strain"][-1]), 1e-9*kx, f"{name}: no strain of the axis")
                close(checks, run.state("p", "stress_zz").max(), YOUNG*fibre(kx, ky, npoint), f"{name}: stress of the fibres")
                checks.small(np.abs(run.state("p", *STRESS[:3])).max()/(YOUNG*kx), 1e-9, f"{name}: no other stress")
                # Trapezoids are exact for a linear body; with a thickness of 2 the fibres are twice as long.
                energy = 0.5*thickness*YOUNG*(ix*kx**2 + iy*ky**2)
                close(checks, run.history["elastic_energy"][-1], energy, f"{name}: stored energy")
                close(checks, run.history["external_work"][-1], energy, f"{name}: external work")
    # Away from the axis: a force without moment there bends; E and KX as of a straight beam.
    held = "FIXED POINT 0. 0. XY\nFIXED POINT 3. 0. Y\n"
    run = Run(checks, "eccentric", bar("GPLSTN", "SMALL", held + sections(f"FORCE {num(1e-3*YOUNG*area)} t", "FREE")))
    if run.ok:
        # N = EA (e + k xc), 0 = E (A xc e + (I + A xc^2) k).
        k = -1e-3*(WIDTH/2)*area/ix
        close(checks, run.history["section_curvature_x"][-1], k, "eccentric: curvature")
        close(checks, run.history["section_strain"][-1], 1e-3 - k*WIDTH/2, "eccentric: strain at the origin")


def fibre(kx, ky, npoint):
    """Largest KX x + KY y over the points of the beam's 4 x 2 elements."""
    g = 1/np.sqrt(3) if npoint == 4 else np.sqrt(0.6)
    return abs(kx)*(0.5*WIDTH - WIDTH/8*(1 - g)) + abs(ky)*(0.5*HEIGHT - HEIGHT/4*(1 - g))


def cylinder(checks):
    """Thick cylinder under pressure inside, its ends free: a quarter."""
    a, b, p = 4.0, 10.0, 1e-3*YOUNG
    c = p*a*a/(YOUNG*(b*b - a*a))
    text = (f"TITLE free ends\nSTATE GPLSTN 3.\nKINEM SMALL\nBLOCK p PL8LS 4 m\n   {num(a, 0, b, 0, 0, b, 0, a)}\n   6 2. 8 1.\n"
            "   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\n" + law_card("ELA") + "LIC t\n   0. 0.   1. 1.\nFIXED p 1 Y\nFIXED p 3 X\n"
            + sections("FREE") + f"PRES2D p 4 3 {num(p)} t\nPROBE inside NODE UX {a} 0.\nPROBE outside NODE UX {b} 0.\nPROBE cut REACT Y p 1\n"
            + TIGHT + "STRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
    run = Run(checks, "cylinder", text)
    if run.ok:
        for name, r in (("inside", a), ("outside", b)):
            close(checks, run.history[name][-1], c*((1 - NU)*r + (1 + NU)*b*b/r), f"cylinder: displacement {name}", 1e-4)
        close(checks, run.history["section_strain"][-1], -2*NU*c, "cylinder: strain of the axis", 1e-4)
        close(checks, run.history["cut"][-1], -3*p*a, "cylinder: the cut bears the pressure", 1e-9)
        checks.small(abs(run.history["section_force"][-1])/(p*a*a), 1e-9, "cylinder: no force on the ends")


def units(checks):
    """A bar bent and pulled beyond yield in mm and N, and in m and N: the same iterations and the same answer."""
    runs = []
    for name, metre in (("mm", 1000.0), ("m", 1.0)):
        young, sy = 200e9/metre**2, 300e6/metre**2
        text = (f"TITLE {name}\nSTATE GPLSTN {num(0.01*metre)}\nKINEM LOG\nBLOCK p PL8LS 4 m\n"
                f"   {num(*(metre*v for v in (-0.01, 0, 0.01, 0, 0.01, 0.005, -0.01, 0.005)))}\n   6 1. 2 1.\nLAW m EPLA\n   {num(young, 0.3)}\n"
                f"   LINEAR {num(sy, 20*sy)}\nSECTN E FORCE {num(15e3)} t\nSECTN KX FORCE {num(120*metre)} t\nSECTN KY HELD\n"
                "FIXED p 1 Y\nFIXED POINT 0. 0. X\nLIC t\n   0. 0.   1. 1.\nSTRAT 0.1 1.E-4 0.1 4 3\nEND\n")
        run = Run(checks, f"units-{name}", text)
        if not run.ok:
            return
        runs.append((run.history, metre))
    (one, a), (two, b) = runs
    checks.that(list(one["iterations"]) == list(two["iterations"]), "units: the same iterations", (one["iterations"], two["iterations"]))
    checks.that(one["plastic_work"][-1] > 0.1*one["elastic_energy"][-1], "units: the bar yields", one["plastic_work"])
    for name, power in (("section_strain", 0), ("section_curvature_x", -1), ("section_moment_y", 1), ("plastic_work", 1)):
        close(checks, one[name][-1]/(two[name][-1]*(a/b)**power), 1.0, f"units: {name}", 1e-9)


def main():
    checks = Checks()
    patches(checks)
    bars(checks)
    beams(checks)
    cylinder(checks)
    units(checks)
    checks.end()


if __name__ == "__main__":
    main()
