"""An augmented penalty a hundred times softer than the automatic one gives the stiff answer: penetrations within the
bound, pressures of closed forms, after cutbacks to the last bit; steps that miss the bound are told. With friction the
elastic slip goes, too."""
import h5py
import numpy

from harness import Check, arguments, run, SCENES

args = arguments(("cases", "few: quick ones", ("few", "all", "friction")))
check = Check()
BOUND = 1e-6
RUNS = SCENES.parent.parent / "runs"
BLOCK, RINGS = SCENES / "contact_patch.yaml", RUNS / "ring_in_ring.yaml"
PLANE = ("contact.0.master={plane: {point: [0, 1, 0], normal: [0, 1, 0]}}",
         "probes=[{name: pressure, pressure_mean: joint}, {name: noise, pressure_deviation: joint, measure: max}]")


def penalty(keys="", scale=0.01):
    return f"contact.0.penalty={{initial: auto, scale: {scale}, augment: true, g_max: {BOUND}, unit: length{keys}}}"


def flat_block(formulation):
    """Pressed on a rigid plane the penetration is the pressure over the penalty; one update takes it to nothing."""
    common = (*PLANE, f"contact.0.formulation={formulation}")
    deep = ("contact.0.penalty.scale=0.01", "certificate.penetration=10")  # deeper than what can be certified by itself
    soft = run(args, BLOCK, out=f"soft_{formulation}", overrides=(*common, *deep)).steps()[-1]
    result = run(args, BLOCK, out=f"block_{formulation}", overrides=(*common, penalty()))
    state, figures = result.steps()[-1], result.summary()
    check.near(f"block, {formulation}: soft penetration", soft["max_penetration"], 10 / soft["penalty_max"], 1e-6 * 0.5)
    check.near(f"block, {formulation}: augmented", (state["max_penetration"], state["min_penetration"]), 0, BOUND)
    check.near(f"block, {formulation}: pressure", figures["probes"]["pressure"], 10, 1e-6)
    check.near(f"block, {formulation}: noise, %", figures["probes"]["noise"], 0, 1e-5)
    check.holds(f"block, {formulation}: one update, the same penalty",
                figures["contact"][0]["penalty"]["augmented"] == 1 and state["penalty_max"] == soft["penalty_max"],
                str(figures["contact"][0]["penalty"]))


def few_updates():
    """Node to surface on nodes that do not match moves the forces from node to node, which soft penalties follow
    slowly."""
    result = run(args, BLOCK, out="few", overrides=(penalty(", max_updates: 1"),))
    figures = result.summary()["contact"][0]["penalty"]
    check.holds(
        "few updates: counted", figures["missed"] == 1 and figures["augmented"] == 1 and figures["outside_window"] > 0
        and figures["largest_excess"] > 1, str(figures))
    check.holds(
        "few updates: told", "beyond g_max after all updates: 1" in result.text
        and "advice   joint: 1 of 1 steps ended with nodes beyond g_max" in result.text)
    check.holds("few updates: in steps.csv", result.steps()[-1]["outside_window"] == figures["outside_window"])


def lifted_off():
    """Pressed, lifted off and pressed again: no multiplier pushes what has left, and the next touch starts from
    nothing."""
    away = ("loads=[{surface: upper_top, uy: -0.001, history: [[0, 0], [0.25, 1], [0.5, -1], [1, 1]]}]",
            "stepping.initial=0.25", *PLANE)
    first, lifted, *_, last = run(args, BLOCK, out="lifted", overrides=(*away, penalty())).steps()
    check.holds("lifted off: no force", lifted["t"] == 0.5 and lifted["contact_nodes"] == 0
                and lifted["contact_force"] == 0)
    check.near("pressed again: force", last["contact_force"], first["contact_force"], 1e-6 * first["contact_force"])
    check.holds("pressed again: within the bound", last["max_penetration"] <= BOUND and last["outside_window"] == 0)


def rings(formulation, overlap):
    """Shrunk into each other: Lame's mean pressure, and less noise than with a stiff penalty."""
    common = ("mesh.parameters={n_inner: 24, n_outer: 30, jitter: 0}", f"contact.0.formulation={formulation}",
              f"contact.0.initial_overlap={overlap}", "stepping.initial=0.5")
    stiff = run(args, RINGS, out=f"stiff_{formulation}_{overlap}", overrides=common).summary()["probes"]
    result = run(args, RINGS, out=f"rings_{formulation}_{overlap}", overrides=(*common, penalty()))
    probes = result.summary()["probes"]
    check.near(f"rings, {formulation}, {overlap}: mean pressure", probes["mean_pressure"], 6.439, 1e-3 * 6.439)
    check.holds(f"rings, {formulation}, {overlap}: within the bound",
                all(row["outside_window"] == 0 and row["max_penetration"] <= BOUND for row in result.steps()))
    check.holds(f"rings, {formulation}, {overlap}: noise", probes["noise_max"] <= 0.1 * stiff["noise_max"],
                f"{probes['noise_max']:.3g} %, stiff {stiff['noise_max']:.3g} %")


