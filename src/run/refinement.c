/* The loop over meshes of a run that is to reach an accuracy, see refinement.h. */
#include "refinement.h"
#include <math.h>
#include "errors/contactzone.h"
#include "errors/elementsizes.h"
#include "files/textfile.h"
#include "mesh/meshdensities.h"
#include "mesh/meshsizes.h"
#include "meshplan.h"
#include "base/explanation.h"
#include "base/refusal.h"

/* Of the error that is allowed the next mesh is made for this part: forecasts are not exact. */
#define REFINEMENT_AIM 0.85
/* Where other causes leave less than this part of the allowed error to the mesh, it is made for this part. */
#define REFINEMENT_LEAST_SHARE 0.25

/* A mesh with sizes of its own has at most so many times the elements of the last one. */
#define REFINEMENT_MOST_ELEMENTS 8
/* It is made for at most this part of the present error, or the change of the answer would hardly tell anything. */
#define REFINEMENT_PART 0.5
/* An element becomes at most so many times larger from one mesh to the next. */
#define REFINEMENT_LARGER 2
/* Sizes are scaled by at least this, over all meshes. */
#define REFINEMENT_LEAST_SCALE 0.5
/* Elements of second order are tried where the limits allow a mesh of elements so many times smaller, which has as many
   unknowns. */
#define REFINEMENT_ORDER_ROOM 2
/* CPU seconds that are left where there are none: no mesh takes so few (s). */
#define REFINEMENT_NO_TIME 1e-9
/* A mesh that only is to confirm the estimate has elements so many times smaller, all of them: an estimate that misses
   a place is not to choose where. */
#define REFINEMENT_WITNESS 1.5

/* Penalties that the run has made stiffer by less than this begin on the next mesh as they did on the last one. */
#define REFINEMENT_STIFFER 1.01

enum { TABLE_ROW = 1024, EDIT_LENGTH = 2 * PETSC_MAX_PATH_LEN };

/* A mesh that was solved */
typedef struct {
  QuantityError error;
  PetscReal     value, mesh_s;
  ContactZone   zone;
  PetscReal     unseen; /* error of the zone that no estimate sees; NaN: not known */
  int           known;  /* changes up to it that tell something, one after the other */
  PetscReal implied; /* error of the elements and surfaces by the change of the answer; NaN: there is no mesh before */
  PetscInt  dofs;
  double    factor; /* its elements are smaller by it than those of the first mesh */
  int       order;
  PetscBool foretold; /* the change from the mesh before was forecast */
  PetscBool rough;    /* there is no estimate of the elements and surfaces, only the change of the answer */
} SolvedMesh;

typedef struct {
  Run          *run;
  RunInput      input; /* of the next mesh */
  SceneAccuracy wish;
  const char   *probe;
  char          directory[PETSC_MAX_PATH_LEN];
  int           dim, order, n_densities, n_given; /* edits that the user gave */
  MeshDensity  *density;
  PetscBool     structured; /* meshes follow densities, else sizes of elements in a file */
  PetscBool     even;       /* all elements of the next mesh are smaller by the same factor */
  PetscReal    *size;       /* wanted of the next mesh at each local cell of the last one */
  int           n_meshing, n_edits;
  char        **edit;             /* of each density, or of the file of sizes; of the order; of each entry's penalty */
  PetscBool     tries_order;      /* the next mesh has elements of second order in the place of those of the last one */
  PetscBool     chooses, may_try; /* the order is for the run to choose; it has not tried the second one yet */
  double        wanted;           /* cells that the sizes of the next mesh should give; 0: not by sizes */
  double        scale;            /* on sizes: gmsh makes fewer cells than they ask for, in space */
  PetscInt      cells;            /* of the first mesh */
  int           n, n_plan;
  MeshFigures  *figures, *plan; /* of each mesh; of those after which the next one is planned: they have its order */
  SolvedMesh   *mesh;
  double        cpu_s; /* spent before the present mesh */
  PetscMPIInt   rank;
  const char   *why;         /* it ends without the accuracy */
  char          reason[256]; /* what that may point to */
} Refinement;

