/* Contact entries that list surfaces, written as pairs of a slave and a master. For scene.c only. */
#pragma once
#include "scene/scene.h"

typedef struct {
  int         entry;          /* place in the list contact */
  const char *slave, *master; /* texts of the document; NULL: the entry itself names slave and master */
  double      share;          /* as in SceneContact */
} SurfacePair;

PetscErrorCode SceneListSurfacePairs(Scene, int *n, SurfacePair **);
PetscErrorCode SceneNameSurfacePair(const SurfacePair *, int alone, const char *entry, char **name);
