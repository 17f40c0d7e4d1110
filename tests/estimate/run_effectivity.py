#!/usr/bin/env python3
"""The estimated errors of stress and strain against the true ones: effectivity (estimated over true) and order of convergence.

usage: run_effectivity.py [-v] [-k]

- `waves`, `ring`, `tube` (tests/patch/run_order.py): exact stress. The computed field of an element is the polynomial through its own
  points (2 x 2: bilinear, 3 x 3: biquadratic); its error in the energy norm is integrated here on 5 x 5 points.
- `hole`: a quarter of a plate with a hole, pulled, and `cook`: Cook's membrane in plane stress, clamped, whose corner is singular; both
  with 3 x 3 points. Where loads are given, ||sigma - sigma_h||^2 = 2 (U - U_h); U is that of a much finer mesh.
Strain: the same with the norm of the deviator, of one step of small strains. - `billet`: the deck decks/upsetting, plastic, a quarter of its height pressed, sticking: the truth is the stress of a mesh four or two
  times as fine at the same points of the material (the corner where the die ends is singular).
Norms of estimate and truth are both over that of the stress itself. Where few elements go round an arc (`ring`, `hole`) the polynomials
of the patches miss the turning of the stress: the estimate is then too high, and its upper bound is asked for from a finer mesh on.
"""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "patch"))
from patch_support import SOURCE, STRESS, Checks, Run, at_points, np, num  # noqa: E402
from run_order import MU, NU, TAIL, YOUNG, ring, ring_deck, tensor_stress, tube, tube_deck, waves, waves_deck  # noqa: E402

BULK = YOUNG/(3*(1 - 2*NU))
MESHES = (8, 16, 32)
FINE = 96
BAND = (0.8, 1.2)
# A corner's singularity spoils elements that are far from it, which no recovery there sees.
LEAST_AT_SINGULARITY = 0.75
BILLETS, FINE_BILLET = (6, 12), 24
LEAST_ORDER = 1.9


def density(stress, mu=MU, bulk=BULK):
    """Complementary energy of stresses (..., 4), without the half."""
    mean = (stress[..., 0] + stress[..., 1] + stress[..., 3])/3
    deviator = stress - mean[..., None]*np.array([1, 1, 0, 1])
    return (deviator**2*np.array([1, 1, 2, 1])).sum(axis=-1)/(2*mu) + mean**2/bulk


def lagrange(m, places):
    """Polynomials that are 1 at one of m Gauss points and 0 at the others, at places of the line (nplace, m)."""
    own = np.polynomial.legendre.leggauss(m)[0]
    return np.array([[np.prod([(x - own[j])/(own[i] - own[j]) for j in range(m) if j != i]) for i in range(m)] for x in places])


def through_points(npoint, n):
    """Values at n x n Gauss points of the tensor-product polynomial through its values at npoint points: (n*n, npoint)."""
    one = lagrange(int(npoint**0.5), np.polynomial.legendre.leggauss(n)[0])
    return np.kron(one, one)


def true_error(run, exact, npoint, axisym):
    """||sigma - sigma_h|| / ||sigma||."""
    nodes, elements = run.mesh()
    places, _, _, volumes = at_points(nodes[elements], nodes[elements], 5)
    if axisym:
        volumes = volumes*places[..., 0]
    stress = tensor_stress(exact(places)[1])
    own = run.state("p", *STRESS).reshape(len(elements), npoint, 4)
    computed = np.einsum("qp,epc->eqc", through_points(npoint, 5), own)
    return np.sqrt((volumes*density(computed - stress)).sum()/(volumes*density(stress)).sum())


