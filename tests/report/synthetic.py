"""A folder of results made up for tests: the layout of the solver's files, a squeezed billet, no mechanics."""
import json
import os

import h5py
import numpy as np

STATE = ["pressure", "friction", "penetration", "contact_status", "slip", "augmentation", "friction_work", "die_piece"]
FIELDS = ["mises", "stress_xx", "stress_yy", "stress_xy", "stress_zz", "plastic_strain"]


def block(nx, ny, width, height):
    """Nodes (n, 2) and 8-node elements of a rectangle, and its sides: bottom, right, top, left, counter-clockwise."""
    number, x = {}, []
    for j in range(2 * ny + 1):
        for i in range(2 * nx + 1):
            if i % 2 and j % 2:
                continue
            number[i, j] = len(x)
            x.append((width * i / (2 * nx), height * j / (2 * ny)))
    shape = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    elements = [[number[2 * i + a, 2 * j + b] for a, b in shape] for j in range(ny) for i in range(nx)]
    right = [[number[2 * nx, 2 * j + k] for k in range(3)] for j in range(ny)]
    top = [[number[2 * i - k, 2 * ny] for k in range(3)] for i in range(nx, 0, -1)]
    return np.array(x), np.array(elements), np.array(right + top)


def squeezed(x, share, width, height):
    """Where material points are when the height is `share` less: incompressible, barrelled."""
    y = x[:, 1] * (1 - share)
    bulge = (1 - share)**-0.5 - 1
    return np.stack([x[:, 0] * (1 + bulge * (1.35 - 1.05 * (x[:, 1] / height)**2)), y], axis=1)


def text(value):
    """A text as the solver stores it: UTF-8 of fixed length."""
    return np.array(value.encode(), dtype=h5py.string_dtype("utf-8", max(len(value.encode()), 1)))


def write_generation(path, number, x0, topology, sides, steps, dies, plane_state, title):
    """NAME.gNN.h5. `steps` are (step, time, share, coordinates, plastic strain, pilots)."""
    with h5py.File(path, "w") as file:
        file["mesh/coordinates"] = x0
        file["mesh/topology"] = topology.astype("i4")
        file.attrs["title"] = text(title)
        file.attrs["plane_state"] = np.int32(plane_state)
        file.attrs["generation"] = np.int32(number)
        for k, (name, elem, nodes) in enumerate([("billet", "PL8LS", topology), ("billet.2+3/zupper", "CNT2D", sides)], start=1):
            file[f"mesh/groups/{k}/connectivity"] = nodes.astype("i4")
            file[f"mesh/groups/{k}"].attrs["name"] = text(name)
            file[f"mesh/groups/{k}"].attrs["elem"] = text(elem)
        for name, pieces in dies:
            file[f"dies/{name}"] = pieces
        folder = path[:-len(".h5")]
        os.makedirs(folder, exist_ok=True)
        for step, time, share, x, strain, pilots in steps:
            file[f"steps/{step:06d}"] = h5py.ExternalLink(f"{os.path.basename(folder)}/{step:06d}.h5", "/")
            write_instant(os.path.join(folder, f"{step:06d}.h5"), step, time, share, x0, x, strain, pilots, sides)


def write_instant(path, step, time, share, x0, x, strain, pilots, sides):
    """NAME.gNN/NNNNNN.h5."""
    with h5py.File(path, "w") as place:
        place["coordinates"] = x
        place["pilots"] = pilots
        place.attrs["time"] = float(time)
        place.attrs["step"] = np.int32(step)
        for name, vector in (("displacement", x - x0), ("applied_force", 0 * x)):
            place[f"node/{name}"] = np.hstack([vector, np.zeros((len(x), 1))])
        for k, name in enumerate(FIELDS):
            place[f"node/{name}"] = strain if name == "plastic_strain" else (700 + 300 * strain) * [1, -.2, -1, .2, -.2, 0][k]
        state = np.zeros((len(sides), 2, len(STATE)))
        closed = np.abs(x[sides][:, [0, 2], 1] - x[:, 1].max()) < 1e-9
        closed &= share > 0
        state[..., 0] = closed * (900 + 40 * x[sides][:, [0, 2], 0])
        state[..., 1] = -0.3 * state[..., 0]
        state[..., 3] = closed * (1 + (x[sides][:, [0, 2], 0] > 5))
        place["points/2/state"] = state
        place["points/2/components"] = np.array([name.encode() for name in STATE], dtype=h5py.string_dtype("utf-8", 16))


