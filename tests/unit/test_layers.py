#!/usr/bin/env python3
"""Shows that the layering check finds what it is for. It runs on a small tree of two folders that is in order, and then
on copies of it, each with one thing that is forbidden.

usage: test_layers.py
"""
import os
import pathlib
import subprocess
import sys
import tempfile

CHECK = pathlib.Path(__file__).resolve().parent.parent / "layers.py"

TREE = {
    "src/LAYERS": "low   # below\nhigh  # above\n",
    "src/low/a.h": "int A(void);\n",
    "src/low/a.c": '#include "low/a.h"\n#include "inner.h"\nint A(void) { return INNER; }\n',
    "src/low/private/inner.h": "#define INNER 1\n",
    "src/low/c.h": "int C(void);\n",
    "src/low/c.c": '#include "low/c.h"\nint C(void) { return 2; }\n',
    "src/high/b.h": '#include "low/a.h"\nint B(void);\n',
    "src/high/b.c": '#include "high/b.h"\nint B(void) { return A(); }\n',
    "include/tree.h": "int B(void);\n",
}

CASES = {  # what is wrong: the files that are different, what the check must say; nothing: it must pass
    "nothing": ({}, ""),
    "an include that runs up": ({"src/low/c.h": '#include "high/b.h"\nint C(void);\n'},
                                "include up: low/c.h -> high/b.h"),
    "a call that runs up": ({"src/low/c.c": "int B(void);\nint C(void) { return B(); }\n"},
                            "call up: low/c.c -> high/b.c (B)"),
    "a circle of calls": ({"src/low/a.c": "int C(void);\nint A(void) { return C(); }\n",
                           "src/low/c.c": "int A(void);\nint C(void) { return A(); }\n"}, "circle: low/a low/c"),
    "a circle of headers": ({"src/low/a.h": '#pragma once\n#include "low/c.h"\nint A(void);\n',
                             "src/low/c.h": '#pragma once\n#include "low/a.h"\nint C(void);\n'},
                            "circle of headers: low/a.h low/c.h"),
    "a private header of another folder": ({"src/high/b.c": '#include "high/b.h"\n#include "low/private/inner.h"\n'
                                                            "int B(void) { return A(); }\n"},
                                           "private header: high/b.c -> low/private/inner.h"),
    "a public header that includes one of src": ({"include/tree.h": '#include "high/b.h"\n'},
                                                 "public header: tree.h -> high/b.h"),
    "a folder without a place": ({"src/new/d.c": "int D(void) { return 3; }\n"}, "not in LAYERS: new/d"),
}


def write_tree(root, changes):
    """Writes the tree with some files changed, and compiles its sources into root/obj."""
    for name, text in {**TREE, **changes}.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    for source in (root / "src").rglob("*.c"):
        target = (root / "obj" / source.relative_to(root / "src")).with_suffix(".o")
        target.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run([os.environ.get("CC", "cc"), "-c", "-I", root / "src", "-iquote", source.parent / "private",
                        "-o", target, source], check=True)


def check(root):
    """Exit status and text of the layering check on a tree."""
    command = [sys.executable, CHECK, root / "obj", root / "src", root / "include"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def main():
    failed = 0
    for wrong, (changes, expected) in CASES.items():
        with tempfile.TemporaryDirectory() as folder:
            write_tree(pathlib.Path(folder), changes)
            status, text = check(pathlib.Path(folder))
        holds = status == 1 and expected in text.splitlines() if expected else status == 0
        failed += not holds
        print(f"{'ok' if holds else 'FAILED'}: {wrong}" + ("" if holds else f": status {status}\n{text}"))
    with tempfile.TemporaryDirectory() as folder:  # a tree that was not built says nothing
        write_tree(pathlib.Path(folder), {})
        subprocess.run(["rm", "-r", pathlib.Path(folder) / "obj"], check=True)
        status, text = check(pathlib.Path(folder))
    failed += status != 1
    print(f"{'ok' if status == 1 else 'FAILED'}: no objects")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
