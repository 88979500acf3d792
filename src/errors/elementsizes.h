/* Sizes of the elements of the next mesh from the errors of the present ones: as few elements as possible for a given
   part of the present error.

   The error of a cell is taken as e r^(2p) where its size changes by the factor r and p is the order. The number of new
   cells sum r^-d is least for a given sum of errors where

     r = s e^(-1 / (2p + d)),

   with one factor s for all cells, so that the errors of the new cells are equal (equidistribution). r is bounded,
   since the errors far from those of the present mesh are guesses. At points where stresses have no bound
   (errors/singularpoints.h) errors fall with another power q in the place of 2p, and the same condition of the least
   number is r^(q + d) = (2p / q) (s e^(-1 / (2p + d)))^(2p + d).

   Cells at surfaces that may meet do not become larger: how well these surfaces are resolved is in no cell's error.
   Where they are in contact they may have to become smaller besides (errors/contactzone.h). Sources: Zienkiewicz and
   Zhu (1987); Coorevits, Hild and Hjiaj, Computer Methods in Applied Mechanics and Engineering 190 (2001). */
#pragma once
#include "solve/model.h"

typedef struct {
  PetscReal elements; /* of the next mesh, over those of the present one */
  PetscReal error;    /* of the next mesh, over that of the present one */
} SizesForecast;

PetscErrorCode ElementSizesFind(Model, const PetscReal *cell_error, PetscReal part, PetscReal larger, PetscReal in_zone,
                                PetscReal most, PetscReal *size, SizesForecast *);
PetscErrorCode ToolSizesFind(Model, const PetscReal *size, PetscReal *tool);
