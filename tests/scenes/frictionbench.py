"""Benchmarks of scripts/friction_table.py on small meshes: every figure is within what the benchmark asks for."""
import sys

from harness import Check, arguments, run, SCENES

sys.path.insert(0, str(SCENES.parent.parent / "scripts"))
import friction_table

# meshes, and the ways of contact that meet the figures on them
CASES = {
    "wedge": (("mu 0.3", "mu 0.3, analytic slope"), friction_table.BOTH),
    "pad": (("flat", "inclined by 30 degrees"), friction_table.BOTH),
    "mindlin_line": (("16 elements", ), friction_table.PLAIN),
    "shear_plane": (("jitter 0, 12 on 15 faces", "jitter 0.25, 12 on 15 faces", "jitter 0.25, 15 on 12 faces"),
                    friction_table.PLAIN),
    "plate_greco": (("32 elements", ), friction_table.BOTH),
    "punch_rounded": (("mu 0.1, elements of 1", ), friction_table.BOTH),
}

args = arguments(("case", "benchmark", tuple(CASES)))
check = Check()
scene, measure, meshes = friction_table.BENCHMARKS[args.case]
wanted, ways = CASES[args.case]
for mesh, argument, overrides, _ in meshes:
    for formulation, smoother in ways if mesh in wanted else ():
        finished = run(args, scene, out=f"{mesh}_{formulation}".replace(" ", "_").replace(",", ""), overrides=[
            *overrides, f"contact.0.formulation={formulation}", f"contact.0.smoother={smoother}"
        ])
        for figure, _, _, deviation, allowed in measure(friction_table.Result(finished.directory), argument):
            if allowed:
                check.holds(f"{mesh}, {formulation}: {figure}", abs(deviation) <= allowed,
                            f"{deviation:.3g} %, allowed {allowed} %")
        check.holds(f"{mesh}, {formulation}: no failed step", finished.summary()["steps_failed"] == 0)
check.finish()
