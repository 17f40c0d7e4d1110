#!/usr/bin/env python3
"""Forces on volumes against closed forms: a bar under its own weight, discs and cylinders that turn.

usage: run_body_forces.py [-v] [-k]

- `hung`: a bar of height H under a force b per volume, nu = 0: u = b H^2/(2 E) at its end in small strain, exact at the nodes; in large
  strain (Hencky's law, sigma = E ln(l)/l, l the stretch) the present length L and the stretch l1 at the support meet
  b H/E = 1/4 + (2 ln l1 - 1)/(4 l1^2), b L = E ln(l1)/l1. Reactions are b times the present volume.
- `turned` (S. Timoshenko, J.N. Goodier, Theory of Elasticity, 3rd ed., section 32): in plane stress
  u = (3 + nu)(1 - nu)/(8 E) d w^2 r (a^2 + b^2 - (1 + nu)/(3 + nu) r^2 + (1 + nu)/(1 - nu) a^2 b^2/r^2); plane strain by E/(1 - nu^2) and
  nu/(1 - nu); a long cylinder with free ends has e_z = -nu d w^2 (a^2 + b^2)/(2 E) on top, since the mean of sigma_r + sigma_t is
  d w^2 (a^2 + b^2)/2.
"""
import sys

sys.dont_write_bytecode = True
from patch_support import Checks, Run, np, num  # noqa: E402

TAIL = "LIC t\n   0. 0.   1. 1.\nNORMS FORCE 1.E-12 DISPL 1.E-10 STRAIN 2.\n"
WIDTH, HEIGHT, YOUNG = 2.0, 5.0, 1000.0


def close(checks, found, exact, what, bound):
    """Relative agreement."""
    checks.small(abs(found/exact - 1), bound, what)


def hung(state, kinem, force, npoint="4", n=4, steps=1, direction="Y"):
    """A bar that hangs on its upper side, or lies against its left one."""
    width, height = (WIDTH, HEIGHT) if direction == "Y" else (HEIGHT, WIDTH)
    rule, _, option = npoint.partition(" ")
    return (f"TITLE hung\nSTATE {state}\nKINEM {kinem}\nBLOCK p PL8LS {rule} m {option}\n   {num(0, 0, width, 0, width, height, 0, height)}\n"
            f"   {1 if direction == 'Y' else n} 1. {n if direction == 'Y' else 1} 1.\nLAW m ELA\n   {YOUNG} 0.\n"
            + ("FIXED p 3 Y\nFIXED p 4 X\n" if direction == "Y" else "FIXED p 1 Y\nFIXED p 4 X\n")
            + f"BFORC p {direction} {num(force)} t\nPROBE end NODE U{direction} {num(width if direction == 'X' else 0, 0)}\n"
            f"PROBE held REACT {direction} p {3 if direction == 'Y' else 4}\n" + TAIL + f"STRAT {1/steps} 1.E-3 {1/steps} 4 3\nSTOP 1.\nEND\n")


