/* Faces of groups at their nodes, see slicesides.h. */
#include "slicesides.h"
#include "base/exchange.h"
#include "base/vectors.h"

/* Centre of some nodes of a cell. */
static void Centre(const SliceMesh *slice, int n, const PetscInt nodes[], PetscReal centre[3])
{
  for (int d = 0; d < 3; d++) centre[d] = 0;
  for (int a = 0; a < n; a++)
    for (int d = 0; d < 3; d++) centre[d] += slice->coords[3 * nodes[a] + d] / n;
}

/* Normal of a face at one of its nodes, times area over reference area. */
static void NodeNormal(const SliceMesh *slice, const Element *face, const PetscInt nodes[], int k, PetscReal normal[3])
{
  double    N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 3];
  PetscReal tangent[2][3] = {{0}, {0, 0, 1}};

  ElementShape(face->type, face->node[k], N, dN, NULL);
  for (int j = 0; j < face->dim; j++)
    for (int d = 0; d < 3; d++) {
      tangent[j][d] = 0;
      for (int a = 0; a < face->nodes; a++) tangent[j][d] += dN[a * face->dim + j] * slice->coords[3 * nodes[a] + d];
    }
  Cross(tangent[0], tangent[1], normal);
}

/* Lists what the nodes of a face know of it: sides[FACE_MAX_NODES]. Returns their number. */
static int FaceSides(const SliceMesh *slice, const SliceFace *face, NodeSide *sides)
{
  const PetscInt  cell    = face->cell - slice->cell_start[slice->rank];
  const Element  *element = slice->cell_block[cell]->element, *of_face = ElementGet((ElementType)element->face_type);
  const PetscInt *nodes = SliceMeshCellNodes(slice, cell);
  PetscInt        of[FACE_MAX_NODES];
  PetscReal       inside[3], centre[3], out[3];

  for (int k = 0; k < of_face->nodes; k++) of[k] = nodes[element->face_nodes[face->number][k]];
  Centre(slice, element->corners, nodes, inside);
  Centre(slice, of_face->corners, of, centre);
  Minus(centre, inside, out);
  for (int k = 0; k < of_face->nodes; k++) {
    sides[k] = (NodeSide){.id = slice->id[of[k]], .group = face->group};
    NodeNormal(slice, of_face, of, k, sides[k].normal);
    if (Dot(sides[k].normal, out) < 0)
      for (int d = 0; d < 3; d++) sides[k].normal[d] *= -1;
    Minus(centre, &slice->coords[3 * of[k]], sides[k].way);
  }
  return of_face->nodes;
}

/* Orders records by nodes and groups, and those of one node and group by the rest, whatever rank they came from. */
static int CompareSides(const void *a, const void *b)
{
  const NodeSide *s = a, *t = b;

  if (s->id != t->id) return s->id < t->id ? -1 : 1;
  if (s->group != t->group) return s->group < t->group ? -1 : 1;
  for (int d = 0; d < 3; d++)
    if (s->normal[d] != t->normal[d]) return s->normal[d] < t->normal[d] ? -1 : 1;
  for (int d = 0; d < 3; d++)
    if (s->way[d] != t->way[d]) return s->way[d] < t->way[d] ? -1 : 1;
  return 0;
}

static void PackSide(const void *context, PetscInt i, void *packed)
{
  *(NodeSide *)packed = ((const NodeSide *)context)[i];
}

/*@
  SliceSidesGather - brings the faces of some groups at their nodes to the homes of these nodes.

  Collective

  Input Parameters:
+ slice  - with the faces of the groups
- groups - which groups are asked for, by their numbers

  Output Parameters:
+ n     - number of records whose nodes have their home here
- sides - the records, to be freed with PetscFree(); by node and group, in the same order on any number of ranks
@*/
PetscErrorCode SliceSidesGather(const SliceMesh *slice, const PetscBool *groups, PetscInt *n, NodeSide **sides)
{
  PetscInt     n_own = 0;
  NodeSide    *own;
  PetscMPIInt *to;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < slice->n_faces; f++) n_own += groups[slice->faces[f].group] ? FACE_MAX_NODES : 0;
  PetscCall(PetscMalloc1(n_own, &own));
  PetscCall(PetscMalloc1(n_own, &to));
  n_own = 0;
  for (PetscInt f = 0; f < slice->n_faces; f++)
    if (groups[slice->faces[f].group]) n_own += FaceSides(slice, &slice->faces[f], &own[n_own]);
  for (PetscInt i = 0; i < n_own; i++) to[i] = SliceMeshRankOf(slice, slice->home_start, own[i].id);
  PetscCall(ExchangeRecords(slice->comm, sizeof(NodeSide), n_own, to, PackSide, own, n, (void **)sides));
  if (*n) qsort(*sides, (size_t)*n, sizeof(NodeSide), CompareSides);
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SliceFaceNormal - gives centre and unit normal of a face.

  Not collective

  Input Parameters:
+ slice - the slice
- face  - a face of one of its cells

  Output Parameters:
+ centre - mean of its corners
- normal - the mean one, out of the cell
@*/
void SliceFaceNormal(const SliceMesh *slice, const SliceFace *face, PetscReal centre[3], PetscReal normal[3])
{
  const PetscInt cell = face->cell - slice->cell_start[slice->rank];
  NodeSide       sides[FACE_MAX_NODES];
  const int      n      = FaceSides(slice, face, sides);
  PetscReal      length = 0;

  for (int d = 0; d < 3; d++) normal[d] = 0;
  for (int k = 0; k < n; k++)
    for (int d = 0; d < 3; d++) normal[d] += sides[k].normal[d];
  length = PetscSqrtReal(Dot(normal, normal));
  for (int d = 0; d < 3 && length > 0; d++) normal[d] /= length;
  for (int d = 0; d < 3; d++)
    centre[d] =
      sides[0].way[d] +
      slice->coords[3 * SliceMeshCellNodes(slice, cell)[slice->cell_block[cell]->element->face_nodes[face->number][0]] +
                    d];
}
