"""The main scene as it stands: t = 1 without a failed step, plate force within 1 % of the reference, and what its run
shows of the parts it is made of."""
import re

import h5py

from harness import Check, arguments, run, SCENES

REFERENCE = {0.5: 52390, 1: 123920}  # N, another code's meshes, elements and penalties extrapolated
FIELDS = ("displacement", "stress", "von_mises", "contact/crown/gap", "contact/crown/penetration",
          "contact/crown/penalty", "contact/crown/pressure", "contact/crown/normal")

args = arguments()
finished = run(args, SCENES.parent.parent / "runs" / "pipe_pinch.yaml", "-snes_monitor", "-snes_view", "-mesh_dm_view",
               "-log_view")
check = Check()
rows = {round(row["t"], 9): row for row in finished.steps()}
for t, force in REFERENCE.items():
    check.near(f"plate force at t = {t}", rows[t]["plate_force"], force, 0.01 * force)
check.holds("20 steps, none failed", finished.summary()["steps"] == 20 and finished.summary()["steps_failed"] == 0)
text = finished.text
check.holds("a DMPlex on these ranks",
            re.search(rf"DM Object: mesh.*{args.ranks} MPI process", text) and re.search(r"type: plex", text))
check.holds("newtonls with the model's line search", re.search(r"type: newtonls", text)
            and re.search(r"SNESLineSearch Object.*\n *type: shell", text))
check.holds("MUMPS", re.search(r"PC Object.*\n *type: shell\n.*mumps", text))
for event in ("ContactSearch", "ContactProject", "ContactResidual", "ContactTangent", "ElasticResidual",
              "ElasticTangent", "SNESFunctionEval", "SNESJacobianEval"):
    check.holds(f"log event {event}", re.search(rf"^{event} ", text, re.MULTILINE))
if args.ranks > 1:
    partition = finished.summary()["partition"]
    check.holds("partition by metis with its edge cut", partition["tool"] == "metis" and partition["edge_cut"] >= 0,
                str(partition))
with h5py.File(finished.directory / "results.h5", "r") as file:
    for field in FIELDS:
        check.holds(f"results.h5 has {field}", all(field in step for step in file["steps"].values()))
check.finish()
