/* What elasticity.c, cellpoints.c, enclosed.c, volumes.c, plasticstates.c and plasticpath.c share: the cells of an
   elasticity in batches. elasticity.c is below the others. */
#pragma once
#include "bodies/elasticity.h"
#include "kernels/elementkernel.h"
#include "matrix/nodematrix.h"

enum {
  MAX_DOFS            = ELEMENT_MAX_NODES * 3, /* of a cell */
  BYTES_OF_CACHE_LINE = 64,                    /* of the usual processors; arrays of a batch are aligned to it */
  /* Blocks are fetched this many pairs of nodes ahead. They are scattered in main memory, and 4 hides most of the wait.
   */
  PREFETCH_PAIRS = 4,
  PLASTIC_FLOW   = 6 /* components of the growth of a plastic strain */
};

/* Cells of one type and law, KERNEL_LANES to a batch. The last batch repeats its last cell. The arrays have one batch
   after the other. */
typedef struct {
  KernelCase kernel;
  int        nodes; /* of one cell */
  PetscInt   n_cells, n_batches;
  PetscInt  *cell; /* [lanes] */
  PetscInt  *node; /* [nodes][lanes] */
  PetscInt
    *block;     /* [nodes][nodes][lanes]: place of the pair of nodes in the block CSR; then PREFETCH_PAIRS of zeros */
  PetscReal *X; /* [nodes][dim][lanes] */
  /* Of bolts: what a shortening of 1 adds to the displacements of the nodes [nodes][dim][lanes], and the first of the
     nodes that have it (MeshTool), -1 in a cell of another body [lanes]; NULL where the group has no cell of a bolt */
  PetscReal   *pull;
  PetscInt    *bolt;
  PetscReal   *constants;   /* of the law [n_constants][lanes] */
  PetscInt     multipliers; /* where those of the first batch are in VolumeState; -1: the group has none */
  PetscInt     yielding;    /* the same in Elasticity.yielding */
  PetscReal   *state;       /* of a plastic law, accepted [points][states][lanes]; else NULL */
  PetscReal   *flow;        /* growth of plastic strains in the last step [cells][points][PLASTIC_FLOW]; else NULL */
  PetscReal   *length;      /* of the cells, for routines of users [lanes]; else NULL */
  PlasticBatch plastic;     /* what kernel.plastic points to, for the batch at hand */
  int          fault[KERNEL_LANES]; /* of routines of users, in the batch at hand */
} CellGroup;

/* Multipliers of the volume, [pressures][lanes] for each batch of the groups that have some: all that mixed elements
   remember from step to step */
typedef struct {
  PetscInt   n;
  PetscReal *multiplier; /* stress times root of volume */
} VolumeState;

/* Bodies that keep their volume exactly and have no free node whose motion would change it (enclosed.h) */
typedef struct {
  int              n_bodies;
  PetscBool        any, *body; /* any: the same on all ranks; body: [n_bodies] */
  const PetscBool *prescribed; /* whether a displacement is supported or imposed [n_nodes*dim] */
  PetscReal        change;     /* largest relative change of the volume of one of them at the last solution */
} Enclosed;

struct _n_Elasticity {
  Mesh        mesh;
  int         dim, n_groups;
  CellGroup  *groups;
  PetscInt   *cell_group, *cell_slot; /* of every local cell: its group, and its number there */
  PetscReal  *cell_modulus;
  PetscInt   *row, *column; /* block CSR over local nodes, columns ascending */
  PetscReal  *value;        /* dim x dim blocks, row-major, in the order of column */
  PetscReal  *u, *u_0;      /* of one batch, aligned to cache lines; u_0: of the state that pressures come from */
  PetscReal  *f, *K;        /* of one batch */
  void       *buffer;       /* what u, u_0, f and K are in */
  PetscInt    inverted;     /* a local cell that the last residual found inverted, or -1 */
  int         fault;        /* of the routine of the user there, or 0 */
  PetscBool   symmetric;
  NodeMatrix  matrix;
  PetscReal   accepted_t; /* time of the accepted plastic state */
  PetscReal   flow_dt;    /* length of the step that led there; 0: the growth in it says nothing of the next one */
  PetscBool   augments;   /* a body has multipliers, perhaps on other ranks only */
  VolumeState state, accepted, kept[VOLUMES_KEPT];
  PetscReal  *yielding;       /* multipliers of mixed elements while energies are compared, see ElasticityYield() */
  PetscBool   may_yield;      /* there are such elements, perhaps on other ranks only */
  PetscBool   yields, forces; /* they are; forces too */
  Enclosed    enclosed;
};

void       ElasticityGather(Elasticity, CellGroup *, PetscInt batch, const PetscReal *u, PetscReal *gathered);
size_t     ElasticityCellStates(const CellGroup *);
int        ElasticityBatchCells(const CellGroup *, PetscInt batch);
PetscReal *ElasticityYieldingOf(Elasticity, const CellGroup *, PetscInt batch);
PetscReal *ElasticityMultipliers(Elasticity, const CellGroup *, PetscInt batch);
PetscReal *ElasticityMultipliersOf(const CellGroup *, PetscInt batch, PetscReal *multipliers);
void       ElasticityGatherCell(Elasticity, CellGroup *, PetscInt slot, const PetscReal *u, PetscReal X[MAX_DOFS],
                                PetscReal cell_u[MAX_DOFS], PetscReal constants[MATERIAL_MAX_CONSTANTS],
                                PetscReal m[MIXED_PRESSURES]);
void       ElasticitySlotCoordinates(Elasticity, const CellGroup *, PetscInt slot, PetscReal *X);
PetscReal  ElasticityPointStrain(const CellGroup *, const PetscReal *state, PetscInt slot, int p);
PetscReal  ElasticityPointWork(const CellGroup *, const PetscReal *state, PetscInt slot, int p);
void       ElasticityPointTensor(const CellGroup *, const PetscReal *state, PetscInt slot, int p, PetscReal strain[6]);
PetscReal  ElasticitySlotVolume(Elasticity, const CellGroup *, PetscInt slot);
