"""Geometry of CAD programs (STEP, BREP, IGES) as a mesh: gmsh's OpenCASCADE reads and meshes it. Bodies are its solids,
surfaces its faces; in the plane, bodies are faces and surfaces are curves. All have names: `volume_N`, `surface_N` and
`curve_N` by gmsh's number, the labels of the file, and the names that the scene gives to surfaces by a point on them.

read_cad() is the reader, list_cad() tells the names. Their options are a map: size (length, or null), order, and
surfaces: maps of name, point, body and size."""
import contextlib
import math

import numpy

from meshfiles.mesh import MeshError
from meshfiles.steplabels import StepLabels

ENDINGS = (".step", ".stp", ".brep", ".igs", ".iges")
KINDS = ("point", "curve", "surface", "volume")  # gmsh's words for entities of dimension 0 to 3
# Size of the elements of a body without the key `size`: this part of its diagonal
PART_OF_BODY = 1 / 15
CIRCLE = 24  # elements around a full circle, at least: with fewer the surface of a round part has visible corners
GROWTH = 0.5  # growth of the size of elements per length away from a surface with a size of its own
# A point may be off its surface by this part of the model's diagonal: programs show coordinates with few digits
NEAR = 1e-3
EQUAL = 1e-6  # surfaces whose distances differ by less than this part of the diagonal are equally near
# Elements at most, by volume over the cube of their size; such a mesh takes an hour and needs another machine
MOST_ELEMENTS = 2e7
TETRAHEDRA = 8.5  # tetrahedra in a cube of their edge length


