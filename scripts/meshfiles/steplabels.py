"""Labels of the faces of a STEP file, which gmsh does not read: ADVANCED_FACE('bore', ...). The faces that gmsh has are
found again by their order in the solid, and each is checked by the distances between its corners, which do not change
where an assembly moves a part. A solid whose faces do not agree gets no labels."""
import re

import numpy

ENTITY = re.compile(r"#(\d+)\s*=\s*(\w*)\s*\((.*?)\)\s*;", re.DOTALL)
REFERENCE = re.compile(r"#(\d+)")
TEXT = re.compile(r"'((?:[^']|'')*)'")
SOLIDS = ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS")
AGREE = 1e-5  # distances of corners agree within this part of the largest one; files have some seven digits
# Words that programs write into every face, and numbers of entities, name nothing
EMPTY = {"", "NONE", "none"}


def _signature(corners):
    """Sorted distances between the corners."""
    points = numpy.asarray(corners, float).reshape(-1, 3)
    k, m = numpy.triu_indices(len(points), 1)
    return numpy.sort(numpy.linalg.norm(points[k] - points[m], axis=1))


class StepLabels:
    """of() gives the labels of the faces of one body. unmatched: some solid has labels that could not be given."""

    def __init__(self, file):
        text = file.read_text(errors="replace")
        self.entities = {}
        self.solids = []  # lists of (label, signature)
        self.unmatched = False
        if re.search(r"ADVANCED_FACE\s*\(\s*'(?!\s*'|NONE')", text, re.IGNORECASE):
            self._read(re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL))
        self.used = [0] * len(self.solids)

    def _read(self, text):
        self.entities = {int(number): (kind.upper(), body) for number, kind, body in ENTITY.findall(text)}
        for kind, body in list(self.entities.values()):
            if kind in SOLIDS:
                faces = [face for shell in self._references(body) for face in self._faces(shell)]
                if len({label for label, _ in faces}) > 1 or len(faces) == 1:  # one label for all faces names nothing
                    self.solids.append(faces)

    def _references(self, body):
        return [int(number) for number in REFERENCE.findall(TEXT.sub("", body))]

    def _faces(self, shell):
        kind, body = self.entities.get(shell, ("", ""))
        if kind == "ORIENTED_CLOSED_SHELL":
            return [face for inner in self._references(body) for face in self._faces(inner)]
        return [(self._label(face), _signature(self._corners(face))) for face in self._references(body)]

    def _label(self, face):
        found = TEXT.search(self.entities.get(face, ("", ""))[1])
        label = found.group(1).replace("''", "'").strip() if found else ""
        return "" if label in EMPTY or label.startswith("#") or '"' in label else label

    def _corners(self, face):
        """Coordinates of the vertices of a face, in the part's own frame."""
        vertices, seen, pending = set(), set(), [face]
        while pending:
            number = pending.pop()
            kind, body = self.entities.get(number, ("", ""))
            if kind == "VERTEX_POINT":
                vertices.update(self._references(body)[:1])
            elif number not in seen and kind in ("ADVANCED_FACE", "FACE_OUTER_BOUND", "FACE_BOUND", "EDGE_LOOP",
                                                 "ORIENTED_EDGE", "EDGE_CURVE", "VERTEX_LOOP"):
                seen.add(number)
                pending += self._references(body)
        return [self._place(point) for point in sorted(vertices)]

    def _place(self, point):
        values = re.search(r"\(([^()]*)\)", TEXT.sub("", self.entities[point][1]) + ")")
        return [float(x) for x in values.group(1).split(",")]

    def _fits(self, solid, signatures):
        """Tells whether the faces agree, up to the unit of length of the file."""
        if len(solid) != len(signatures) or any(len(a[1]) != len(b) for a, b in zip(solid, signatures)):
            return False
        theirs = numpy.concatenate([signature for _, signature in solid] or [[]])
        ours = numpy.concatenate(signatures or [[]])
        if not len(ours) or not theirs.max() > 0:
            return len(solid) == 1
        return numpy.abs(theirs / theirs.max() - ours / ours.max()).max() <= AGREE

    def of(self, faces):
        """Labels of a body's faces, each face given by its corners; None without labels. Of solids that agree the one
        is taken that was taken least often, in the order of the file."""
        signatures = [_signature(face) for face in faces]
        fitting = [k for k, solid in enumerate(self.solids) if self._fits(solid, signatures)]
        if not fitting:
            self.unmatched = self.unmatched or any(len(solid) == len(faces) for solid in self.solids)
            return None
        chosen = min(fitting, key=lambda k: self.used[k])
        self.used[chosen] += 1
        return [label for label, _ in self.solids[chosen]]