def write_xdmf(path, grids):
    """NAME.xdmf over (time, file, step, nodes, elements)."""
    def item(shape, kind, place):
        number = 'NumberType="Int" Precision="4"' if kind == "i" else 'NumberType="Float" Precision="8"'
        return f'     <DataItem Format="HDF" Dimensions="{shape}" {number}>{place}</DataItem>\n'

    out = ['<?xml version="1.0" encoding="UTF-8"?>\n<Xdmf Version="3.0">\n <Domain>\n'
           '  <Grid Name="history" GridType="Collection" CollectionType="Temporal">\n']
    for time, file, step, nodes, elements in grids:
        place = f"{file[:-len('.h5')]}/{step:06d}.h5:"
        out.append(f'   <Grid Name="mesh" GridType="Uniform">\n    <Time Value="{time!r}"/>\n    <Geometry GeometryType="XY">\n'
                   + item(f"{nodes} 2", "f", f"{place}/coordinates") + "    </Geometry>\n"
                   f'    <Topology TopologyType="Quadrilateral_8" NumberOfElements="{elements}">\n'
                   + item(f"{elements} 8", "i", f"{file}:/mesh/topology") + "    </Topology>\n"
                   f'    <Attribute Name="displacement" AttributeType="Vector" Center="Node">\n'
                   + item(f"{nodes} 3", "f", f"{place}/node/displacement") + "    </Attribute>\n")
        for name in FIELDS:
            out.append(f'    <Attribute Name="{name}" AttributeType="Scalar" Center="Node">\n'
                       + item(f"{nodes}", "f", f"{place}/node/{name}") + "    </Attribute>\n")
        out.append("   </Grid>\n")
    with open(path, "w", encoding="utf-8") as file:
        file.write("".join(out) + "  </Grid>\n </Domain>\n</Xdmf>\n")


def make_run(folder, name="billet", generations=1, stop=0, title="Billet <10 x 30> & dies", plane_state=2, bad_checks=False,
             cycle=False):
    """A whole folder: fields, XDMF, history, summary, listing; with `cycle`, what lagacycle adds."""
    os.makedirs(folder, exist_ok=True)
    width, height, nsteps = 10.0, 15.0, 24
    straight = np.array([[[30., 0.], [14.5, 0.], [-1., 0.]]])
    turn = np.linspace(-0.9, 0.9, 7)
    wheel = np.stack([14 + 3 * np.cos(np.pi + turn[::-1]), 6 + 3 * np.sin(np.pi + turn[::-1])], axis=1)
    arc = np.stack([wheel[0:5:2], wheel[1:6:2], wheel[2:7:2]], axis=1) - [14, 6]
    dies = [("zupper", straight), ("a_wheel", arc)]        # HDF5 lists them in the other order
    pilots_at = lambda share: np.array([[0, height * (1 - share), 0], [16 + 4 * share, 6, 2 * share]])
    grids = []
    for g in range(1, generations + 1):
        first, last = (g - 1) * nsteps // generations, g * nsteps // generations
        material, topology, sides = block(4 + 2 * g, 6 + 2 * g, width, height)
        steps = []
        for step in sorted({*range(first, last + 1, 3), last}):
            time = step / nsteps
            share = 0.5 * time
            strain = -np.log(1 - share) * (0.3 + 1.4 * (1 - material[:, 1] / height) * (1 - 0.5 * material[:, 0] / width))
            steps.append((step, time, share, squeezed(material, share, width, height), strain, pilots_at(share)))
        file = f"{name}.g{g:02d}.h5"
        write_generation(os.path.join(folder, file), g, steps[0][3], topology, sides, steps, dies, plane_state, title)
        grids += [(step[1], file, step[0], len(material), len(topology)) for step in steps]
    write_xdmf(os.path.join(folder, name + ".xdmf"), grids)
    if cycle:
        write_cycle(folder, name, grids)
    write_history(folder, nsteps, height)
    write_summary(folder, name, title, generations, nsteps, stop, bad_checks)
    with open(os.path.join(folder, name + ".log"), "w", encoding="utf-8") as file:
        file.write("scene      made up\ncut: step 7  time 0.25  length 0.04 -> 0.02: 15 iterations (element 3 of billet)\nstep 7\n")
        if cycle:
            for wall, memory in ((2.5, 30.25), (1.25, 60.5), (1e-1, 20)):
                file.write(f"  1742 equations, 276 elements, 1 threads, {wall} s on the wall, 0.1846 s of processor, {memory} MB\n")
    return folder


CYCLE_HEAD = ("generation [-],try [-],stop_step [-],stop_time [time],step [-],trigger,action,result,accepted,stage,"
              "old_elements [-],new_elements [-],error_before [%],error_after [%],first_residual [-],iterations [-],"
              "force_change [%],energy_change [%],depth_change [-],least_step_ratio [-],remdata [s],restart [s],reason")


