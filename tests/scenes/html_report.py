"""scripts/report.py: one HTML page of a run, without links, with its probes, pictures, contact, advice and scene; also of
a run that found no equilibrium; a folder without a run is one message. Where Chromium is here, it shows the page."""
import base64
import html.parser
import pathlib
import re
import shutil
import subprocess
import sys

from harness import SCENES, Check, arguments, run

SCENE = SCENES / "stack.yaml"
EMPTY = ("meta", "img", "br")  # tags without an end
args = arguments()
check = Check()
out = pathlib.Path(args.out).resolve()


class Tags(html.parser.HTMLParser):
    """Whether each tag has its end, and what is linked."""

    def __init__(self):
        super().__init__()
        self.open, self.wrong, self.sources = [], [], []

    def handle_starttag(self, tag, attrs):
        self.sources += [value for name, value in attrs if name in ("src", "href")]
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


def report(directory, *options):
    line = [sys.executable, SCENES.parent.parent / "scripts/report.py", directory, *options, "--burnish", args.burnish]
    return subprocess.run([str(word) for word in line], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def looked_at(name, finished, *options, pictures):
    made = report(finished.directory, *options)
    page = finished.directory / "report.html"
    check.holds(f"{name}: a page", made.returncode == 0 and page.exists(), made.stdout[-500:])
    text, tags = page.read_text(), Tags()
    tags.feed(text)
    check.holds(f"{name}: each tag has its end", not tags.wrong and not tags.open, f"{tags.wrong} {tags.open}")
    check.holds(f"{name}: nothing outside is needed", all(source.startswith("data:image/png;base64,")
                                                          for source in tags.sources))
    images = [base64.b64decode(source.split(",", 1)[1]) for source in tags.sources]
    check.holds(f"{name}: {pictures} pictures", len(images) == pictures and
                all(image.startswith(b"\x89PNG") for image in images), f"{len(images)}; {made.stdout[-300:]}")
    return text


good = run(args, SCENE, out="good", overrides=["output.every=1", "name=stack_1"])
text = looked_at("done", good, "--scene", SCENE, "--units", "mm,MPa", pictures=4)
check.holds("its probe", f"{good.summary()['probes']['force']:.6g}</td>" in text)
check.holds("its certificate", "<td>certified</td><td>yes</td>" in text)
check.holds("its advice", "contact.0.penalty=" in text)
check.holds("the report of -check", "held by supports and imposed displacements" in text)
check.holds("its scene", "lower_bottom" in text and "stack_1" in text)
bad = run(args, SCENE, out="bad", must=None,
          overrides=["contact.0.penalty.scale=1e-4", "loads.0.uy=-3.5", "stepping.initial=0.1", "output.every=1"])
text = looked_at("not converged", bad, pictures=4)
check.holds("why", re.search(r"class=bad>not converged: .*cannot be certified.*\[B202\]", text))
plot = [sys.executable, SCENES.parent.parent / "scripts/plot.py", good.directory, "-o", out / "x.png", "--x"]
for column, status in (("force", 0), ("nothing", 1)):
    drawn = subprocess.run([*map(str, plot), column], capture_output=True, text=True)
    check.holds(f"curves over {column}: exit {status}", drawn.returncode == status and
                (not status or "allowed: step, t" in drawn.stderr), drawn.stderr)
none = report(out)
check.holds("no run: exit 1, one message", none.returncode == 1 and none.stdout.count("\n") == 1, none.stdout)
chromium = shutil.which("chromium") or shutil.which("chromium-browser")
if chromium:
    shot = out / "report.png"
    subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", f"--screenshot={shot}",
                    f"file://{good.directory.resolve()}/report.html"], capture_output=True, timeout=120)
    check.holds("Chromium shows it", shot.exists() and shot.stat().st_size > 10000)
check.finish()
