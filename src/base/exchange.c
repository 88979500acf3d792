/* Records that are sent between all ranks, see exchange.h. */
#include "base/exchange.h"

/* Where the records for each rank begin, and how many there are. */
typedef struct {
  PetscMPIInt *count, *start;
} Portions;

static PetscErrorCode CountPortions(PetscMPIInt size, PetscInt n, const PetscMPIInt to[], Portions *send)
{
  PetscMPIInt all;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(n, &all)); /* no sum of counts is larger */
  for (PetscInt i = 0; i < n; i++)
    if (to[i] >= 0) send->count[to[i]]++;
  for (PetscMPIInt r = 0; r + 1 < size; r++) send->start[r + 1] = send->start[r] + send->count[r];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ShareCounts(MPI_Comm comm, PetscMPIInt size, const Portions *send, Portions *receive,
                                  PetscInt *n_arrived)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Alltoall(send->count, 1, MPI_INT, receive->count, 1, MPI_INT, comm));
  *n_arrived = 0;
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscCall(PetscMPIIntCast(*n_arrived, &receive->start[r]));
    *n_arrived += receive->count[r];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExchangeRecords - sends records to the ranks that shall have them, this one included.

  Collective

  Input Parameters:
+ comm    - the ranks
. bytes   - size of a record
. n       - number of records of this rank
. to      - rank to which each of them goes [n]; -1: it is not sent
. pack    - writes one of them
- context - for pack

  Output Parameters:
+ n_arrived - number of records that came
- arrived   - the records, in the order of the ranks from which they come, and of one rank in its order; to be
  freed with PetscFree()
@*/
PetscErrorCode ExchangeRecords(MPI_Comm comm, size_t bytes, PetscInt n, const PetscMPIInt to[], ExchangePack pack,
                               const void *context, PetscInt *n_arrived, void **arrived)
{
  Portions     send, receive;
  PetscMPIInt  size, n_sent, *next;
  char        *records;
  MPI_Datatype type;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(
    PetscCalloc5(size, &send.count, size, &send.start, size, &receive.count, size, &receive.start, size, &next));
  PetscCall(CountPortions(size, n, to, &send));
  n_sent = send.start[size - 1] + send.count[size - 1];
  PetscCall(PetscCalloc1((size_t)n_sent * bytes, &records));
  PetscCall(PetscArraycpy(next, send.start, size));
  for (PetscInt i = 0; i < n; i++)
    if (to[i] >= 0) pack(context, i, records + (size_t)next[to[i]]++ * bytes);
  if (size == 1) {
    *n_arrived = n_sent;
    *arrived   = records;
  } else {
    PetscCall(ShareCounts(comm, size, &send, &receive, n_arrived));
    PetscCall(PetscMalloc1((size_t)*n_arrived * bytes, (char **)arrived));
    PetscCallMPI(MPI_Type_contiguous((int)bytes, MPI_BYTE, &type));
    PetscCallMPI(MPI_Type_commit(&type));
    PetscCallMPI(
      MPI_Alltoallv(records, send.count, send.start, type, *arrived, receive.count, receive.start, type, comm));
    PetscCallMPI(MPI_Type_free(&type));
    PetscCall(PetscFree(records));
  }
  PetscCall(PetscFree5(send.count, send.start, receive.count, receive.start, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExchangeSources - says from which ranks records come.

  Collective

  Input Parameters:
+ comm - the ranks
. n    - number of records that this rank sends
- to   - rank to which each of them goes [n]

  Output Parameter:
. from - rank from which each record comes, in the order in which ExchangeRecords() returns them; to be freed with
  PetscFree()
@*/
PetscErrorCode ExchangeSources(MPI_Comm comm, PetscInt n, const PetscMPIInt to[], PetscMPIInt **from)
{
  Portions    send, receive;
  PetscMPIInt size;
  PetscInt    n_arrived;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscCalloc4(size, &send.count, size, &send.start, size, &receive.count, size, &receive.start));
  PetscCall(CountPortions(size, n, to, &send));
  PetscCall(ShareCounts(comm, size, &send, &receive, &n_arrived));
  PetscCall(PetscMalloc1(n_arrived, from));
  for (PetscMPIInt r = 0; r < size; r++)
    for (PetscMPIInt i = 0; i < receive.count[r]; i++) (*from)[receive.start[r] + i] = r;
  PetscCall(PetscFree4(send.count, send.start, receive.count, receive.start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ExchangeStarts - numbers things through all ranks.

  Collective

  Input Parameters:
+ comm - the ranks
- n    - how many this rank has

  Output Parameter:
. start - for each rank, how many lower ranks have; behind them the number of all [ranks + 1]; to be freed with
  PetscFree()
@*/
PetscErrorCode ExchangeStarts(MPI_Comm comm, PetscInt n, PetscInt **start)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1(size + 1, start));
  (*start)[0] = 0;
  PetscCallMPI(MPI_Allgather(&n, 1, MPIU_INT, *start + 1, 1, MPIU_INT, comm));
  for (PetscMPIInt r = 0; r < size; r++) (*start)[r + 1] += (*start)[r];
  PetscFunctionReturn(PETSC_SUCCESS);
}
