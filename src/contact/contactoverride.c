/* Pairs with a slave and a master beside lists of surfaces: where both have two surfaces, the pair treats them. Lists
   that cannot be treated are refused. */
#include "contactimpl.h"
#include "base/refusal.h"
#include "search/facemarks.h"

/* Refuses two lists that have faces of two surfaces in common, because their forces would add up. */
static PetscErrorCode RefuseCommonFaces(Contact contact, const ContactPair *a, const ContactPair *b)
{
  PetscBool straight[2], crossed[2];

  PetscFunctionBeginUser;
  PetscCall(FaceMarksShare(a->slave, b->slave, &straight[0]));
  PetscCall(FaceMarksShare(a->master, b->master, &straight[1]));
  PetscCall(FaceMarksShare(a->slave, b->master, &crossed[0]));
  PetscCall(FaceMarksShare(a->master, b->slave, &crossed[1]));
  if ((straight[0] && straight[1]) || (crossed[0] && crossed[1]))
    PetscCall(RefuseInput(contact->mesh->comm,
                          "%s: contact '%s' and '%s' list faces of the same two surfaces: their forces would add up; "
                          "allowed: one list for them, or exclude in one",
                          SceneWhere(contact->scene, a->scene->path, "surfaces"), a->scene->name, b->scene->name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses what a listed pair cannot be beside another one before it. */
static PetscErrorCode RefuseBeside(Contact contact, const ContactPair *pair, const ContactPair *other)
{
  PetscFunctionBeginUser;
  if (!other->scene->listed || !other->master) PetscFunctionReturn(PETSC_SUCCESS);
  if (strcmp(other->scene->path, pair->scene->path) != 0) PetscCall(RefuseCommonFaces(contact, pair, other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the faces and slave points of a listed pair that two surfaces have, too. The pair leaves them out where they
   meet each other. */
static PetscErrorCode MarkApart(ContactPair *listed, ContactSurface slave, ContactSurface master, int number)
{
  const ContactSurface side[] = {slave, master};

  PetscFunctionBeginUser;
  if (!listed->marks) PetscCall(PetscCalloc1(listed->slaves->n, &listed->marks));
  for (int k = 0; k < 2; k++) {
    PetscCall(FaceMarksAdd(listed->slave, side[k], 2 * number + k));
    PetscCall(FaceMarksAdd(listed->master, side[k], 2 * number + k));
    PetscCall(FaceMarksPoints(listed->slaves, side[k], 2 * number + k, listed->marks));
  }
  SearchSetMarks(listed->search, listed->marks);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes from a pair of joined surfaces the parts that do not meet. */
static PetscErrorCode LeaveApart(Contact contact, Elasticity elasticity, ContactPair *listed)
{
  const SceneContact *scene = listed->scene;

  PetscFunctionBeginUser;
  if (scene->n_apart > FACE_MARKS_PAIRS)
    PetscCall(RefuseInput(
      contact->mesh->comm, "%s: contact '%s' leaves out %d pairs of the surfaces that are joined in it; allowed: %d",
      SceneWhere(contact->scene, scene->path, "exclude"), scene->name, scene->n_apart, FACE_MARKS_PAIRS));
  for (int k = 0; k < scene->n_apart; k++) {
    ContactSurface slave = NULL, master = NULL;

    PetscCall(
      SurfaceCreate(contact->mesh, contact->scene, elasticity, scene->path, "exclude", scene->apart[k].slave, &slave));
    PetscCall(SurfaceCreate(contact->mesh, contact->scene, elasticity, scene->path, "exclude", scene->apart[k].master,
                            &master));
    PetscCall(MarkApart(listed, slave, master, k));
    PetscCall(SurfaceDestroy(&slave));
    PetscCall(SurfaceDestroy(&master));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do a listed pair and one with a slave and a master have faces of the same two surfaces? The same on all ranks. */
static PetscErrorCode PairsMeet(const ContactPair *listed, const ContactPair *named, PetscBool *meet)
{
  PetscBool slave, master;

  PetscFunctionBeginUser;
  PetscCall(FaceMarksShare(listed->slave, named->slave, &slave));
  PetscCall(FaceMarksShare(listed->master, named->master, &master));
  *meet = (PetscBool)(slave && master);
  PetscCall(FaceMarksShare(listed->slave, named->master, &slave));
  PetscCall(FaceMarksShare(listed->master, named->slave, &master));
  *meet = (PetscBool)(*meet || (slave && master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes from a listed pair what pairs with a slave and a master treat. */
static PetscErrorCode OverridePair(Contact contact, ContactPair *listed)
{
  int number = listed->scene->n_apart;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    const ContactPair *named = &contact->pairs[p];
    PetscBool          meet  = PETSC_FALSE;

    if (named->scene->listed || !named->master) continue;
    PetscCall(PairsMeet(listed, named, &meet));
    if (!meet) continue;
    if (number == FACE_MARKS_PAIRS)
      PetscCall(RefuseInput(contact->mesh->comm,
                            "%s: contact '%s' is one of more than %d pairs by slave and master whose surfaces '%s' "
                            "lists; allowed: %d of them",
                            SceneWhere(contact->scene, named->scene->path, "slave"), named->scene->name,
                            FACE_MARKS_PAIRS, listed->scene->name, FACE_MARKS_PAIRS));
    PetscCall(MarkApart(listed, named->slave, named->master, number++));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has pairs with a slave and a master take the place of lists that have faces of both. Refuses two lists with the same
   faces. Collective */
PetscErrorCode ContactOverride(Contact contact, Elasticity elasticity)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    if (!pair->scene->listed || !pair->master) continue;
    PetscCall(LeaveApart(contact, elasticity, pair));
    PetscCall(OverridePair(contact, pair));
    for (int q = 0; q < p; q++) PetscCall(RefuseBeside(contact, pair, &contact->pairs[q]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