class Cad:
    """The geometry in gmsh, its bodies and surfaces by name. All entities are (dim, tag) of gmsh."""

    def __init__(self, gmsh, file, dim, options):
        self.gmsh, self.dim, self.options = gmsh, dim, options
        self.bodies = self._import(file)
        self.box = self._box_of(self.bodies)
        self.diagonal = self._diagonal_of(self.bodies)
        self.surfaces = self._surfaces()
        self.names = {}  # entity -> names
        self.notes = []
        self._name_bodies()
        self._name_surfaces(StepLabels(file) if file.suffix.lower() in (".step", ".stp") and dim == 3 else None)
        self._pick_surfaces()

    # Geometry

    def _import(self, file):
        try:
            self.gmsh.model.occ.importShapes(str(file), highestDimOnly=False)
        except Exception as error:  # gmsh raises Exception itself
            raise MeshError(f"gmsh cannot read it: {error}") from None
        self.gmsh.model.occ.synchronize()
        bodies = self.gmsh.model.getEntities(self.dim)
        if not bodies:
            found = [f"{len(self.gmsh.model.getEntities(d))} {KINDS[d]}s" for d in range(4)
                     if self.gmsh.model.getEntities(d)]
            raise MeshError(f"it has no {KINDS[self.dim]}s, which the scene's geometry asks for, but "
                            f"{', '.join(found) or 'nothing'}; allowed: solids, in the plane faces at z = 0")
        if self.dim == 2:
            low, high = self._box_of(bodies)
            if max(-low[2], high[2]) > EQUAL * numpy.linalg.norm(high - low):
                raise MeshError(f"its faces lie at z = {low[2]:.4g} to {high[2]:.4g}; allowed in the plane: faces at "
                                "z = 0; solids are for geometry: solid")
        return bodies

    def _box_of(self, entities):
        boxes = numpy.array([self.gmsh.model.getBoundingBox(*entity) for entity in entities])
        return numpy.array([boxes[:, :3].min(axis=0), boxes[:, 3:].max(axis=0)])

    def _surfaces(self):
        """Surface -> its bodies."""
        bodies = {}
        for body in self.bodies:
            for surface in self.gmsh.model.getBoundary([body], oriented=False):
                bodies.setdefault(surface, []).append(body)
        return dict(sorted(bodies.items()))

    # Names

    def _label(self, entity):
        """The last part of the label, which names the product; without characters that no name of a mesh has."""
        label = self.gmsh.model.getEntityName(*entity).split("/")[-1]
        return "".join(c for c in label if c.isprintable() and c != '"').strip()

    def _name_bodies(self):
        labels = {body: self._label(body) for body in self.bodies}
        for body in self.bodies:
            label, names = labels[body], [f"{KINDS[self.dim]}_{body[1]}"]
            same = [other for other in self.bodies if labels[other] == label]
            if label and len(same) == 1:
                names.append(label)
            elif label:
                names.append(f"{label}.{same.index(body) + 1}")
            self.names[body] = names

    def _name_surfaces(self, labels):
        """Names by number and, with labels, by these: LABEL where one body has it, and BODY.LABEL."""
        for surface in self.surfaces:
            self.names[surface] = [f"{KINDS[self.dim - 1]}_{surface[1]}"]
        owners = {}  # label -> {body: surfaces}
        for body in self.bodies if labels else ():
            faces = [surface for surface in self.gmsh.model.getBoundary([body], oriented=False)]
            found = labels.of([self._corners(face) for face in faces])
            for face, label in zip(faces, found or ()):
                if label:
                    owners.setdefault(label, {}).setdefault(body, []).append(face)
        for label, bodies in owners.items():
            for body, faces in bodies.items():
                for face in faces:
                    self.names[face].append(f"{self.names[body][-1]}.{label}")
                    if len(bodies) == 1:
                        self.names[face].append(label)
        if labels and labels.unmatched:
            self.notes.append("labels of faces are not taken, as the faces of the file could not be told: "
                              "pick surfaces by points")

    def _corners(self, face):
        points = self.gmsh.model.getBoundary([face], oriented=False, recursive=True)
        return [self.gmsh.model.getValue(0, tag, []) for _, tag in points]

    def named(self, name):
        return [entity for entity, names in self.names.items() if name in names]

    def _bodies_named(self, name):
        bodies = [body for body in self.named(name) if body in self.bodies]
        if not bodies:
            there = ", ".join(self.names[body][-1] for body in self.bodies)
            raise MeshError(f"mesh.surfaces: there is no body '{name}'; there are: {there}")
        return bodies

    # Surfaces by points

    def _pick_surfaces(self):
        taken = {name for names in self.names.values() for name in names}
        for wanted in self.options["surfaces"]:
            name, point = wanted["name"], wanted.get("point")
            if point is None:
                self._surfaces_named(name)
            elif name in taken:
                raise MeshError(f"mesh.surfaces: the file has the name '{name}' already; allowed: another name, or this "
                                "one without a point")
            else:
                self.names[self._at(name, numpy.array([*point, 0.0][:3], float), wanted.get("body"))].append(name)

    def _surfaces_named(self, name):
        found = [entity for entity in self.named(name) if entity in self.surfaces]
        if not found:
            there = ", ".join(self.names[surface][-1] for surface in self.surfaces)
            raise MeshError(f"mesh.surfaces: '{name}' has no point, and the file has no surface of this name; there are: "
                            f"{there}")
        return found

    def _at(self, name, point, body):
        """The surface nearest to the point, of a body if one is given."""
        allowed = list(self.surfaces)
        if body:
            bodies = self._bodies_named(body)
            allowed = [surface for surface in allowed if any(owner in bodies for owner in self.surfaces[surface])]
        marker = self.gmsh.model.occ.addPoint(*point)
        try:
            distances = numpy.array([self.gmsh.model.occ.getDistance(0, marker, *surface)[0] for surface in allowed])
        finally:
            self.gmsh.model.occ.remove([(0, marker)])
        nearest = int(distances.argmin())
        where = f"mesh.surfaces: '{name}': the point ({', '.join('%.6g' % x for x in point[:self.dim])})"
        if distances[nearest] > NEAR * self.diagonal:
            raise MeshError(f"{where} is {distances[nearest]:.3g} away from the nearest surface "
                            f"{self._told(allowed[nearest])}; allowed: a point on the surface, within "
                            f"{NEAR * self.diagonal:.3g}")
        equal = [surface for surface, d in zip(allowed, distances) if d <= distances[nearest] + EQUAL * self.diagonal]
        if len(equal) > 1:
            raise MeshError(f"{where} is on {len(equal)} surfaces: {', '.join(map(self._told, equal))}; allowed: a point "
                            "inside of one, or `body`, which says whose surface is meant")
        return equal[0]

    def _told(self, surface):
        bodies = " and ".join(self.names[body][-1] for body in self.surfaces[surface])
        return f"'{self.names[surface][-1]}' of '{bodies}'"

    # Mesh

    def _sizes(self):
        """Body -> size of its elements. Refuses sizes that give too many elements."""
        size = self.options.get("size")
        sizes = {body: size or PART_OF_BODY * self._diagonal_of([body]) for body in self.bodies}
        if size is None:
            self.notes.append(f"elements have a fifteenth of the diagonal of their body, {min(sizes.values()):.3g} to "
                              f"{max(sizes.values()):.3g}; mesh.size sets it")
        number = sum(self.gmsh.model.occ.getMass(*body) / sizes[body]**self.dim for body in self.bodies)
        number *= TETRAHEDRA if self.dim == 3 else 2
        if number > MOST_ELEMENTS:
            least = size * (number / MOST_ELEMENTS)**(1 / self.dim)
            box = " x ".join("%.4g" % side for side in (self.box[1] - self.box[0])[:self.dim])
            raise MeshError(f"mesh.size {size:.3g} gives some {number:.1g} elements, as the model is {box} large; "
                            f"allowed: {least:.2g} or more")
        return sizes

    def _diagonal_of(self, entities):
        low, high = self._box_of(entities)
        return float(numpy.linalg.norm(high - low))

    def _refine(self, sizes):
        """Bodies and surfaces with sizes of their own: elements grow away from a surface."""
        field, fields = self.gmsh.model.mesh.field, []
        for (_, tag), size in sizes.items():
            fields.append(field.add("Constant"))
            field.setNumbers(fields[-1], "VolumesList" if self.dim == 3 else "SurfacesList", [tag])
            field.setNumber(fields[-1], "VIn", size)
        for wanted in self.options["surfaces"]:
            if wanted.get("size") is None:
                continue
            distance, growth = field.add("Distance"), field.add("Threshold")
            surfaces, most = self._surfaces_named(wanted["name"]), max(sizes.values())
            field.setNumbers(distance, "SurfacesList" if self.dim == 3 else "CurvesList", [tag for _, tag in surfaces])
            field.setNumber(distance, "Sampling", self._sampling(surfaces, wanted["size"]))
            for option, value in (("InField", distance), ("SizeMin", wanted["size"]), ("SizeMax", most), ("DistMin", 0),
                                  ("DistMax", max(most - wanted["size"], 0) / GROWTH)):
                field.setNumber(growth, option, value)
            fields.append(growth)
        least = field.add("Min")
        field.setNumbers(least, "FieldsList", fields)
        field.setAsBackgroundMesh(least)

    def _sampling(self, surfaces, size):
        """Points along a side of a surface from which distances are taken: one for each element, within bounds."""
        return int(min(max(math.ceil(self._diagonal_of(surfaces) / size), 20), 200))

    def mesh(self):
        sizes = self._sizes()
        self._refine(sizes)
        for name, value in (("MeshSizeMax", max(sizes.values())), ("MeshSizeFromCurvature", CIRCLE),
                            ("MeshSizeFromPoints", 0), ("ElementOrder", self.options["order"]),
                            ("SecondOrderIncomplete", 0), ("HighOrderOptimize", int(self.options["order"] == 2))):
            self.gmsh.option.setNumber(f"Mesh.{name}", value)
        try:
            self.gmsh.model.mesh.generate(self.dim)
        except Exception as error:
            last = [line for line in self.gmsh.logger.get() if line.startswith(("Error", "Warning"))][-3:]
            raise MeshError(f"gmsh cannot mesh it: {error}; {'; '.join(last)}; a smaller mesh.size may help, or a repair "
                            "of the geometry in the CAD program") from None


@contextlib.contextmanager
def opened(file, dim, options):
    """The geometry of a file as a Cad, as long as gmsh has it."""
    import gmsh

    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Verbosity", 0)
    gmsh.logger.start()
    try:
        yield Cad(gmsh, file, dim, {"order": 2, "surfaces": [], **options})
    finally:
        gmsh.finalize()


def list_cad(file, dim, options):
    """Bodies and surfaces without a mesh: rows of (dimension, names, centre, size of the entity)."""
    with opened(file, dim, options) as cad:
        measure = cad.gmsh.model.occ
        return [(entity[0], cad.names[entity], measure.getCenterOfMass(*entity), measure.getMass(*entity))
                for entity in [*cad.bodies, *cad.surfaces]]


def read_cad(file, dim, options):
    """Reads the geometry and meshes it."""
    from meshfiles.libraries import mesh_of_entities

    with opened(file, dim, options) as cad:
        cad.mesh()
        mesh = mesh_of_entities(cad.gmsh, dim, cad.names)
        mesh.notes += cad.notes
        return mesh
