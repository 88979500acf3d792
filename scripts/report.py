"""One HTML page of a run: how it ended, probes, curves, pictures, advice, counts, options and the scene. The page is one
file without links, for a mail or an archive.
    python scripts/report.py out/roller [-o FILE] [--units mm,MPa] [--mirror x] [--scene SCENE.yaml]
It is written to report.html in the run's folder. With --scene the page has the report of `burnish -check` on that scene,
too, which makes the mesh again if it is not there."""
import argparse
import base64
import html
import json
import pathlib
import subprocess
import sys
import tempfile

from launch import ROOT, environment, read_steps, read_summary

STYLE = """body { font: 15px/1.45 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #222 }
h1, h2 { font-weight: 600 } h2 { margin-top: 2em; border-bottom: 1px solid #ccc }
table { border-collapse: collapse } td, th { padding: .2em .8em; text-align: left; border-bottom: 1px solid #e5e5e5 }
td.number { text-align: right; font-variant-numeric: tabular-nums } img { max-width: 100% }
pre { background: #f6f6f6; padding: 1em; overflow-x: auto; font-size: 13px } .bad { color: #a00 }"""
COUNTS = ("ranks", "dofs", "elements", "steps", "steps_failed", "steps_repeated", "newton_iterations",
          "krylov_iterations", "wall_s", "cpu_s", "peak_rss_mb")
PAIR = ("nodes", "max_penetration", "max_penetration_over_h", "pressure_scatter")
ERRORS = ("error_force", "error_pressure", "error_peak", "error_displacement")  # parts; in the map `penalty`


def shown(value):
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def table(rows, head=()):
    """A table; numbers stand to the right."""
    text = "<table>\n"
    if head:
        text += "<tr>" + "".join(f"<th>{html.escape(cell)}</th>" for cell in head) + "</tr>\n"
    for row in rows:
        cells = (f'<td{" class=number" if isinstance(cell, (int, float)) and not isinstance(cell, bool) else ""}>'
                 f"{html.escape(shown(cell))}</td>" for cell in row)
        text += "<tr>" + "".join(cells) + "</tr>\n"
    return text + "</table>\n"


def pictures(directory, options):
    """Curves and fields of the run, each (title, PNG as text) of those that can be made."""
    scripts = pathlib.Path(__file__).resolve().parent
    found = []
    with tempfile.TemporaryDirectory() as folder:
        wanted = [("Curves", "plot.py", [])]
        view = [word for key in ("mirror", "units") if getattr(options, key) for word in
                (f"--{key}", getattr(options, key))]
        contact = bool(read_summary(directory)["contact"])
        wanted += [(title, "render.py", ["--field", field, *view]) for title, field, there in
                   (("von Mises stress", "von_mises", True), ("Contact pressure", "pressure", contact),
                    ("Displacement", "displacement", True)) if there]
        for k, (title, script, words) in enumerate(wanted):
            file = pathlib.Path(folder) / f"{k}.png"
            finished = subprocess.run([sys.executable, scripts / script, directory, "-o", file, *words],
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if finished.returncode == 0 and file.exists():
                found.append((title, base64.b64encode(file.read_bytes()).decode()))
            else:
                print(f"no picture '{title}': {finished.stdout.strip().splitlines()[-1:]}", file=sys.stderr)
    return found


def pairs(summary):
    """What is known of each contact pair."""
    rows = [[pair["name"], *(pair.get(key) for key in PAIR),
             *(None if pair["penalty"].get(key) is None else 100 * pair["penalty"][key] for key in ERRORS)]
            for pair in summary["contact"]]
    head = ("pair", "slave nodes in contact", "penetration", "over the face size", "scatter of pressures",
            "error of forces, %", "of pressures, %", "of the peak, %", "of displacements, %")
    return table(rows, head)


def checked(scene, burnish):
    finished = subprocess.run([burnish, "-check", scene], env=environment(burnish), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
    return f"<pre>{html.escape(finished.stdout)}</pre>\n"


def page(directory, options):
    summary, steps = read_summary(directory), read_steps(directory)
    good = summary["status"] == "done"
    ended = html.escape(summary["status"] + (f": {summary['message']}" if summary.get("message") else ""))
    title = html.escape(f"{summary['name']}, Burnish {summary['version']}")
    text = [f"<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><title>{title}</title><style>{STYLE}</style>"
            f"</head><body>\n<h1>{title}</h1>\n<p{'' if good else ' class=bad'}>{ended}; t = {summary['t']:g}</p>\n"]

    def section(name, body):
        text.append(f"<h2>{name}</h2>\n{body}")

    section("Effects", "<p>" + html.escape(", ".join(summary["effects"])) + "</p>\n")
    if summary["probes"]:
        first = {key: float(column[0]) for key, column in steps.items() if key != "during"}
        units = summary.get("units", {"probes": {}, "forces": "as the scene says"})
        rows = [[key, first.get(key), value, units["probes"].get(key, "")] for key, value in summary["probes"].items()]
        section("Probes", table(rows, ("probe", "after the first step", "at the end", "unit"))
                + f"<p>Forces are {html.escape(units['forces'])}.</p>\n")
    for name, picture in pictures(directory, options):
        section(name, f'<img alt="{name}" src="data:image/png;base64,{picture}">\n')
    if summary["contact"]:
        section("Contact", pairs(summary))
    if summary.get("certificate"):
        section("Certificate", table([["certified", summary.get("certified", False)], *summary["certificate"].items()]))
    if summary["advice"]:
        section("Advice", "<ul>" + "".join(f"<li>{html.escape(line)}</li>" for line in summary["advice"]) + "</ul>\n")
    section("Counts", table([[key, summary[key]] for key in COUNTS]))
    if options.scene:
        section("Check", checked(options.scene, options.burnish))
    section("Options", f"<pre>{html.escape(json.dumps(summary['options'], indent=1))}</pre>\n")
    section("Scene", f"<pre>{html.escape((directory / 'scene.yaml').read_text())}</pre>\n")
    return "".join(text) + "</body></html>\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("-o", dest="file", type=pathlib.Path, help="default: report.html in the run's folder")
    parser.add_argument("--scene", type=pathlib.Path, help="scene whose -check stands in the page")
    parser.add_argument("--burnish", type=pathlib.Path, default=ROOT / "build/burnish", help="the program for --scene")
    parser.add_argument("--units", help="of length and stress in the pictures, such as mm,MPa")
    parser.add_argument("--mirror", help="axes across which the pictures have mirror images, such as xz")
    options = parser.parse_args()
    if not (options.directory / "summary.json").exists():
        sys.exit(f"{options.directory} has no summary.json; allowed: the folder of a run that has ended")
    file = options.file or options.directory / "report.html"
    file.write_text(page(options.directory, options))
    print(file)


if __name__ == "__main__":
    main()
