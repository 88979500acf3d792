"""Runs of Burnish: scenes that are written, the environment in which mpirun starts, and what a run leaves as Python
values."""
import csv
import functools
import json
import os
import pathlib
import re
import shutil
import subprocess

import numpy

MPI = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",  # Open MPI 5
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",  # two runs at a time would be bound to the same cores
    "PRTE_MCA_hwloc_default_binding_policy": "none",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}


@functools.cache
def kernels(burnish):
    """OPENBLAS_CORETYPE, where the program says that its BLAS has faster kernels for this processor than those it
    chooses."""
    try:
        said = subprocess.run([burnish, "-version"], env={
            **MPI,
            **os.environ
        }, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    except OSError:  # the run will say why
        return {}
    return dict(re.findall(r"(OPENBLAS_CORETYPE)=(\w+)", said))


def environment(burnish):
    """The caller's, with what several ranks on few cores and the BLAS need where it says nothing."""
    return {**MPI, **kernels(burnish), **os.environ}


def command(burnish, ranks, scene, directory, overrides, *options):
    """Command line of a run, for subprocess."""
    line = ["mpirun", "-n", str(ranks), str(burnish), str(scene), "-o", str(directory), *options]
    for override in overrides:
        line += ["-set", override]
    return line


def read_summary(directory):
    return json.loads((pathlib.Path(directory) / "summary.json").read_text())


def read_units(directory):
    """[length, stress] as the scene's key units names them, None without it or before the run has ended."""
    path = pathlib.Path(directory) / "summary.json"
    units = read_summary(directory).get("units", {}) if path.exists() else {}
    return [units["length"], units["stress"]] if units.get("named") else None


def read_steps(directory):
    """Columns of steps.csv, NaN where empty, and texts of the column `during`; {} without an accepted step."""
    with open(pathlib.Path(directory) / "steps.csv", newline="") as file:
        rows = list(csv.DictReader(file, skipinitialspace=True))
    if not rows:
        return {}
    return {
        key: numpy.array([row[key] if key == "during" else float(row[key] or "nan") for row in rows])
        for key in rows[0]
    }


class Failed(RuntimeError):
    """A run that ended with another status than 0; status and text are those of the program."""

    def __init__(self, status, text):
        super().__init__(f"exit status {status}\n{text}")
        self.status, self.text = status, text


def program():
    """The program: that of the variable BURNISH, or the one that the shell would find."""
    found = os.environ.get("BURNISH") or shutil.which("burnish")
    if not found:
        raise FileNotFoundError("burnish is not on the path; allowed: a PATH with it, or the variable BURNISH")
    return found


def write_scene(scene, path):
    """Writes a scene of dicts and lists as a YAML file. JSON is YAML too; paths in it count from the file's folder."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(scene, indent=2) + "\n")
    return path


def execute(scene, directory, ranks=1, overrides=None, burnish=None, options=("-overwrite", "-quiet")):
    """Runs a scene file on so many ranks into a folder. overrides: values by their keys, such as {"mesh.order": 2}. It
    raises Failed, with what the program said, unless the run is done."""
    burnish = burnish or program()
    values = [f"{key}={json.dumps(value) if not isinstance(value, str) else value}"
              for key, value in (overrides or {}).items()]
    finished = subprocess.run(command(burnish, ranks, scene, directory, values, *options), env=environment(burnish),
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if finished.returncode:
        raise Failed(finished.returncode, finished.stdout)
    return finished.stdout
