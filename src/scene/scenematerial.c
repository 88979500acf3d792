/* The reader of the material of a body, see scenematerial.h. A law has constants of its own, in the keys that its
   ElasticLaw names. The volume is given by nu, by K or by incompressible: true. Laws whose only constant is the shear
   modulus take E instead of mu, too. */
#include "scenematerial.h"
#include "sceneread.h"
#include <math.h>
#include <string.h>

/* The keys of the constants of all laws, and those of the volume */
static const char *const ConstantKeys[] = {"E", "mu", "c10", "c01", "c20", "c30", MATERIAL_TERMS, "lambda_m", NULL};
static const char *const VolumeKeys[]   = {"nu", "K", "incompressible", NULL};
static const char        Volume[]       = "allowed: one of nu, K (bulk modulus) and incompressible: true";

/* Largest number of terms of two constants, beside the modulus of the volume */
enum { MAX_TERMS = (MATERIAL_MAX_CONSTANTS - 1) / 2 };

static int LawTakes(MaterialLaw word, const char *key)
{
  const ElasticLaw *law = MaterialGetLaw(word);

  for (int k = 0; law->keys[k]; k++) {
    if (!strcmp(law->keys[k], key)) return 1;
  }
  return MaterialHasModuli(word) && !strcmp(key, "E");
}

