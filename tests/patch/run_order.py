#!/usr/bin/env python3
"""Order of convergence of PL8LS in linear elasticity, against closed forms.

usage: run_order.py [-v] [-k]

Displacement in L2, and the energy norm of the error: sqrt(integral of (eps_h - eps):C:(eps_h - eps)), eps_h from the program's nodal
displacements with shape functions written here, on 5 x 5 points whatever the element uses: not the program's stress at its own 2 x 2 points,
which is better than the norm says. That one is printed apart as `points`: the root mean square over the program's integration points of its
stress less the exact one there. The order is that of the last halving.

- `waves`: plane strain, Kolosov-Muskhelishvili potentials phi = exp(a z), psi = sin(b z), all boundary nodes moved, in a distorted quadrangle.
- `ring`: Lame's cylinder, a quarter in plane strain, sides on arcs, pressure inside.
- `tube`: the same, axisymmetric, graded.
Energy of the cylinder: pi p a u(a) = 8.27705 per unit length, by C. Felippa's numbers a = 4, b = 10, p = 10, E = 1000, nu = 0.3.
"""
import sys

sys.dont_write_bytecode = True
from patch_support import STRESS, Checks, Run, at_points, hooke, np, num  # noqa: E402

YOUNG, NU = 1000.0, 0.3
MU = YOUNG/(2*(1 + NU))
A, B, P = 4.0, 10.0, 10.0
ENERGY = 8.27705
LEAST_L2, LEAST_ENERGY, LEAST_STORED = 2.8, 1.9, 3.8
TAIL = "NORMS FORCE 1.E-12 DISPL 1.E-10\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n"


def tensor_stress(strain):
    """Hooke's stress of strains xx, yy, xy, zz."""
    return hooke(strain, YOUNG, NU)


def waves(x):
    """Displacement (..., 2) and strain (..., 4): 2 mu (u + i v) = (3 - 4 nu) phi - z conj(phi') - conj(psi)."""
    a, b = 0.8 + 0.3j, 1.1 - 0.2j
    z = x[..., 0] + 1j*x[..., 1]
    phi, d_phi, dd_phi = np.exp(a*z), a*np.exp(a*z), a*a*np.exp(a*z)
    psi, d_psi = np.sin(b*z), b*np.cos(b*z)
    w = ((3 - 4*NU)*phi - z*np.conj(d_phi) - np.conj(psi))/(2*MU)
    # sxx + syy = 4 Re phi', syy - sxx + 2 i sxy = 2 (conj(z) phi'' + psi')
    total, other = 4*d_phi.real, 2*(np.conj(z)*dd_phi + d_psi)
    sxx, syy, sxy = (total - other.real)/2, (total + other.real)/2, other.imag/2
    exx, eyy = ((1 - NU)*sxx - NU*syy)/(2*MU), ((1 - NU)*syy - NU*sxx)/(2*MU)
    return np.stack([w.real, w.imag], axis=-1), np.stack([exx, eyy, sxy/(2*MU), 0*exx], axis=-1)


def lame(r):
    """Radial displacement, radial and hoop strain."""
    c = (1 + NU)*P*A*A/(YOUNG*(B*B - A*A))
    return c*((1 - 2*NU)*r + B*B/r), c*((1 - 2*NU) - B*B/r**2), c*((1 - 2*NU) + B*B/r**2)


def ring(x):
    """Lame's cylinder in the plane of its section."""
    r = np.linalg.norm(x, axis=-1)
    u, err, ett = lame(r)
    c, s = x[..., 0]/r, x[..., 1]/r
    return np.stack([u*c, u*s], axis=-1), np.stack([err*c*c + ett*s*s, err*s*s + ett*c*c, (err - ett)*c*s, 0*r], axis=-1)


def tube(x):
    """Lame's cylinder in a plane through its axis."""
    u, err, ett = lame(x[..., 0])
    return np.stack([u, 0*u], axis=-1), np.stack([err, 0*u, 0*u, ett], axis=-1)


