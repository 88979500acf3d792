"""Runs judge their steps by default: a needle in a film and beams that cross edge on edge are refused with node, edge
and place, on any number of ranks. Cubes that overhang each other are not, nor is a coarse plate where it rises beside
the flat of a punch that it resists. A step in which a peg goes past a strip that it should have pushed aside is
refused; shaft and sleeve that turn beside a ring with little play are not. Outer forces and moments balance. What the
work from outside misses of all energies falls with the square of the step, with self contact and with friction."""
import re

from harness import Check, arguments, run, SCENES

BALANCE = 1e-12  # of the outer forces
RULE = (3, 5)  # by which the error of the trapezoidal rule falls with steps of half the length
ARMS = 1e-3  # of their moments: surfaces that press stand a little in each other

args = arguments(("case", "needle, beams, punch, past, blocks or energy"))
check = Check()
if args.case == "needle":
    film = run(args, SCENES / "film.yaml", out="film", must=2)
    check.holds("the needle is named", re.search(r"cannot be certified; contact 'prick': node \d+ ", film.text))
    chosen = run(args, SCENES / "film.yaml", out="chosen", overrides=["contact.0.roles=auto"])
    check.holds("with the roles of a run's own choice it is held", chosen.status == 0 and chosen.summary()["certified"],
                chosen.text[-200:])
    swapped = run(args, SCENES / "film.yaml", out="swapped", must=2,
                  overrides=["contact.0.slave=flanks", "contact.0.master=top", "contact.0.penalty.scale=1e-3"])
    check.holds("so is one that the film does not resist", "cannot be certified" in swapped.text)
elif args.case == "beams":
    for gap in (0.1, 0.5):
        beams = run(args, SCENES / "crossed_beams.yaml", out=f"beams{gap}", must=2,
                    overrides=[f"mesh.parameters.gap={gap}", "stepping={control: fixed, initial: 0.5, dt_min: 0.2}"])
        check.holds(f"gap {gap}: the edges are named", re.search(r"the edge of the nodes \d+ and \d+ ", beams.text))
elif args.case == "punch":
    plate = run(args, SCENES / "plate_under_punch.yaml", out="plate").summary()
    check.holds("a face that rises beside the punch's flat is explained",
                plate["certified"] is True and plate["steps_failed"] == 0, str(plate["certificate"]))
    soft = run(args, SCENES / "plate_under_punch.yaml", out="soft", must=2,
               overrides=["contact.0.penalty={initial: 0.1, scale: 1e-3}"])
    check.holds("a punch that the plate does not resist is refused there", "cannot be certified" in soft.text)
elif args.case == "past":
    cylinder = "{cylinder: {point: [21.5, 8], radius: 2, motion: [{uy: -16}]}}"
    for name, overrides in (("meshed", []), ("analytic", [f"contact.0.master={cylinder}"])):
        peg = run(args, SCENES / "strip_past_peg.yaml", out=name, overrides=overrides).summary()
        check.holds(f"{name} peg: it rubs on the strip", peg["certificate"]["dissipated_by_friction"] > 0)
        leap = run(args, SCENES / "strip_past_peg.yaml", out=f"{name}_leap", must=2, overrides=[
            *overrides, "stepping={control: fixed, initial: 1, dt_min: 1}"])
        check.holds(f"{name} peg: a step past the strip is refused", "passed through without contact" in leap.text)
    turning = run(args, SCENES / "turning_sleeve.yaml", out="turning",
                  overrides=["stepping={control: fixed, initial: 0.5, dt_min: 0.5}"]).summary()
    check.holds("turns of 60 degrees are explained", turning["certified"] and turning["steps_failed"] == 0,
                str(turning["certificate"]))
elif args.case == "energy":
    folding, jobs = SCENES.parent.parent / "runs/folding", SCENES.parent / "jobs"
    for scene in (folding / "bellows.yaml", jobs / "rope_on_bollard.yaml"):
        judged = [run(args, scene, out=f"{scene.stem}_{steps}", overrides=[
            f"stepping={{control: fixed, initial: {1 / steps}}}"]).summary()["certificate"] for steps in (10, 20)]
        ratio = judged[0]["energy_apart"] / judged[1]["energy_apart"]
        check.holds(f"{scene.stem}: energies come together", RULE[0] < ratio < RULE[1], f"{ratio:.2f}")
        check.near(f"{scene.stem}: work from outside", judged[1]["energy_apart"], 0, 1e-3)
        check.near(f"{scene.stem}: no step gives back what was dissipated", judged[1]["least_dissipation"], 0, 1e-12)
else:
    summary = run(args, SCENES / "offset_blocks.yaml", out="blocks").summary()
    certificate = summary["certificate"]
    check.holds("certified", summary["certified"] is True, str(certificate))
    check.holds("forces balance", certificate["force_balance"] < BALANCE, str(certificate["force_balance"]))
    check.holds("moments balance", certificate["moment_balance"] < ARMS, str(certificate["moment_balance"]))
check.finish()
