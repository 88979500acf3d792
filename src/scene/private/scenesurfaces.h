/* Contact entries that list surfaces, written as pairs of a slave and a master. For scene.c only.

   SceneListSurfacePairs() lists the pairs of all entries, SceneNameSurfacePair() names one of a list. */
#pragma once
#include "scene/scene.h"
#include "schema.h"

/* One of the surfaces of an entry: its group in the mesh, and the name by which users know it. */
typedef struct {
  char        group[KEY_PATH_LENGTH];
  const char *label;
  int         rigid;
} ListedSurface;

typedef struct {
  int           entry;         /* place in the list contact */
  int           listed;        /* 0: the entry itself names slave and master, and nothing below is set */
  ListedSurface slave, master; /* labels are texts of the document or names of bodies */
  double        share;         /* as in SceneContact */
} SurfacePair;

PetscErrorCode SceneListSurfacePairs(Scene, int *n, SurfacePair **);
PetscErrorCode SceneNameSurfacePair(const SurfacePair *, int alone, const char *entry, char **name);
