/* The certificate of a run, see certificate.h. */
#include "certificate/certificate.h"
#include "analytic.h"
#include "base/timing.h"
#include "mesh/pressurenodes.h"
#include "search/freeedge.h"
#include <string.h>

/* A node is at the end of a surface if it is nearer to a free edge than this part of the mean size of the faces: the
   node in the middle of an edge that turns by 45 degrees is off the chord by a tenth of it, and other nodes are
   further. */
#define CERTIFICATE_AT_END 0.1

/* Room for the name of a surface in a message. The scene allows 127 characters. */
enum { SURFACE_NAME = 128 };

/* The two sides of one contact pair */
typedef struct {
  int          pair;
  ContactSides of;
  Side         side[2]; /* the second is NULL where the master is analytic */
  PieceList    near[2]; /* pieces of each side that come near this rank's part of the other one */
  PieceList    beside;  /* pieces of a tool that is judged, where it comes near the other side */
  PetscBool    apart;   /* nothing pressed at either state of the step */
} CertifiedPair;

struct _n_Certificate {
  Mesh               mesh;
  Scene              scene;
  Loads              loads;
  Contact            contact;
  int                n;
  CertifiedPair     *pairs;
  PetscReal         *pressed;   /* of each node of the mesh, of one pair */
  Look               look, own; /* at the other side; at the side that is judged, if that is a tool */
  CertificateFigures figures;
};

/*@
  CertificateCreate - prepares the certificate of all pairs.

  Collective

  Input Parameters:
+ mesh    - the mesh
. scene   - gives the allowed penetration
. loads   - give the places of tools
- contact - the contact

  Output Parameter:
. out - free it with CertificateDestroy()

  Note:
  All arguments are borrowed. Two pairs that treat the same surfaces from both sides are judged once.
@*/
PetscErrorCode CertificateCreate(Mesh mesh, Scene scene, Loads loads, Contact contact, Certificate *out)
{
  Certificate certificate;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&certificate));
  certificate->mesh    = mesh;
  certificate->scene   = scene;
  certificate->loads   = loads;
  certificate->contact = contact;
  PetscCall(PetscCalloc2(ContactPairs(contact), &certificate->pairs, mesh->n_nodes, &certificate->pressed));
  for (int p = 0; p < ContactPairs(contact); p++) {
    CertifiedPair *pair    = &certificate->pairs[certificate->n];
    const int      partner = ContactPairPartner(contact, p);

    if (partner >= 0 && partner < p) continue;
    pair->pair = p;
    ContactPairSides(contact, p, &pair->of);
    PetscCall(SideCreate(pair->of.slave, loads, pair->of.n_mirrors, pair->of.mirrors, &pair->side[0]));
    if (pair->of.master && partner != p)
      PetscCall(SideCreate(pair->of.master, loads, pair->of.n_mirrors, pair->of.mirrors, &pair->side[1]));
    if (partner == p) pair->side[1] = pair->side[0];
    certificate->n++;
  }
  *out = certificate;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CertificateDestroy - frees the certificate.

  Collective

  Input/Output Parameter:
. certificate - NULL on return; may be NULL before
@*/
PetscErrorCode CertificateDestroy(Certificate *certificate)
{
  PetscFunctionBeginUser;
  if (!*certificate) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < (*certificate)->n; k++) {
    CertifiedPair *pair = &(*certificate)->pairs[k];

    if (pair->side[1] != pair->side[0]) PetscCall(SideDestroy(&pair->side[1]));
    PetscCall(SideDestroy(&pair->side[0]));
    for (int s = 0; s < 2; s++) PetscCall(PetscFree(pair->near[s].pieces));
    PetscCall(PetscFree(pair->beside.pieces));
  }
  LookDestroy(&(*certificate)->look);
  LookDestroy(&(*certificate)->own);
  PetscCall(PetscFree2((*certificate)->pairs, (*certificate)->pressed));
  PetscCall(PetscFree(*certificate));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes a finding if it is worse than the worst one so far. The largest depth over the face counts in any case. */
