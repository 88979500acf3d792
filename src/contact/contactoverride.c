/* Pairs with a slave and a master beside lists of surfaces: where both have two surfaces, the pair treats them. Lists
   that cannot be treated are refused. */
#include "contactimpl.h"
#include "base/complaint.h"
#include "base/refusal.h"
#include "base/vectors.h"
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

/* Adds to way[3*n_nodes] the ways from the nodes of a surface to the centres of the faces around them. */
static PetscErrorCode NodeWays(ContactSurface surface, PetscReal *way)
{
  const Mesh mesh = surface->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(way, 3 * mesh->n_nodes));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const Facet *face = &surface->faces[f];
    const int    n    = ElementGet(face->type)->nodes;

    for (int d = 0; d < mesh->dim; d++) {
      PetscReal centre = 0;

      for (int a = 0; a < n; a++) centre += mesh->coords[face->nodes[a] * mesh->dim + d] / n;
      for (int a = 0; a < n; a++) way[3 * face->nodes[a] + d] += centre - mesh->coords[face->nodes[a] * mesh->dim + d];
    }
  }
  PetscCall(MeshSumNodes(mesh, 3, way));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses two masters of one list that are sides of a sharp convex edge of one body, each of them without the other.
   What has gone around the edge is behind the plane of the first and would be pressed back by it. */
static PetscErrorCode RefuseSidesOfEdge(Contact contact, const ContactPair *a, const ContactPair *b)
{
  const Mesh      mesh   = contact->mesh;
  const PetscReal cosine = PetscCosReal(a->fit.feature_angle);
  PetscReal      *area, *normal, *other, *way;
  Complaint       complaint = {""};
  PetscBool       meet;

  PetscFunctionBeginUser;
  PetscCall(MeshGroupsMeet(mesh, a->master->group, b->master->group, &meet));
  if (!meet) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(
    PetscMalloc4(mesh->n_nodes, &area, 3 * mesh->n_nodes, &normal, 3 * mesh->n_nodes, &other, 3 * mesh->n_nodes, &way));
  PetscCall(SurfaceNodeNormals(a->master, NULL, area, normal));
  PetscCall(SurfaceNodeNormals(b->master, NULL, area, other));
  PetscCall(NodeWays(b->master, way));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    const PetscReal *n = &normal[3 * i], *o = &other[3 * i], *w = &way[3 * i];
    const PetscReal  length = PetscSqrtReal(Dot(n, n) * Dot(o, o));

    if (length > 0 && Dot(n, o) < cosine * length && Dot(n, w) < 0)
      Complain(&complaint,
               "%s: contact '%s' lists '%s' and '%s', which meet at a sharp edge at node %" PetscInt_FMT
               ": past it each of them would press back what is in front of the other; allowed: one surface of the "
               "mesh that has both, or surfaces: all",
               SceneWhere(contact->scene, a->scene->path, "surfaces"), a->scene->name, b->scene->master,
               a->scene->master, mesh->node_tag[i]);
  }
  PetscCall(PetscFree4(area, normal, other, way));
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses what a listed pair cannot be beside another one before it. */
static PetscErrorCode RefuseBeside(Contact contact, const ContactPair *pair, const ContactPair *other)
{
  PetscFunctionBeginUser;
  if (!other->scene->listed || !other->master) PetscFunctionReturn(PETSC_SUCCESS);
  if (strcmp(other->scene->path, pair->scene->path) != 0) {
    PetscCall(RefuseCommonFaces(contact, pair, other));
  } else if (!strcmp(other->scene->slave, pair->scene->slave) && !pair->master->rigid && !other->master->rigid) {
    PetscCall(RefuseSidesOfEdge(contact, pair, other));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the faces and slave points of a listed pair that a pair with a slave and a master has, too. */
static PetscErrorCode MarkPair(ContactPair *listed, const ContactPair *named, int number)
{
  const ContactSurface side[] = {named->slave, named->master};

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
  int number = 0;

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
    PetscCall(MarkPair(listed, named, number++));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has pairs with a slave and a master take the place of lists that have faces of both. Refuses two lists with the same
   faces, and lists with sides of a sharp edge. Collective */
PetscErrorCode ContactOverride(Contact contact)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    if (!pair->scene->listed || !pair->master) continue;
    PetscCall(OverridePair(contact, pair));
    for (int q = 0; q < p; q++) PetscCall(RefuseBeside(contact, pair, &contact->pairs[q]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
