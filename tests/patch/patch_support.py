"""What the scripts of this folder share: writing decks, running them, reading fields, the 8-node quadrilateral in numpy.

Fields are read with h5py, which the project asks for: a script starts itself again with LAGAMINE_PYTHON, and without h5py there it
fails and says so.
"""
import csv
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE))
BIN = os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin")
LAGAMINE = os.path.join(os.path.abspath(BIN), "lagamine")
DONE, NO_CONVERGENCE = 0, 3
LONGEST_RUN = 120  # seconds


def need_h5py():
    """Go on with an interpreter that has h5py and numpy, or fail."""
    if all(map(importlib.util.find_spec, ("h5py", "numpy"))):
        return
    other = os.environ.get("LAGAMINE_PYTHON")
    if other and not os.environ.get("LAGAMINE_PYTHON_TRIED"):
        os.environ["LAGAMINE_PYTHON_TRIED"] = "1"
        os.execv(other, [other] + sys.argv)
    print("FAILED this test reads HDF5 files: install python3-h5py, or set LAGAMINE_PYTHON to a Python that has it")
    print("0 passed, 1 failed")
    sys.exit(1)


need_h5py()
import h5py  # noqa: E402
import numpy as np  # noqa: E402


class Checks:
    """Counts what holds and prints what does not; `-v` prints all, `-k` keeps the decks and results."""

    def __init__(self):
        self.passed = self.failed = 0
        self.verbose = "-v" in sys.argv[1:]
        self.folder = tempfile.mkdtemp(prefix="lagamine-patch-")

    def that(self, holds, what, detail=""):
        """One check; `detail` is printed when it fails."""
        self.passed += bool(holds)
        self.failed += not holds
        if not holds:
            print(f"FAILED {what}" + (f": {detail}" if str(detail) else ""), flush=True)
        elif self.verbose:
            print(f"ok     {what}" + (f" ({detail})" if str(detail) else ""), flush=True)
        return bool(holds)

    def small(self, error, bound, what):
        """An error is at most its bound; not-a-number is not."""
        return self.that(error <= bound, what, f"{error:.2e}, bound {bound:.0e}")

    def end(self):
        """Print the count, remove the folder, end with 0 or 1."""
        if "-k" in sys.argv[1:]:
            print(f"kept {self.folder}")
        else:
            shutil.rmtree(self.folder, ignore_errors=True)
        print(f"{self.passed} passed, {self.failed} failed")
        sys.exit(1 if self.failed or not self.passed else 0)


