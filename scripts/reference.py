"""Writes the tables of doc/pages/scene.md from the program's own table of keys (`burnish -help`), and that of
doc/pages/troubleshooting.md from its table of messages (`burnish -explain all`).

    build/venv/bin/python scripts/reference.py            # writes them anew
    build/venv/bin/python scripts/reference.py --check    # exit status 1 where they differ from what the program says
"""
import argparse
import pathlib
import re
import subprocess
import sys

PAGES = pathlib.Path(__file__).resolve().parent.parent / "doc/pages"
BEGIN, END = "<!-- begin: scripts/reference.py -->\n", "<!-- end: scripts/reference.py -->\n"
LINE = re.compile(r"^  (?P<path>[A-Za-z_][\w.|]*): (?P<rest>.*)$")

MEANING = r" - (?![^(]*\))"  # separates the allowed values from the meaning, but not within parentheses


def keys(burnish):
    """Path, allowed values, remarks, default and meaning of every key, in the program's order."""
    text = subprocess.run([burnish, "-help"], stdout=subprocess.PIPE, text=True, check=True).stdout
    for line in text[text.index("Scene file (YAML") :].splitlines():
        match = LINE.match(line)
        if match:
            stated, meaning = (re.split(MEANING, match["rest"], maxsplit=1) + [""])[:2]
            allowed, *remarks = stated.split("; ")
            default = next((remark.removeprefix("default ") for remark in remarks if remark.startswith("default ")), "")
            others = [remark for remark in remarks if not remark.startswith("default ")]
            yield match["path"], allowed, others, default, meaning


def cell(text):
    return text.replace("|", "\\|")


def code(text):
    return f"`{cell(text)}`" if text else ""


def sections(burnish):
    """One table for each top-level key that has keys below it, and one table for all that have none."""
    tables = {}
    for path, allowed, remarks, default, meaning in keys(burnish):
        top = path.split(".")[0]
        text = cell("; ".join(filter(None, [meaning, *remarks]))).replace("*", "\\*")
        tables.setdefault(top, []).append(f"| {code(path)} | {cell(allowed)} | {code(default)} | {text} |")
    single = [rows[0] for rows in tables.values() if len(rows) == 1]
    head = "| key | allowed | default | meaning |\n| --- | --- | --- | --- |\n"
    text = "## Single keys\n\n" + head + "\n".join(single) + "\n"
    for top, rows in tables.items():
        if len(rows) > 1:
            text += f"\n## {top}\n\n" + head + "\n".join(rows) + "\n"
    return text


def messages(burnish):
    """One row for each code of a message."""
    text = subprocess.run([burnish, "-explain", "all"], stdout=subprocess.PIPE, text=True, check=True).stdout
    table = "| code | message | cause | what to change |\n| --- | --- | --- | --- |\n"
    for entry in text.strip().split("\n\n"):
        lines = entry.splitlines()
        code, message = lines[0].split("  ", 1)
        table += f"| {code} | {cell(message)} | {cell(lines[1].removeprefix('cause   '))} | " \
                 f"{cell(lines[2].removeprefix('change  '))} |\n"
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--burnish", default="build/burnish")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    for name, text in (("scene.md", sections(options.burnish)), ("troubleshooting.md", messages(options.burnish))):
        there = (PAGES / name).read_text()
        wanted = there[: there.index(BEGIN) + len(BEGIN)] + text + there[there.index(END) :]
        if options.check and wanted != there:
            sys.exit(f"doc/pages/{name} differs from the program: build/venv/bin/python scripts/reference.py writes it")
        if not options.check:
            (PAGES / name).write_text(wanted)


main()