static PetscBool TakeFinding(const Finding *here, Finding *worst)
{
  const PetscReal over_h = PetscMax(here->over_h, worst->over_h);
  const PetscBool worse  = (PetscBool)FindingWorse(here, worst);

  if (worse) *worst = *here;
  worst->over_h = over_h;
  return worse;
}

/* Begins the search in a list of pieces. */
static PetscErrorCode BeginLook(int dim, const PieceList *list, Look *look)
{
  PetscFunctionBeginUser;
  PetscCheck(LookBegin(dim, list, look), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for %" PetscInt_FMT " faces",
             list->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the pieces of the side s itself, if it is a rigid tool, as far as a chord of the other one from where the two
   are near each other. `near` is the box of this rank's part of it. The shape of a deformable side explains nothing: a
   fine one swells between the nodes of a coarse one. */
static PetscErrorCode LookBeside(Certificate certificate, CertifiedPair *pair, int s, const Box near)
{
  const PieceList *list   = &pair->near[1 - s];
  const PetscReal  margin = pair->side[s]->surface->max_extent + certificate->look.overlap;
  Box              beside;

  PetscFunctionBeginUser;
  certificate->look.own = NULL;
  if (!pair->side[s]->surface->rigid) PetscFunctionReturn(PETSC_SUCCESS);
  BoxAround(0, NULL, beside);
  for (PetscInt k = 0; k < list->n; k++) {
    const Piece    *piece  = &list->pieces[k];
    const PetscReal extent = margin + piece->order * piece->side; /* as it is stretched */

    for (int d = 0; d < 3; d++) {
      beside[d]     = PetscMin(beside[d], PetscMax(near[d], piece->box[d]) - extent);
      beside[3 + d] = PetscMax(beside[3 + d], PetscMin(near[3 + d], piece->box[3 + d]) + extent);
    }
  }
  PetscCall(SideShare(pair->side[s], beside, pair->of.n_images, pair->of.images, &pair->beside));
  if (!list->n || !pair->beside.n) PetscFunctionReturn(PETSC_SUCCESS);
  certificate->own.dim    = pair->side[s]->dim;
  certificate->own.list   = &pair->beside;
  certificate->own.failed = 0;
  certificate->look.own   = &certificate->own;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Judges points and edges of one side against the pieces of the other one. Crossings of edges are seen from the
   slave's side alone. */
static PetscErrorCode JudgeSide(Certificate certificate, CertifiedPair *pair, int s, PetscReal overlap, Finding *worst)
{
  const Side own  = pair->side[s];
  PieceList *list = &pair->near[1 - s];
  Look      *look = &certificate->look;
  Finding    here = {.kind = FINDING_NONE};
  Box        near;

  PetscFunctionBeginUser;
  SideBox(own, near);
  PetscCall(SideShare(pair->side[1 - s], near, pair->of.n_images, pair->of.images, list));
  look->overlap = overlap;
  PetscCall(LookBeside(certificate, pair, s, near));
  if (!list->n) PetscFunctionReturn(PETSC_SUCCESS);
  look->penetration = certificate->scene->certificate.penetration;
  look->walls       = pair->of.scene->listed;
  look->apart       = pair->apart;
  for (int k = 0; k < 2; k++) {
    const int side = k ? 1 - s : s;

    look->slave[k] = !pair->side[side]->surface->rigid && (side == 0 || pair->of.scene->listed);
  }
  PetscCall(BeginLook(own->dim, list, look));
  for (PetscInt i = 0; i < own->n_points; i++) PointFinding(look, &own->points[i], &here);
  for (PetscInt i = 0; i < own->n_edges; i++) EdgeFinding(look, &own->edges[i], s == 0, &here);
  here.side = s;
  TakeFinding(&here, worst);
  if (look->own) LookEnd(&certificate->own);
  LookEnd(look);
  PetscCheck(!look->failed && !certificate->own.failed, PETSC_COMM_SELF, PETSC_ERR_MEM,
             "No memory for the faces that a node crosses");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Can the two sides have met in the step? The same on all ranks. */
static PetscBool SidesMeet(const CertifiedPair *pair, PetscReal overlap)
{
  const MPI_Comm comm  = pair->side[0]->surface->mesh->comm;
  PetscReal      reach = overlap;
  Box            box[2], image;

  for (int s = 0; s < 2; s++) {
    SideBox(pair->side[s], box[s]);
    BoxJoin(comm, box[s]);
    reach = PetscMax(reach, pair->side[s]->surface->max_extent);
  }
  if (BoxesMeet(box[0], box[1], reach)) return PETSC_TRUE;
  for (int m = 1; m < pair->of.n_images; m++) {
    Place corner[2], to[2] = {{0}};

    for (int k = 0; k < 2; k++)
      for (int d = 0; d < 3; d++) corner[k][d] = box[1][3 * k + d];
    for (int k = 0; k < 2; k++) SurfaceReflect(&pair->of.images[m], pair->side[1]->dim, corner[k], to[k]);
    BoxAround(2, (const Place *)to, image);
    if (!pair->of.images[m].left_out && BoxesMeet(box[0], image, reach)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Judges the slave against an analytic tool. Its free components are those of the second state at last. */
static void JudgeAnalytic(Certificate certificate, const CertifiedPair *pair, const PetscReal *const u[2],
                          const PetscReal t[2], PetscReal overlap, Finding *worst)
{
  const SceneContact *scene = pair->of.scene;
  const Side          slave = pair->side[0];
  AnalyticTool        tool  = {.dim         = slave->dim,
                               .surface     = scene->analytic,
                               .penetration = certificate->scene->certificate.penetration,
                               .overlap     = overlap,
                               .apart       = pair->apart};

  for (int state = 0; state < 2; state++) {
    ToolsPlace(certificate->mesh, u[state], t[state]);
    MotionPlace(&scene->motion, t[state], scene->motion.point, tool.point[state]);
    for (int d = 0; d < 3; d++)
      tool.point[state][d] = d < slave->dim ? tool.point[state][d] - certificate->mesh->centre[d] : 0;
    MotionTurn(&scene->motion, t[state], scene->analytic.axis, tool.axis[state]);
  }
  for (PetscInt i = 0; i < slave->n_points; i++) AnalyticPointFinding(&tool, &slave->points[i], worst);
  for (PetscInt k = 0; k < slave->n_pieces; k++) AnalyticPieceFinding(&tool, &slave->pieces[k], worst);
}

/* Finds where terms of a pair pressed, and the overlap that the scene leaves in it. */
static PetscErrorCode FindPressed(Certificate certificate, const CertifiedPair *pair, PetscReal t, PetscReal *overlap)
{
  const int partner = ContactPairPartner(certificate->contact, pair->pair);
  PetscReal other   = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(certificate->pressed, certificate->mesh->n_nodes));
  PetscCall(ContactPairPressed(certificate->contact, pair->pair, certificate->pressed));
  PetscCall(ContactPairOverlap(certificate->contact, pair->pair, t, overlap));
  if (partner >= 0 && pair->side[1] != pair->side[0]) {
    PetscCall(ContactPairPressed(certificate->contact, partner, certificate->pressed));
    PetscCall(ContactPairOverlap(certificate->contact, partner, t, &other));
  }
  *overlap = PetscMax(*overlap, other);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds whether a pair and its partner pressed nowhere at either state. */
static PetscErrorCode FindApart(Certificate certificate, CertifiedPair *pair)
{
  const int partner = ContactPairPartner(certificate->contact, pair->pair);

  PetscFunctionBeginUser;
  PetscCall(ContactPairApart(certificate->contact, pair->pair, &pair->apart));
  if (pair->apart && partner >= 0) PetscCall(ContactPairApart(certificate->contact, partner, &pair->apart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a pair is wholly there at t. Else its surfaces may pass through each other. */
static PetscBool IsThere(const CertifiedPair *pair, PetscReal t)
{
  const History *presence = &pair->of.scene->presence;

  return (PetscBool)(!presence->n || HistoryValue(presence, t) == 1);
}

/* Judges whether faces of one deformable side fold over themselves. */
static void JudgeFolds(const Side side, int s, Finding *worst)
{
  const ContactSurface surface = side->surface;
  Finding              here    = {.kind = FINDING_NONE};
  PetscInt             first   = 0;

  for (PetscInt f = 0; f < surface->n_faces && !surface->rigid; f++) {
    int       node[PIECE_MAX][3];
    const int n = PieceDivide(surface->faces[f].type, node);

    FoldFinding(side->dim, n, &side->pieces[first], &here);
    first += n;
  }
  here.side = s;
  TakeFinding(&here, worst);
}

/* Judges one pair on this rank. */
static PetscErrorCode JudgePair(Certificate certificate, CertifiedPair *pair, const PetscReal *const u[2],
                                const PetscReal t[2], Finding *worst)
{
  const int sides = pair->side[1] && pair->side[1] != pair->side[0] ? 2 : 1;
  PetscReal overlap;

  PetscFunctionBeginUser;
  PetscCall(FindPressed(certificate, pair, t[1], &overlap));
  for (int s = 0; s < sides; s++) {
    PetscCall(SideMove(pair->side[s], u, t));
    JudgeFolds(pair->side[s], s, worst);
  }
  if (pair->side[1] && !SidesMeet(pair, overlap)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindApart(certificate, pair));
  for (int s = 0; s < sides; s++) PetscCall(SideMeasure(pair->side[s], certificate->pressed));
  if (!pair->side[1]) JudgeAnalytic(certificate, pair, u, t, overlap, worst);
  for (int s = 0; s < sides && pair->side[1]; s++) PetscCall(JudgeSide(certificate, pair, s, overlap, worst));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The worst finding of all ranks, and the number of its pair. */
static PetscErrorCode WorstOfAll(MPI_Comm comm, Finding *worst, int *pair)
{
  typedef struct {
    Finding finding;
    int     pair;
  } Sent;
  const Sent  mine = {*worst, *pair};
  Sent       *all;
  PetscMPIInt ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  if (ranks == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(ranks, &all));
  PetscCallMPI(MPI_Allgather(&mine, sizeof(mine), MPI_BYTE, all, sizeof(mine), MPI_BYTE, comm));
  *worst = all[0].finding;
  *pair  = all[0].pair;
  for (int r = 1; r < ranks; r++)
    if (TakeFinding(&all[r].finding, worst)) *pair = all[r].pair;
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether anything presses in a pair or its partner. */
static PetscErrorCode Presses(Certificate certificate, int pair, PetscBool *presses)
{
  const int partner = ContactPairPartner(certificate->contact, pair);
  PetscInt *label, closed, other = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(certificate->mesh->n_nodes, &label));
  PetscCall(ContactPairClosed(certificate->contact, pair, label, 1, &closed));
  if (partner >= 0) PetscCall(ContactPairClosed(certificate->contact, partner, label, 1, &other));
  *presses = (PetscBool)(closed + other > 0);
  PetscCall(PetscFree(label));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a slave node that stands too deep lies where the slave ends, and nothing holds it: what the body has
   beside it bulges against the master without a contact term. */
static PetscErrorCode IsAtEnd(Certificate certificate, const Finding *finding, const ContactSides *of, PetscBool *ends)
{
  const Mesh  mesh = certificate->mesh;
  FreeEdges   edges;
  PetscReal   X[3] = {0};
  PetscMPIInt held = 0;

  PetscFunctionBeginUser;
  *ends = PETSC_FALSE;
  if (finding->kind != FINDING_DEPTH || finding->tag[0] < 0 || finding->tag[1] || finding->side)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    if (mesh->node_tag[n] != finding->tag[0] || IsPressureNode(mesh, n)) continue;
    for (int d = 0; d < mesh->dim; d++) held = held || LoadsPrescribed(certificate->loads, n * mesh->dim + d);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPI_INT, MPI_MAX, mesh->comm));
  if (held) PetscFunctionReturn(PETSC_SUCCESS);
  for (int d = 0; d < mesh->dim; d++) X[d] = finding->X[d] + mesh->centre[d];
  PetscCall(FreeEdgesCreate(mesh, certificate->scene, of->scene, of->slave->group, &edges));
  *ends = (PetscBool)(FreeEdgesDistance(edges, X) <= CERTIFICATE_AT_END * of->slave->mean_size);
  PetscCall(FreeEdgesDestroy(&edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes which face has folded, and where. */
static PetscErrorCode DescribeFold(Certificate certificate, const Finding *finding, int pair, char *text, size_t size)
{
  const PetscReal *centre = certificate->mesh->centre;
  char             about[96];
  ContactSides     of;

  PetscFunctionBeginUser;
  ContactPairSides(certificate->contact, pair, &of);
  if (finding->tag[1])
    PetscCall(
      PetscSNPrintf(about, sizeof(about), "the line of the nodes %ld and %ld", finding->tag[0], finding->tag[1]));
  else
    PetscCall(PetscSNPrintf(about, sizeof(about), "node %ld", finding->tag[0]));
  PetscCall(PetscSNPrintf(text, size, "contact '%s': face %ld of '%s' folds over itself about %s (%.5g, %.5g, %.5g)",
                          ContactPairName(certificate->contact, pair), finding->face,
                          finding->side && of.scene->master ? of.scene->master : of.scene->slave, about,
                          (double)(finding->X[0] + centre[0]), (double)(finding->X[1] + centre[1]),
                          (double)(finding->X[2] + centre[2])));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes who did what: nodes, face, place, and the surfaces of both. */
static PetscErrorCode Describe(Certificate certificate, const Finding *finding, int pair, char *text, size_t size)
{
  static const char *const what[FINDING_KINDS] = {[FINDING_DEPTH]  = "stands",
                                                  [FINDING_PASSED] = "has passed through without contact,",
                                                  [FINDING_EDGES]  = "has crossed an edge and is"};
  const PetscReal         *centre              = certificate->mesh->centre;
  const PetscBool          tool                = (PetscBool)(finding->tag[0] < 0);
  const long long          first               = tool ? -1 - finding->tag[0] : finding->tag[0],
                  second                       = tool ? -1 - finding->tag[1] : finding->tag[1];
  char         who[96], face[64 + SURFACE_NAME] = "the tool";
  ContactSides of;
  PetscBool    presses = PETSC_FALSE, ends;

  PetscFunctionBeginUser;
  ContactPairSides(certificate->contact, pair, &of);
  PetscCall(Presses(certificate, pair, &presses));
  PetscCall(IsAtEnd(certificate, finding, &of, &ends));
  if (finding->tag[1])
    PetscCall(PetscSNPrintf(who, sizeof(who), "the edge of the nodes %lld and %lld", first, second));
  else
    PetscCall(PetscSNPrintf(who, sizeof(who), "node %lld", first));
  if (finding->face)
    PetscCall(PetscSNPrintf(face, sizeof(face), "face %ld of '%s'", finding->face,
                            finding->side || !of.scene->master ? of.scene->slave : of.scene->master));
  PetscCall(PetscSNPrintf(
    text, size, "contact '%s': %s (%.5g, %.5g, %.5g) of '%s' %s %.3g deep, at %s; allowed are %.3g%s%s",
    ContactPairName(certificate->contact, pair), who, (double)(finding->X[0] + centre[0]),
    (double)(finding->X[1] + centre[1]), (double)(finding->X[2] + centre[2]),
    finding->side && of.scene->master ? of.scene->master : of.scene->slave, what[finding->kind], finding->depth, face,
    finding->allowed, finding->kind == FINDING_EDGES && !presses ? "; an edge against an edge has no contact" : "",
    ends ? "; the slave ends there, and what the body has beside it has no contact" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CertificateCheck - judges the step from the accepted state to a converged solution.

  Collective

  Input Parameters:
+ certificate - may be NULL: then every step holds
. u_0         - local displacements of the accepted state, u_0[n_nodes*dim], ghosts included (length)
. t_0         - its load parameter
. u           - of the solution, which contact was evaluated at last
. t           - its load parameter
- size        - of the text

  Output Parameters:
+ holds  - the same on all ranks, and on any number of them
. excess - if the step does not hold because of a depth: this depth over what is allowed; else INFINITY
- text   - what was found and where, if the step does not hold
@*/
PetscErrorCode CertificateCheck(Certificate certificate, const PetscReal *u_0, PetscReal t_0, const PetscReal *u,
                                PetscReal t, PetscBool *holds, PetscReal *excess, char *text, size_t size)
{
  const PetscReal *const states[2] = {u_0, u};
  const PetscReal        ts[2]     = {t_0, t};
  Finding                worst     = {.kind = FINDING_NONE};
  CertificateFigures    *figures;
  int                    pair = -1;

  PetscFunctionBeginUser;
  *holds  = PETSC_TRUE;
  *excess = INFINITY;
  if (!certificate) PetscFunctionReturn(PETSC_SUCCESS);
  TimingBegin(TIMING_CERTIFICATE);
  for (int k = 0; k < certificate->n; k++) {
    Finding here = {.kind = FINDING_NONE};

    if (!IsThere(&certificate->pairs[k], t_0) || !IsThere(&certificate->pairs[k], t)) continue;
    PetscCall(JudgePair(certificate, &certificate->pairs[k], states, ts, &here));
    if (TakeFinding(&here, &worst) || pair < 0) pair = certificate->pairs[k].pair;
  }
  ToolsPlace(certificate->mesh, u, t);
  PetscCall(WorstOfAll(certificate->mesh->comm, &worst, &pair));
  *holds  = (PetscBool)(worst.kind == FINDING_NONE);
  *excess = worst.kind == FINDING_DEPTH ? worst.ratio : INFINITY;
  figures = &certificate->figures;
  figures->steps++;
  figures->refused += !*holds;
  if (*holds) {
    figures->over_h = PetscMax(figures->over_h, worst.over_h);
    figures->ratio  = PetscMax(figures->ratio, worst.ratio);
  } else {
    PetscCall((worst.kind == FINDING_FOLDED ? DescribeFold : Describe)(certificate, &worst, pair, text, size));
  }
  TimingEnd(TIMING_CERTIFICATE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CertificateBalance - takes what is out of balance in an accepted state. The largest parts of the run are kept.

  Not collective

  Input Parameters:
+ certificate - the certificate
. force       - part of the outer forces that is out of balance, the same on all ranks
- moment      - the same of moments; NaN: there are none
@*/
void CertificateBalance(Certificate certificate, PetscReal force, PetscReal moment)
{
  CertificateFigures *figures = &certificate->figures;

  figures->force = PetscMax(figures->force, force);
  if (!PetscIsNanReal(moment)) figures->moment = PetscMax(figures->moment, moment);
}

/*@
  CertificateGetFigures - returns what was found so far.

  Not collective

  Input Parameter:
. certificate - may be NULL: then nothing was judged

  Output Parameter:
. figures - the same on all ranks
@*/
void CertificateGetFigures(Certificate certificate, CertificateFigures *figures)
{
  const CertificateFigures none = {.over_h = NAN, .ratio = NAN, .force = NAN, .moment = NAN};

  *figures = certificate ? certificate->figures : none;
}

/*@
  CertificateArchive - saves or loads the figures of the run so far.

  Collective

  Input Parameters:
+ certificate - may be NULL: then nothing is done
- archive     - decides whether they are saved or loaded
@*/
PetscErrorCode CertificateArchive(Certificate certificate, Archive archive)
{
  CertificateFigures none = {0}, *figures = certificate ? &certificate->figures : &none;
  PetscReal         *real[]    = {&figures->over_h, &figures->ratio, &figures->force, &figures->moment};
  PetscInt          *integer[] = {&figures->steps, &figures->refused};

  PetscFunctionBeginUser;
  PetscCall(ArchiveRealsAt(archive, "certificate/depths", PETSC_STATIC_ARRAY_LENGTH(real), real));
  PetscCall(ArchiveIntegersAt(archive, "certificate/counts", PETSC_STATIC_ARRAY_LENGTH(integer), integer));
  PetscFunctionReturn(PETSC_SUCCESS);
}