def waves_deck(n, npoint):
    """A quadrangle with no side along an axis, written out node by node."""
    corners = np.array([[0.1, 0.0], [1.4, 0.2], [1.2, 1.3], [-0.1, 1.0]])
    number, nodes, edge, elements = {}, [], [], []
    for j in range(2*n + 1):
        for i in range(2*n + 1):
            if i % 2 and j % 2:
                continue
            s, t = i/(2*n), j/(2*n)
            number[i, j] = len(nodes) + 1
            nodes.append(np.array([(1 - s)*(1 - t), s*(1 - t), s*t, (1 - s)*t]) @ corners)
            edge.append(i in (0, 2*n) or j in (0, 2*n))
    for j in range(0, 2*n, 2):
        for i in range(0, 2*n, 2):
            elements.append([number[i + a, j + b] for a, b in
                             ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))])
    text = "TITLE waves\nSTATE PLSTN\nKINEM SMALL\nNODES\n" + "".join(f"   {k + 1} {num(*x)}\n" for k, x in enumerate(nodes))
    text += f"PL8LS p {npoint} m\n" + "".join(f"   {k + 1} " + " ".join(map(str, e)) + "\n" for k, e in enumerate(elements))
    text += f"LAW m ELA\n   {num(YOUNG, NU)}\nLIC t\n   0. 0.   1. 1.\n"
    u = waves(np.array(nodes))[0]
    for k in np.flatnonzero(edge):
        text += "".join(f"MOVE NODE {k + 1} {c} t {num(v)}\n" for c, v in zip("XY", u[k]))
    return text + TAIL


def ring_deck(n, npoint):
    """A quarter ring; side 4 is the inner arc, sides 1 and 3 the symmetry lines."""
    return (f"TITLE ring\nSTATE PLSTN\nKINEM SMALL\nBLOCK p PL8LS {npoint} m\n   {num(A, 0, B, 0, 0, B, 0, A)}\n   {n} 2. {n} 1.\n"
            f"   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\nLAW m ELA\n   {num(YOUNG, NU)}\nLIC t\n   0. 0.   1. 1.\n"
            f"FIXED p 1 Y\nFIXED p 3 X\nPRES2D p 4 3 {num(P)} t\nPROBE below REACT Y p 1\nPROBE left REACT X p 3\n" + TAIL)


def tube_deck(n, npoint):
    """A slice of unit length."""
    return (f"TITLE tube\nSTATE AXISYM\nKINEM SMALL\nBLOCK p PL8LS {npoint} m\n   {num(A, 0, B, 0, B, 1, A, 1)}\n   {n} 2. {(n + 1)//2} 1.\n"
            f"LAW m ELA\n   {num(YOUNG, NU)}\nLIC t\n   0. 0.   1. 1.\nFIXED p 1 3 Y\nPRES2D p 4 3 {num(P)} t\n" + TAIL)


def errors(run, exact, npoint, axisym):
    """Displacement in L2, energy norm, root mean square of the stress at the program's own points; all over the exact ones."""
    nodes, elements = run.mesh()
    x, u = nodes[elements], run.displacement()[elements]
    places, values, gradients, volumes = at_points(x, u, 5)
    if axisym:
        volumes = volumes*places[..., 0]
    strain = np.stack([gradients[..., 0, 0], gradients[..., 1, 1], (gradients[..., 0, 1] + gradients[..., 1, 0])/2,
                       values[..., 0]/places[..., 0] if axisym else 0*volumes], axis=-1)
    u_exact, strain_exact = exact(places)

    def energy(e):
        return np.sqrt((volumes*(tensor_stress(e)*e*[1, 1, 2, 1]).sum(axis=-1)).sum())

    def size(v):
        return np.sqrt((volumes*(v*v).sum(axis=-1)).sum())

    own = at_points(x, u, int(npoint**0.5))[0].reshape(-1, 2)
    stress_exact = tensor_stress(exact(own)[1])
    stress = run.state("p", *STRESS)
    return [size(values - u_exact)/size(u_exact), energy(strain - strain_exact)/energy(strain_exact),
            np.linalg.norm(stress - stress_exact)/np.linalg.norm(stress_exact)]