def bars(checks):
    """Small and large strain in all plane states."""
    sections = "".join(f"SECTN {name} HELD\n" for name in ("E", "KX", "KY"))
    states = {"PLSTN": WIDTH, "PLSTN 3.": 3*WIDTH, "PLSTS 3.": 3*WIDTH, "GPLSTN 3.": 3*WIDTH, "AXISYM": np.pi*WIDTH**2}
    for state, area in states.items():
        for npoint in ("4", "9", "9 MEAN"):
            if npoint == "9 MEAN" and "PLSTS" in state:
                continue
            name = f"hung-{state}-{npoint}".replace(" ", "")
            more = sections if "GPLSTN" in state else ""
            run = Run(checks, name + "-small", hung(state, "SMALL", -2.0, npoint).replace("KINEM", more + "KINEM"))
            if run.ok:
                close(checks, run.history["end"][-1], -2.0*HEIGHT**2/(2*YOUNG), f"{name}: displacement of the end", 1e-9)
                close(checks, run.history["held"][-1], 2.0*area*HEIGHT, f"{name}: reaction", 1e-9)
                energy = 4.0*HEIGHT**3/(6*YOUNG)*area
                close(checks, run.history["elastic_energy"][-1], energy, f"{name}: stored energy", 1e-9)
                close(checks, run.history["external_work"][-1], energy, f"{name}: work of the weight", 1e-9)
            force = 0.06*YOUNG/HEIGHT
            low, high = 1.0, np.exp(0.5)
            for _ in range(100):
                stretch = 0.5*(low + high)
                if 0.25 + (2*np.log(stretch) - 1)/(4*stretch**2) > force*HEIGHT/YOUNG:
                    high = stretch
                else:
                    low = stretch
            length = YOUNG*np.log(stretch)/(stretch*force)
            run = Run(checks, name + "-large", hung(state, "LOG", -force, npoint, n=8, steps=10).replace("KINEM", more + "KINEM"))
            if run.ok:
                close(checks, -run.history["end"][-1], length - HEIGHT, f"{name}: end of the long bar", 1e-4)
                close(checks, run.history["held"][-1], force*area*length, f"{name}: reaction of the long bar", 1e-5)
                close(checks, run.history["external_work"][-1], run.history["elastic_energy"][-1], f"{name}: work by trapezoids", 0.01)
    run = Run(checks, "pushed-x", hung("PLSTN", "SMALL", 2.0, direction="X"))
    if run.ok:
        close(checks, run.history["end"][-1], 2.0*HEIGHT**2/(2*YOUNG), "pushed-x: displacement of the end", 1e-9)
        close(checks, run.history["held"][-1], -2.0*WIDTH*HEIGHT, "pushed-x: reaction", 1e-9)


A, B, NU, DENSITY, OMEGA = 1.0, 4.0, 0.3, 2.0, 1.5


def disc(r, young, nu):
    """Timoshenko's displacement."""
    return ((3 + nu)*(1 - nu)/(8*young)*DENSITY*OMEGA**2*r
            * (A*A + B*B - (1 + nu)/(3 + nu)*r*r + (1 + nu)/(1 - nu)*A*A*B*B/r**2))


def turning(checks):
    """A ring with a hole in all plane states; the load grows with the square of the multiplier."""
    strain = -NU*DENSITY*OMEGA**2*(A*A + B*B)/(2*YOUNG)
    cases = {"PLSTS 2.": lambda r: disc(r, YOUNG, NU),
             "PLSTN": lambda r: disc(r, YOUNG/(1 - NU**2), NU/(1 - NU)),
             "AXISYM": lambda r: disc(r, YOUNG/(1 - NU**2), NU/(1 - NU)),
             "GPLSTN": lambda r: disc(r, YOUNG/(1 - NU**2), NU/(1 - NU)) - NU*strain*r}
    for state, exact in cases.items():
        if state == "AXISYM":
            body = f"   {num(A, 0, B, 0, B, 1, A, 1)}\n   12 2. 1 1.\nFIXED p 1 3 Y\n"
        else:
            body = f"   {num(A, 0, B, 0, 0, B, 0, A)}\n   12 2. 8 1.\n   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\nFIXED p 1 Y\nFIXED p 3 X\n"
        if state == "GPLSTN":
            body += "SECTN E FREE\nSECTN KX HELD\nSECTN KY HELD\n"
        name = f"turned-{state[:6].strip()}"
        run = Run(checks, name, f"TITLE turned\nSTATE {state}\nKINEM SMALL\nBLOCK p PL8LS 4 m\n{body}LAW m ELA\n   {num(YOUNG, NU)}\n"
                  f"CENTR p {DENSITY} {num(OMEGA/2)} w\nLIC w\n   0. 0.   1. 2.\nPROBE inside NODE UX {A} 0.\nPROBE outside NODE UX {B} 0.\n"
                  "STRAT 0.5 0.5 0.5 4 3\nNORMS FORCE 1.E-12 DISPL 1.E-10\nSTOP 1.\nEND\n")
        if not run.ok:
            continue
        for place, r in (("inside", A), ("outside", B)):
            close(checks, run.history[place][-1], exact(r), f"{name}: displacement {place}", 2e-4)
            close(checks, run.history[place][-1], 4*run.history[place][-2], f"{name}: the square of the multiplier, {place}", 1e-9)
        if state == "GPLSTN":
            close(checks, run.history["section_strain"][-1], strain, f"{name}: strain of the axis", 1e-5)


def main():
    checks = Checks()
    bars(checks)
    turning(checks)
    checks.end()


if __name__ == "__main__":
    main()