/* Refuses keys that belong to other laws, and missing ones. */
static PetscErrorCode CheckConstantKeys(Scene scene, const char *path, MaterialLaw word)
{
  const ElasticLaw *law    = MaterialGetLaw(word);
  const int         moduli = MaterialHasModuli(word);
  char              text[200];
  int               n;

  PetscFunctionBeginUser;
  n = snprintf(text, sizeof text, "allowed with law: %s:%s", MaterialLaws[word], moduli ? " E or" : "");
  for (int k = 0; law->keys[k]; k++) n += snprintf(text + n, sizeof text - n, "%s %s", k ? "," : "", law->keys[k]);
  for (int k = 0; ConstantKeys[k]; k++) {
    if (SceneHas(scene, path, ConstantKeys[k]) && !LawTakes(word, ConstantKeys[k]))
      PetscCall(SceneRefuse(scene, path, ConstantKeys[k], text, "has no place here;"));
  }
  if (moduli && SceneHas(scene, path, "E") == SceneHas(scene, path, "mu"))
    PetscCall(SceneRefuse(scene, path, "E", text, SceneHas(scene, path, "E") ? "is given beside mu;" : "is missing;"));
  for (int k = 0; k < law->required && !moduli; k++) {
    if (!SceneHas(scene, path, law->keys[k])) PetscCall(SceneRefuse(scene, path, law->keys[k], text, "is missing;"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the terms [[mu, alpha], ...] of a law with any number of them. */
static PetscErrorCode ReadTerms(Scene scene, const char *path, int *n, double *own)
{
  const Node list = SceneNode(scene, path, MATERIAL_TERMS);
  char       text[100];

  PetscFunctionBeginUser;
  snprintf(text, sizeof text, "terms are too many; allowed: at most %d", MAX_TERMS);
  if (list->n > MAX_TERMS) PetscCall(SceneRefuse(scene, path, MATERIAL_TERMS, text, NULL));
  for (int i = 0; i < list->n; i++) {
    (void)NodeReal(list->child[i]->child[0], &own[2 * i]);
    (void)NodeReal(list->child[i]->child[1], &own[2 * i + 1]);
    if (own[2 * i + 1] == 0)
      PetscCall(SceneRefuse(scene, path, MATERIAL_TERMS,
                            "has an exponent of 0, which has no energy; allowed: [[mu, alpha], ...] with alpha not 0",
                            NULL));
  }
  *n = 2 * list->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the constants of a law with other keys than moduli. */
static PetscErrorCode ReadConstants(Scene scene, const char *path, MaterialLaw law, Material *material)
{
  const ElasticLaw *elastic = MaterialGetLaw(law);
  double            own[MATERIAL_MAX_CONSTANTS - 1], mu;
  char              text[120];
  int               n = 0;

  PetscFunctionBeginUser;
  if (!strcmp(elastic->keys[0], MATERIAL_TERMS))
    PetscCall(ReadTerms(scene, path, &n, own));
  else
    for (; elastic->keys[n]; n++) own[n] = SchemaReal(SceneDocument(scene), "%s.%s", path, elastic->keys[n]);
  *material = MaterialFromConstants(law, n, own);
  mu        = MaterialShear(material);
  snprintf(text, sizeof text, "the shear modulus of the undeformed state is %g; allowed: constants with one above 0",
           mu);
  if (!(mu > 0)) PetscCall(SceneRefuse(scene, path, "", text, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the key that gives the volume. Refuses none and more than one. incompressible: false is none. */
static PetscErrorCode FindVolumeKey(Scene scene, const char *path, const char **key)
{
  PetscFunctionBeginUser;
  *key = NULL;
  for (int k = 0; VolumeKeys[k]; k++) {
    if (!SceneHas(scene, path, VolumeKeys[k])) continue;
    if (k == 2 && !SchemaBoolean(SceneDocument(scene), "%s.incompressible", path)) continue;
    if (*key) PetscCall(SceneRefuse(scene, path, VolumeKeys[k], Volume, "is one too many;"));
    *key = VolumeKeys[k];
  }
  if (!*key) PetscCall(SceneRefuse(scene, path, "nu", Volume, "is missing;"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the material of a law with moduli from E or mu and the volume: from nu, or from K, which is INFINITY if the
   material is incompressible. */
static PetscErrorCode ReadModuli(Scene scene, const char *path, MaterialLaw law, const char *volume, double nu,
                                 double K, Material *material)
{
  const int    has_E   = SceneHas(scene, path, "E");
  const double modulus = SchemaReal(SceneDocument(scene), "%s.%s", path, has_E ? "E" : "mu");
  double       mu      = modulus;

  PetscFunctionBeginUser;
  if (!strcmp(volume, "nu")) {
    *material = MaterialFromModuli(law, has_E ? modulus : 2 * (1 + nu) * mu, nu);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (has_E && !(modulus < 9 * K))
    PetscCall(SceneRefuse(scene, path, "K", "is too small for this E; allowed: above E/9", NULL));
  if (has_E) mu = modulus / (3 - modulus / (3 * K));
  *material = MaterialFromConstants(law, 1, &mu);
  MaterialSetBulk(material, K);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadMaterial - reads the material of a deformable body.

  Collective

  Input Parameters:
+ scene - the scene, of which kinematics has been read
- body  - a body, of which the path has been read

  Note:
  It fills body->material, and refuses keys that do not belong to the law.
@*/
PetscErrorCode SceneReadMaterial(Scene scene, SceneBody *body)
{
  char        path[KEY_PATH_LENGTH];
  const char *volume;
  MaterialLaw law;
  double      nu, K;

  PetscFunctionBeginUser;
  KeyPathJoin(path, body->path, "material");
  law = (MaterialLaw)SchemaChoice(SceneDocument(scene), "%s.law", path);
  if (law == MATERIAL_LINEAR && scene->kinematics == KINEMATICS_FINITE)
    PetscCall(
      SceneRefuse(scene, path, "law", "linear needs kinematics: small; allowed with finite: any other law", NULL));
  PetscCall(CheckConstantKeys(scene, path, law));
  PetscCall(FindVolumeKey(scene, path, &volume));
  nu = SchemaReal(SceneDocument(scene), "%s.nu", path);
  K  = strcmp(volume, "K") ? INFINITY : SchemaReal(SceneDocument(scene), "%s.K", path);
  if (MaterialHasModuli(law)) {
    PetscCall(ReadModuli(scene, path, law, volume, nu, K, &body->material));
  } else {
    PetscCall(ReadConstants(scene, path, law, &body->material));
    if (!strcmp(volume, "nu")) K = MaterialBulk(MaterialShear(&body->material), nu);
    MaterialSetBulk(&body->material, K);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneCheckIncompressible - refuses an incompressible material whose law or elements evaluate the change of volume.

  Collective

  Input Parameters:
+ scene - the scene
- body  - a body, of which material and formulation have been read
@*/
PetscErrorCode SceneCheckIncompressible(Scene scene, const SceneBody *body)
{
  char        path[KEY_PATH_LENGTH];
  const char *volume;

  PetscFunctionBeginUser;
  if (!isinf(body->material.constants[0])) PetscFunctionReturn(PETSC_SUCCESS);
  KeyPathJoin(path, body->path, "material");
  PetscCall(FindVolumeKey(scene, path, &volume));
  if (!MaterialGetLaw(body->material.law)->separable && scene->kinematics == KINEMATICS_FINITE)
    PetscCall(SceneRefuse(scene, path, volume,
                          "is incompressible, which this law cannot be; allowed: nu below 0.5, K, or another law",
                          NULL));
  if (scene->plane_stress)
    PetscCall(SceneRefuse(scene, path, volume,
                          "is incompressible, which needs pressures that plane stress has not; allowed with geometry: "
                          "plane_stress: nu below 0.5, such as 0.4999, or K",
                          NULL));
  if (strcmp(Formulations[body->formulation], "mixed"))
    PetscCall(SceneRefuse(scene, path, volume,
                          "is incompressible, which needs formulation: mixed; allowed with other formulations: nu "
                          "below 0.5, or K",
                          NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}
