/* What node to surface contact leaves of error between the nodes of the slave.

   There the nodes do not enter the master, and between them surfaces overlap and part: nodal forces press waves into
   elements of second order. A quantity J with the adjoint solution y changes by that by -int z dg(u) + p dg(y), where
   dg is the change of the gap along the displacements u and along y, less what is interpolated of it between the nodes,
   p the pressure and z its rate along y (contactzoneend.c has the source). p and z are interpolated between the nodes
   by the shape functions of the faces. A face whose nodes do not all press holds the end of the zone, where p and z are
   not known, and is left out. The shape of the surfaces is not in it, as changes alone are compared. On curved faces of
   first order displacements are interpolated too badly for that.

   The gaps are those of the pair's own smoother at quadrature points of the slave's faces, for which lists are made. */
#include "contactimpl.h"

/* Of a node: its pressure, that one's rate along y, the changes of its gap along u and y; whether it presses */
enum { NODE_PRESSURE, NODE_RATE, NODE_ALONG_U, NODE_ALONG_Y, NODE_PRESSES, NODE_WIDTH };

/* The pair as it is, with quadrature points of its slave's faces in the place of its slave points */
typedef struct {
  ContactPair      pair;
  int             *rung;
  PetscReal       *frame;
  const PetscReal *u;
} Between;

