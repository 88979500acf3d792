"""Bodies that fold until they touch themselves, at default settings: a flattened tube, a ring that is crumpled in a
channel, a column that is twisted and shortened, a bellows whose folds meet at sharp corners, a spiral spring that is
wound. All end certified."""
from harness import SCENES, Check, arguments, run

FOLDING = SCENES.parent.parent / "runs" / "folding"
# does it touch itself at the end?
TOUCH = {"flattened_tube": True, "crumpled_ring": True, "twisted_column": False, "bellows": True,
         "spiral_spring": False}

args = arguments(("case", "scene", list(TOUCH)))
check = Check()
finished = run(args, FOLDING / f"{args.case}.yaml", must=None)
check.holds("done", finished.status == 0, finished.text[-300:] if finished.status else "")
check.holds("certified", "certified: nothing passed through anything unseen" in finished.text)
if TOUCH[args.case]:
    nodes = next(pair for pair in finished.summary()["contact"] if pair["name"].startswith("fold"))
    check.holds("it touches itself", finished.steps()[-1]["contact_nodes"] > 0 and nodes, str(nodes)[:200])
if args.case == "flattened_tube":
    # a step in which the ends of the fold would turn past each other is shortened before it is tried
    check.holds("no step fails", finished.summary()["steps_failed"] == 0, str(finished.summary()["steps_failed"]))
if args.case == "bellows":
    check.holds("few faces between sharp corners: the error line says what it leaves out",
                "not in it: the shape of the surfaces" in finished.text)
check.finish()
