"""Bodies that fold until they touch themselves, at default settings: a flattened tube, a ring that is crumpled in a
channel, a column that is twisted and shortened. All end certified."""
from harness import SCENES, Check, arguments, run

FOLDING = SCENES.parent.parent / "runs" / "folding"
TOUCH = {"flattened_tube": True, "crumpled_ring": True, "twisted_column": False}  # does it touch itself at the end?

args = arguments(("case", "scene", list(TOUCH)))
check = Check()
finished = run(args, FOLDING / f"{args.case}.yaml", must=None)
check.holds("done", finished.status == 0, finished.text[-300:] if finished.status else "")
check.holds("certified", "certified: nothing passed through anything unseen" in finished.text)
if TOUCH[args.case]:
    nodes = next(pair for pair in finished.summary()["contact"] if pair["name"].startswith("fold"))
    check.holds("it touches itself", finished.steps()[-1]["contact_nodes"] > 0 and nodes, str(nodes)[:200])
check.finish()
