/* Yield stress and hardening of a plastic body, and routines of users, see sceneplasticity.h. */
#include "sceneplasticity.h"
#include "sceneread.h"
#include "base/refusal.h"
#include <math.h>
#include <stdio.h>

/* Reads a number below the material of a body. */
static double MaterialReal(Scene scene, const SceneBody *body, const char *key)
{
  return SchemaReal(SceneDocument(scene), "%s.material.%s", body->path, key);
}

static PetscErrorCode SceneReadTable(Scene scene, const SceneBody *body, Hardening *h)
{
  const Node list = SceneNode(scene, body->path, "material.hardening.table");
  char       rows[16];

  PetscFunctionBeginUser;
  snprintf(rows, sizeof rows, "%d points", HARDENING_MAX_ROWS);
  if (list->n > HARDENING_MAX_ROWS)
    PetscCall(
      SceneRefuse(scene, body->path, "material.hardening.table", "has too many points; allowed: at most", rows));
  for (int i = 0; i < list->n; i++) {
    for (int k = 0; k < 2; k++) (void)NodeReal(list->child[i]->child[k], &h->table[i][k]);
    if (h->table[i][1] <= 0 || (i && h->table[i][1] < h->table[i - 1][1]))
      PetscCall(SceneRefuse(scene, body->path, "material.hardening.table",
                            "falls or is not positive; allowed: yield stresses above 0 that do not fall", NULL));
  }
  h->rows  = list->n;
  h->yield = h->table[0][1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the terms that are added to the yield stress. */
static PetscErrorCode SceneReadTerms(Scene scene, const SceneBody *body, Hardening *h)
{
  PetscFunctionBeginUser;
  if (SceneHas(scene, body->path, "material.hardening.linear"))
    h->linear = MaterialReal(scene, body, "hardening.linear");
  if (SceneHas(scene, body->path, "material.hardening.voce")) {
    h->saturation = MaterialReal(scene, body, "hardening.voce.saturation");
    h->rate       = MaterialReal(scene, body, "hardening.voce.rate");
    if (h->saturation < h->yield)
      PetscCall(SceneRefuse(scene, body->path, "material.hardening.voce.saturation",
                            "is below yield; allowed: the yield stress at large strains, at least yield", NULL));
  }
  if (SceneHas(scene, body->path, "material.hardening.swift")) {
    h->strength = MaterialReal(scene, body, "hardening.swift.strength");
    h->exponent = MaterialReal(scene, body, "hardening.swift.exponent");
    h->strain   = pow(h->yield / h->strength, 1 / h->exponent);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads backstresses and overstress. */
static PetscErrorCode SceneReadRates(Scene scene, const SceneBody *body, Hardening *h)
{
  Document *const document = SceneDocument(scene);

  PetscFunctionBeginUser;
  if (SceneHas(scene, body->path, "material.kinematic"))
    h->terms = SchemaCount(document, "%s.material.kinematic", body->path);
  for (int k = 0; k < h->terms; k++) {
    h->backstress[k][0] = SchemaReal(document, "%s.material.kinematic.%d.C", body->path, k);
    h->backstress[k][1] = SchemaReal(document, "%s.material.kinematic.%d.gamma", body->path, k);
  }
  if (SceneHas(scene, body->path, "material.perzyna")) {
    h->overstress = MaterialReal(scene, body, "perzyna.overstress");
    h->speed      = MaterialReal(scene, body, "perzyna.speed");
    h->power      = MaterialReal(scene, body, "perzyna.power");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadPlasticity - reads yield stress and hardening of a body, or refuses them where the law has none.

  Collective

  Input Parameters:
+ scene - the scene
- body  - its law has been read; its hardening is filled
@*/
PetscErrorCode SceneReadPlasticity(Scene scene, SceneBody *body)
{
  static const char *const Terms[] = {"material.hardening.linear", "material.hardening.voce",
                                      "material.hardening.swift"};
  static const char *const Own[]   = {"material.yield", "material.hardening", "material.kinematic", "material.perzyna"};
  const int                plastic = body->material.law == MATERIAL_VON_MISES;
  const int                table   = SceneHas(scene, body->path, "material.hardening.table");
  const int                yield   = SceneHas(scene, body->path, "material.yield");

  PetscFunctionBeginUser;
  if (!plastic) {
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(Own); k++)
      if (SceneHas(scene, body->path, Own[k]))
        PetscCall(SceneRefuse(scene, body->path, Own[k], "is for law: von_mises", NULL));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (yield && table)
    PetscCall(SceneRefuse(scene, body->path, "material.yield",
                          "has no place beside hardening.table, whose first value is the yield stress", NULL));
  for (int k = 0; k < 3 && table; k++) {
    if (SceneHas(scene, body->path, Terms[k]))
      PetscCall(
        SceneRefuse(scene, body->path, Terms[k], "has no place beside hardening.table; allowed: one of both", NULL));
  }
  if (!yield && !table)
    PetscCall(SceneRefuse(scene, body->path, "material.law",
                          "von_mises needs yield; allowed: yield, or hardening with a table", NULL));
  if (table)
    PetscCall(SceneReadTable(scene, body, &body->material.hardening));
  else {
    body->material.hardening.yield = MaterialReal(scene, body, "yield");
    PetscCall(SceneReadTerms(scene, body, &body->material.hardening));
  }
  PetscCall(SceneReadRates(scene, body, &body->material.hardening));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the list of constants of a routine. */
static PetscErrorCode SceneReadConstants(Scene scene, const SceneBody *body, int *n, double **constants)
{
  const Node list =
    SceneHas(scene, body->path, "material.constants") ? SceneNode(scene, body->path, "material.constants") : NULL;

  PetscFunctionBeginUser;
  *n = list ? list->n : 0;
  PetscCall(PetscMalloc1(*n, constants));
  for (int k = 0; k < *n; k++) (void)NodeReal(list->child[k], &(*constants)[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keys of a routine */
static const char *const routine_keys[] = {"material.library", "material.constants", "material.states",
                                           "material.unsymmetric"};

/* Writes the path of the library that a body names. Tells whether it fits. */
static PetscBool SceneLibraryPath(Scene scene, const SceneBody *body, char *path, size_t size)
{
  return SceneFilePath(scene, SchemaText(SceneDocument(scene), "%s.%s", body->path, routine_keys[0]), path, size);
}

/*@
  SceneCheckRoutine - refuses a body with law: umat that names no library, and the keys of one where the law is another.

  Collective

  Input Parameters:
+ scene - the scene
- body  - its law has been read

  Note:
  Nothing is loaded, see SceneLoadRoutines().
@*/
PetscErrorCode SceneCheckRoutine(Scene scene, const SceneBody *body)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (body->material.law != MATERIAL_UMAT) {
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(routine_keys); k++)
      if (SceneHas(scene, body->path, routine_keys[k]))
        PetscCall(SceneRefuse(scene, body->path, routine_keys[k], "is for law: umat", NULL));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!SceneHas(scene, body->path, routine_keys[0]))
    PetscCall(
      SceneRefuse(scene, body->path, routine_keys[0], "is missing; allowed: the path of a shared library", NULL));
  if (!SceneLibraryPath(scene, body, path, sizeof path))
    PetscCall(SceneRefuse(scene, body->path, routine_keys[0], "the path is too long", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Loads the library of a body. Ranks may see other files, so that the refusal is of all ranks together. */
static PetscErrorCode SceneLoadRoutine(Scene scene, SceneBody *body, MPI_Comm comm)
{
  char    path[PETSC_MAX_PATH_LEN], key[KEY_PATH_LENGTH], message[UMAT_MESSAGE], text[2 * PETSC_MAX_PATH_LEN];
  double *constants;
  int     n, failed;

  PetscFunctionBeginUser;
  (void)SceneLibraryPath(scene, body, path, sizeof path);
  KeyPathJoin(key, body->path, routine_keys[0]);
  PetscCall(SceneReadConstants(scene, body, &n, &constants));
  failed =
    UmatOpen(path, body->name, n, constants, SchemaInteger(SceneDocument(scene), "%s.%s", body->path, routine_keys[2]),
             &body->material.umat, message);
  PetscCall(PetscFree(constants));
  if (failed)
    snprintf(text, sizeof text,
             "%s: %s - the library cannot be loaded; allowed: one with a routine umat, see scripts/build_umat.sh",
             DocumentWhere(SceneDocument(scene), key), message);
  PetscCall(RefuseInputAnywhere(comm, failed ? text : NULL));
  if (SchemaBoolean(SceneDocument(scene), "%s.%s", body->path, routine_keys[3]))
    UmatSetUnsymmetric(body->material.umat);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneLoadRoutines - loads the shared libraries that the bodies with law: umat name.

  Collective

  Input Parameters:
+ scene - from SceneRead(), which loads nothing
. comm  - communicator of all ranks
- trust - whether the scene may run code of its own; else one that names a library is refused

  Note:
  A library runs code as soon as it is loaded. A model of such a scene needs its routines. SceneDestroy() unloads them.
@*/
PetscErrorCode SceneLoadRoutines(Scene scene, MPI_Comm comm, PetscBool trust)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < scene->n_bodies; b++) {
    SceneBody *body = &scene->bodies[b];

    if (body->rigid || body->material.law != MATERIAL_UMAT) continue;
    if (!trust)
      PetscCall(SceneRefuse(scene, body->path, routine_keys[0],
                            "is a library, whose code would run; allowed: laws of the program (-trust on the command "
                            "line allows libraries, for a scene that you trust)",
                            SchemaText(SceneDocument(scene), "%s.%s", body->path, routine_keys[0])));
    PetscCall(SceneLoadRoutine(scene, body, comm));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
