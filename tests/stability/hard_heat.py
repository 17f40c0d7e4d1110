"""Hard cases of heat and phases: shocks, latent heat in a narrow range, unlike materials, bursts of martensite under load."""
import os

from hard_support import Case, SOURCE, deck, np, report

LEAST = "PROBE cold MIN temperature b/PL8TM\n"
STEELS = os.path.join(SOURCE, "decks")


def bar(name, law, loads, strat, checks, start=1000.0, nodes=(0.0, 10.0), divisions="5 1. 1 1."):
    """A bar of heat alone, 10 long and 2 wide, with probes t0 t1 ... of its temperature at places along it."""
    probes = "".join(f"PROBE t{k} NODE T {x!r} 0.\n" for k, x in enumerate(nodes))
    return checks.run(name, deck("PLSTN", "SMALL", f"BLOCK b PL8TM 4 h BILINEAR\n 0. 0. 10. 0. 10. 2. 0. 2.\n {divisions}\n",
                                 law, f"START T {start!r}\n{loads}{probes}", strat))


def beyond(run, low, high):
    """How far any probe leaves low and high, over their difference; and the imbalance of heat."""
    values = np.concatenate([column for name, column in run.history.items() if name[0] == "t" and name[1:].isdigit()])
    return max(0.0, low - values.min(), values.max() - high)/(high - low) + abs(run.history["heat_imbalance"]).max()


def water_quench(checks):
    """Biot 1 000 on five elements, from steps of a millionth to a thousand times what heat needs: no temperature beyond the bounds."""
    return max(beyond(bar(f"biot-{k}", "LAW h HEAT\n 30. 4.\n", "CONVE b 2 H 3000. TS 20.\n", f"STRAT {dt} {dt*1e-3} {dt} 5 3\nSTOP {8*dt}\n",
                          checks, nodes=(0.0, 2.0, 4.0, 6.0, 8.0, 10.0)), 20, 1000)
               for k, dt in enumerate((1e-5, 1e-2, 1.0, 1e4)))


def narrow_latent_heat(checks):
    """Freezing over half a kelvin, at steps from short to one for all: heat is kept, and temperatures stay within bounds."""
    law = "LAW h HEATH\n TEMP 0.\n 30. 0.\n TEMP 600.\n 30. 2400.\n TEMP 600.5\n 30. 3600.\n TEMP 1000.\n 30. 5200.\n"
    return max(beyond(bar(f"latent-{k}", law, "CONVE b 2 H 3. TS 20.\n", f"STRAT {dt} {dt*1e-6} {dt} 5 3\nSTOP {stop}\n",
                          checks, nodes=(0.0, 2.0, 4.0, 6.0, 8.0, 10.0)), 20, 1000)
               for k, (dt, stop) in enumerate(((0.02, 2.0), (0.5, 20.0), (50.0, 500.0))))


def radiation_to_nothing(checks):
    """A white-hot bar in space, steps a thousand times too long for the explicit rate: monotone, never below absolute zero."""
    run = bar("radiation", "LAW h HEAT\n 30. 4.\n", "RADIA b 2 EPS 1. SIGMA 5.67E-11 ZERO 0. TS 0.\n", "STRAT 1.E4 1. 1.E5 5 3\nSTOP 1.E6\n",
              checks, start=3000.0)
    rises = max(0.0, np.diff(run.history["t1"]).max())/3000
    return max(beyond(run, 0, 3000), rises)


def unlike_conductors(checks):
    """Two joined walls, one conducting a hundred million times better: the flow is that of the other one alone."""
    run = checks.run("conductors", deck(
        "PLSTN", "SMALL", "BLOCK b PL8TM 4 h BILINEAR\n 0. 0. 5. 0. 5. 2. 0. 2.\n 4 1. 1 1.\nBLOCK c PL8TM 4 g BILINEAR\n 5. 0. 10. 0. 10. 2. 5. 2.\n"
        " 4 1. 1 1.\nJOIN b 2 c 4\n", "LAW h HEAT\n 1.E-6 1.\nLAW g HEAT\n 100. 1.\n",
        "START T 0.\nIMPOS b 4 T one 100.\nIMPOS c 2 T one 0.\nLIC one\n 0. 1.\nPROBE t0 NODE T 5. 0.\nPROBE t1 NODE T 2.5 0.\n",
        "STRAT 1.E12 1. 1.E12 5 3\nSTOP 1.E13\n"))
    return max(abs(run.history["t0"][-1]/1e-6 - 1)*1e-6, abs(run.history["t1"][-1]/50 - 1))


