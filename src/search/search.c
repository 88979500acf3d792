/* Search for contact partners: candidates around the slave points, the nearest facet of each, and the lists. */
#include "searchimpl.h"
#include "flank.h"
#include "ownbody.h"
#include "way.h"
#include "search/facemarks.h"

/* Reach of the search beyond the requested motion, in face sizes. The nearest facet of a slave point is listed if it
   is not farther away than this. */
#define SEARCH_REACH 2.0
/* A list holds every facet whose distance exceeds that of the nearest one by at most this many face sizes (plus the
   motion), so that the point may slide there within a solve. The size is that of the point's own face or of the nearest
   one, whichever is larger: large faces elsewhere do not lengthen lists between fine faces. */
#define SEARCH_MARGIN 1.5
/* A slave point is fitted if it is behind its nearest facet, or may come within this many face sizes of it while lists
   stand still. Else the facets tell that it is open, as fits are nearer to them than that. */
#define SEARCH_FITTED 1.0
/* Lists begin with room for those before and this part of them, one over it. */
enum { LIST_ROOM = 16 };

/*@
  SearchCreate - holds what does not change in a run: surfaces, images, slave points.

  Collective

  Input Parameters:
+ mesh       - the mesh
. scene      - the scene
. loads      - gives the position of rigid tools
. master     - the master surface; NULL: an analytic one, which needs no lists
. slave_size - largest face of the slave (length)
. n_images   - number of mirror images of the master
. images     - the images
. fit        - how the master is fitted
. slaves     - the slave points; NULL: the surface is searched by itself (offset.h)
. offset     - of the master's quadrature points for integral fits, [faces][FACE_RULE_POINTS*dim] (length), or NULL
- maps       - these points as combinations of nodes instead, or NULL

  Output Parameter:
. out - the search

  Note:
  All arguments are borrowed. The values of offset and maps are read whenever lists are made.
@*/
PetscErrorCode SearchCreate(Mesh mesh, Scene scene, Loads loads, ContactSurface master, PetscReal slave_size,
                            int n_images, const SurfaceImage *images, const FitSettings *fit, SlavePoints slaves,
                            const PetscReal *offset, const FaceMaps *maps, ContactSearch *out)
{
  ContactSearch   s;
  const PetscReal size = master ? PetscMax(slave_size, master->max_size) : slave_size;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *s = (struct _n_ContactSearch){.mesh     = mesh,
                                 .scene    = scene,
                                 .loads    = loads,
                                 .master   = master,
                                 .n_images = n_images,
                                 .images   = images,
                                 .fit      = fit,
                                 .slaves   = slaves,
                                 .offset   = offset,
                                 .maps     = maps,
                                 .reach    = SEARCH_REACH * size,
                                 .margin   = SEARCH_MARGIN * size};
  if (master) s->fit_reach = SearchFitReach(s);
  *out = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchDestroy - frees a search.

  Collective

  Input/Output Parameter:
. s - the search, NULL on return
@*/
PetscErrorCode SearchDestroy(ContactSearch *s)
{
  PetscFunctionBeginUser;
  if (*s) PetscCall(SearchPartnersFree(*s));
  if (*s) PetscCall(NeighbourListsFreeSpare(*s));
  PetscCall(PetscFree(*s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Positions of a candidate's nodes once they are numbers of points. */
static void CandidatePositions(NeighbourLists lists, const Candidate *c, PetscReal *x)
{
  const int dim = lists->dim;

  for (int a = 0; a < ElementGet(c->facet.type)->nodes; a++)
    for (int d = 0; d < dim; d++)
      x[a * dim + d] = lists->point_X[c->facet.nodes[a] * dim + d] + lists->point_u[c->facet.nodes[a] * dim + d];
}

/* Can a candidate that faces the slave point be its partner? It is not its own face, nor hidden by its own body. */
static PetscBool IsPartner(const Nearest *look, const Candidate *c, Foot *foot)
{
  const int dim = look->lists->dim;
  Facet     own = c->facet; /* without free edges: the distance to the facet itself, not to its extension */
  PetscReal x[FACE_MAX_NODES * 3];

  if (FlankIsOwn(look, c)) return PETSC_FALSE;
  CandidatePositions(look->lists, c, x);
  own.free_edges = 0;
  for (int a = 0; a < ElementGet(own.type)->nodes; a++) {
    own.nodes[a] = a;
    for (int d = 0; d < dim; d++) x[a * dim + d] -= look->x[d];
  }
  FacetProject(dim, &own, x, foot);
  return (PetscBool)(!OwnBodyHides(look, c, foot) && !OwnBodyTurnsFrom(look, c, foot));
}

/* Compares a candidate with the nearest one so far. Two facets share the foot on the edge between them. Where facets
   are equally near, the smaller tag decides and not round-off. Fits would show the difference, because they start
   from the nearest facet and its normal. */
static void NearestVisit(void *context, int index, double *bound)
{
  Nearest         *look  = context;
  const Candidate *c     = &look->candidates[index];
  const PetscBool  faces = FlankFaces(look, c);
  PetscReal        distance;
  Foot             foot;

  if (!faces && (look->averse || look->best >= 0 || look->one_body)) return;
  if (!faces && CandidateBoxDistance(look->lists->dim, c, look->x) > look->size) return; /* too far to be averse */
  if (!IsPartner(look, c, &foot)) return;
  distance = PetscAbsReal(foot.gap);
  if (!faces) look->averse = (PetscBool)(distance <= look->size);
  if (!faces || distance > *bound) return;
  look->least = PetscMin(distance, look->least);
  *bound      = look->least + look->tie;
  if (look->best >= 0 && look->distance <= *bound && c->facet.tag > look->candidates[look->best].facet.tag) return;
  look->distance = distance;
  look->best     = index;
  look->foot     = foot;
}

/* Finds the nearest facet of a slave point up to a distance (length). */
static void FindNearest(Nearest *look, BoxTree tree, PetscReal distance)
{
  const BoxTreeSide side  = {&look->lists->slave_normal[3 * look->q], look->one_body ? 0 : -INFINITY,
                             OwnBodyBehind(look), 0, 0};
  double            bound = distance + look->tie;

  look->least = distance;
  BoxTreeClosest(tree, look->x, look->listed ? &side : NULL, &bound, NearestVisit, look);
}

/* Finds the nearest facet of a slave point within reach, or else of those that may come within reach while lists stand
   still. */
static void SearchNearest(Nearest *look, BoxTree tree, PetscReal reach)
{
  PetscReal approach;

  FindNearest(look, tree, look->way.way ? reach : reach + look->way.most);
  if (!look->way.way || look->best >= 0) return;
  approach = BoxTreeApproach(tree, look->x, &look->way, reach);
  if (approach > 0) FindNearest(look, tree, reach + approach);
}

/* Finds the facets that may come nearer to the slave point than the nearest one while lists stand still, and those that
   are within a margin of it besides. Returns how many there are. */
static int FindFacets(const Nearest *look, const SearchField *field, BoxTree tree, PetscReal margin, int *found)
{
  BoxTreeWay      way     = look->way;
  const PetscReal recedes = way.way ? WayApproach(look, &look->candidates[look->best]) : 0;

  way.most -= recedes;
  return BoxTreeNearing(tree, look->x, &way, look->least + margin + recedes, (int)field->n_candidates, found);
}

/* May a slave point come within reach of any of the facets that FindFacets() has found? */
static PetscBool ComesNear(const Nearest *look, PetscReal reach, int n, const int *found)
{
  Foot foot;

  if (!look->way.way || look->least <= reach) return PETSC_TRUE;
  for (int i = 0; i < n; i++) {
    const Candidate *c        = &look->candidates[found[i]];
    const PetscReal  distance = reach + WayApproach(look, c);

    if (!FlankFaces(look, c) || CandidateBoxDistance(look->lists->dim, c, look->x) > distance) continue;
    if (IsPartner(look, c, &foot) && PetscAbsReal(foot.gap) <= distance) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Curvature of the master around its nearest facet: angle between the normals of the facets that touch it, over the
   distance of their centres. */
static PetscReal ListCurvature(const Nearest *look, PetscInt n, const int *found)
{
  const Candidate *c     = &look->candidates[look->best];
  PetscReal        kappa = 0;

  for (PetscInt i = 0; i < n; i++) {
    const Candidate *o      = &look->candidates[found[i]];
    PetscReal        cosine = 0, distance = 0;
    PetscBool        touch = PETSC_FALSE;

    for (int a = 0; a < ElementGet(c->facet.type)->corners; a++)
      for (int b = 0; b < ElementGet(o->facet.type)->corners; b++)
        touch = (PetscBool)(touch || c->facet.nodes[a] == o->facet.nodes[b]);
    for (int d = 0; d < 3; d++) {
      cosine += c->normal[d] * o->normal[d];
      distance += PetscSqr(c->centre[d] - o->centre[d]);
    }
    if (touch && distance > 0)
      kappa = PetscMax(kappa, PetscAcosReal(PetscMax(-1, PetscMin(1, cosine))) / PetscSqrtReal(distance));
  }
  return kappa;
}

/* Appends the found candidates to the slave point's list, which starts at first. The nodes of the facets become
   positions in that list, the ends of the flank become free edges, and those at facets that were dropped become cut
   ones. */
static PetscErrorCode ListAddFacets(const Nearest *look, PetscInt n, const int *found, const int *ends,
                                    const FaceRecord *records, PetscInt first, ListBuffer *buffer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const Candidate *c     = &look->candidates[found[i]];
    Facet            facet = c->facet;

    if (buffer->n == buffer->room) {
      buffer->room = 2 * buffer->room + 64;
      PetscCall(PetscRealloc(buffer->room * sizeof(Facet), &buffer->facet));
      PetscCall(PetscRealloc(buffer->room * sizeof(PetscReal), &buffer->size));
    }
    for (int a = 0; a < ElementGet(facet.type)->nodes; a++) {
      PetscCall(ListBufferAddPoint(buffer, first, facet.nodes[a]));
      facet.nodes[a] = (int)(buffer->position[facet.nodes[a]] - first);
    }
    facet.free_edges |= ends[i] % FLANK_CONVEX;
    facet.cut_edges            = ends[i] / FLANK_CUT;
    buffer->size[buffer->n]    = records[c->record].size;
    buffer->facet[buffer->n++] = facet;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the normal of the master at the slave point's foot. */
static void TakeNormal(Nearest *look, const FitSupport *fit)
{
  if (fit)
    CornerNormalsAt(fit->corners, look->best, look->foot.xi, look->normal);
  else
    for (int d = 0; d < 3; d++) look->normal[d] = look->candidates[look->best].normal[d];
}

/* Does the fit of a slave point matter while lists stand still, as it overlaps or may come near to its nearest facet?
   size: of its own face or of the nearest facet (length). */
static PetscBool NeedsFit(const Nearest *look, const FitSettings *fit, PetscReal size)
{
  const PetscReal approach = WayApproach(look, &look->candidates[look->best]);

  return (PetscBool)(fit->far || look->foot.gap < 0 || look->distance <= SEARCH_FITTED * size + approach);
}

/* Finds the nearest facet of one slave point, lists it with all facets within margin and motion of it, and fits the
   surface there. look gives the slave point, the size of its face and the distance within which it is searched, reach
   that without the motion. found and ends have room for all candidates. possible: which points may have a partner;
   NULL: any of them. */
static PetscErrorCode FillSlave(NeighbourLists lists, const SearchField *field, BoxTree tree, FitSupport *fit,
                                PetscReal reach, const PetscBool *possible, Nearest *look, int *found, int *ends,
                                ListBuffer *buffer)
{
  const PetscInt q = look->q, first = buffer->n_points;
  double         margin;
  int            count, facing, dropped, convex = 0;

  PetscFunctionBeginUser;
  if (possible && !possible[q]) PetscFunctionReturn(PETSC_SUCCESS);
  SearchNearest(look, tree, reach);
  lists->averse[q] = (PetscBool)(look->best < 0 && look->averse);
  if (look->best >= 0 && FaceMarksTreated(look->marks, field->records[look->candidates[look->best].record].marks))
    look->best = -1;
  if (look->best < 0) PetscFunctionReturn(PETSC_SUCCESS);
  margin = SEARCH_MARGIN * PetscMax(look->size, field->records[look->candidates[look->best].record].size);
  count  = FindFacets(look, field, tree, margin, found);
  if (!ComesNear(look, reach, count, found)) PetscFunctionReturn(PETSC_SUCCESS);
  facing = FlankSort(look, &count, found, &dropped);
  if (FlankPastEnd(look, count + dropped, found)) PetscFunctionReturn(PETSC_SUCCESS);
  FlankLeaveCorner(look, facing, found);
  TakeNormal(look, fit);
  lists->share[q] = FlankShare(look, facing, count, found, ends);
  FlankCuts(look, facing, found, dropped, &found[count], ends);
  if (lists->share[q] == 0 && !look->one_body) lists->averse[q] = FlankIsBeside(look, facing, count, found);
  lists->kappa[q] = ListCurvature(look, facing, found);
  for (int i = 0; i < facing; i++) {
    if (found[i] != look->best) continue;
    lists->nearest[q] = i;
    convex            = ends[i] % FLANK_CUT / FLANK_CONVEX;
  }
  if (fit && !NeedsFit(look, fit->s->fit, margin / SEARCH_MARGIN))
    lists->rung[q] = RUNG_UNASKED;
  else if (fit && !FlankNearRidge(look, fit->neighbourhoods, facing, found))
    PetscCall(FitSupportSlave(fit, look, q, convex, first, buffer));
  else if (fit && look->two_sided && FlankLies(look)) /* the edge has terms of its own */
    PetscCall(FitSupportLift(fit, look, q));
  PetscCall(ListAddFacets(look, facing, found, ends, field->records, first, buffer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the unit normal of the slave point. */
static void TakeOutward(Nearest *look)
{
  const PetscReal *own    = &look->lists->slave_normal[3 * look->q];
  const PetscReal  length = PetscSqrtReal(own[0] * own[0] + own[1] * own[1] + own[2] * own[2]);

  for (int d = 0; d < 3; d++) look->outward[d] = length > 0 ? own[d] / length : 0;
}

/* The lists of slave points from *next to `last` begin where the last list ended. */
static void BeginLists(NeighbourLists lists, PetscInt *next, PetscInt last, const ListBuffer *buffer)
{
  for (; *next <= last; (*next)++) {
    lists->list_ptr[*next]  = buffer->n_points;
    lists->facet_ptr[*next] = buffer->n;
  }
}

/* Fills the lists of all slave points. fit is NULL where the facets are used. */
static PetscErrorCode NeighbourListsFill(ContactSearch s, NeighbourLists lists, const SearchField *field,
                                         FitSupport *fit, PetscReal motion)
{
  const int  dim = lists->dim;
  BoxTree    tree;
  int       *found, *ends;
  PetscInt   next   = 0;
  FacetsAt   at     = {0};
  ListBuffer buffer = {.room        = s->room + s->room / LIST_ROOM,
                       .points_room = s->points_room + s->points_room / LIST_ROOM};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(field->n_candidates, &found, field->n_candidates, &ends, lists->n_points, &buffer.position));
  PetscCall(PetscCalloc1(lists->n_points, &at.latest));
  PetscCall(
    PetscMalloc2(lists->n_points, &at.first, 4 * field->n_candidates, &at.entry)); /* a quadrilateral has 4 corners */
  PetscCall(PetscMalloc1(buffer.room, &buffer.facet));
  PetscCall(PetscMalloc1(buffer.room, &buffer.size));
  PetscCall(PetscMalloc1(buffer.points_room, &buffer.point));
  for (PetscInt p = 0; p < lists->n_points; p++) buffer.position[p] = -1;
  PetscCall(CandidatesTree(dim, field->n_candidates, field->candidates, s->one_body, s->before.known,
                           &tree)); /* none is averse then */
  for (PetscInt i = 0; i < lists->n_near; i++) {
    const PetscInt q    = lists->near[i];
    Nearest        look = {.lists      = lists,
                           .slaves     = s->slaves,
                           .candidates = field->candidates,
                           .corners    = fit ? fit->corners : NULL,
                           .q          = q,
                           .own        = s->slaves->ptr[q + 1] - s->slaves->ptr[q],
                           .size       = s->slaves->size[q],
                           .height     = s->slaves->height[q],
                           .listed     = s->listed,
                           .one_body   = s->one_body,
                           .two_sided  = (PetscBool)(s->listed && s->master && !s->master->rigid),
                           .sharp      = s->fit->feature_angle,
                           .marks      = s->marks ? s->marks[q] : 0,
                           .way        = WayOf(s, q),
                           .best       = -1,
                           .at         = &at,
                           .tie        = FACET_TIE * (s->reach + motion)};

    for (int d = 0; d < dim; d++) look.x[d] = lists->slave_X[q * dim + d] + lists->slave_u[q * dim + d];
    TakeOutward(&look);
    BeginLists(lists, &next, q, &buffer);
    PetscCall(FillSlave(lists, field, tree, fit, s->reach, s->partners.possible, &look, found, ends, &buffer));
  }
  BeginLists(lists, &next, lists->n_slaves, &buffer);
  lists->list_point = buffer.point;
  s->room           = buffer.n;
  s->points_room    = buffer.n_points;
  lists->facet      = buffer.facet;
  lists->facet_size = buffer.size;
  PetscCall(SearchPartnersLearn(s, lists, field, tree));
  BoxTreeDestroy(&tree);
  PetscCall(PetscFree3(found, ends, buffer.position));
  PetscCall(PetscFree(at.latest));
  PetscCall(PetscFree2(at.first, at.entry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CompareTags(const void *a, const void *b)
{
  const long left = ((const Facet *)a)->tag, right = ((const Facet *)b)->tag;

  return (left > right) - (left < right);
}

/* Keeps all faces that were collected, by ascending tag. */
static PetscErrorCode NeighbourListsTakeFaces(NeighbourLists lists, const SearchField *field)
{
  PetscFunctionBeginUser;
  lists->n_faces = field->n_candidates;
  PetscCall(PetscMalloc1(lists->n_faces, &lists->face));
  for (PetscInt c = 0; c < lists->n_faces; c++) lists->face[c] = field->candidates[c].facet;
  if (lists->n_faces) qsort(lists->face, lists->n_faces, sizeof(Facet), CompareTags);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchKeepFaces - has lists keep all faces of the master around the slave points, for NeighbourListsFindFace().

  Not collective

  Input Parameter:
. s - the search
@*/
void SearchKeepFaces(ContactSearch s)
{
  s->keeps_faces = PETSC_TRUE;
}

/*@
  SearchAllSides - has lists leave out what lies behind a slave point beyond its own body, because any side of the
  bodies may meet any other one.

  Not collective

  Input Parameters:
+ s        - the search
- one_body - slave and master have faces of one body
@*/
void SearchAllSides(ContactSearch s, PetscBool one_body)
{
  s->listed   = PETSC_TRUE;
  s->one_body = one_body;
}

/*@
  SearchSetTool - makes the nodes of a tool, whose surface is the master, contact nodes of all lists.

  Not collective

  Input Parameters:
+ s    - the search
- tool - with free components of its motion; borrowed
@*/
void SearchSetTool(ContactSearch s, const MeshTool *tool)
{
  s->tool = tool;
}

/*@
  SearchSetMarks - has slave points that find their nearest facet on a face which another pair treats with them find no
  partner.

  Not collective

  Input Parameters:
+ s     - the search
- marks - of each slave point of this rank, see facemarks.h; borrowed, read by each search
@*/
void SearchSetMarks(ContactSearch s, const FaceMarks *marks)
{
  s->marks = marks;
}

/*@
  SearchSetRungs - says on which rung of the ladder of fall-backs the fit of each slave point begins.

  Not collective

  Input Parameters:
+ s     - the search
- first - of each slave point of this rank, RUNG_PLAIN to RUNGS, where it has no fit; borrowed, read by each search
@*/
void SearchSetRungs(ContactSearch s, const int *first)
{
  s->first_rung = first;
}

/*@
  SearchSetFrames - has fits keep the direction of their frames.

  Not collective

  Input Parameters:
+ s    - the search
- kept - of each slave point of this rank, kept[3*n]: normal of the frame that its fit keeps, on the side of the slave;
         0 where the search chooses it; borrowed, read by each search
@*/
void SearchSetFrames(ContactSearch s, const PetscReal *kept)
{
  s->kept = kept;
}

/*@
  SearchLists - lists for every slave point of this rank the facets near it and the points of which these are made, from
  whatever rank.

  Collective

  Input Parameters:
+ s      - the search
. u      - local displacements u[mesh n_nodes*dim] (length), ghosts included
. t      - load parameter, for rigid tools
- motion - relative motion (length) for which the lists must be good

  Output Parameter:
. out - the lists, to be freed with NeighbourListsDestroy()

  Note:
  Facets are listed if they face the slave and lie within SEARCH_MARGIN of the nearest one, provided that this lies
  within SEARCH_REACH; the motion, or what SearchSetBefore() tells of it, is added to both. Order and content do not
  depend on the ranks.
@*/
PetscErrorCode SearchLists(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion, NeighbourLists *out)
{
  const PetscReal distance = SearchListsDistance(s, motion);
  const PetscBool partners = SearchHasPartners(s);
  PetscReal       box[6], *normals;
  SearchField     field;
  NeighbourLists  lists;
  FitSupport      fit;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&lists));
  lists->t = NAN; /* not updated yet */
  ToolsPlace(s->mesh, u, t);
  PetscCall(WayBegin(s, u, t, motion));
  PetscCall(PetscMalloc1(3 * s->slaves->n, &normals));
  if (partners) PetscCall(SearchPartners(s, u, t, motion, normals));
  lists->empty = (PetscBool)(partners && !s->partners.any);
  PetscCall(NeighbourListsChoosePoints(s, lists));
  SearchSlaveBox(s, box);
  PetscCall(SearchFieldCreate(s, u, t, box, distance, (PetscBool)(s->fit->fitted && (!partners || s->partners.any)),
                              lists, &field));
  PetscCall(NeighbourListsCreateSlaves(s, lists));
  if (!partners) PetscCall(SlavePointsNormals(s->slaves, s->n_images, s->images, u, NULL, normals));
  for (PetscInt i = 0; i < lists->n_near; i++)
    PetscCall(PetscArraycpy(&lists->slave_normal[3 * lists->near[i]], &normals[3 * lists->near[i]], 3));
  PetscCall(PetscFree(normals));
  if (s->master) PetscCall(SlavePointsFindEnds(s->slaves, u));
  if (s->fit->fitted) PetscCall(FitSupportCreate(s, lists, &field, &fit));
  if (s->fit->fitted && s->fit->global_frame)
    PetscCall(SurfaceMeanNormal(s->master, s->loads, s->n_images, s->images, u, t, fit.plane, NULL));
  PetscCall(NeighbourListsFindAlike(lists));
  PetscCall(NeighbourListsFill(s, lists, &field, s->fit->fitted ? &fit : NULL, motion));
  PetscCall(WayEnd(s));
  if (s->fit->fitted) PetscCall(FitSupportDestroy(&fit));
  if (s->keeps_faces) PetscCall(NeighbourListsTakeFaces(lists, &field));
  PetscCall(NeighbourListsFindMoving(lists));
  PetscCall(NeighbourListsUpdate(s, lists, u, t, NULL));
  for (PetscInt i = 0; i < lists->n_near; i++)
    NeighbourListsCentre(lists, lists->near[i], &lists->centre[2 * lists->near[i]]);
  PetscCall(SearchFieldDestroy(&field));
  *out = lists;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchDistance - computes the signed distance (length) of any point to the whole master, without its mirror images.

  Collective

  Input Parameters:
+ s - the search
. u - local displacements u[mesh n_nodes*dim] (length), ghosts included
. t - load parameter, for rigid tools
- x - the point, relative to the mesh's centre

  Output Parameter:
. gap - the distance, the same on all ranks

  Note:
  Every rank examines its own facets.
@*/
PetscErrorCode SearchDistance(ContactSearch s, const PetscReal *u, PetscReal t, const PetscReal x[3], PetscReal *gap)
{
  Mesh      mesh = s->mesh;
  const int dim  = mesh->dim;
  PetscInt  n    = s->master->rigid ? s->master->rigid->n_nodes : mesh->n_nodes;
  double   *relative;
  Foot      foot;
  struct {
    double distance;
    int    rank;
  } mine = {PETSC_MAX_REAL, 0}, least;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
  ToolsPlace(mesh, u, t);
  PetscCall(PetscMalloc1(n * dim, &relative));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal y[3] = {0, 0, 0};

    if (s->master->rigid) SearchRigidPosition(s, i, t, y);
    for (int d = 0; d < dim; d++)
      relative[i * dim + d] = (s->master->rigid ? y[d] : mesh->coords[i * dim + d] + u[i * dim + d]) - x[d];
  }
  if (FacetClosest(dim, (int)s->master->n_faces, s->master->faces, relative, -1, &foot)) {
    mine.distance = PetscSqrtReal(PetscSqr(foot.gap) + PetscSqr(foot.beyond));
    *gap          = foot.gap;
  }
  PetscCallMPI(MPI_Allreduce(&mine, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, mesh->comm));
  PetscCallMPI(MPI_Bcast(gap, 1, MPIU_REAL, least.rank, mesh->comm));
  PetscCall(PetscFree(relative));
  PetscFunctionReturn(PETSC_SUCCESS);
}
