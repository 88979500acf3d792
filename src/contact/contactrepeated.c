/* Pairs that would treat the same contact twice. Their forces would add up without a word, so they are refused. */
#include "contactimpl.h"
#include "base/refusal.h"
#include "search/facemarks.h"

/* Rigid tools are the same one if they lie in one place, within this part of the size of the model, at REPEATED_TIMES
   load parameters from 0 to 1. */
#define REPEATED_PLACE 1e-9
enum { REPEATED_TIMES = 5 };

/* Refuses two pairs of the same two meshed surfaces. */
static PetscErrorCode RefuseNames(Mesh mesh, Scene scene, const SceneContact *a, const SceneContact *b)
{
  const PetscBool meshed = (PetscBool)(a->master && b->master),
                  same   = (PetscBool)(meshed && !strcmp(a->slave, b->slave) && !strcmp(a->master, b->master));
  /* Within a list of surfaces each of two is slave of the other with half its area. */
  const PetscBool listed = (PetscBool)(a->listed && b->listed && !strcmp(a->path, b->path)),
                  swapped =
                    (PetscBool)(meshed && !listed && !strcmp(a->slave, b->master) && !strcmp(a->master, b->slave));

  PetscFunctionBeginUser;
  if (same || swapped)
    PetscCall(RefuseInput(
      mesh->comm,
      "%s: contact '%s' is '%s' once more%s: their forces would add up; allowed: one pair for each two surfaces",
      SceneWhere(scene, a->path, "slave"), a->name, b->name, swapped ? ", slave and master swapped" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether two rigid tools with a closed form lie in one place at t. tolerance is a length. */
static PetscBool SamePlace(const SceneContact *a, const SceneContact *b, double t, double tolerance)
{
  const SceneContact *of[2]     = {a, b};
  double              square[2] = {0, 0}, cosine = 0, along = 0, apart = 0, point[2][3], axis[2][3];

  for (int k = 0; k < 2; k++) {
    MotionPlace(&of[k]->motion, t, of[k]->motion.point, point[k]);
    MotionTurn(&of[k]->motion, t, of[k]->analytic.axis, axis[k]);
  }
  for (int d = 0; d < 3; d++) {
    for (int k = 0; k < 2; k++) square[k] += PetscSqr(axis[k][d]);
    cosine += axis[0][d] * axis[1][d];
    along += (point[1][d] - point[0][d]) * axis[0][d];
    apart += PetscSqr(point[1][d] - point[0][d]);
  }
  if (a->analytic.shape == ANALYTIC_SPHERE) return (PetscBool)(sqrt(apart) <= tolerance);
  cosine /= sqrt(square[0] * square[1]);
  along /= sqrt(square[0]);
  if (a->analytic.shape == ANALYTIC_PLANE)
    return (PetscBool)(cosine >= 1 - REPEATED_PLACE && fabs(along) <= tolerance);
  return (PetscBool)(fabs(cosine) >= 1 - REPEATED_PLACE && sqrt(PetscMax(0, apart - along * along)) <= tolerance);
}

/* Says whether two pairs have the same rigid tool with a closed form. Tools that are free to move are two. */
static PetscBool SameTool(Mesh mesh, const SceneContact *a, const SceneContact *b)
{
  const double tolerance = REPEATED_PLACE * mesh->size;

  if (a->master || b->master || a->motion.n_free || b->motion.n_free) return PETSC_FALSE;
  if (a->analytic.shape != b->analytic.shape || a->analytic.inside != b->analytic.inside) return PETSC_FALSE;
  if (a->analytic.shape != ANALYTIC_PLANE && fabs(a->analytic.radius - b->analytic.radius) > tolerance)
    return PETSC_FALSE;
  for (int k = 0; k < REPEATED_TIMES; k++)
    if (!SamePlace(a, b, k / (REPEATED_TIMES - 1.), tolerance)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Refuses two pairs with faces in common that meet the same rigid tool with a closed form. */
static PetscErrorCode RefuseTool(Contact contact, const ContactPair *a, const ContactPair *b)
{
  PetscBool share;

  PetscFunctionBeginUser;
  if (!SameTool(contact->mesh, a->scene, b->scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FaceMarksShare(a->slave, b->slave, &share));
  if (share)
    PetscCall(RefuseInput(contact->mesh->comm,
                          "%s: contact '%s' and '%s' have faces in common that meet the same rigid tool: their forces "
                          "would add up; allowed: one pair for each face and tool",
                          SceneWhere(contact->scene, a->scene->path, a->scene->listed ? "surfaces" : "slave"),
                          a->scene->name, b->scene->name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactRefuseRepeated - refuses two pairs of the same two surfaces, or of the same faces and the same rigid tool.

  Collective

  Input Parameter:
. contact - the contact, with the surfaces of its pairs

  Note:
  ContactOverride() refuses lists with faces in common.
@*/
PetscErrorCode ContactRefuseRepeated(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    for (int q = 0; q < p; q++) {
      const ContactPair *a = &contact->pairs[p], *b = &contact->pairs[q];

      PetscCall(RefuseNames(contact->mesh, contact->scene, a->scene, b->scene));
      PetscCall(RefuseTool(contact, a, b));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
