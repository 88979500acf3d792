/* Whatever bytes stand in a .msh file, its reader reads a mesh or complains, and frees what it made. */
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

  if (GmshRead(FuzzFile(data, size), &mesh, &complaint) || GmshReset(&mesh)) abort();
  return 0;
}