def moving_source(checks):
    """A source that passes an element in less than a step: all of its heat comes in, wherever the steps fall."""
    law = "LAW h HEAT\n 30. 4.\n"
    heats = []
    for k, dt in enumerate((0.01, 0.2, 1.0)):
        run = bar(f"source-{k}", law, "LIC on\n 0. 0. 0.1 1. 0.3 1. 0.4 0. 2. 0.\nFLUX b 3 Q 5. on\n", f"STRAT {dt} {dt*1e-3} {dt} 5 3\nSTOP 2.\n", checks,
                  start=20.0)
        heats.append(run.history["heat_in"][-1])
    return max(abs(heat/(5*10*0.3) - 1) for heat in heats)


def thermal_shock(checks):
    """A fixed plate chilled on one side within a step: stresses of the surface are those of full restraint, and none of the section."""
    run = checks.run("shock", deck(
        "GPLSTN", "SMALL", "SECTN E FREE\nSECTN KX HELD\nSECTN KY HELD\nBLOCK b PL8LS 9 m\n 0. 0. 10. 0. 10. 1. 0. 1.\n 20 0.02 1 1.\nADDEL b PL8TM h\n",
        "LAW m ELATH\n 200000. 0.3 1.E-5\nLAW h HEAT\n 30. 4.\n",
        "START T 600.\nIMPOS b 2 T cold\nLIC cold\n 0. 600. 1.E-4 20. 1. 20.\nFIXED b 1 Y\nFIXED b 3 Y\nFIXED b 4 X\n"
        "PROBE s POINT stress_yy 10. 0.5\nPROBE c POINT stress_yy 0. 0.5\nPROBE t NODE T 10. 0.\n", "STRAT 1.E-4 1.E-6 1.E-3 5 3"))
    restrained = 200000*1e-5*580
    return max(0.0, run.history["s"].max()/(restrained/(1 - 0.3)) - 1, abs(run.history["t"][-1] - 20)/580)


def martensite_burst(checks):
    """Martensite under load, in steps up to fifty times as long: fractions as before to 1e-3, transformation plasticity to 2e-3."""
    answers = []
    for steps in (1000, 50, 20):
        text = f"""TITLE burst
KINEM LOG
LAW steel ARBTHMET
 STEEL {STEELS}/quench_bar_trip/hardening.met hardening
 STRESS 1. TIME 1. TRIP 1.
PATH steel T 850.
 1. 10 S 0. S 30. S 0. S 0. T 840.
 41. {steps} S 0. S 30. S 0. S 0. T 20.
"""
        table = checks.point(f"burst-{steps}", text + "END\n")
        answers.append((table["martensite"][-1], table["strain_yy"][-1] - table["strain_xx"][-1]))
    z, e = zip(*answers)
    return max(max(abs(v - z[0]) for v in z), max(abs(v/e[0] - 1) for v in e)/2)


def quench_by_long_steps(checks):
    """A bar of steel quenched with steps ten times as long as the kinetics ask for: fractions of all phases sum to one, no cold spot."""
    law = f"LAW h META\n STEEL {STEELS}/steels/16mnd5.met '16MND5'\n ENERGY 1.\n"
    worst = 0.0
    for k, dt in enumerate((0.5, 5.0)):
        run = bar(f"steel-{k}", law, "CONVE b 2 H 1. TS 20.\nPROBE m MEAN martensite b\nPROBE f MEAN bainite b\nPROBE a MEAN austenite b\n"
                  "PROBE p MEAN ferrite b\nPROBE q MEAN pearlite b\n", f"STRAT 0.1 1.E-5 {dt} 6 3\nSTOP 200.\nNORMS FORCE 1.E-9\n", checks, start=900.0)
        total = sum(run.history[name] for name in "mfapq")
        worst = max(worst, abs(total - 1).max(), beyond(run, 20, 900))
    return worst