def true_strain_error(run, exact, npoint, axisym):
    """The same of the strain, in the norm of its deviator."""
    nodes, elements = run.mesh()
    x, u = nodes[elements], run.displacement()[elements]

    def deviator(strain):
        return strain - strain[..., [0, 1, 3]].mean(axis=-1)[..., None]*np.array([1, 1, 0, 1])

    def size(strain):
        return np.sqrt((volumes*(deviator(strain)**2*[1, 1, 2, 1]).sum(axis=-1)).sum())

    places, values, gradients, _ = at_points(x, u, int(npoint**0.5))
    own = np.stack([gradients[..., 0, 0], gradients[..., 1, 1], (gradients[..., 0, 1] + gradients[..., 1, 0])/2,
                    values[..., 0]/places[..., 0] if axisym else 0*places[..., 0]], axis=-1)
    places, _, _, volumes = at_points(x, u, 5)
    if axisym:
        volumes = volumes*places[..., 0]
    strain = exact(places)[1]
    return size(np.einsum("qp,epc->eqc", through_points(npoint, 5), own) - strain)/size(strain)


def estimated(run):
    """The program's estimate, and the same from its values of the elements."""
    with run.open() as file:
        last = sorted(file["steps"])[-1]
        parts = file[f"steps/{last}/element/error_stress"][()]
    nodes, elements = run.mesh()
    volumes = at_points(nodes[elements], nodes[elements], 5)[3].sum(axis=1)
    return run.history["error_stress"][-1], np.sqrt((parts**2*volumes).sum()/volumes.sum())


def with_estimate(text):
    return text.replace("\nEND\n", "\nESTIM\nEND\n")


def hole_deck(n):
    """Blocks on both sides of the diagonal; the hole's radius is 1, the plate's half side 4."""
    c = np.sqrt(0.5)
    return (f"TITLE hole\nSTATE PLSTN\nKINEM SMALL\nBLOCK p PL8LS 9 m\n   {num(1, 0, 4, 0, 4, 4, c, c)}\n   {n} 6. {n} 1.\n"
            f"   SIDE 4 ARC 0. 0.\nBLOCK q PL8LS 9 m\n   {num(c, c, 4, 4, 0, 4, 0, 1)}\n   {n} 6. {n} 1.\n"
            f"   SIDE 4 ARC 0. 0.\nJOIN p 3 q 1\nLAW m ELA\n   {num(YOUNG, NU)}\nLIC t\n   0. 0.   1. 1.\n"
            f"FIXED p 1 Y\nFIXED q 3 X\nTRACT q 2 Y 10. t\nESTIM\n" + TAIL)


def cook_deck(n):
    """R.D. Cook, J. Struct. Div. ASCE 100 (1974) 1851-1863: clamped on the left, sheared on the right."""
    return (f"TITLE cook\nSTATE PLSTS\nKINEM SMALL\nBLOCK p PL8LS 9 m\n   {num(0, 0, 48, 44, 48, 60, 0, 44)}\n   {n} 1. {n} 1.\n"
            f"LAW m ELA\n   {num(YOUNG, NU)}\nLIC t\n   0. 0.   1. 1.\nFIXED p 4 XY\nTRACT p 2 Y 0.0625 t\nESTIM\n" + TAIL)


def report(checks, name, rows, least_order, upper_from, lower=BAND[0]):
    """The table of true and estimated errors; effectivity within the band, order of both."""
    print(f"{name:>14}   n       true  order  estimated  order  effectivity")
    for k, (n, true, guess) in enumerate(rows):
        orders = [f"{np.log2(a/b):6.2f}" for a, b in zip(rows[k - 1][1:], (true, guess))] if k else [" "*6]*2
        print(f"{n:18d} {true:10.3e} {orders[0]} {guess:10.3e} {orders[1]} {guess/true:10.3f}")
        checks.that(guess/true >= lower and (n < upper_from or guess/true <= BAND[1]), f"{name}, n = {n}: effectivity",
                    f"{guess/true:.3f}")
    if least_order:
        for column, what in ((1, "true"), (2, "estimated")):
            order = np.log2(rows[-2][column]/rows[-1][column])
            checks.that(order >= least_order, f"{name}: order of the {what} error", f"{order:.3f}")


