/* A checkpoint is the archive of all objects of a run, with the scene and the mesh file that it began with. */
#define _GNU_SOURCE /* memfd_create() */
#include "report/checkpoint.h"
#include "base/complaint.h"
#include "base/timing.h"
#include "mesh/pressurenodes.h"
#include <errno.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static const char MESH_NAME[] = "mesh/file";

struct _n_Checkpoint {
  MPI_Comm    comm;
  PetscMPIInt rank, size;
  char        name[PETSC_MAX_PATH_LEN]; /* of the file */
  /* This rank's part of the mesh file. The file itself may be gone or changed when the checkpoint is written. */
  PetscInt64  n_mesh;
  char       *mesh;
  Scene       scene;
  Model       model;
  LoadStepper stepper;
  Results     results;
  Archive     archive; /* while it is being loaded */
  FILE       *stream;  /* rank 0: the mesh, while it is being loaded */
};

static PetscErrorCode CheckpointNew(MPI_Comm comm, const char *directory, Checkpoint *checkpoint)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(checkpoint));
  (*checkpoint)->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &(*checkpoint)->rank));
  PetscCallMPI(MPI_Comm_size(comm, &(*checkpoint)->size));
  PetscCall(PetscSNPrintf((*checkpoint)->name, sizeof((*checkpoint)->name), "%s/checkpoint.h5", directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 reads the mesh file part by part and sends each rank its part. Its own part comes last, so that it holds one
   part at a time. */
static PetscErrorCode ShareOut(Checkpoint c, FILE *stream)
{
  PetscInt64  total = 0;
  PetscMPIInt n;

  PetscFunctionBeginUser;
  if (c->rank == 0 && !fseeko(stream, 0, SEEK_END)) total = (PetscInt64)ftello(stream);
  if (c->rank == 0) rewind(stream);
  PetscCallMPI(MPI_Bcast(&total, 1, MPIU_INT64, 0, c->comm));
  for (PetscMPIInt r = 0; r < c->size; r++) {
    const PetscMPIInt to    = (r + 1) % c->size;
    const PetscInt64  first = total * to / c->size;
    char             *part;

    if (c->rank && c->rank != to) continue;
    PetscCheck(total * (to + 1) / c->size - first <= PETSC_MPI_INT_MAX, PETSC_COMM_SELF, PETSC_ERR_SUP,
               "The mesh file is too long for so few ranks");
    n = (PetscMPIInt)(total * (to + 1) / c->size - first);
    PetscCall(PetscMalloc1(n, &part));
    if (c->rank == 0)
      PetscCheck(!fseeko(stream, first, SEEK_SET) && fread(part, 1, (size_t)n, stream) == (size_t)n, PETSC_COMM_SELF,
                 PETSC_ERR_FILE_READ, "Cannot read the mesh file: %s", strerror(errno));
    if (c->rank == 0 && to) PetscCallMPI(MPI_Send(part, n, MPI_CHAR, to, 0, c->comm));
    if (c->rank == to && to) PetscCallMPI(MPI_Recv(part, n, MPI_CHAR, 0, 0, c->comm, MPI_STATUS_IGNORE));
    if (c->rank == to) {
      c->mesh   = part;
      c->n_mesh = n;
    } else
      PetscCall(PetscFree(part));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointCreate - prepares the checkpoints of a run that begins; none is written yet.

  Collective

  Input Parameters:
+ comm      - all ranks
. directory - of the results
- mesh_file - its bytes are kept, each rank has a part of them

  Output Parameter:
. checkpoint - to be freed with CheckpointDestroy()

  Note:
  Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_READ.
@*/
PetscErrorCode CheckpointCreate(MPI_Comm comm, const char *directory, const char *mesh_file, Checkpoint *checkpoint)
{
  FILE *stream = NULL;

  PetscFunctionBeginUser;
  PetscCall(CheckpointNew(comm, directory, checkpoint));
  if (!(*checkpoint)->rank) {
    stream = fopen(mesh_file, "rb");
    PetscCheck(stream, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot read %s: %s", mesh_file, strerror(errno));
  }
  PetscCall(ShareOut(*checkpoint, stream));
  if (stream) fclose(stream);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointOpen - opens the checkpoint that a run left in its directory.

  Collective

  Input Parameters:
+ comm      - all ranks
- directory - of the results

  Output Parameter:
. checkpoint - to be freed with CheckpointDestroy()

  Note:
  A checkpoint that is missing, truncated, foreign, or of which a bit has changed is refused. No file is
  touched.
@*/
PetscErrorCode CheckpointOpen(MPI_Comm comm, const char *directory, Checkpoint *checkpoint)
{
  PetscFunctionBeginUser;
  PetscCall(CheckpointNew(comm, directory, checkpoint));
  PetscCall(ArchiveOpen(comm, (*checkpoint)->name, &(*checkpoint)->archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointDestroy - frees the checkpoint; its file stays.

  Collective

  Input Parameter:
. checkpoint - from CheckpointCreate() or CheckpointOpen()
@*/
PetscErrorCode CheckpointDestroy(Checkpoint *checkpoint)
{
  PetscFunctionBeginUser;
  if (!*checkpoint) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArchiveClose(&(*checkpoint)->archive));
  if ((*checkpoint)->stream) fclose((*checkpoint)->stream);
  PetscCall(PetscFree((*checkpoint)->mesh));
  PetscCall(PetscFree(*checkpoint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointReadScene - returns the scene as the run had it, with edits.

  Collective

  Input Parameters:
+ checkpoint - from CheckpointOpen()
. n_set      - number of edits
- set        - edits KEY=VALUE

  Output Parameter:
. scene - to be freed with SceneDestroy()

  Note:
  Edits of anything but solver, output and stepping are refused.
@*/
PetscErrorCode CheckpointReadScene(Checkpoint checkpoint, int n_set, char *const *set, Scene *scene)
{
  char          *file, *text;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(ArchiveText(checkpoint->archive, "scene/file", &file));
  PetscCall(ArchiveText(checkpoint->archive, "scene/text", &text));
  code = SceneReadAgain(checkpoint->comm, file, checkpoint->name, text, n_set, set, scene);
  PetscCall(PetscFree(file));
  PetscCall(PetscFree(text));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointMeshFile - returns where MeshCreate() finds the mesh.

  Collective

  Input Parameter:
. checkpoint - from CheckpointOpen()

  Output Parameter:
. file - name of a file in the memory of rank 0, empty on the others (PETSC_MAX_PATH_LEN characters)

  Note:
  The file goes with CheckpointRead() or CheckpointDestroy(). Errors: PETSC_ERR_MEM.
@*/
PetscErrorCode CheckpointMeshFile(Checkpoint checkpoint, char *file)
{
  Checkpoint c = checkpoint;

  PetscFunctionBeginUser;
  PetscCall(ArchiveBytes(c->archive, MESH_NAME, &c->n_mesh, &c->mesh));
  *file = '\0';
  if (c->rank == 0) {
    const int memory = memfd_create("checkpoint.msh", MFD_CLOEXEC);

    c->stream = memory < 0 ? NULL : fdopen(memory, "wb");
    PetscCheck(c->stream, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for the mesh file: %s", strerror(errno));
    PetscCall(PetscSNPrintf(file, PETSC_MAX_PATH_LEN, "/proc/self/fd/%d", memory));
  }
  PetscCall(ArchiveExtract(c->archive, MESH_NAME, c->stream));
  if (c->rank == 0)
    PetscCheck(!fflush(c->stream), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for the mesh file: %s", strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointSetRun - says which objects are saved and restored.

  Not collective

  Input Parameters:
+ checkpoint - borrows the others until it is destroyed
. scene      - as it was read, with its edits
. model      - of that scene
. stepper    - of that model
- results    - of that model
@*/
PetscErrorCode CheckpointSetRun(Checkpoint checkpoint, Scene scene, Model model, LoadStepper stepper, Results results)
{
  PetscFunctionBeginUser;
  checkpoint->scene   = scene;
  checkpoint->model   = model;
  checkpoint->stepper = stepper;
  checkpoint->results = results;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves which bodies have pressures at nodes, or refuses to go on with others: the unknowns would not be the same. */
static PetscErrorCode CheckpointPressures(Checkpoint c, Archive archive)
{
  const Scene scene     = c->scene;
  const Mesh  mesh      = c->model->mesh;
  Complaint   complaint = {""};
  PetscInt   *here, *saved;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(scene->n_bodies, &here, scene->n_bodies, &saved));
  for (PetscInt k = 0; k < mesh->n_cells; k++) here[mesh->cell_body[k]] |= CellHasPressureNodes(mesh, scene, k);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, here, scene->n_bodies, MPIU_INT, MPI_MAX, c->comm));
  PetscCall(PetscArraycpy(saved, here, scene->n_bodies));
  PetscCall(ArchiveIntegers(archive, "scene/pressures", scene->n_bodies, saved));
  for (int b = 0; b < scene->n_bodies; b++)
    if (saved[b] != here[b])
      Complain(&complaint,
               "%s: the run began with pressures of body '%s' %s, and this solver has them %s; allowed: the type with "
               "which it began",
               SceneWhere(scene, "solver", "type"), scene->bodies[b].name, saved[b] ? "at nodes" : "in elements",
               here[b] ? "at nodes" : "in elements");
  PetscCall(PetscFree2(here, saved));
  PetscCall(ComplaintRefuse(c->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads what changes from step to step. */
static PetscErrorCode CheckpointState(Checkpoint c, Archive archive)
{
  PetscFunctionBeginUser;
  PetscCall(CheckpointPressures(c, archive));
  PetscCall(ModelArchive(c->model, archive));
  PetscCall(LoadStepperArchive(c->stepper, archive));
  PetscCall(ResultsArchive(c->results, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names all values of a checkpoint, for the size or for the file. */
static PetscErrorCode CheckpointSave(Checkpoint c, Archive archive)
{
  PetscFunctionBeginUser;
  PetscCall(ArchiveText(archive, "scene/file", &c->scene->file));
  PetscCall(ArchiveText(archive, "scene/text", &c->scene->text));
  PetscCall(ArchiveBytes(archive, MESH_NAME, &c->n_mesh, &c->mesh));
  PetscCall(CheckpointState(c, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointRead - loads the saved state into the model, the stepper and the results.

  Collective

  Input Parameter:
. checkpoint - from CheckpointOpen(), after CheckpointSetRun() with fresh objects

  Note:
  A checkpoint that does not fit the objects is refused. No file is touched, ResultsStart() does that.
@*/
PetscErrorCode CheckpointRead(Checkpoint checkpoint)
{
  PetscFunctionBeginUser;
  PetscCall(CheckpointState(checkpoint, checkpoint->archive));
  PetscCall(ArchiveClose(&checkpoint->archive));
  if (checkpoint->stream) fclose(checkpoint->stream);
  checkpoint->stream = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointWrite - writes the state of the last accepted step, under a temporary name until it is whole and on the
  disk.

  Collective

  Input Parameter:
. checkpoint - after CheckpointSetRun()

  Note:
  Errors: PETSC_ERR_FILE_WRITE, where there is no room for instance. The checkpoint before is intact then.
@*/
PetscErrorCode CheckpointWrite(Checkpoint checkpoint)
{
  Archive    archive;
  PetscInt64 bytes;

  PetscFunctionBeginUser;
  TimingBegin(TIMING_OUTPUT);
  PetscCall(ArchiveMeasure(checkpoint->comm, &archive));
  PetscCall(CheckpointSave(checkpoint, archive));
  PetscCall(ArchiveSize(archive, &bytes));
  PetscCall(ArchiveClose(&archive));
  PetscCall(ArchiveCreate(checkpoint->comm, checkpoint->name, bytes, &archive));
  PetscCall(CheckpointSave(checkpoint, archive));
  PetscCall(ArchiveClose(&archive));
  TimingEnd(TIMING_OUTPUT);
  PetscFunctionReturn(PETSC_SUCCESS);
}
