"""What penetration leaves of error at default settings: forces and peak pressures of some scenes against their limit for
stiff penalties on the same mesh, beside the estimate that the last screen prints. Leaves one record per run and prints
the table; --print tables an existing record.
    python scripts/penalty_table.py [--burnish BINARY] [--before BINARY] [--record FILE]
--before: an older program, which runs the scenes at its own defaults."""
import re
import shutil
import subprocess

from launch import ROOT, command, environment, read_records, read_summary, table_parser, write_records

DEFAULT = ("contact.0.penalty={}", "contact.0.formulation=auto")
# scene, overrides, probe of the force (None: it is given), probe of the peak pressure
CASES = {
    "roller": ("roller.yaml", (), "force", "peak_pressure"),
    "ball in a cone": ("tests/jobs/ball_in_cone.yaml", (), None, "peak_pressure"),
    "tyre": ("tests/jobs/tyre_kerb.yaml", (), "force", "peak"),
    "Hertz line": ("runs/hertz_line.yaml", DEFAULT, None, "peak_pressure"),
    "Hertz sphere": ("runs/hertz_sphere.yaml", DEFAULT, None, "peak_pressure"),
    "ironing": ("tests/jobs/ironing.yaml", (), "fy", None),
}
LIMIT = ("contact.0.penalty.scale=10000", )
COLUMNS = ("scene", "program", "status", "iterations", "cpu_s", "force", "peak", "force_estimate", "peak_estimate")


def roller(out):
    """The README's first example as files."""
    text = (ROOT / "README.md").read_text()
    for kind, name in (("c", "roller.geo"), ("yaml", "roller.yaml")):
        (out / name).write_text(re.search(rf"```{kind}\n(.*?)```", text, re.S).group(1))
    return out / "roller.yaml"


def solve(args, binary, name, program, more):
    scene, overrides, force, peak = CASES[name]
    scene = roller(args.out) if scene == "roller.yaml" else ROOT / scene
    if program == "before":
        overrides = tuple(o.replace("auto", "node_to_surface") for o in overrides)
    out = args.out / f"{name} {program}"
    shutil.rmtree(out, ignore_errors=True)
    line = command(binary, 1, scene, out, (*overrides, *more), "-quiet")
    subprocess.run(line, env=environment(binary), capture_output=True, check=False)
    summary = read_summary(out)
    probes, penalty = summary["probes"], summary["contact"][0]["penalty"]
    return {
        "scene": name, "program": program, "status": summary["status"], "iterations": summary["newton_iterations"],
        "cpu_s": summary["cpu_s"], "force": probes.get(force, ""), "peak": probes.get(peak, ""),
        "force_estimate": penalty.get("error_force", ""), "peak_estimate": penalty.get("error_peak", "")
    }


def error(row, limit, key):
    if row is None or not row[key] or not limit[key]:
        return ""
    return f"{100 * (float(row[key]) / float(limit[key]) - 1):+.2f}"


def part(row, key):
    return f"{100 * float(row[key]):.2f}" if row[key] else ""


def table(rows):
    print("| scene | iterations before, now | CPU (s) | force before (%) | force now (%) | estimate (%) "
          "| peak before (%) | peak now (%) | estimate (%) |")
    print("| --- " * 9 + "|")
    for name in CASES:
        found = {row["program"]: row for row in rows if row["scene"] == name}
        before, now, limit = found.get("before"), found["now"], found["limit"]
        old = before or {"iterations": "", "cpu_s": "0"}
        estimate = part(now, "force_estimate") if now["force"] else ""
        print(f"| {name} | {old['iterations']}, {now['iterations']} | {float(old['cpu_s']):.1f}, "
              f"{float(now['cpu_s']):.1f} | {error(before, limit, 'force')} | {error(now, limit, 'force')} | {estimate} "
              f"| {error(before, limit, 'peak')} | {error(now, limit, 'peak')} "
              f"| {part(now, 'peak_estimate') if now['peak'] else ''} |")


def main():
    parser = table_parser(__doc__, "penalty")
    parser.add_argument("--before", help="an older program")
    args = parser.parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        args.record.parent.mkdir(parents=True, exist_ok=True)
        programs = [("now", args.burnish, ()), ("limit", args.burnish, LIMIT)]
        if args.before:
            programs.insert(0, ("before", args.before, ()))
        cases = [(name, binary, program, more) for name in CASES for program, binary, more in programs]
        write_records(args.record, COLUMNS, lambda c: [solve(args, c[1], c[0], c[2], c[3])], cases, 1)
    table(read_records(args.record))


if __name__ == "__main__":
    main()
