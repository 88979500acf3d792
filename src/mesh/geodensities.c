/* Finds the parameters of a .geo file that refine its mesh, see geodensities.h. */
#include "geodensities.h"
#include <stdlib.h>
#include <string.h>

/* Finds what a Name says by its beginning. *known: it says something. */
static DensityKind FindKind(const GeoToken *text, PetscBool *known)
{
  static const struct {
    const char *beginning;
    DensityKind kind;
  } kinds[] = {{"elements", DENSITY_COUNT},
               {"faces", DENSITY_COUNT},
               {"element size", DENSITY_SIZE},
               {"divides", DENSITY_DIVISOR}};

  *known = PETSC_TRUE;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(kinds); k++) {
    const int length = (int)strlen(kinds[k].beginning);

    if (text->length >= length && !strncmp(text->at, kinds[k].beginning, (size_t)length)) return kinds[k].kind;
  }
  *known = PETSC_FALSE;
  return DENSITY_COUNT;
}

/* Adds the parameter "NAME = {NUMBER, ... Name TEXT ...}" that begins at a token, if it is a density. */
static PetscErrorCode AddParameter(GeoDensities *densities, const GeoToken *at)
{
  const GeoToken *text = at + 4;
  GeoDensity     *density;
  DensityKind     kind;
  PetscBool       known;

  PetscFunctionBeginUser;
  if (at[3].kind != GEO_NUMBER) PetscFunctionReturn(PETSC_SUCCESS);
  while (text->kind != GEO_END && !GeoTokenIs(text, "}") && !GeoTokenIs(text, "Name")) text++;
  if (!GeoTokenIs(text, "Name") || text[1].kind != GEO_TEXT) PetscFunctionReturn(PETSC_SUCCESS);
  kind = FindKind(text + 1, &known);
  if (!known || !(strtod(at[3].at, NULL) > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscRealloc(sizeof(GeoDensity) * (size_t)(densities->n + 1), &densities->density));
  density  = &densities->density[densities->n++];
  *density = (GeoDensity){.value = (PetscReal)strtod(at[3].at, NULL), .kind = kind};
  PetscCall(PetscCalloc1((size_t)at->length + 1, &density->name));
  PetscCall(PetscArraycpy(density->name, at->at, at->length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoDensitiesAdd - adds the densities that a file declares.

  Not collective

  Input Parameter:
. tokens - of the file

  Input/Output Parameter:
. densities - zero before the first call, to be freed with GeoDensitiesReset()

  Note:
  A parameter whose default is 0, or no plain number, is none.
@*/
PetscErrorCode GeoDensitiesAdd(GeoDensities *densities, const GeoTokens *tokens)
{
  PetscBool within = PETSC_FALSE; /* a DefineConstant */

  PetscFunctionBeginUser;
  for (int i = 0; i + 4 < tokens->n; i++) {
    const GeoToken *token = &tokens->token[i];

    if (GeoTokenIs(token, "DefineConstant")) within = PETSC_TRUE;
    if (GeoTokenIs(token, ";")) within = PETSC_FALSE;
    if (GeoTokenIs(token, "Transfinite")) densities->structured = PETSC_TRUE;
    if (within && token->kind == GEO_WORD && GeoTokenIs(token + 1, "=") && GeoTokenIs(token + 2, "{"))
      PetscCall(AddParameter(densities, token));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoDensitiesReset - frees the list.

  Not collective

  Input Parameter:
. densities - zero afterwards
@*/
PetscErrorCode GeoDensitiesReset(GeoDensities *densities)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < densities->n; i++) PetscCall(PetscFree(densities->density[i].name));
  PetscCall(PetscFree(densities->density));
  *densities = (GeoDensities){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