static void Say(const Refinement *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints a line on the terminal unless the user wants none. */
static void Say(const Refinement *r, const char *format, ...)
{
  va_list arguments;

  if (r->rank || r->input.quiet) return;
  va_start(arguments, format);
  vfprintf(stdout, format, arguments);
  va_end(arguments);
  fflush(stdout);
}

/* A part, 0 where it is not known. */
static PetscReal KnownPart(const QuantityError *error, ErrorCause cause)
{
  return isnan((double)error->part[cause]) ? 0 : error->part[cause];
}

/* What the shape of the contact surfaces and contact within their faces leave, as estimated. */
static PetscReal SurfacesEstimate(const QuantityError *error)
{
  return PetscAbsReal(KnownPart(error, ERROR_GEOMETRY)) + PetscAbsReal(KnownPart(error, ERROR_FACES));
}

/* What the elements and the contact surfaces leave of error, as estimated. */
static PetscReal MeshEstimate(const QuantityError *error)
{
  return isnan((double)error->part[ERROR_BODIES]) ? 0
                                                  : PetscAbsReal(error->part[ERROR_BODIES]) + SurfacesEstimate(error);
}

/* What they leave: the estimate, and no less than what the change from the mesh before implies. */
static PetscReal MeshError(const SolvedMesh *mesh)
{
  const PetscReal estimate = MeshEstimate(&mesh->error);

  return isnan((double)mesh->implied) ? estimate : PetscMax(estimate, mesh->implied);
}

/* What the other causes leave. */
static PetscReal OtherError(const SolvedMesh *mesh)
{
  return mesh->error.magnitude - MeshEstimate(&mesh->error);
}

/* The error of a mesh over the value. */
static PetscReal Error(const SolvedMesh *mesh)
{
  return (OtherError(mesh) + MeshError(mesh)) / PetscAbsReal(mesh->value);
}

static const SolvedMesh *Last(const Refinement *r)
{
  return &r->mesh[r->n - 1];
}

/* What the next mesh may leave of error, in the units of the probe. */
static PetscReal WantedMeshError(const Refinement *r)
{
  const SolvedMesh *mesh    = Last(r);
  const PetscReal   allowed = r->wish.to * PetscAbsReal(mesh->value);

  return REFINEMENT_AIM * PetscMax(allowed - OtherError(mesh), REFINEMENT_LEAST_SHARE * allowed);
}

/* Number of the entry of the scene that a pair stands for. How many pairs a list has may differ from mesh to mesh. */
static int EntryOf(const SceneContact *pair)
{
  return atoi(strrchr(pair->path, '.') + 1);
}

/* Makes room, and finds out how the mesh can be refined. */
static PetscErrorCode Begin(Run *run, const RunInput *input, Refinement *r)
{
  const SceneAccuracy *wish = &run->scene->accuracy;
  const char          *name = run->scene->probes[wish->probe].name;
  char                *copy;

  PetscFunctionBeginUser;
  *r         = (Refinement){.run   = run,
                            .input = *input,
                            .wish  = *wish,
                            .dim   = run->mesh->dim,
                            .order = run->mesh->order,
                            .scale = 1};
  r->n_given = input->n_set;
  PetscCallMPI(MPI_Comm_rank(run->comm, &r->rank));
  PetscCall(PetscStrallocpy(name, &copy));
  r->probe = copy;
  PetscCall(PetscStrncpy(r->directory, run->directory, sizeof(r->directory)));
  *strrchr(r->directory, '/') = '\0';
  PetscCall(MeshDensitiesFind(run->comm, run->scene, input->trust, &r->n_densities, &r->density, &r->structured));
  if (r->structured && !r->n_densities)
    PetscCall(RefuseInput(run->comm,
                          "%s: '%s' declares no parameter that refines its mesh; allowed: names of them in "
                          "accuracy.densities",
                          SceneWhere(run->scene, "accuracy", NULL), run->scene->mesh_file));
  r->n_meshing = r->structured ? r->n_densities : 1;
  r->n_edits   = r->n_meshing + 1;
  if (run->scene->n_contacts) r->n_edits += EntryOf(&run->scene->contacts[run->scene->n_contacts - 1]) + 1;
  r->chooses = r->may_try = (PetscBool)(run->scene->order_chosen && r->order == 1);
  r->cells                = run->mesh->n_cells_global;
  PetscCall(PetscCalloc1(r->n_edits, &r->edit));
  PetscCall(PetscCalloc3(wish->meshes, &r->figures, wish->meshes, &r->plan, wish->meshes, &r->mesh));
  r->wish.densities = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frees what Begin() and Edit() have made. */
static PetscErrorCode End(Refinement *r)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < r->n_edits; i++) PetscCall(PetscFree(r->edit[i]));
  PetscCall(PetscFree(r->size));
  PetscCall(PetscFree(r->edit));
  PetscCall(PetscFree(r->density));
  PetscCall(PetscFree3(r->figures, r->plan, r->mesh));
  if (r->input.n_set > r->n_given) PetscCall(PetscFree(r->input.set));
  PetscCall(PetscFree(r->probe));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the elements and the shape of the contact surfaces leave of error, with its sign. Contact within faces is not in
   it: from mesh to mesh zones end anywhere within them, so that it forecasts no change. */
static PetscReal MeshPart(const QuantityError *error)
{
  return error->part[ERROR_BODIES] + KnownPart(error, ERROR_GEOMETRY);
}

/* The answer of a mesh without the errors of other causes than the mesh, as far as they are known. */
static PetscReal MeshAnswer(const SolvedMesh *mesh)
{
  const QuantityError *error = &mesh->error;

  return mesh->value + error->sum - (mesh->rough ? 0 : MeshPart(error) + KnownPart(error, ERROR_FACES));
}

/* Sum of the magnitudes of what single places leave, by which the fall of the error shows. */
static double Spread(const QuantityError *error)
{
  return (double)(error->spread + PetscAbsReal(KnownPart(error, ERROR_GEOMETRY)));
}

/* Takes what the change from the mesh before implies. Second order puts nodes half as far apart. Where it is more than
 * was estimated, so was it on that mesh. */
static void Compare(Refinement *r)
{
  SolvedMesh       *mesh    = &r->mesh[r->n];
  const SolvedMesh *before  = mesh - 1;
  MeshFigures      *figures = &r->figures[r->n], *last = r->n_plan ? &r->plan[r->n_plan - 1] : NULL;
  MeshChange        change;

  mesh->implied = mesh->unseen = NAN;
  mesh->foretold               = PETSC_FALSE;
  if (!r->n) return;
  change         = (MeshChange){.change   = (double)(MeshAnswer(mesh) - MeshAnswer(before)),
                                .before   = (double)MeshPart(&before->error),
                                .estimate = (double)MeshPart(&mesh->error),
                                .fall     = Spread(&mesh->error) / Spread(&before->error),
                                .finer    = r->tries_order ? 2 : mesh->factor / before->factor,
                                .zone     = mesh->zone.ends ? (double)(before->zone.size / mesh->zone.size) : 0,
                                .most     = Spread(&before->error) + (before->known ? (double)before->unseen : 0),
                                .allowed  = (double)(r->wish.to * PetscAbsReal(mesh->value)),
                                .known    = before->known,
                                .even     = r->even};
  mesh->implied  = (PetscReal)MeshPlanImplied(&change, before->order);
  mesh->unseen   = (PetscReal)MeshPlanUnseen(&change, before->order);
  mesh->foretold = (PetscBool)MeshPlanForetold(&change);
  mesh->known    = isnan((double)mesh->unseen) ? 0 : before->known + 1;
  figures->error = (double)MeshError(mesh);
  if (!isnan((double)mesh->implied)) last->error = fmax(last->error, (double)mesh->implied + fabs(change.change));
}

/* How much finer the elements of the present mesh are than those of the first one; planned: by densities. */
static double PresentFactor(Refinement *r, double planned)
{
  const double cells = (double)r->run->mesh->n_cells_global;

  if (r->structured) return planned;
  if (r->wanted > 0) r->scale *= fmax(pow(cells / r->wanted, 1.0 / r->dim), REFINEMENT_LEAST_SCALE);
  r->scale = fmin(fmax(r->scale, REFINEMENT_LEAST_SCALE), 1);
  return pow(cells / (double)r->cells, 1.0 / r->dim);
}

/* Chooses the order of the elements (of a probe without an estimate by the error of the energy) after a mesh of second
   order on the cells of one of first order: the one with which the error of the second mesh takes less time, as smooth
   solutions have it. */
static void ChooseOrder(Refinement *r)
{
  const MeshFigures *second = &r->figures[r->n];
  const SolvedMesh  *mesh   = &r->mesh[r->n];
  MeshFigures        first  = r->plan[r->n_plan - 1];
  const double       fall  = mesh->rough ? Spread(&mesh->error) / Spread(&mesh[-1].error) : second->error / first.error;
  const double       finer = MeshPlanFactor(1, &first, 1, fall * first.error) / first.factor;
  const double       cpu_s = MeshPlanForecast(1, &first, r->dim, 1, finer * first.factor).cpu_s;

  Say(r, "order   2 takes %.2g s for an error of %.2g %%, order 1 would take some %.2g s\n", second->cpu_s,
      100 * second->error / fabs((double)r->mesh[r->n].value), cpu_s);
  if (second->cpu_s <= cpu_s) {
    r->n_plan            = 0;
    r->plan[r->n_plan++] = *second;
  } else
    r->order = 1;
}

/* Takes the figures of the mesh that was solved last. */
static PetscErrorCode Record(Refinement *r, double planned)
{
  const double         factor = PresentFactor(r, planned);
  SolvedMesh          *mesh   = &r->mesh[r->n];
  const QuantityError *error;
  const char          *why;
  RunUsage             usage;

  PetscFunctionBeginUser;
  PetscCall(ResultsGetError(r->run->results, r->wish.probe, &mesh->value, &why, &error));
  if (!error->shared)
    PetscCall(RefuseInput(r->run->comm, "%s: the error of '%s' has no estimate: %s",
                          SceneWhere(r->run->scene, "accuracy", "probe"), r->probe, why));
  PetscCall(ResultsGetUsage(r->run->results, &usage));
  PetscCall(ModelDofs(r->run->model, &mesh->dofs));
  mesh->error       = *error;
  mesh->error.cells = NULL; /* they go with the run */
  mesh->mesh_s      = r->run->mesh_s;
  PetscCall(ContactZoneFind(r->run->model, NULL, &mesh->zone));
  mesh->rough      = (PetscBool)(why != NULL);
  mesh->factor     = factor;
  mesh->order      = r->run->mesh->order;
  r->figures[r->n] = (MeshFigures){.factor   = factor,
                                   .unknowns = (double)mesh->dofs,
                                   .error    = (double)MeshEstimate(error),
                                   .cpu_s    = (double)usage.cpu_s - r->cpu_s,
                                   .rss_mb   = (double)usage.peak_rss_mb};
  r->cpu_s         = (double)usage.cpu_s;
  Compare(r);
  if (r->tries_order)
    ChooseOrder(r);
  else
    r->plan[r->n_plan++] = r->figures[r->n];
  r->tries_order = PETSC_FALSE;
  r->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the last mesh. */
static void Print(const Refinement *r)
{
  const SolvedMesh *mesh = Last(r);
  const double      part = 100 / fabs((double)mesh->value);

  Say(r, "mesh %-2d  %" PetscInt_FMT " unknowns, %s %.6g, ", r->n, mesh->dofs, r->probe, (double)mesh->value);
  if (mesh->rough && r->n == 1)
    Say(r, "error not known before a second mesh");
  else
    Say(r, "error %.3g %% =", 100 * (double)Error(mesh));
  for (int c = 0; c < ERROR_CAUSES; c++)
    if (mesh->rough && isnan((double)mesh->error.part[c]))
      continue;
    else if (isnan((double)mesh->error.part[c]))
      Say(r, " %s not included", ErrorCauses[c]);
    else if (mesh->error.part[c] != 0)
      Say(r, " %s %+.2g", ErrorCauses[c], part * (double)mesh->error.part[c]);
  if (MeshError(mesh) > MeshEstimate(&mesh->error))
    Say(r, "; %.2g by the change from the mesh before", fabs(part) * (double)MeshError(mesh));
  if (r->n > 1 && isnan((double)mesh->implied)) Say(r, "; the mesh before is too coarse to confirm it");
  Say(r, "; CPU %.2f s, gmsh %.2f s\n", r->figures[r->n - 1].cpu_s, (double)mesh->mesh_s);
}

/* Writes accuracy.csv anew, with a row for each mesh. */
static PetscErrorCode Write(const Refinement *r)
{
  const size_t size = (size_t)(r->n + 1) * TABLE_ROW;
  char        *text;
  size_t       used = 0;

  PetscFunctionBeginUser;
  if (r->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(size, &text));
  used += (size_t)snprintf(text, size, "mesh,unknowns,value,error,magnitude");
  for (int c = 0; c < ERROR_CAUSES; c++) used += (size_t)snprintf(text + used, size - used, ",%s", ErrorCauses[c]);
  used += (size_t)snprintf(text + used, size - used, ",by_change,per_cent,cpu_s,gmsh_s,peak_rss_mb\n");
  for (int k = 0; k < r->n; k++) {
    const SolvedMesh *mesh = &r->mesh[k];

    used += (size_t)snprintf(text + used, size - used, "%d,%" PetscInt_FMT ",%.10g,%.6g,%.6g", k + 1, mesh->dofs,
                             (double)mesh->value, (double)mesh->error.sum, (double)mesh->error.magnitude);
    for (int c = 0; c < ERROR_CAUSES; c++)
      used += (size_t)snprintf(text + used, size - used, isnan((double)mesh->error.part[c]) ? "," : ",%.6g",
                               (double)mesh->error.part[c]);
    used +=
      (size_t)snprintf(text + used, size - used, isnan((double)mesh->implied) ? "," : ",%.6g", (double)mesh->implied);
    used += (size_t)snprintf(text + used, size - used, ",%.4g,%.3f,%.3f,%.1f\n", 100 * (double)Error(mesh),
                             r->figures[k].cpu_s, (double)mesh->mesh_s, r->figures[k].rss_mb);
  }
  PetscCall(TextFileReplace(r->directory, "accuracy.csv", text));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the sizes the scale with which gmsh makes as many cells as they ask for. more: cells, over the present ones. */
static void TakeScale(Refinement *r, double more)
{
  const Mesh mesh = r->run->mesh;

  r->wanted = more * (double)mesh->n_cells_global;
  for (PetscInt c = 0; c < mesh->n_cells; c++) r->size[c] *= (PetscReal)r->scale;
}

/* How many times larger an element may become. After a mesh that is finer everywhere an element does not become larger
   than it was before that one, whose answer would then be no witness of the next one. Where surfaces are in contact,
   what the first mesh says is not yet compared with anything; later ones are compared, and powers of sizes hold for
   elements that become smaller. Without an estimate of the probe the errors of the cells are those of the energy, and
   say nothing of what the probe needs: no element becomes larger. */
static PetscReal Largest(const Refinement *r)
{
  if (r->even) return REFINEMENT_WITNESS;
  return Last(r)->rough || (r->n > 1 && Last(r)->zone.size > 0) ? 1 : REFINEMENT_LARGER;
}

/* What the next mesh is to leave of the present errors. Without contact, and where the probe has no estimate, shares of
   the cells stand for all of it. */
static MeshWish WishedParts(const Refinement *r)
{
  const SolvedMesh *mesh   = Last(r);
  const PetscReal   wanted = WantedMeshError(r), surfaces = SurfacesEstimate(&mesh->error),
                  bodies = MeshEstimate(&mesh->error) - surfaces,
                  zone   = surfaces + (r->n == 1 || !mesh->zone.ends ? 0 : mesh->unseen);
  MeshWish split;

  if (mesh->rough || !(mesh->zone.size > 0))
    return (MeshWish){.bodies = fmin((double)wanted / r->plan[r->n_plan - 1].error, REFINEMENT_PART), .zone = 1};
  split = MeshPlanSplit((double)wanted, (double)bodies, (double)zone);
  if (r->n == 1 && mesh->zone.ends)
    split.zone = fmin(split.zone, MeshPlanResolve((double)ContactZoneLeft(&mesh->zone), (double)r->wish.to));
  return split;
}

/* Chooses the sizes of the next mesh's elements and forecasts it. finer: it may have so many times the elements, to the
   power of 1 / dim. */
static PetscErrorCode PlanSizes(Refinement *r, PetscReal finer, MeshFigures *next)
{
  const Mesh           mesh = r->run->mesh;
  const MeshFigures   *last = &r->plan[r->n_plan - 1];
  const MeshWish       wish = WishedParts(r);
  const QuantityError *error;
  const char          *why;
  PetscReal            value;
  SizesForecast        forecast;

  PetscFunctionBeginUser;
  PetscCall(ResultsGetError(r->run->results, r->wish.probe, &value, &why, &error));
  PetscCall(PetscFree(r->size));
  PetscCall(PetscMalloc1(mesh->n_cells, &r->size));
  PetscCall(ElementSizesFind(r->run->model, error->cells, (PetscReal)wish.bodies, Largest(r), (PetscReal)wish.zone,
                             PetscMin(PetscPowRealInt(finer, r->dim), REFINEMENT_MOST_ELEMENTS), r->size, &forecast));
  r->even = PETSC_FALSE;
  *next =
    MeshPlanForecast(r->n_plan, r->plan, r->dim, r->order, last->factor * pow((double)forecast.elements, 1.0 / r->dim));
  next->error = last->error * (double)forecast.error;
  TakeScale(r, (double)forecast.elements);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Plans a mesh whose elements are all smaller by the same factor. */
static PetscErrorCode PlanEven(Refinement *r, double factor, MeshFigures *next)
{
  const Mesh      mesh    = r->run->mesh;
  const PetscReal smaller = (PetscReal)(factor / r->plan[r->n_plan - 1].factor);
  PetscReal      *measure;

  PetscFunctionBeginUser;
  r->even = PETSC_TRUE;
  *next   = MeshPlanForecast(r->n_plan, r->plan, r->dim, r->order, factor);
  if (r->structured) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(r->size));
  PetscCall(PetscMalloc1(mesh->n_cells, &r->size));
  PetscCall(PetscMalloc1(mesh->n_cells, &measure));
  MeshCellSizes(mesh, r->size, measure);
  for (PetscInt c = 0; c < mesh->n_cells; c++) r->size[c] /= smaller;
  TakeScale(r, pow((double)smaller, r->dim));
  PetscCall(PetscFree(measure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest factor of a next mesh that the limits allow, 0 where there is none. */
static double LargestFactor(Refinement *r)
{
  const MeshFigures left    = {.cpu_s  = r->wish.cpu_s > 0 ? fmax(r->wish.cpu_s - r->cpu_s, REFINEMENT_NO_TIME) : 0,
                               .rss_mb = r->wish.rss_mb},
                    in_time = {.cpu_s = left.cpu_s};
  const double largest      = MeshPlanLargest(r->n_plan, r->plan, r->dim, r->order, left);

  if (largest == 0)
    r->why = MeshPlanLargest(r->n_plan, r->plan, r->dim, r->order, in_time) == 0
               ? "the next mesh would take more than accuracy.limit.time"
               : "the next mesh would take more than accuracy.limit.memory";
  return largest;
}

/* Does the estimate of the last mesh meet the wish, but not what other meshes say? */
static PetscBool IsDoubted(const Refinement *r)
{
  const SolvedMesh *last = Last(r);

  if (last->rough) return (PetscBool)(r->n == 1);
  return (PetscBool)(OtherError(last) + MeshEstimate(&last->error) <= r->wish.to * PetscAbsReal(last->value));
}

/* Plans the last mesh with elements of second order. */
static void PlanOrder(Refinement *r, MeshFigures *next)
{
  *next          = MeshPlanForecast(r->n_plan, r->plan, r->dim, 1, 2 * r->plan[r->n_plan - 1].factor);
  next->factor   = r->plan[r->n_plan - 1].factor;
  r->even        = PETSC_TRUE;
  r->tries_order = PETSC_TRUE;
  r->may_try     = PETSC_FALSE;
  r->order       = 2;
  r->wanted      = 0;
}

/* Were penalties of a pair made stiffer without the success that was forecast? */
static PetscBool PenaltyStays(Model model)
{
  for (int p = 0; p < ContactPairs(model->contact); p++)
    if (ModelPenaltyStays(model, p)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Says that what is left of error does not come from the mesh, but from the cause that leaves most besides it. */
static void WhyOther(Refinement *r)
{
  const QuantityError *error = &Last(r)->error;
  ErrorCause           worst = ERROR_PENETRATION;

  for (int c = ERROR_SLIP; c < ERROR_CAUSES; c++)
    if (PetscAbsReal(KnownPart(error, (ErrorCause)c)) > PetscAbsReal(KnownPart(error, worst))) worst = (ErrorCause)c;
  snprintf(
    r->reason, sizeof(r->reason), "%.3g %% of error come from %s and not from the mesh%s",
    100 * (double)PetscAbsReal(KnownPart(error, worst) / Last(r)->value), ErrorCauses[worst],
    worst != ERROR_PENETRATION ? ""
    : PenaltyStays(r->run->model)
      ? ", which stiffer penalties have hardly lowered: surfaces have to overlap, as where a body that keeps its "
        "volume has no room"
      : ": penalties that the run may not make stiffer, or not any more");
  r->why = r->reason;
}

/* Chooses the next mesh and forecasts it. r->why: there is none. */
static PetscErrorCode Plan(Refinement *r, MeshFigures *next)
{
  const SolvedMesh *last    = Last(r);
  const double      largest = LargestFactor(r), present = r->plan[r->n_plan - 1].factor;
  const PetscBool   doubted = IsDoubted(r);

  PetscFunctionBeginUser;
  if (r->n == r->wish.meshes)
    r->why = "accuracy.meshes are solved";
  else if (!doubted && MeshError(last) < REFINEMENT_LEAST_SHARE * (MeshError(last) + OtherError(last)) &&
           MeshError(last) < WantedMeshError(r))
    WhyOther(r);
  if (r->why) PetscFunctionReturn(PETSC_SUCCESS);
  if (r->may_try && !doubted && largest >= REFINEMENT_ORDER_ROOM * present)
    PlanOrder(r, next);
  else if (doubted && (r->n == 1 || r->structured || !(last->zone.size > 0 || last->foretold)))
    PetscCall(PlanEven(r, fmin(largest, REFINEMENT_WITNESS * present), next));
  else if (r->structured || r->run->mesh->order != r->order)
    PetscCall(
      PlanEven(r, fmin(largest, MeshPlanFactor(r->n_plan, r->plan, r->order, (double)WantedMeshError(r))), next));
  else
    PetscCall(PlanSizes(r, (PetscReal)(largest / present), next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the sizes of the next mesh's elements and the edit that names their file. */
static PetscErrorCode EditSizes(Refinement *r)
{
  const Mesh mesh = r->run->mesh;
  PetscReal *tool;
  char       file[PETSC_MAX_PATH_LEN + 32], full[PETSC_MAX_PATH_LEN] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s/mesh-%d.pos", r->directory, r->n + 1));
  PetscCall(PetscMalloc1(mesh->n_rigid, &tool));
  PetscCall(ToolSizesFind(r->run->model, r->size, tool));
  PetscCall(MeshSizesWrite(mesh, r->size, tool, file));
  PetscCall(PetscFree(tool));
  if (!r->rank) PetscCall(PetscGetFullPath(file, full, sizeof(full)));
  PetscCallMPI(MPI_Bcast(full, sizeof(full), MPI_CHAR, 0, r->run->comm));
  PetscCall(PetscSNPrintf(r->edit[0], EDIT_LENGTH, "mesh.sizes=%s", full));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many times as stiff the penalties of a pair of the scene were at the end of the last mesh as at its begin, the
   least of the pairs that stand for it. 1: no more, or the run may not choose them. */
static PetscErrorCode Stiffened(const Refinement *r, const SceneContact *scene, PetscReal *factor)
{
  const Contact contact = r->run->model->contact;

  PetscFunctionBeginUser;
  *factor = PETSC_MAX_REAL;
  for (int p = 0; p < ContactPairs(contact); p++) {
    PetscReal least, most;

    if (strcmp(ContactPairScene(contact, p)->path, scene->path)) continue;
    PetscCall(ContactPairPenalty(contact, p, &least, &most));
    *factor = PetscMin(*factor, most > 0 ? most / ContactPairInitialPenalty(contact, p) : 1);
  }
  if (!scene->penalty_may_stiffen || *factor == PETSC_MAX_REAL) *factor = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the edit with which the penalties of a pair begin on the next mesh as they were at the end of the last one. */
static PetscErrorCode EditPenalty(const Refinement *r, const SceneContact *scene, char *edit)
{
  PetscReal factor;

  PetscFunctionBeginUser;
  PetscCall(Stiffened(r, scene, &factor));
  if (factor > REFINEMENT_STIFFER)
    PetscCall(PetscSNPrintf(edit, EDIT_LENGTH, "%s.penalty.scale=%.6g", scene->path,
                            (double)(factor * (PetscReal)scene->penalty_scale)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the edits of the scene that give the next mesh. */
static PetscErrorCode Edit(Refinement *r, double factor)
{
  const SceneContact *pair     = r->run->scene->contacts;
  const int           contacts = r->run->scene->n_contacts;
  RunInput           *input    = &r->input;
  int                 n        = r->n_given;
  char              **set;
  char                value[MESH_DENSITY_TEXT];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(r->n_given + r->n_edits, &set));
  PetscCall(PetscArraycpy(set, input->set, r->n_given));
  for (int i = 0; i < r->n_edits; i++)
    if (!r->edit[i]) PetscCall(PetscCalloc1(EDIT_LENGTH, &r->edit[i]));
  for (int i = 0; i < r->n_meshing && r->structured; i++) {
    MeshDensityText(&r->density[i], (PetscReal)factor, value);
    PetscCall(PetscSNPrintf(r->edit[i], EDIT_LENGTH, "mesh.parameters.%s=%s", r->density[i].name, value));
  }
  if (!r->structured && !r->tries_order) PetscCall(EditSizes(r));
  if (r->chooses) PetscCall(PetscSNPrintf(r->edit[r->n_meshing], EDIT_LENGTH, "mesh.order=%d", r->order));
  for (int i = 0; i < contacts; i++) PetscCall(EditPenalty(r, &pair[i], r->edit[r->n_meshing + 1 + EntryOf(&pair[i])]));
  for (int i = 0; i < r->n_edits; i++)
    if (r->edit[i][0]) set[n++] = r->edit[i];
  if (input->n_set > r->n_given) PetscCall(PetscFree(input->set));
  input->set       = set;
  input->n_set     = n;
  input->overwrite = PETSC_TRUE;
  input->mesh      = r->n + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Announces the next mesh and solves it. */
static PetscErrorCode SolveNext(Refinement *r, const MeshFigures *next, BurnishStatus *status)
{
  const MPI_Comm comm = r->run->comm;
  const double   part = 100 / fabs((double)r->mesh[r->n - 1].value);

  PetscFunctionBeginUser;
  PetscCall(Edit(r, next->factor));
  Say(r, "next    ");
  if (r->tries_order) Say(r, " elements of second order,");
  for (int i = 0; r->structured && !r->tries_order && i < r->n_meshing; i++)
    Say(r, " %s,", strchr(r->edit[i], '.') + strlen(".parameters."));
  Say(r, " some %.0f unknowns, error by the mesh %.2g %%, CPU %.2g s\n", next->unknowns, part * next->error,
      next->cpu_s);
  PetscCall(RunDestroy(r->run));
  *r->run = (Run){.comm = comm};
  PetscCall(RunScene(r->run, &r->input, status));
  if (*status != BURNISH_DONE) r->why = "the next mesh is not solved";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mesh with the least error. What has no estimate has no error either on the first one. */
static const SolvedMesh *Best(const Refinement *r)
{
  const SolvedMesh *best = Last(r);

  for (const SolvedMesh *mesh = r->mesh; mesh < Last(r); mesh++)
    if (!(mesh->rough && mesh == r->mesh) && Error(mesh) < Error(best)) best = mesh;
  return best;
}

/* Says how it ended. */
static void Conclude(Refinement *r, BurnishStatus *status)
{
  const SolvedMesh *best = Best(r);

  if (r->why) {
    if (*status == BURNISH_DONE || *status == BURNISH_NOT_CONVERGED) *status = BURNISH_INACCURATE;
    snprintf(r->run->message, sizeof(r->run->message),
             "the accuracy of %g %% is not %s: %s; the best is %s %.6g with an error of %.3g %%, in %.600s/mesh-%d",
             100 * (double)r->wish.to, Error(best) <= r->wish.to ? "confirmed by a second mesh" : "reached", r->why,
             r->probe, (double)best->value, 100 * (double)Error(best), r->directory, (int)(best - r->mesh) + 1);
    ExplanationAppend(r->run->message, sizeof(r->run->message), EXPLANATION_UNSOLVED);
    if (!r->rank) fprintf(stderr, "burnish: %s\n", r->run->message);
  } else
    Say(r, "done: %s %.6g with an estimated error of %.3g %%%s, %d meshes, %.1f s of CPU; results in %s/mesh-%d\n",
        r->probe, (double)Last(r)->value, 100 * (double)Error(Last(r)),
        Last(r)->rough ? ", that of the mesh by the change of the answer alone"
        : isnan((double)Last(r)->error.part[ERROR_GEOMETRY])
          ? ", that of the contact surfaces by the change of the answer alone"
          : "",
        r->n, r->cpu_s, r->directory, r->n);
}

/* Solves meshes until the last one is accurate enough. */
static PetscErrorCode Loop(Refinement *r, BurnishStatus *status)
{
  MeshFigures next = {.factor = 1};

  PetscFunctionBeginUser;
  while (!r->why) {
    PetscCall(Record(r, next.factor));
    Print(r);
    PetscCall(Write(r));
    if (!isnan((double)Last(r)->implied) && Error(Last(r)) <= r->wish.to) break;
    PetscCall(Plan(r, &next));
    if (!r->why) PetscCall(SolveNext(r, &next, status));
  }
  Conclude(r, status);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  RefinementRun - solves a scene on finer meshes until the probe is as accurate as the scene asks

  Collective

  Input Parameters:
+ run   - solved on the first mesh, by RunScene()
- input - what the user asks for

  Output Parameters:
+ run    - solved on the last mesh
- status - BURNISH_DONE or BURNISH_INACCURATE, or that of a run which was stopped

  Note:
  Returns REFUSED for a scene whose mesh cannot be refined, or whose probe has no estimate.
@*/
PetscErrorCode RefinementRun(Run *run, const RunInput *input, BurnishStatus *status)
{
  Refinement     r;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  code = Begin(run, input, &r);
  if (!code) code = Loop(&r, status);
  if (!code || code == REFUSED) PetscCall(End(&r));
  PetscFunctionReturn(code);
}
