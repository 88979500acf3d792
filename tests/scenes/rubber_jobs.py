"""Rubber that keeps its volume takes about as many steps as rubber that does not. A load that bends elements far in one
step is predicted in pieces; the pressures of the states between them, which are not in equilibrium, must not get into
the tangent. A search that judges steps by the energy of volumes that yield alone fails in steps where rubber snaps
over an edge."""
from harness import Check, arguments, run, SCENES

RATIOS = (0.45, 0.499)
MORE = 1.5  # times the steps of the lower ratio
# With the pressures of these states the first takes 7 steps, 1 failed, the second 8, 2 failed.
JOBS = ["bush_bonded", "tube_flattened"]
# With that search the first takes 10 steps, 1 failed, instead of 6, the second 8, 2 failed, instead of 5.
SNAPS = ["lip_inverted", "plug_orifice"]
# With the tangent of an extrapolated state as it is, whose volume is off, these take 14 steps, 2 failed, instead of 6.
RINGS = {"stacked_rings": (0, 1, 2)}
# Where lists that do not reach the end of the first linear step stand for imbalance: 10 steps, 2 failed, instead of 7.
DRAWN = {"sheet_over_edge": (1, )}

args = arguments(("cases", "jobs in which nothing snaps, or others too", ("few", "all")))
check = Check()
first = dict.fromkeys(JOBS, (0, )) | RINGS
others = dict.fromkeys(SNAPS, (0, )) | DRAWN
for job, bodies in (first | (others if args.cases == "all" else {})).items():
    low, high = (run(args, SCENES.parent / f"jobs/{job}.yaml", out=f"{job}_{nu}",
                     overrides=(*(f"bodies.{i}.material.nu={nu}" for i in bodies), "output.every=0")).summary()
                 for nu in RATIOS)
    check.holds(f"{job}: steps", high["steps"] <= MORE * low["steps"], f"{high['steps']} instead of {low['steps']}")
    check.holds(f"{job}: no failed steps", high["steps_failed"] == 0, str(high["steps_failed"]))
if args.cases == "all":
    # Pressures of volumes that are exact go back with a step that did not pay; else it takes 102 steps, 8 failed.
    exact = run(args, SCENES.parent / "jobs/tube_on_barb.yaml", out="tube_on_barb_0.5",
                overrides=("bodies.0.material.nu=0.5", "output.every=0")).summary()
    check.holds("tube_on_barb at nu 0.5: steps", exact["steps"] <= 8 and exact["steps_failed"] == 0,
                f"{exact['steps']}, {exact['steps_failed']} failed")
check.finish()