static PetscErrorCode Create(Contact contact, const ContactPair *pair, const PetscReal *u, Between *b)
{
  ContactPair *points = &b->pair;

  PetscFunctionBeginUser;
  *points = *pair;
  b->u    = u;
  PetscCall(SlavePointsCreateQuadrature(pair->slave, pair->geometry, FACE_RULE_PLAIN, PETSC_FALSE, &points->slaves));
  PetscCall(SearchCreate(pair->mesh, contact->scene, contact->loads, pair->master, pair->slave->max_size,
                         pair->n_images, pair->images, &pair->fit, points->slaves, NULL, NULL, &points->search));
  if (pair->scene->listed) SearchAllSides(points->search, pair->one_body);
  SearchSetTool(points->search, pair->tool);
  PetscCall(PetscCalloc4(points->slaves->n, &b->rung, 3 * points->slaves->n, &b->frame, points->slaves->n,
                         &points->seed, points->slaves->n, &points->point_gap));
  SearchSetRungs(points->search, b->rung);
  SearchSetFrames(points->search, b->frame);
  points->lists = NULL;
  PetscCall(SearchLists(points->search, u, pair->t, 0, &points->lists));
  for (PetscInt q = 0; q < points->slaves->n; q++) points->seed[q] = -1;
  PetscCall(ContactVariationsCreate(pair->mesh->dim, points->slaves->n, &points->variations));
  ContactVariationsReset(points->variations);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Between *b)
{
  PetscFunctionBeginUser;
  PetscCall(ContactVariationsDestroy(&b->pair.variations));
  PetscCall(NeighbourListsDestroy(&b->pair.lists));
  PetscCall(SearchDestroy(&b->pair.search));
  PetscCall(PetscFree4(b->rung, b->frame, b->pair.seed, b->pair.point_gap));
  PetscCall(SlavePointsDestroy(&b->pair.slaves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves the contact nodes of a pair along u and y. */
static PetscErrorCode Motions(Contact contact, ContactPair *pair, const PetscReal *u, const PetscReal *y,
                              PetscReal **along_u, PetscReal **along_y)
{
  const PetscInt n = pair->lists->n_nodes * pair->mesh->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, along_u, n, along_y));
  PetscCall(ContactPairMove(contact, pair, u, pair->t, pair->t, *along_u));
  PetscCall(ContactPairMove(contact, pair, y, pair->t, pair->t, *along_y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes what nodes have to where the points need it: value[nodes of the points][NODE_WIDTH]. */
static PetscErrorCode NodeValues(Contact contact, ContactPair *pair, const Between *b, const PetscReal *y,
                                 PetscReal *value)
{
  PetscReal   *along_u, *along_y, *home;
  MPI_Datatype block;

  PetscFunctionBeginUser;
  PetscCall(Motions(contact, pair, b->u, y, &along_u, &along_y));
  PetscCall(PetscCalloc1(pair->mesh->n_nodes * NODE_WIDTH, &home));
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    const PetscInt q  = pair->term_point[pair->term_ptr[c]];
    PetscReal     *of = &home[pair->node[c] * NODE_WIDTH], area;
    LawValue       law;

    ContactTermLaw(pair, c, pair->t, &law, NULL, &area);
    if (!(law.pressure > 0)) continue;
    PetscCall(ContactVariationsAlong(pair, q, along_u, &of[NODE_ALONG_U]));
    PetscCall(ContactVariationsAlong(pair, q, along_y, &of[NODE_ALONG_Y]));
    of[NODE_PRESSES]  = 1;
    of[NODE_PRESSURE] = law.pressure;
    of[NODE_RATE]     = -law.stiffness * of[NODE_ALONG_Y];
  }
  PetscCallMPI(MPI_Type_contiguous(NODE_WIDTH, MPIU_REAL, &block));
  PetscCallMPI(MPI_Type_commit(&block));
  PetscCall(PetscSFBcastBegin(b->pair.slaves->sf, block, home, value, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(b->pair.slaves->sf, block, home, value, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&block));
  PetscCall(PetscFree(home));
  PetscCall(PetscFree2(along_u, along_y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do all nodes of a face press? */
static PetscBool FacePresses(SlavePoints slaves, PetscInt f, const PetscReal *value)
{
  for (int a = 0; a < ElementGet(slaves->faces[f].type)->nodes; a++)
    if (!(value[slaves->faces[f].nodes[a] * NODE_WIDTH + NODE_PRESSES] > 0)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Adds what a point leaves. */
static PetscErrorCode AddPoint(const Between *b, PetscInt q, const PetscReal *value, const PetscReal *along_u,
                               const PetscReal *along_y, PetscReal *error)
{
  const SlavePoints slaves         = b->pair.slaves;
  PetscReal         at[NODE_WIDTH] = {0}, u = 0, y = 0;

  PetscFunctionBeginUser;
  if (b->pair.lists->facet_ptr[q] == b->pair.lists->facet_ptr[q + 1]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = slaves->ptr[q]; k < slaves->ptr[q + 1]; k++)
    for (int i = 0; i < NODE_WIDTH; i++) at[i] += slaves->S[k] * value[slaves->node[k] * NODE_WIDTH + i];
  PetscCall(ContactVariationsAlong(&b->pair, q, along_u, &u));
  PetscCall(ContactVariationsAlong(&b->pair, q, along_y, &y));
  *error -= b->pair.scene->share * slaves->weight[q] *
            (at[NODE_RATE] * (u - at[NODE_ALONG_U]) + at[NODE_PRESSURE] * (y - at[NODE_ALONG_Y]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums up the error of one quantity over this rank's points. */
static PetscErrorCode SumError(Contact contact, ContactPair *pair, Between *b, const PetscReal *y, PetscReal *error)
{
  const SlavePoints slaves = b->pair.slaves;
  PetscReal        *value, *along_u, *along_y;
  PetscMPIInt       rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(pair->mesh->comm, &rank));
  PetscCall(PetscCalloc1(slaves->n_nodes * NODE_WIDTH, &value));
  PetscCall(NodeValues(contact, pair, b, y, value));
  PetscCall(Motions(contact, &b->pair, b->u, y, &along_u, &along_y));
  *error = 0;
  for (PetscInt f = 0; f < slaves->n_faces; f++) {
    if (!SlavePointIsOwn(slaves, slaves->first[f], rank) || !FacePresses(slaves, f, value)) continue;
    for (PetscInt q = slaves->first[f]; q < slaves->first[f + 1]; q++)
      PetscCall(AddPoint(b, q, value, along_u, along_y, error));
  }
  PetscCall(PetscFree2(along_u, along_y));
  PetscCall(PetscFree(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums up what is left between the nodes of a pair in some quantities, on this rank. u: local displacements; y: as of
   ContactPairWithinFaces(). */
PetscErrorCode ContactBetweenNodes(Contact contact, ContactPair *pair, const PetscReal *u, int n, PetscReal *const y[],
                                   PetscReal error[])
{
  Between b;

  PetscFunctionBeginUser;
  PetscCall(Create(contact, pair, u, &b));
  for (int i = 0; i < n; i++) PetscCall(SumError(contact, pair, &b, y[i], &error[i]));
  PetscCall(Destroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