class Run:
    """A deck that ran: exit code, history by column, fields of the last saved step."""

    def __init__(self, checks, name, text, code=DONE, threads=1, options=()):
        self.name = name
        path = os.path.join(checks.folder, name + ".lag")
        self.out = os.path.join(checks.folder, name)
        with open(path, "w", encoding="utf-8") as deck:
            deck.write(text)
        result = subprocess.run([LAGAMINE, path, "--out", self.out, "--threads", str(threads), "--quiet", *options], text=True,
                                check=False, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                timeout=LONGEST_RUN)
        self.code, self.said = result.returncode, result.stderr.strip()
        self.ok = checks.that(self.code == code, f"{name}: exit code {code}", f"{self.code} {self.said[:400]}")
        self.history = self.read_history() if self.code in (DONE, NO_CONVERGENCE) else {}

    def read_history(self):
        """Columns of history.csv by name without unit."""
        with open(os.path.join(self.out, "history.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        names = [title.split(" [")[0] for title in rows[0]]
        return {name: np.array([float(row[k]) for row in rows[1:]]) for k, name in enumerate(names)}

    def open(self, generation=1):
        """The fields on a mesh, the first or that of a later operation."""
        return h5py.File(os.path.join(self.out, f"{self.name}.g{generation:02}.h5"), "r")

    def mesh(self):
        """Coordinates (nnode, 2) as the scene began, and nodes (nelem, 8) from 0."""
        with self.open() as file:
            return file["mesh/coordinates"][()][:, :2], file["mesh/topology"][()]

    def displacement(self):
        """Displacements (nnode, 2) at the end."""
        with self.open() as file:
            last = sorted(file["steps"])[-1]
            return file[f"steps/{last}/node/displacement"][()][:, :2]

    def state(self, group, *names):
        """Components `names` at all points of the group of this name at the end: (nelem*npoint, len(names)), points of an element
        one after the other."""
        with self.open() as file:
            last = sorted(file["steps"])[-1]
            for number, thing in file["mesh/groups"].items():
                if as_text(thing.attrs["name"]) == group:
                    place = file[f"steps/{last}/points/{number}"]
                    components = [as_text(name) for name in place["components"][()]]
                    state = place["state"][()]
                    state = state.reshape(-1, state.shape[-1])
                    return state[:, [components.index(name) for name in names]]
        raise KeyError(group)


STRESS = ("stress_xx", "stress_yy", "stress_xy", "stress_zz")


# Nodes of the sides of an element, its first, middle and last.
SIDES = ((0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0))


def least_place(run, component=0):
    """Least coordinate, x or y, over the sides of the boundary at all saved instants, each by the chord of its side at the start."""
    first, nodes = run.mesh()
    sharing = np.bincount(nodes[:, 4:].ravel(), minlength=len(first))
    sides = np.concatenate([nodes[:, side] for side in SIDES])
    sides = sides[sharing[sides[:, 1]] == 1]
    chord = np.linalg.norm(first[sides[:, 2]] - first[sides[:, 0]], axis=1)
    xi = np.linspace(-1, 1, 201)
    phi = np.array([xi*(xi - 1)/2, 1 - xi**2, xi*(xi + 1)/2])
    least = np.inf
    with run.open() as file:
        for step in sorted(file["steps"]):
            now = (first + file[f"steps/{step}/node/displacement"][()][:, :2])[:, component]
            least = min(least, ((now[sides] @ phi).min(axis=1)/chord).min())
    return least


def as_text(word):
    """Text of an HDF5 string, fixed or not."""
    if isinstance(word, np.ndarray):
        word = word.flat[0]
    return (word.decode() if isinstance(word, bytes) else str(word)).strip()


def num(*values):
    """Numbers with all their digits."""
    return " ".join(repr(float(value)) for value in values)


def hooke(strain, young, nu):
    """Stress xx, yy, xy, zz of strains with the tensor shear."""
    strain = np.asarray(strain, dtype=float)
    mu, lam = young/(2*(1 + nu)), young*nu/((1 + nu)*(1 - 2*nu))
    stress = 2*mu*strain
    trace = strain[..., 0] + strain[..., 1] + strain[..., 3]
    for k in (0, 1, 3):
        stress[..., k] += lam*trace
    return stress


CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


def quad8(xi, eta):
    """Serendipity functions (8) and parent derivatives (2, 8): own statement, not the program's."""
    phi, d_xi, d_eta = np.zeros(8), np.zeros(8), np.zeros(8)
    for i, (a, b) in enumerate(CORNERS):
        phi[i] = 0.25*(1 + a*xi)*(1 + b*eta)*(a*xi + b*eta - 1)
        d_xi[i] = 0.25*a*(1 + b*eta)*(2*a*xi + b*eta)
        d_eta[i] = 0.25*b*(1 + a*xi)*(2*b*eta + a*xi)
    for i, b in ((4, -1), (6, 1)):
        phi[i], d_xi[i], d_eta[i] = 0.5*(1 - xi*xi)*(1 + b*eta), -xi*(1 + b*eta), 0.5*b*(1 - xi*xi)
    for i, a in ((5, 1), (7, -1)):
        phi[i], d_xi[i], d_eta[i] = 0.5*(1 - eta*eta)*(1 + a*xi), 0.5*a*(1 - eta*eta), -eta*(1 + a*xi)
    return phi, np.array([d_xi, d_eta])


def at_points(x, u, n):
    """Points of the n x n Gauss rule (xi fastest) of elements x (nelem, 8, 2): places, displacements, gradients du_i/dx_j, weights."""
    points, weights = np.polynomial.legendre.leggauss(n)
    places, values, gradients, volumes = [], [], [], []
    for j in range(n):
        for i in range(n):
            phi, dphi = quad8(points[i], points[j])
            jacobian = np.einsum("ka,eai->eki", dphi, x)
            nx = np.linalg.solve(jacobian, np.broadcast_to(dphi, (len(x), 2, 8)))
            places.append(np.einsum("a,eai->ei", phi, x))
            values.append(np.einsum("a,eai->ei", phi, u))
            gradients.append(np.einsum("eja,eai->eij", nx, u))
            volumes.append(np.linalg.det(jacobian)*weights[i]*weights[j])
    return [np.stack(part, axis=1) for part in (places, values, gradients, volumes)]