def write_cycle(folder, name, grids):
    """cycle.csv of the generations in `grids` (as for write_xdmf), the second mesh after a refused try; facts of each mesh."""
    first = {}
    for time, file, step, _, elements in grids:
        first.setdefault(int(file[-5:-3]), (step, time, elements))
    rows = [CYCLE_HEAD]
    for number, (step, time, elements) in first.items():
        if number == 1:
            continue
        head, old, new = f"{step},{time!r},{step}", first[number - 1][2], elements
        if number == 2:
            rows.append(f"2,1,{head},times,old mesh,goes on,y,,{old},{old},20.,,,,,,,,,,")
            rows.append(f"2,1,{head},stress_error 0.2 (limit 0.1),as the deck says,refused,n,mesh,{old},,20.,"
                        ",,,,,,,,,an <angle> of 3")
            rows.append(f"2,2,{head},stress_error 0.2 (limit 0.1),finer,goes on,y,,{old},{new},20.,7.25,0.0625,4,0.5,0.375,0.75,0.125,0.25,0.5,")
        else:
            rows.append(f"{number},1,{head},times,as the deck says,goes on,y,,{old},{new},9.,5.,0.03,3,-0.25,0.5,0.25,1.5,0.1,0.2,")
        stem = os.path.join(folder, f"{name}.g{number:02d}")
        with open(stem + ".start.h5.json", "w", encoding="utf-8") as file:
            json.dump({"transfer": [{"name": "plastic_strain", "before": 200.0, "carried": 199.0, "after": 201.0,
                                     "largest_before": 2.0, "largest_after": 1.875}]}, file)
        with open(stem + ".restart.json", "w", encoding="utf-8") as file:
            json.dump({"volume_before": 400.0, "volume_after": 402.0, "elastic_energy_before": 8.0, "elastic_energy_after": 7.0,
                       "plastic_work_before": 0.0, "plastic_work_after": None, "first_residual_limit": 0.5, "iterations_limit": 40,
                       "force_change_limit": 0.125, "energy_change_limit": 0.25, "depth_change_limit": 2.0}, file)
        with open(stem + ".probation.json", "w", encoding="utf-8") as file:
            json.dump({"least_step_ratio": 0.125, "least_step_ratio_limit": 0.0625}, file)
    with open(os.path.join(folder, "cycle.csv"), "w", encoding="utf-8") as file:
        file.write("\n".join(rows) + "\n")


def write_history(folder, nsteps, height):
    head = ["time [time]", "step [-]", "step_length [time]", "iterations [-]", "cutbacks [-]", "strain_increment [-]",
            "external_work [energy]", "elastic_energy [energy]", "plastic_work [energy]", "friction_work [energy]",
            "volume_drift [-]", "max_penetration [length]", "points_sticking [-]", "points_slipping [-]"]
    for die in ("zupper", "a_wheel"):
        head += [f"force_x_{die} [force]", f"force_y_{die} [force]", f"moment_{die} [force*length]",
                 f"displacement_x_{die} [length]", f"displacement_y_{die} [length]", f"rotation_{die} [rad]"]
    rows = [",".join(head + ["bulge [length]"])]
    for step in range(1, nsteps + 1):
        t = step / nsteps
        work = 2e6 * t**1.3
        rows.append(",".join(repr(float(v)) if not isinstance(v, int) else str(v) for v in [
            t, step, 1 / nsteps, 3 + step % 4, step // 9, 0.02, work, 0.02 * work, 0.93 * work, 0.045 * work, -1e-4 * t, 1e-3, 9, 4,
            2e4 * t, 2e5 + 5e5 * t * t, 1e5 * t, 0.0, -0.5 * height * t, 0.0, -3e4 * t, 1e3 * t, 4e4 * t, 2 * t, 0.0, t,
            10 + 3 * t * t]))
    with open(os.path.join(folder, "history.csv"), "w", encoding="utf-8") as file:
        file.write("\n".join(rows) + "\n")


def write_summary(folder, name, title, generations, nsteps, stop, bad):
    effects = {"displacement": (True, f"BLOCK billet at {name}.lag:6", "300 unknowns", 494, 0.11),
               "contact": (True, f"CNT2D billet at {name}.lag:16", "3 unknowns per die", 457, 0.02),
               "heat": (False, "no card asks for it", "nothing", 0, 0.)}
    summary = {"program": "lagamine", "version": "0.1.0", "deck": f"decks/{name}.lag", "title": title, "deck_sha256": "0f" * 32,
               "status": "stopped" if stop else "done", "exit_code": stop,
               "stop_reason": "no convergence: step 25 from time 1" if stop else "end of the scene", "time": 1.0, "end_time": 1.0,
               "steps": nsteps, "iterations": 108, "cutbacks": 2, "remeshings": generations - 1, "wall_s": 1.5, "cpu_s": 1.4,
               "peak_rss_mb": 24.5, "threads": 2, "dofs": 616, "elements": 96, "symmetric": False, "initial_volume": 400.0,
               "effects": {key: dict(zip(("on", "why", "adds", "calls", "wall_s"), row)) for key, row in effects.items()},
               "seconds": {"analysis": 0.01, "displacement": 0.11, "contact": 0.02, "factorisation": 0.9},
               "checks": {"volume_drift": 0.02 if bad else -1e-4, "max_penetration": 0.003 if bad else 0.001,
                          "allowed_penetration": 0.00125, "worst_linear_residual": 1e-8 if bad else 1e-14, "least_dissipation": 0.0,
                          "energy_imbalance": None if bad else 0.005},
               "energy": {"external_work": 2e6, "elastic": 4e4, "plastic": 1.86e6, "friction": 9e4}}
    if not bad:
        summary["checks"]["volume_drift_unloaded"] = 2.5e-5
    with open(os.path.join(folder, "summary.json"), "w", encoding="utf-8") as file:
        json.dump(summary, file, indent=2)