def hardly_cooled(checks):
    """Biot 3e-5: the bar cools as one lump, by the steps of implicit Euler."""
    run = bar("lump", "LAW h HEAT\n 30. 4.\n", "CONVE b 2 H 1.E-4 TS 20.\n", "STRAT 1.E4 1. 1.E4 5 3\nSTOP 4.E5\n", checks)
    lump = 20 + 980*(1 + 1e4/4e5)**-40
    return max(abs(run.history[name][-1] - lump) for name in ("t0", "t1"))/980


def steady_in_one_step(checks):
    """A wall held hot on one side and cooled on the other, in one step of a million million seconds: the straight line."""
    run = bar("steady", "LAW h HEAT\n 30. 4.\n", "IMPOS b 4 T one 500.\nLIC one\n 0. 1.\nCONVE b 2 H 6. TS 20.\n", "STRAT 1.E12 1. 1.E12 5 3\nSTOP 1.E12\n", checks,
              nodes=(0.0, 4.0, 10.0))
    flow = 480/(10/30 + 1/6)
    return max(abs(run.history["t1"][-1] - (500 - flow*4/30)), abs(run.history["t2"][-1] - (20 + flow/6)))/480


def heated_by_flux(checks):
    """Heat that comes in by a flux, at steps from short to one for all: what is stored is what came in, to round-off."""
    worst = 0.0
    for k, dt in enumerate((0.1, 3.0, 40.0)):
        run = bar(f"flux-{k}", "LAW h HEAT\n 30. 4.\n", "FLUX b 2 Q 7. go\nLIC go\n 0. 0. 10. 1. 40. 1.\n", f"STRAT {dt} 1.E-3 {dt} 5 3\n", checks)
        worst = max(worst, abs(run.history["heat_stored"][-1]/run.history["heat_in"][-1] - 1))
        # the ramp is met by its end: at most half a step of it too much
        worst = max(worst, float(abs(run.history["heat_in"][-1]) < 7*2*35 - 1e-6))
    return worst


def two_orders_of_nodes(checks):
    """The steady state by temperatures at corners and at all eight nodes: the same line."""
    ends = []
    for name, option in (("corners", " BILINEAR"), ("eight", "")):
        run = checks.run(name, deck("PLSTN", "SMALL", f"BLOCK b PL8TM 4 h{option}\n 0. 0. 10. 0. 10. 2. 0. 2.\n 4 1. 1 1.\n", "LAW h HEAT\n 30. 4.\n",
                                    "START T 20.\nIMPOS b 4 T one 500.\nLIC one\n 0. 1.\nCONVE b 2 H 6. TS 20.\nPROBE a NODE T 5. 0.\nPROBE z NODE T 10. 0.\n",
                                    "STRAT 1.E12 1. 1.E12 5 3\nSTOP 1.E12\n"))
        ends.append([run.history[c][-1] for c in "az"])
    return max(abs(a/b - 1) for a, b in zip(*ends))


CASES = (
    Case("water quench, Biot 1 000", water_quench, 1e-6), Case("narrow latent heat", narrow_latent_heat, 1e-6),
    Case("radiation to nothing", radiation_to_nothing, 1e-6), Case("conductors 1e8 apart", unlike_conductors, 1e-6),
    Case("burst of heat", moving_source, 1e-9), Case("thermal shock", thermal_shock, 1e-3),
    Case("martensite burst under load", martensite_burst, 1e-3), Case("steel in long steps", quench_by_long_steps, 1e-6),
    Case("hardly cooled, Biot 3e-5", hardly_cooled, 1e-4), Case("steady in one step", steady_in_one_step, 1e-9),
    Case("heated by a flux", heated_by_flux, 1e-9), Case("corners or eight nodes", two_orders_of_nodes, 1e-9))
