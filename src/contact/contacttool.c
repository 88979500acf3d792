/* Contact with a rigid tool whose motion has unknowns: its nodes in variations, forces and tangent.

   Contact does not change when slave and tool move together as one rigid body. So the slave nodes of a slave point tell
   everything: if B_s is the velocity of a place of the tool that coincides with slave node s, over the tool's dofs, the
   first variation of a gap over these dofs is -sum B_s^T N_s. The derivative of that gives the tangent. */
#include "contactimpl.h"
#include "kernels/rigidkernel.h"

/* The tool at the last update of the lists. */
typedef struct {
  const MeshTool *tool;
  int             dim, turns;      /* turns: number of rotation components */
  PetscReal       point[3];        /* relative to the mesh's centre (length) */
  double          spin[3][3];      /* angular velocity of each rotation component over its dof (1 / length) */
  double          change[3][3][3]; /* change[l][k]: derivative of spin[k] by rotation dof l (1 / length^2) */
} ToolState;

static void FindTool(const ContactPair *pair, ToolState *s)
{
  const NeighbourLists lists = pair->lists;
  PetscReal            turn[3];

  s->tool  = pair->tool;
  s->dim   = lists->dim;
  s->turns = s->dim == 3 ? 3 : 1;
  ToolGetPlace(pair->mesh, s->tool, &lists->u[lists->tool * s->dim], s->point, turn);
  RigidTurnRate(turn, s->spin);
  RigidTurnRateChange(turn, s->change);
  for (int k = 0; k < s->turns; k++) {
    const int component = s->dim == 3 ? k : 2;

    for (int d = 0; d < 3; d++) s->spin[k][d] = s->spin[component][d] / s->tool->arm;
    for (int l = 0; l < s->turns; l++)
      for (int d = 0; d < 3; d++)
        s->change[l][k][d] = s->change[s->dim == 3 ? l : 2][component][d] / PetscSqr(s->tool->arm);
  }
}

static void Cross(const double a[3], const double b[3], double c[3])
{
  for (int d = 0; d < 3; d++) c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/* Place of a contact node from the tool's point. */
static void Arm(const ContactPair *pair, const ToolState *s, PetscInt node, double arm[3])
{
  const NeighbourLists lists = pair->lists;

  for (int d = 0; d < 3; d++)
    arm[d] = d < s->dim ? lists->X[node * s->dim + d] + lists->u[node * s->dim + d] - s->point[d] : 0;
}

/* Velocity B[dim][2*dim] of what belongs to the tool at a contact node, over the tool's dofs. */
static void Velocity(const ContactPair *pair, const ToolState *s, PetscInt node, PetscReal *B)
{
  const int width = TOOL_NODES * s->dim;
  double    arm[3], v[3];

  Arm(pair, s, node, arm);
  for (int i = 0; i < s->dim * width; i++) B[i] = 0;
  for (int d = 0; d < s->dim; d++) B[d * width + d] = 1;
  for (int k = 0; k < s->turns; k++) {
    Cross(s->spin[k], arm, v);
    for (int d = 0; d < s->dim; d++) B[d * width + s->dim + k] = v[d];
  }
}

/* Adds the forces on the tool, own[2*dim], to those N[n*dim] on some nodes, of which the slave nodes count. */
static void Balance(const ContactPair *pair, PetscInt n, const PetscInt *nodes, const PetscReal *N, PetscReal *own)
{
  ToolState s;

  FindTool(pair, &s);
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt node  = nodes ? nodes[i] : i;
    const int      width = TOOL_NODES * s.dim;
    PetscReal      B[3 * TOOL_NODES * 3];

    if (node >= pair->lists->tool) continue;
    Velocity(pair, &s, node, B);
    for (int q = 0; q < width; q++)
      for (int d = 0; d < s.dim; d++) own[q] -= B[d * width + q] * N[i * s.dim + d];
  }
}

/*@
  ContactToolVariation - computes the first variation of a gap over the tool's dofs.

  Not collective

  Input Parameters:
+ pair  - the pair, whose master is a tool with free motions
. n     - number of nodes
. nodes - contact nodes of the gap
- N     - first variation over them [n*dim]

  Output Parameter:
. own - first variation over the dofs of the tool's two nodes [2*dim]
@*/
PetscErrorCode ContactToolVariation(const ContactPair *pair, PetscInt n, const PetscInt nodes[], const PetscReal *N,
                                    PetscReal *own)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(own, TOOL_NODES * pair->mesh->dim));
  Balance(pair, n, nodes, N, own);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactToolForces - sets the forces on the tool to the reactions of those on the slave nodes.

  Not collective

  Input Parameter:
. pair - the pair, whose master is a tool with free motions

  Input/Output Parameter:
. values - forces on the contact nodes [n_nodes*dim]
@*/
PetscErrorCode ContactToolForces(const ContactPair *pair, PetscReal *values)
{
  PetscReal *own = &values[pair->lists->tool * pair->mesh->dim];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(own, TOOL_NODES * pair->mesh->dim));
  Balance(pair, pair->lists->tool, NULL, values, own);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactToolRelative - takes the motion of the tool from that of the slave nodes.

  Not collective

  Input Parameter:
. pair - the pair, whose master is a tool with free motions

  Input/Output Parameter:
