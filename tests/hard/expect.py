"""What a hard case must show. Each expectation judges a finished run of one variant and gives (holds, figure as text).
A bound or an expectation that differs by variant is a tuple in the order of VARIANTS."""
import re

import numpy

VARIANTS = (("facet", "node_to_surface"), ("facet", "surface_to_surface"), ("diffuse", "node_to_surface"),
            ("diffuse", "surface_to_surface"))


def of_variant(value, variant):
    """The entry of a variant, of a value for all or a tuple of one for each."""
    return value[variant] if isinstance(value, tuple) else value


def figure(error):
    """Two digits in per cent, or a power of ten."""
    if error >= 1e-4:
        return f"{float(f'{100 * error:.2g}'):g} %"
    return f"{error:.0e}" if error else "0"


class Done:
    """The run reaches its end."""

    status = 0

    def judge(self, finished, variant, again):
        return True, "runs to its end"


class Near(Done):
    """A probe at the end of the run has its exact value. bound: relative; infinite: whatever comes is shown."""

    def __init__(self, probe, exact, bound):
        self.probe, self.exact, self.bound = probe, exact, bound

    def judge(self, finished, variant, again):
        value = finished.summary()["probes"][self.probe]
        error = numpy.inf if value is None else abs(value / self.exact - 1)
        return error <= of_variant(
            self.bound, variant), f"{self.probe.replace('_', ' ')} " + ("none" if value is None else figure(error))


class Most(Done):
    """A column of steps.csv is at most so much, at the end or at a load parameter."""

    def __init__(self, name, most, t=1):
        self.name, self.most, self.t = name, most, t

    def judge(self, finished, variant, again):
        value = min(finished.steps(), key=lambda row: abs(row["t"] - self.t))[self.name]
        return value is not None and value <= self.most, f"{self.name.replace('_', ' ')} {value:.1g}"


class Uniform(Done):
    """The pressure of every slave node is the exact one. bound: relative."""

    def __init__(self, pressure, bound, pair="joint"):
        self.pressure, self.bound, self.pair = pressure, bound, pair

    def judge(self, finished, variant, again):
        pressure = finished.fields()[f"contact/{self.pair}/pressure"]
        error = numpy.max(numpy.abs(pressure / self.pressure - 1))
        return error <= of_variant(self.bound, variant), f"pressure {figure(error)}"


class Balance(Done):
    """Probes that are one force are the same. bound: relative."""

    def __init__(self, *probes, bound=1e-8):
        self.probes, self.bound = probes, bound

    def judge(self, finished, variant, again):
        forces = [finished.summary()["probes"][probe] for probe in self.probes]
        error = (max(forces) - min(forces)) / max(map(abs, forces))
        return error <= of_variant(self.bound, variant), f"balance {figure(error)}"


class Same(Done):
    """Probes are those of the same case made easy: with other overrides. bound: relative to the largest of them; scale:
    of a probe, over the other's."""

    def __init__(self, *overrides, probes, bound, scale=None):
        self.overrides, self.probes, self.bound, self.scale = list(overrides), probes, bound, scale or {}

    def judge(self, finished, variant, again):
        ours, theirs = finished.summary()["probes"], again(self.overrides).summary()["probes"]
        scale = max(abs(theirs[probe]) for probe in self.probes)
        error = max(abs(ours[probe] / self.scale.get(probe, 1) - theirs[probe]) for probe in self.probes) / scale
        return error <= of_variant(self.bound, variant), f"differs {figure(error)}"


class Turned(Done):
    """A force is that of the same case made easy, turned about z by so many degrees, and as many times as large. bound:
    relative."""

    def __init__(self, *overrides, probes, bound, angle=0, scale=1):
        self.overrides, self.probes, self.bound, self.factor = list(overrides), probes, bound, scale * numpy.exp(
            1j * numpy.radians(angle))

    def judge(self, finished, variant, again):
        ours, theirs = (complex(*(run.summary()["probes"][probe]
                                  for probe in self.probes))
                        for run in (finished, again(self.overrides)))
        error = abs(ours / self.factor - theirs) / abs(theirs)
        return error <= of_variant(self.bound, variant), f"differs {figure(error)}"


class Told(Done):
    """A figure of summary.json, by its path there, lies between bounds; words: what another entry of the same map says,
    by its name."""

    def __init__(self, path, least=-numpy.inf, most=numpy.inf, **words):
        self.path, self.least, self.most, self.words = path.split("."), least, most, words

    def judge(self, finished, variant, again):
        figures = finished.summary()[self.path[0]]
        value = figures[self.path[1]]
        says = all(re.search(words, figures[name] or "") for name, words in self.words.items())
        return says and self.least <= value <= self.most, f"{' '.join(self.path).replace('_', ' ')} {value:.2g}"


class Certified(Done):
    """The run reaches its end, and its certificate says that nothing passed through anything unseen."""

    def judge(self, finished, variant, again):
        summary = finished.summary()
        return summary["certified"] is True, f"crossing {summary['certificate']['largest_over_h']:.2g} of a face"


class Refused:
    """Wrong input: exit status 1 and a message with these words."""

    status = 1

    def __init__(self, *words):
        self.words = words

    def judge(self, finished, variant, again):
        messages = [line for line in finished.text.splitlines() if line.startswith("burnish: ")]
        return bool(messages) and all(re.search(word, messages[-1]) for word in self.words), "refused"


class Stops(Refused):
    """Exit status 2 with a message that has these words, the last good state on disk, near a load parameter if one is
    known."""

    status = 2

    def __init__(self, *words, t=None, within=0.0):
        super().__init__(*words)
        self.t, self.within = t, within

    def judge(self, finished, variant, again):
        holds, _ = super().judge(finished, variant, again)
        steps = finished.steps() if (finished.directory / "steps.csv").exists() else []
        reached = steps[-1]["t"] if steps else 0
        near = self.t is None or abs(reached - self.t) <= self.within
        return holds and near and finished.summary()["status"] == "not converged", f"stops at t = {reached:.3g}"


class All(Done):
    """Several at once; the figures of all. The first says how the run ends."""

    def __init__(self, *parts):
        self.parts, self.status = parts, parts[0].status

    def judge(self, finished, variant, again):
        judged = [part.judge(finished, variant, again) for part in self.parts]
        return all(holds for holds, _ in judged), ", ".join(text for _, text in judged)
