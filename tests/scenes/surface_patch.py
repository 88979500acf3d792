"""Surface to surface passes the contact patch test in 3D: on bricks of either order with jittered interface nodes the
pressure of every slave node is the load within 2 %, the mean over a patch within 0.2 %, the mean stress of every element
next to the interface within 1 %, in small and finite strain."""
import sys

from harness import Check, arguments, run, SCENES

ROOT = SCENES.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import patch_table  # noqa: E402

PRESSURE, STRESS, PATCH_MEAN = 2, 1, 0.2  # per cent
COARSE_STRESS = 3  # where a slave face spans two of the master's
PATCH = "probes.3={name: patch, pressure_mean: joint, at: [0.5, 0, 0.5], within: 0.3}"

args = arguments(("strain", "kinematics", patch_table.STRAINS), ("order", "of the elements", ["1", "2"]),
                 ("pair", "faces per side, master-slave"), ("jitter", "in face sizes", ["0", "0.125", "0.25"]))
pair = [int(n) for n in args.pair.split("-")]
case = (args.strain, "bricks", int(args.order), pair, args.jitter, "surface_to_surface", "pair")
finished = run(args, ROOT / "runs/patch_blocks.yaml", overrides=[*patch_table.overrides(*case), PATCH])
load, figures = patch_table.STRAINS[args.strain][0], patch_table.deviations(finished.directory, args.strain)
check = Check()
check.near("contact force over load", finished.summary()["probes"]["force"] / load, 1, 1e-8)
check.near("mean pressure of a patch over load", finished.summary()["probes"]["patch"] / load, 1, PATCH_MEAN / 100)
check.near("pressure, per cent", figures["pressure_max"], 0, PRESSURE)
for side in ("master", "slave"):
    check.near(f"stress next to the interface, {side}, per cent", figures["stress_" + side], 0,
               COARSE_STRESS if pair[0] >= 2 * pair[1] else STRESS)
print("     " + ", ".join(f"{name} {value:.2f}" for name, value in figures.items()))
check.finish()
