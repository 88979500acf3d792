/* The reader of the key `mesh` of a scene, see scenemesh.h. */
#include "scenemesh.h"
#include "sceneread.h"
#include <string.h>
#include <strings.h>

/* Endings of mesh files of other programs, and of geometry of CAD programs. */
static const char *const Foreign[] = {".inp", ".med", ".unv", ".cgns", ".bdf", ".nas", ".vtk", ".vtu", NULL};
static const char *const Cad[]     = {".step", ".stp", ".brep", ".igs", ".iges", NULL};

/* Tells whether an ending is one of a list. Capitals do not matter, as CAD programs like them. */
static PetscBool IsOneOf(const char *ending, const char *const *endings)
{
  for (; ending && *endings; endings++)
    if (!strcasecmp(ending, *endings)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Reads how the surfaces of CAD geometry are named and meshed. */
static PetscErrorCode SceneReadSurface(Scene scene, int i)
{
  SceneCadSurface *surface = &scene->cad_surfaces[i];
  char            *path;

  PetscFunctionBeginUser;
  PetscCall(ScenePath(&path, "mesh.surfaces", i));
  PetscCall(SceneReadText(scene, path, "name", &surface->name));
  PetscCall(SceneReadText(scene, path, "body", &surface->body));
  surface->has_point = SceneHas(scene, path, "point");
  (void)SceneReals(scene, path, "point", surface->point);
  surface->size = SceneHas(scene, path, "size") ? SchemaReal(SceneDocument(scene), "%s.size", path) : 0;
  if (!surface->has_point && !surface->size)
    PetscCall(
      SceneRefuse(scene, path, "", "has neither a point, which names a surface, nor a size of its elements", NULL));
  if (surface->body && !surface->has_point)
    PetscCall(SceneRefuse(scene, path, "body", "has no place without point", NULL));
  PetscCall(PetscFree(path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadCad(Scene scene)
{
  static const char *const keys[]   = {"size", "surfaces"};
  Document                *document = SceneDocument(scene);

  PetscFunctionBeginUser;
  for (int k = 0; k < 2 && !scene->cad; k++)
    if (SceneHas(scene, "mesh", keys[k]))
      PetscCall(SceneRefuse(scene, "mesh", keys[k],
                            "is for geometry of CAD programs; allowed with .step, .stp, .brep, .igs, .iges", NULL));
  if (!scene->cad) PetscFunctionReturn(PETSC_SUCCESS);
  if (SceneHas(scene, "mesh", "parameters"))
    PetscCall(SceneRefuse(scene, "mesh", "parameters", "is for a .geo file; allowed: size, order, surfaces", NULL));
  scene->mesh_size      = SceneHas(scene, "mesh", "size") ? SchemaReal(document, "mesh.size") : 0;
  scene->n_cad_surfaces = SchemaCount(document, "mesh.surfaces");
  PetscCall(PetscCalloc1(scene->n_cad_surfaces, &scene->cad_surfaces));
  for (int i = 0; i < scene->n_cad_surfaces; i++) PetscCall(SceneReadSurface(scene, i));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the name of a file below mesh: where the process can open it. */
static PetscErrorCode SceneReadPath(Scene scene, const char *key, char **name)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (!SceneFilePath(scene, SchemaText(SceneDocument(scene), "mesh.%s", key), path, sizeof path))
    PetscCall(SceneRefuse(scene, "mesh", key, "the path is too long", NULL));
  PetscCall(PetscStrallocpy(path, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadMesh - reads the key `mesh` of the document into the scene.

  Collective

  Input Parameter:
. scene - the scene, whose dimension is known

  Note:
  It refuses the first mistake.
@*/
PetscErrorCode SceneReadMesh(Scene scene)
{
  const char *file = SchemaText(SceneDocument(scene), "mesh.file"), *dot = strrchr(file, '.');
  const int   geo = dot && !strcmp(dot, ".geo");

  PetscFunctionBeginUser;
  scene->cad          = IsOneOf(dot, Cad);
  scene->foreign_mesh = scene->cad || IsOneOf(dot, Foreign) ? PETSC_TRUE : PETSC_FALSE;
  if (!geo && !scene->foreign_mesh && (!dot || strcmp(dot, ".msh")))
    PetscCall(SceneRefuse(scene, "mesh", "file",
                          "is no mesh file; allowed: .geo, .msh, .inp, .med, .unv, .cgns, .bdf, .nas, .vtk, .vtu, and "
                          "geometry as .step, .stp, .brep, .igs, .iges",
                          file));
  PetscCall(SceneReadPath(scene, "file", &scene->mesh_file));
  if (SceneHas(scene, "mesh", "sizes")) {
    if (!geo) PetscCall(SceneRefuse(scene, "mesh", "sizes", "needs a geometry; allowed with a .geo file", NULL));
    PetscCall(SceneReadPath(scene, "sizes", &scene->sizes));
  }
  scene->order = SceneHas(scene, "mesh", "order") ? SchemaInteger(SceneDocument(scene), "mesh.order")
                 : scene->cad                     ? 2
                                                  : geo;
  PetscCall(SceneReadCad(scene));
  PetscCall(SceneReadPairs(scene, "mesh.parameters", &scene->n_parameters, &scene->parameters));
  for (int i = 0; i < scene->n_parameters; i++) {
    if (!scene->parameters[i].value[0])
      PetscCall(SceneRefuse(scene, "mesh.parameters", scene->parameters[i].key,
                            "has no value; allowed: a number or a text", NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneMeshDestroy - frees what SceneReadMesh() has read.

  Not collective

  Input Parameter:
. scene - the scene
@*/
PetscErrorCode SceneMeshDestroy(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_cad_surfaces; i++) {
    PetscCall(PetscFree(scene->cad_surfaces[i].name));
    PetscCall(PetscFree(scene->cad_surfaces[i].body));
  }
  PetscCall(PetscFree(scene->cad_surfaces));
  PetscCall(ScenePairsDestroy(scene->n_parameters, &scene->parameters));
  PetscCall(PetscFree(scene->mesh_file));
  PetscCall(PetscFree(scene->sizes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
