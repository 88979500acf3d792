/* Faces of listed surfaces that other pairs treat, see facemarks.h. */
#include "search/facemarks.h"

/* Most faces of a cell. */
enum { MARKS_CELL_FACES = 6 };

/* Marks of all pairs as slaves */
static const FaceMarks of_slaves = 0x5555555555555555;

/* Says for each face of a surface on this rank whether it is one of another surface, too. Returns their number. */
static PetscErrorCode FindCommon(ContactSurface surface, ContactSurface of, PetscBool *common, PetscInt *n)
{
  const MeshGroup *group = surface->group, *other = of->group;
  char            *has;

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt f = 0; f < surface->n_faces; f++) common[f] = PETSC_FALSE;
  if (!group || !other) {
    for (PetscInt f = 0; f < surface->n_faces && surface->rigid && surface->rigid == of->rigid; f++) {
      common[f] = PETSC_TRUE;
      (*n)++;
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscCalloc1(MARKS_CELL_FACES * surface->mesh->n_cells, &has));
  for (PetscInt f = 0; f < other->n_faces; f++) has[MARKS_CELL_FACES * other->face_cell[f] + other->face_number[f]] = 1;
  for (PetscInt f = 0; f < group->n_faces; f++) {
    common[f] = (PetscBool)has[MARKS_CELL_FACES * group->face_cell[f] + group->face_number[f]];
    *n += common[f];
  }
  PetscCall(PetscFree(has));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceMarksAdd - marks the faces of a surface that belong to another one.

  Not collective

  Input Parameters:
+ surface - a listed surface
. of      - slave or master of a pair
- mark    - number of the mark
@*/
PetscErrorCode FaceMarksAdd(ContactSurface surface, ContactSurface of, int mark)
{
  PetscBool *common;
  PetscInt   n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(surface->n_faces, &common));
  PetscCall(FindCommon(surface, of, common, &n));
  if (n && !surface->face_marks) PetscCall(PetscCalloc1(surface->n_faces, &surface->face_marks));
  for (PetscInt f = 0; f < surface->n_faces && n; f++)
    if (common[f]) surface->face_marks[f] |= (FaceMarks)1 << mark;
  PetscCall(PetscFree(common));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceMarksPoints - marks the slave points on faces of a surface. A node belongs to all faces around it.

  Collective

  Input Parameters:
+ slaves - the points of a listed surface, of a deformable body, whose faces FaceMarksAdd() has marked
. of     - slave or master of a pair
- mark   - number of the mark

  Input/Output Parameter:
. marks - marks[points]
@*/
PetscErrorCode FaceMarksPoints(SlavePoints slaves, ContactSurface of, int mark, FaceMarks *marks)
{
  const FaceMarks bit = (FaceMarks)1 << mark;

  PetscFunctionBeginUser;
  if (slaves->face_sf) {
    const FaceMarks *faces = slaves->surface->face_marks;
    PetscInt        *from, *to;

    PetscCall(PetscCalloc2(slaves->surface->n_faces, &from, slaves->n_faces, &to));
    for (PetscInt f = 0; f < slaves->surface->n_faces && faces; f++) from[f] = (faces[f] & bit) != 0;
    PetscCall(PetscSFBcastBegin(slaves->face_sf, MPIU_INT, from, to, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(slaves->face_sf, MPIU_INT, from, to, MPI_REPLACE));
    for (PetscInt f = 0; f < slaves->n_faces; f++)
      for (PetscInt q = slaves->first[f]; q < slaves->first[f + 1]; q++)
        if (to[f]) marks[q] |= bit;
    PetscCall(PetscFree2(from, to));
  } else if (of->group) {
    for (PetscInt q = 0; q < slaves->n; q++) { /* a rank's points of nodes are nodes of its own */
      PetscInt at;

      PetscCall(PetscFindInt(slaves->nodes[slaves->node[slaves->ptr[q]]].local, of->group->n_nodes, of->group->nodes,
                             &at));
      if (at >= 0) marks[q] |= bit;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceMarksShare - says whether two surfaces have a face in common.

  Collective

  Input Parameters:
+ a - a surface
- b - another one

  Output Parameter:
. share - the same on all ranks
@*/
PetscErrorCode FaceMarksShare(ContactSurface a, ContactSurface b, PetscBool *share)
{
  PetscBool *common;
  PetscInt   n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(a->n_faces, &common));
  PetscCall(FindCommon(a, b, common, &n));
  PetscCall(PetscFree(common));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, a->mesh->comm));
  *share = n > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceMarksTreated - says whether a pair with a slave and a master treats a point and a face, in either role.

  Not collective

  Input Parameters:
+ point - marks of the slave point
- face  - marks of the face that it meets
@*/
PetscBool FaceMarksTreated(FaceMarks point, FaceMarks face)
{
  return (PetscBool)((point & (((face & of_slaves) << 1) | ((face >> 1) & of_slaves))) != 0);
}