. values - motion of the contact nodes [n_nodes*dim] (length); that of the slave nodes becomes relative to the tool
@*/
PetscErrorCode ContactToolRelative(const ContactPair *pair, PetscReal *values)
{
  const PetscReal *own = &values[pair->lists->tool * pair->mesh->dim];
  PetscReal        B[3 * TOOL_NODES * 3];
  ToolState        s;

  PetscFunctionBeginUser;
  FindTool(pair, &s);
  for (PetscInt i = 0; i < pair->lists->tool; i++) {
    Velocity(pair, &s, i, B);
    for (int d = 0; d < s.dim; d++)
      for (int q = 0; q < TOOL_NODES * s.dim; q++) values[i * s.dim + d] -= B[d * TOOL_NODES * s.dim + q] * own[q];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows and columns of a block's tangent that belong to the tool's dofs. */
typedef struct {
  ToolState        s;
  PetscInt         n, m; /* nodes and dofs of the block */
  const PetscInt  *nodes;
  const PetscReal *force;
  PetscInt         row[6]; /* of each dof of the tool */
  PetscReal       *B;      /* n*dim*2*dim */
  PetscReal       *K;
} ToolBlock;

/* Columns of the tool in the rows of slave node i. */
static void SlaveRows(ToolBlock *b, PetscInt i)
{
  const int dim = b->s.dim, width = TOOL_NODES * dim;

  for (int d = 0; d < dim; d++) {
    PetscReal *row    = &b->K[(i * dim + d) * b->m];
    PetscReal  sum[6] = {0};

    for (PetscInt j = 0; j < b->m; j++)
      for (int q = 0; q < width; q++) sum[q] -= row[j] * b->B[j * width + q];
    for (int q = 0; q < width; q++) row[b->row[q]] = sum[q];
  }
  for (int k = 0; k < b->s.turns; k++) {
    double force[3] = {0}, turned[3];

    for (int d = 0; d < dim; d++) force[d] = b->force[i * dim + d];
    Cross(b->s.spin[k], force, turned);
    for (int d = 0; d < dim; d++) b->K[(i * dim + d) * b->m + b->row[dim + k]] += turned[d];
  }
}

/* What a slave node adds to the rows of the tool, besides the products with B: the turn of its force. */
static void TurnRows(const ContactPair *pair, ToolBlock *b, PetscInt i)
{
  const int dim      = b->s.dim;
  double    force[3] = {0}, arm[3], moment[3], turned[3];

  for (int d = 0; d < dim; d++) force[d] = b->force[i * dim + d];
  Arm(pair, &b->s, b->nodes[i], arm);
  Cross(arm, force, moment);
  for (int k = 0; k < b->s.turns; k++) {
    PetscReal *row = &b->K[b->row[dim + k] * b->m];

    Cross(b->s.spin[k], force, turned);
    for (int d = 0; d < dim; d++) {
      row[i * dim + d] += turned[d];
      row[b->row[d]] -= turned[d];
    }
    for (int l = 0; l < b->s.turns; l++)
      for (int d = 0; d < 3; d++) row[b->row[dim + l]] -= b->s.change[l][k][d] * moment[d];
  }
}

/*@
  ContactToolBlock - completes a block of the tangent by the rows and columns of the tool's dofs.

  Not collective

  Input Parameters:
+ pair  - the pair, whose master is a tool with free motions
. n     - number of nodes of the block
. nodes - its contact nodes, all slave nodes of its terms and the two nodes of the tool among them
- force - residual of what the block is the derivative of [n*dim]; slave nodes count

  Input/Output Parameter:
. M - the block [(n*dim)^2]; the rows and columns of slave nodes are read, those of the tool overwritten
@*/
PetscErrorCode ContactToolBlock(const ContactPair *pair, PetscInt n, const PetscInt nodes[], const PetscReal *force,
                                PetscReal *M)
{
  const PetscInt tool = pair->lists->tool;
  ToolBlock      b    = {.n = n, .nodes = nodes, .force = force, .K = M};
  int            dim, width;

  PetscFunctionBeginUser;
  FindTool(pair, &b.s);
  dim   = b.s.dim;
  width = TOOL_NODES * dim;
  b.m   = n * dim;
  PetscCall(PetscCalloc1(n * dim * width, &b.B));
  for (PetscInt i = 0; i < n; i++) {
    if (nodes[i] < tool) Velocity(pair, &b.s, nodes[i], &b.B[i * dim * width]);
    for (int d = 0; d < dim && nodes[i] >= tool && nodes[i] < tool + TOOL_NODES; d++)
      b.row[(nodes[i] - tool) * dim + d] = i * dim + d;
  }
  for (int q = 0; q < width; q++)
    for (PetscInt j = 0; j < b.m; j++) M[b.row[q] * b.m + j] = M[j * b.m + b.row[q]] = 0;
  for (PetscInt i = 0; i < n; i++)
    if (nodes[i] < tool) SlaveRows(&b, i);
  for (PetscInt i = 0; i < b.m; i++)
    for (int q = 0; q < width && nodes[i / dim] < tool; q++)
      for (PetscInt j = 0; j < b.m; j++) M[b.row[q] * b.m + j] -= b.B[i * width + q] * M[i * b.m + j];
  for (PetscInt i = 0; i < n; i++)
    if (nodes[i] < tool) TurnRows(pair, &b, i);
  PetscCall(PetscFree(b.B));
  PetscFunctionReturn(PETSC_SUCCESS);
}