def order(table, column):
    """Order at the last halving."""
    return np.log2(table[-2][column]/table[-1][column])


def study(checks, name, make, exact, npoint, axisym=False):
    """One problem on meshes n = 2, 4, 8, 16, the table, the orders; the runs."""
    runs, table = [], []
    for n in (2, 4, 8, 16):
        run = Run(checks, f"{name}-{npoint}-{n}", make(n, npoint))
        if not run.ok:
            return []
        runs.append(run)
        table.append(errors(run, exact, npoint, axisym))
    print(f"{name}, {npoint} points    n   displacement  order     energy norm  order          points  order")
    for k, (n, row) in enumerate(zip((2, 4, 8, 16), table)):
        orders = [f"{np.log2(a/b):6.2f}" for a, b in zip(table[k - 1], row)] if k else [" "*6]*3
        print(f"{n:{len(name) + 18}d}" + "".join(f"{e:15.3e} {o}" for e, o in zip(row, orders)))
    what = f"{name}, {npoint} points: order of "
    checks.that(order(table, 0) >= LEAST_L2, what + "the displacement", f"{order(table, 0):.3f}")
    checks.that(order(table, 1) >= LEAST_ENERGY, what + "the energy norm", f"{order(table, 1):.3f}")
    checks.that(order(table, 2) >= LEAST_ENERGY, what + "the stress at the points", f"{order(table, 2):.3f}")
    return runs


def stored(checks, runs, what, share, exact_at_nodes=False):
    """Energy of the whole ring by the program's own sum: work of the load, order 4, and the number of the books."""
    exact = np.pi*P*A*lame(A)[0]
    checks.small(abs(exact/ENERGY - 1), 1e-6, f"{what}: the closed form's energy is {ENERGY}")
    found = [share*run.history["elastic_energy"][-1] for run in runs]
    work = [share*run.history["external_work"][-1] for run in runs]
    fall = [abs(e/exact - 1) for e in found]
    rate = np.log2(fall[-2]/fall[-1])
    print(f"{what}: stored energy {found[-1]:.8f}, exact {exact:.8f}, errors " + " ".join(f"{e:.2e}" for e in fall)
          + ("" if exact_at_nodes else f", order {rate:.2f}"))
    if exact_at_nodes:
        checks.small(max(fall), 1e-10, f"{what}: stored energy on every mesh")
    else:
        checks.that(rate >= LEAST_STORED, f"{what}: order of the stored energy", fall)
        checks.small(fall[-1], 1e-5, f"{what}: stored energy")
    checks.small(max(abs(e/w - 1) for e, w in zip(found, work)), 1e-10, f"{what}: stored energy is the work of the pressure")


def main():
    checks = Checks()
    for npoint in (4, 9):
        study(checks, "waves", waves_deck, waves, npoint)
        runs = study(checks, "ring", ring_deck, ring, npoint)
        if runs:
            stored(checks, runs, f"ring, {npoint} points", 4)
            for run in runs:
                # The cut holds what the pressure pushes with: p a, whatever the mesh.
                error = max(abs(run.history[side][-1]/-(P*A) - 1) for side in ("below", "left"))
                checks.small(error, 1e-10, f"{run.name}: reaction of the cuts")
        runs = study(checks, "tube", tube_deck, tube, npoint, axisym=True)
        if runs:
            # Lame's solution is met at the nodes by quadratics with two points across, on any mesh: no order is left to measure.
            stored(checks, runs, f"tube, {npoint} points", 1, exact_at_nodes=npoint == 4)
    checks.end()


if __name__ == "__main__":
    main()
