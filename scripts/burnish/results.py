"""What a run has left, as NumPy arrays and pictures."""
import pathlib

import h5py

from burnish import meshview, plot, render
from burnish.runs import read_steps, read_summary


class Results:
    """The folder of a run. Fields are those of the written steps, -1 is the last one."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        self.path = self.directory / "results.h5"

    @property
    def summary(self):
        """summary.json."""
        return read_summary(self.directory)

    @property
    def probes(self):
        """Probes by their names, of the last state."""
        return self.summary["probes"]

    @property
    def steps(self):
        """Columns of steps.csv by their names."""
        return read_steps(self.directory)

    @property
    def nodes(self):
        """Reference coordinates of the nodes [n, 3] (length)."""
        with h5py.File(self.path, "r") as file:
            return file["mesh/nodes"][()]

    @property
    def cells(self):
        """Cells [n, nodes] by the names of their kinds, such as hex8, and the body of each, in the order of the scene."""
        with h5py.File(self.path, "r") as file:
            return {kind: (cells, body) for kind, cells, body in meshview.cells_of(file)}

    @property
    def times(self):
        """Load parameter of each written step."""
        return [t for t, *_ in meshview.read_states(self.path)]

    def field(self, name, step=-1):
        """A field at the nodes of all bodies: displacement [n, 3], stress [n, 6] (xx, yy, zz, xy, yz, xz), von_mises."""
        return meshview.read_states(self.path, name)[step][1]

    def contact(self, pair, name, step=-1):
        """A field of a contact pair, and the nodes that it belongs to: gap, penetration, penalty, pressure, normal."""
        return meshview.read_slave(self.path, pair), self.field(f"contact/{pair}/{name}", step)

    def plot(self, file=None, x="t"):
        """Draws the curves of the probes into a file, steps.png in the folder by default; x is a column of steps.csv."""
        return plot.draw([self.directory], x, file)

    def draw(self, field=None, file=None, **options):
        """Draws pictures; options are those of render.py: step, view, up, mirror, units, cut (axis and value),
        undeformed, arrows, animate, width."""
        return render.draw(self.directory, field=field, file=file, **options)
