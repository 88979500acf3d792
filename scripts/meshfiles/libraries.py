"""Readers that gmsh and meshio have: .msh of any version, .med, .unv, .cgns, .bdf and .nas; .vtk and .vtu."""
import numpy

from meshfiles.mesh import Mesh, MeshError, shape_of_number
from meshfiles.shapes import SHAPES

KINDS = ("point", "curve", "surface", "volume")  # gmsh's words for entities of dimension 0 to 3
# Shapes by meshio's names; its order of nodes is VTK's: for each node of the shape, its place in a cell of meshio
MESHIO = {
    "vertex": ("point", None),
    "line": ("edge2", None),
    "line3": ("edge3", None),
    "triangle": ("tri3", None),
    "triangle6": ("tri6", None),
    "quad": ("quad4", None),
    "quad8": ("quad8", None),
    "quad9": ("quad9", None),
    "tetra": ("tet4", None),
    "tetra10": ("tet10", [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]),
    "hexahedron": ("hex8", None),
    "hexahedron20": ("hex20", [*range(8), 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14]),
    "hexahedron27": ("hex27", [*range(8), 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14, 24, 22, 20, 21, 23, 25, 26]),
}
MOST_VALUES = 1000  # an array of cells with more different values than this is a field and not a set of groups


def read_gmsh(file, dim):
    """Reads what gmsh reads. Groups are its physical groups; entities that no group has are named by their number. What
    gmsh warns of, such as groups that it leaves out, are notes of the mesh."""
    import gmsh

    if file.suffix == ".msh" and not file.read_bytes()[:1024].lstrip().startswith((b"$MeshFormat", b"$NOD", b"$Comm")):
        raise MeshError("this is no .msh file: it does not start with $MeshFormat")
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Verbosity", 2)  # errors and warnings
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.logger.start()
    try:
        gmsh.open(str(file))
        mesh = mesh_of_entities(gmsh, dim, _names_of_entities(gmsh, dim))
        warnings = [line.split(": ", 1)[-1] for line in gmsh.logger.get() if line.startswith("Warning")]
        mesh.notes += [f"gmsh says: {text}" for text in dict.fromkeys(warnings)]
        return mesh
    except MeshError:
        raise
    except Exception as error:  # gmsh raises Exception itself
        raise MeshError(f"gmsh cannot read it: {error}") from None
    finally:
        gmsh.finalize()


def _names_of_entities(gmsh, dim):
    """Names of all entities that are read: physical groups, else the entity's own name, else its kind and number."""
    names = {}
    for entity in gmsh.model.getEntities():
        groups = gmsh.model.getPhysicalGroupsForEntity(*entity)
        own = gmsh.model.getEntityName(*entity).split("/")[-1] or f"{KINDS[entity[0]]}_{entity[1]}"
        if len(groups):
            names[entity] = [gmsh.model.getPhysicalName(entity[0], abs(tag)).strip() or str(abs(tag)) for tag in groups]
        elif entity[0] >= dim - 1:
            names[entity] = [own if entity[0] <= dim else ""]
    return names


def mesh_of_entities(gmsh, dim, names):
    """The mesh that gmsh has, with the elements of the entities that have names, in groups of these names."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    if not len(tags):
        raise MeshError("gmsh finds no mesh in it")
    row = numpy.full(int(tags.max()) + 1, -1)
    row[tags] = numpy.arange(len(tags))
    mesh = Mesh(dim, coordinates)
    for entity_dim, entity in gmsh.model.getEntities():
        types, _, nodes = gmsh.model.mesh.getElements(entity_dim, entity)
        for number, connectivity in zip(types, nodes) if (entity_dim, entity) in names else ():
            shape = shape_of_number(number)
            indices = mesh.add_elements(shape, row[connectivity])
            for name in names[entity_dim, entity]:
                mesh.group(name, entity_dim).add(shape, indices)
    return mesh


def read_meshio(file, dim):
    """Reads what meshio reads. Groups are its cell sets, the values of arrays of integers over cells as NAME:VALUE, and
    for arrays of integers over points the outer faces whose points have the value."""
    import meshio

    try:
        read = meshio.read(file)
    except BaseException as error:  # meshio ends the program where it cannot read a file
        raise MeshError(f"meshio cannot read it: {error or type(error).__name__}") from None
    points = numpy.zeros((len(read.points), 3))
    points[:, :read.points.shape[1]] = read.points
    mesh = Mesh(dim, points)
    blocks = []
    for block in read.cells:
        if block.type not in MESHIO:
            raise MeshError(f"elements of meshio's type {block.type} are not available; there are triangles, "
                            "quadrilaterals, tetrahedra and bricks of order 1 and 2")
        shape, order = MESHIO[block.type]
        data = numpy.asarray(block.data)
        blocks.append((shape, mesh.add_elements(shape, data if order is None else data[:, order])))
    for name, sets in read.cell_sets.items():
        for (shape, indices), chosen in zip(blocks, sets):
            if chosen is not None and len(chosen):
                mesh.group(name, SHAPES[shape].dim).add(shape, indices[chosen])
    for name, arrays in read.cell_data.items():
        _groups_of_values(mesh, name, blocks, arrays)
    for name, values in read.point_data.items():
        _groups_of_points(mesh, name, numpy.asarray(values))
    return mesh


def _is_group_array(values):
    return values.ndim == 1 and values.dtype.kind in "iu" and len(numpy.unique(values)) <= MOST_VALUES


def _groups_of_values(mesh, name, blocks, arrays):
    arrays = [numpy.squeeze(values, 1) if numpy.ndim(values) == 2 and len(values[0]) == 1 else numpy.asarray(values)
              for values in arrays]
    if not all(_is_group_array(values) for values in arrays):
        return
    for (shape, indices), values in zip(blocks, arrays):
        for value in numpy.unique(values):
            mesh.group(f"{name}:{value}", SHAPES[shape].dim).add(shape, indices[values == value])


def _groups_of_points(mesh, name, values):
    if not _is_group_array(values):
        return
    for value in numpy.unique(values[values != 0]):
        group = mesh.group(f"{name}:{value}", mesh.dim - 1)
        mesh.add_faces_of_nodes(group, numpy.flatnonzero(values == value))
