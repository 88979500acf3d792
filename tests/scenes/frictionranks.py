"""Benchmarks of scripts/friction_table.py on small meshes and on 1, 2 and 3 ranks: probes, pressures and tractions agree to
1e-8 of the largest, with both formulations, the smooth master and its facets."""
import sys

import numpy

from harness import Check, arguments, run, SCENES

sys.path.insert(0, str(SCENES.parent.parent / "scripts"))
import friction_table

# scene, overrides of a cheap variant, ways of contact
RUNS, PLAIN, BOTH, ALL = friction_table.RUNS, friction_table.PLAIN, friction_table.BOTH, friction_table.ALL
CASES = {
    "wedge": (RUNS / "wedge.yaml", [], ALL),
    "pad": (RUNS / "pad.yaml", [
        "mesh.parameters.angle=30", "supports.0.spring=[0.2, 0.2]",
        "contact.0.master.plane.normal=[-0.5, 0.866025403784439]"
    ], BOTH),
    "bar": (SCENES / "bar.yaml", [], BOTH),
    "shear_plane": (RUNS / "shear_plane.yaml", ["mesh.parameters.jitter=0.25"], ALL),
    "shear": (SCENES / "shear.yaml", ["mesh.parameters.jitter=0.25"], ALL),
    "rings": (RUNS / "press_fit.yaml", ["mesh.parameters.jitter=0.25", "stepping.initial=0.5"], ALL),
    "belt": (SCENES / "belt.yaml", ["mesh.parameters.n=24"], BOTH),
    "mindlin_line": (RUNS / "mindlin_line.yaml", ["mesh.parameters.n=4", "stepping.initial=0.1"], ALL),
    "mindlin_sphere": (RUNS / "mindlin_sphere.yaml", ["mesh.parameters.n=2"], BOTH),
    "mindlin_loop": (RUNS / "mindlin_loop.yaml", ["mesh.parameters.n=2"], PLAIN),
    "shallow_ironing": (RUNS / "shallow_ironing.yaml", [
        "mesh.parameters.n=2", "loads.1.ux=3", "stepping={control: fixed, initial: 0.05}"
    ], PLAIN),
    "plate_greco": (RUNS / "plate_greco.yaml", [
        "mesh.parameters={n: 12, m: 12}", "probes=[{name: u_0, displacement: [0, 0], component: x}]"
    ], BOTH),
    "punch_rounded": (RUNS / "punch_rounded.yaml", ["mesh.parameters.h=4", "solver.tolerance=1e-11"], ALL),
    "twisted_hemisphere": (RUNS / "twisted_hemisphere.yaml", [
        "mesh.parameters={n: 2, n_side: 2, n_wall: 1, m: 4, m_depth: 3}", "loads.0.uz=-0.6*min(1,t/0.25)",
        "stepping.initial=0.125", "stepping.at=[0.25]", "contact.0.friction.stick={}", "contact.0.penalty={}"
    ], PLAIN),
    "die": (SCENES / "die.yaml", ["stepping.initial=0.125"], ALL),
}
TOLERANCE = 1e-8

args = arguments(("case", "benchmark", tuple(CASES)))
check = Check()
scene, overrides, ways = CASES[args.case]
for formulation, smoother in ways:
    runs = {
        n: run(args, scene, out=f"{formulation}_{smoother}_{n}", ranks=n, overrides=[
            *overrides, f"contact.0.formulation={formulation}", f"contact.0.smoother={smoother}"
        ])
        for n in (1, 2, 3)
    }
    one = runs[1].fields()
    contact = [name for name in one if name.startswith("contact/") and name.endswith(("pressure", "traction"))]
    for n in (2, 3):
        what = f"{formulation}, {smoother}, {n} ranks"
        for name, value in runs[1].summary()["probes"].items():
            check.near(f"{what}: {name}", runs[n].summary()["probes"][name], value, TOLERANCE * abs(value))
        fields = runs[n].fields()
        for name in contact:
            check.near(f"{what}: {name}", fields[name], one[name], TOLERANCE * numpy.abs(one[name]).max())
check.finish()
