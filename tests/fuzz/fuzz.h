/* Functions that the fuzzers of the readers share. FuzzStart() starts PETSc. FuzzFile() gives the input as a file in
   memory, so that nothing is written to a disk. A fuzzer consists of LLVMFuzzerInitialize() and
   LLVMFuzzerTestOneInput(), for libFuzzer (make fuzz, with FUZZER defined) and for the driver of AFL++. If there is no
   fuzzer, a main() replays files. */
#define _GNU_SOURCE /* memfd_create() */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#include "base/petsccompat.h"

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Returns the path of a file in memory that holds the input. It is the same file in each call. */
static const char *FuzzFile(const uint8_t *data, size_t size)
{
  static int  file = -1;
  static char path[64];

  if (file < 0) {
    file = memfd_create("input", 0);
    snprintf(path, sizeof(path), "/proc/self/fd/%d", file);
  }
  if (file < 0 || ftruncate(file, 0) || pwrite(file, data, size, 0) != (ssize_t)size) abort();
  return path;
}

/* Starts PETSc without the command line, which holds the options of the fuzzer. */
static void FuzzStart(void)
{
  if (PetscInitialize(NULL, NULL, NULL, NULL)) abort();
}

#ifndef FUZZER
static int ReplayFile(const char *path)
{
  FILE    *file = fopen(path, "rb");
  uint8_t *data = malloc(1 << 24);
  size_t   size = file && data ? fread(data, 1, 1 << 24, file) : 0;

  if (!file || !data) abort();
  fclose(file);
  LLVMFuzzerTestOneInput(data, size);
  free(data);
  return 1;
}

/* Replays every file of the folders, so that an input that a fuzzer has found once is tested again each time. */
int main(int argc, char **argv)
{
  int n = 0;

  LLVMFuzzerInitialize(&argc, &argv);
  for (int i = 1; i < argc; i++) {
    DIR *folder = opendir(argv[i]);

    if (!folder) abort();
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
      char path[4096];

      snprintf(path, sizeof(path), "%s/%s", argv[i], entry->d_name);
      if (entry->d_type == DT_REG) n += ReplayFile(path);
    }
    closedir(folder);
  }
  printf("%d inputs\n", n);
  if (PetscFinalize()) return 1;
  return n > 0 ? 0 : 1;
}
#endif
