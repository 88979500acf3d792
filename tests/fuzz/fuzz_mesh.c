/* Shows that the reader of .msh files reads a mesh or complains, whatever bytes the file has, and that all its memory
   is freed. */
#include "fuzz.h"
#include "gmshfile.h"

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc;
  (void)argv;
  FuzzStart();
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  Complaint complaint = {""};
  GmshMesh  mesh;

  if (GmshRead(PETSC_COMM_SELF, FuzzFile(data, size), &mesh, &complaint) || GmshReset(&mesh)) abort();
  return 0;
}
