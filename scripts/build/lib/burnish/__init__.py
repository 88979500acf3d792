"""Burnish from Python: write a scene, run it with mpirun, read its results into NumPy, draw them.

    import burnish

    results = burnish.run(scene, "out/block", ranks=2)  # scene: dicts and lists as in a scene file, or a file's name
    print(results.probes, abs(results.field("displacement")).max())
    results.draw("von_mises")
"""
import pathlib

from burnish.results import Results
from burnish.runs import Failed, execute, write_scene

__all__ = ["Failed", "Results", "run", "write_scene"]


def run(scene, directory, ranks=1, overrides=None, burnish=None):
    """Runs a scene and returns its Results. A scene of dicts and lists is written to DIRECTORY.yaml first, from whose
    folder its paths count. overrides: values by their keys, such as {"mesh.order": 2}. burnish: the program, by default
    that of the variable BURNISH or of the path. It raises Failed unless the run is done."""
    directory = pathlib.Path(directory)
    if isinstance(scene, dict):
        scene = write_scene(scene, directory.with_name(directory.name + ".yaml"))
    execute(scene, directory, ranks, overrides, burnish)
    return Results(directory)
