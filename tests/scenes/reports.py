"""-check says the same on 1, 2 and 3 ranks, overlaps before they are refused; the last screen has the figures of
summary.json, and after a failure cause, place and what to try."""
import re

from harness import Check, arguments, run, SCENES

RUNS = SCENES.parent.parent / "runs"
args = arguments(("cases", "all of them, or a few", ("all", "few")))
EVERY = args.cases == "all"
check = Check()


def told(text):
    """What depends on the machine or the ranks left out."""
    return [
        line for line in re.sub(r"^cost .*(?:\n {9}.*)*", "", text, flags=re.MULTILINE).splitlines()
        if not line.startswith("parts")
    ]


def line(text, head):
    return (re.search(rf"^{head} .*$", text, re.MULTILINE) or [""])[0]


def numbers(text):
    return [float(number) for number in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", text)]


# 1. Before: the same text on any number of ranks, and a cost on each.
for scene, overrides in (("ring_in_ring", ["mesh.parameters={n_inner: 12, n_outer: 15}"]), ("slide_cylinder", []),
                         ("cup_flattening", []), ("ring_in_ring_3d", [
                             "mesh.parameters={n_inner: 8, n_outer: 10, n_len: 3, jitter: 0.25}",
                             "contact.0.formulation=surface_to_surface"
                         ])):
    if not EVERY and scene != "ring_in_ring":
        continue
    texts = [
        run(args, RUNS / f"{scene}.yaml", "-check", out=scene, overrides=overrides, ranks=ranks).text
        for ranks in (1, 2, 3)
    ]
    check.holds(f"{scene}: the same on 1, 2 and 3 ranks", told(texts[0]) == told(texts[1]) == told(texts[2]))
    check.holds(
        f"{scene}: cost",
        all(
            re.search(r"cost     tangent of .*\n +on \d ranks? about \d+ MB.*\n +about \S+ s an iteration", text)
            for text in texts))
deep = run(args, RUNS / "ring_in_ring.yaml", "-check", out="deep",
           overrides=["contact.0.initial_overlap=refuse", "mesh.parameters.interference=0.1"], must=None)
found = re.search(r"overlap: (\d+) nodes, area (\S+); deeper than the facets' own shape explains: (\d+) nodes",
                  deep.text)
check.holds("overlaps are reported, then refused", deep.status == 1 and found and int(found[3]) > 0
            and "before any load; allowed" in deep.text, found and found[0])

# 2. After: the figures of the screen are those of summary.json.
good = run(args, RUNS / "ring_in_ring.yaml", out="good", overrides=["mesh.parameters={n_inner: 12, n_outer: 15}"])
summary = good.summary()
pair = summary["contact"][0]
check.holds(
    "effects and dofs",
    line(good.text.split("\n\n")[-1], "effects") ==
    f"effects  {', '.join(summary['effects'])}; {summary['dofs']} dofs on {summary['ranks']} "
    f"rank{'s' * (summary['ranks'] > 1)}"
)
check.holds(
    "steps",
    numbers(line(good.text, "steps")) == [
        summary[key] for key in ("steps", "steps_failed", "steps_repeated", "newton_iterations", "newton_accepted")
    ])
shown = re.search(
    r"contact  fit: (\d+) nodes, penetration up to (\S+) \((\S+) of a face\) at node .*; facet error (\S+), smoothing "
    r"error (\S+)",
    good.text)
check.holds("contact", shown is not None and int(shown[1]) == pair["nodes"] == summary["contact_nodes"])
for name, digits, text in zip(("max_penetration", "max_penetration_over_h", "facet_error", "smoothing_error"),
                              (3, 2, 2, 2),
                              shown.groups()[1:]):
    check.holds(name, text == f"{pair[name]:.{digits}g}", f"{text}, {pair[name]}")
for word, key in (("set-up", "setup"), ("solver", "solve"), ("output", "output")):
    share = 100 * summary["seconds"][key] / summary["wall_s"]
    check.holds(f"time: {word}", share < 0.5 or f" {word} {share:.0f} %" in line(good.text, "time"),
                line(good.text, "time"))
check.holds("closing line", good.text.rstrip().splitlines()[-1].startswith("done: 1 steps"))
if EVERY:
    check.holds(
        "quiet", "guards" not in run(args, RUNS / "ring_in_ring.yaml", "-quiet", out="quiet",
                                     overrides=["mesh.parameters={n_inner: 12, n_outer: 15}"]).text)
    soft = run(
        args, RUNS / "ring_in_ring.yaml", out="soft",
        overrides=["mesh.parameters={n_inner: 12, n_outer: 15, interference: 0.1}", "contact.0.penalty.scale=0.1"])
    check.holds("a soft penalty is advised against", "advice   fit: penetration leaves" in soft.text
                and "advice" not in good.text, line(soft.text, "advice"))

# 3. After a failure.
stuck = run(args, RUNS / "slide_cylinder.yaml", out="stuck",
            overrides=["solver.max_iterations=1", "stepping={control: fixed, initial: 0.1, dt_min: 0.06, damping: none}"],
            must=2)
summary = stuck.summary()
check.holds(
    "failure: on which way",
    re.search(r"^failed   on the way from t = \S+ to \S+: Newton's method did not converge", stuck.text, re.MULTILINE)
    and summary["status"] == "not converged", line(stuck.text, "failed"))
check.holds("failure: three nodes with their residuals",
            len(re.findall(r"^where    node \d+ \(.*\): residual \S+", stuck.text, re.MULTILINE)) == 3)
check.holds("failure: what was tried, what to try",
            re.search(r"^tried    \d+ times, dt from 0.1 .*\n(.*\n)*?try      \S+", stuck.text, re.MULTILINE) is not None,
            line(stuck.text, "tried"))
held = run(args, RUNS / "slide_flat.yaml", out="held", overrides=["stepping.initial=1"], must=None).text
check.holds("what contact alone holds is said in the first lines",
            "motion   block: translation along y, (0, 1, 0): held by contact only (sole)" in held.split("\n\n")[0])
check.finish()
