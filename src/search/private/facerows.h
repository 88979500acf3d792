/* Rows of faces that are much longer than wide, like those of a ring that has few elements around and many across. Such
   rows run along curves. Seen in the tangent plane of a foot they bend aside, soon by more than a support is wide. Fits
   there measure their supports along and across the rows (FitBend).

   FaceRowsFollow() walks from face to face around a foot. It adds up the steps along and across the faces, and compares
   them with the places of the faces in the tangent plane. */
#pragma once
#include "neighbourhood.h"
#include "smooth/diffusefit.h"

typedef struct _n_FaceRows *FaceRows;

/* The rows around a foot. */
typedef struct {
  PetscReal share;           /* 0: the faces are about as long as wide, and the rest is not set; 1: much longer */
  PetscReal normal[3];       /* unit, mean of the faces' normals */
  PetscReal length2, width2; /* mean second moments of the faces along and across the rows (length^2) */
  PetscReal area;            /* mean area of the faces per node (length^2) */
  PetscReal along[3];        /* unit, of the row through the foot, square to the normal for which rows were followed */
  PetscReal bends;           /* 0: coordinates stay straight; 1: they bend wholly with the row */
  PetscReal h[2];            /* of the bend, as in FitBend */
} FaceRow;

PetscErrorCode FaceRowsCreate(const SurfaceView *, Neighbourhoods, FaceRows *);
PetscErrorCode FaceRowsDestroy(FaceRows *);
PetscErrorCode FaceRowsFollow(FaceRows, PetscInt start, const PetscReal foot[3], const PetscReal upright[3],
                              PetscReal support, FaceRow *);