def against_exact(checks, name, make, exact, npoint, axisym=False, upper_from=0):
    rows, strains = [], []
    for n in MESHES:
        run = Run(checks, f"{name}-{npoint}-{n}", with_estimate(make(n, npoint)))
        if not run.ok:
            return
        whole, parts = estimated(run)
        if not axisym:
            checks.that(abs(parts/whole - 1) < 1e-3, f"{run.name}: elements make the whole", (whole, parts))
        rows.append((n, true_error(run, exact, npoint, axisym), whole))
        strains.append((n, true_strain_error(run, exact, npoint, axisym), run.history["error_strain"][-1]))
    report(checks, f"{name} {npoint}", rows, LEAST_ORDER, upper_from)
    report(checks, f"{name} {npoint} strain", strains, LEAST_ORDER, upper_from)


def against_fine(checks, name, make, least_order, lower=BAND[0]):
    energies, guesses = [], []
    for n in MESHES + (FINE,):
        run = Run(checks, f"{name}-{n}", make(n))
        if not run.ok:
            return
        energies.append(run.history["elastic_energy"][-1])
        guesses.append(run.history["error_stress"][-1])
    rows = [(n, np.sqrt(1 - u/energies[-1]), guess) for n, u, guess in zip(MESHES, energies, guesses)]
    report(checks, name, rows, least_order, 0, lower)


def billet_deck(n):
    """The billet on n x 3n/2 elements, a quarter of its height pressed."""
    with open(os.path.join(SOURCE, "decks", "upsetting", "upsetting.lag"), encoding="utf-8") as deck:
        text = deck.read()
    for name, value in (("nx", n), ("ny", 3*n//2), ("travel", 3.75)):
        line = next(line for line in text.splitlines() if line.split()[:2] == ["PARAM", name])
        text = text.replace(line, f"PARAM  {name} {value}")
    return with_estimate(text)


def billet(checks):
    """Blocks of elements of the fine mesh lie in elements of the coarse ones, at the same points of the material."""
    fine = Run(checks, f"billet-{FINE_BILLET}", billet_deck(FINE_BILLET))
    if not fine.ok:
        return
    nodes, elements = fine.mesh()
    places, _, _, volumes = at_points((nodes + fine.displacement())[elements], nodes[elements], 2)
    volumes = volumes*places[..., 0]
    young, nu = 200000.0, 0.3
    moduli = young/(2*(1 + nu)), young/(3*(1 - 2*nu))
    stress = fine.state("billet", *STRESS).reshape(len(elements), 4, 4)
    gauss = np.polynomial.legendre.leggauss(2)[0]
    rows = []
    for n in BILLETS:
        run = Run(checks, f"billet-{n}", billet_deck(n))
        if not run.ok:
            return
        coarse = run.state("billet", *STRESS).reshape(3*n//2, n, 4, 4)
        computed, ratio = np.zeros_like(stress), FINE_BILLET//n
        for e in range(len(elements)):
            j, i = divmod(e, FINE_BILLET)
            x, y = (lagrange(2, -1 + 2*(k % ratio + (gauss + 1)/2)/ratio) for k in (i, j))
            computed[e] = np.kron(y, x) @ coarse[j//ratio, i//ratio]
        true = np.sqrt((volumes*density(computed - stress, *moduli)).sum()/(volumes*density(stress, *moduli)).sum())
        rows.append((n, true, run.history["error_stress"][-1]))
    report(checks, "billet", rows, 0, 0, LEAST_AT_SINGULARITY)


def main():
    checks = Checks()
    for npoint in (4, 9):
        against_exact(checks, "waves", waves_deck, waves, npoint)
        against_exact(checks, "ring", ring_deck, ring, npoint, upper_from=16 if npoint == 4 else 32)
        against_exact(checks, "tube", tube_deck, tube, npoint, axisym=True)
    against_fine(checks, "hole", hole_deck, LEAST_ORDER)
    against_fine(checks, "cook", cook_deck, 0, LEAST_AT_SINGULARITY)
    billet(checks)
    checks.end()


if __name__ == "__main__":
    main()