def cut_back():
    """The same steps, found by cutbacks or given."""
    common = ("loads=[{surface: upper_top, pressure: 150}]", "solver.max_iterations=3", "solver.tolerance=1e-8",
              penalty(", max_updates: 3", 1))
    cut = run(args, BLOCK, out="cut", overrides=(*common, "stepping={control: fixed, initial: 1}"))
    given = run(
        args, BLOCK, out="given",
        overrides=(*common, f"stepping={{control: fixed, initial: 1, at: {[row['t'] for row in cut.steps()]}}}"))
    check.holds("cutbacks: steps failed, the given ones did not",
                cut.summary()["steps_failed"] > 1 and given.summary()["steps_failed"] == 0)
    for name in ("t", "residual", "contact_nodes", "max_penetration", "min_penetration", "outside_window",
                 "contact_force", "force"):
        check.holds(f"cutbacks: {name}", [row[name] for row in cut.steps()] == [row[name] for row in given.steps()])
    check.holds(
        "cutbacks: counts",
        cut.summary()["contact"] == given.summary()["contact"]
        and given.summary()["contact"][0]["penalty"]["augmented"] > 3)
    differ = []
    with h5py.File(cut.directory / "results.h5") as a, h5py.File(given.directory / "results.h5") as b:
        a.visititems(lambda name, item: differ.append(name) if isinstance(item, h5py.Dataset) and not numpy.array_equal(
            item[()], b[name][()], equal_nan=item.dtype.kind == "f") else None)
    check.holds("cutbacks: every field of every step", not differ, " ".join(differ))


def sheared():
    """Sheared blocks that stick: the first update takes 30 to 200 times from the elastic slip; later ones find tractions
    that neighbours hand on to each other, which hardly move a body, and still halve it. The forces stay."""
    for scene, name in ((RUNS / "friction/shear_plane.yaml", "plane"), (SCENES / "shear.yaml", "solid")):
        for formulation in ("surface_to_surface", "node_to_surface") if name == "plane" else ("surface_to_surface",):
            slips = []
            for updates in range(4 if name == "plane" else 2):
                keys = f", augment: true, g_max: 1e-15, unit: length, max_updates: {updates}" if updates else ""
                finished = run(args, scene, out=f"shear_{name}_{formulation}_{updates}", overrides=[
                    f"contact.0.formulation={formulation}", f"contact.0.penalty={{scale: 10{keys}}}",
                    "solver.tolerance=1e-11", "probes=[{name: force_x, contact_force: joint, component: x}]"
                ])
                figures = finished.summary()
                slips.append(figures["contact"][0]["friction"]["elastic_slip"])
                check.near(f"sheared {name}, {formulation}, {updates} updates: force", figures["probes"]["force_x"],
                           0.2, 1e-8)
            check.holds(f"sheared {name}, {formulation}: elastic slip falls", slips[1] < slips[0] / 10 and all(
                after < before / 1.4 for before, after in zip(slips[1:], slips[2:])), " ".join(f"{s:.3g}" for s in slips))


def slides():
    """In full slip the force is mu times the load, as without multipliers, and what friction takes does not depend on the
    penalty of what sticks."""
    taken = []
    for stiffness in (1e3, 1e5):
        finished = run(args, RUNS / "slide_flat.yaml", out=f"slides_{stiffness:g}", overrides=[
            "contact.0.friction.mu=0.3", f"contact.0.friction.stick.penalty={stiffness}", "stepping.initial=0.1",
            f"contact.0.penalty={{scale: 1, augment: true, g_max: {BOUND}, unit: length}}"
        ])
        figures = finished.summary()
        friction = figures["contact"][0]["friction"]
        check.near(f"slides, {stiffness:g}: force", figures["probes"]["force_x"], 0.3 * 160, 1e-5)
        check.holds(f"slides, {stiffness:g}: all slip", friction["sticking"] == 0)
        taken.append(friction["dissipated"])
    check.near("slides: energy taken with either penalty", taken[0], taken[1], 1e-6 * taken[1])


def pulled():
    """A bar on its bed is pulled and let go: it sticks in part, slips, and slips back. Exact: u = F^2/(2 E A mu p b), and
    half of it is left. A soft penalty of what sticks leaves several times the mesh's error there, multipliers do not."""
    errors = []
    for keys in ("", "augment: true, g_max: 1e-6, unit: length, max_updates: 30"):
        finished = run(args, SCENES / "bar.yaml", out=f"pulled_{bool(keys)}", overrides=[
            "contact.0.friction.stick.penalty=1000", f"contact.0.penalty={{scale: 1, {keys}}}"
        ])
        errors.append(abs(finished.summary()["probes"]["end"] / (2**2 / (4 * 1000 * 0.3)) - 1))
    check.near("pulled: end after release", errors[1], 0, 0.01)
    check.holds("pulled: multipliers lower its error", errors[1] < errors[0] / 4, f"{errors[0]:.3g} {errors[1]:.3g}")


if args.cases == "friction":
    sheared()
    slides()
    pulled()
    check.finish()
few_updates()
if args.cases == "few":
    rings("surface_to_surface", "ramp")
else:
    flat_block("node_to_surface")
    flat_block("surface_to_surface")
    lifted_off()
    for choice in ("node_to_surface", "resolve"), ("surface_to_surface", "ramp"):
        rings(*choice)
    if args.ranks == 1:
        cut_back()
check.finish()
