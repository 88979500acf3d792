/* gmsh: a .geo file is meshed once for each content, gmsh's errors reach the user, text and binary files give the same
   mesh, and a damaged file is refused. */
#include "gmsh.h"
#include "gmshfile.h"
#include "gmshprocess.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static const char *const geometry =
  "Include \"size.geo\";\n"
  "DefineConstant[ n = {2, Name \"n\"} ];\n"
  "Point(1) = {0, 0, 0}; Point(2) = {length, 0, 0}; Point(3) = {length, 1, 0}; Point(4) = {0, 1, 0};\n"
  "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
  "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
  "Transfinite Curve{1, 2, 3, 4} = n + 1; Transfinite Surface{1}; Recombine Surface{1};\n"
  "Physical Surface(\"block one\", 7) = {1}; Physical Curve(\"left\", 7) = {-4}; Physical Curve(3) = {2}; Physical "
  "Point(\"corner\") = {1};\n";

/* length is a parameter. width is not one, because the file assigns its value without declaring it. */
static const char *const sizes  = "If (!Exists(length)) length = 2; EndIf\nwidth = 4;\n";
static const char *const longer = "If (!Exists(length)) length = 3; EndIf\nwidth = 4;\n";

static const char *const wrong = "DefineConstant[n = 1];\nFoo(1);\n";

static void WriteText(const char *name, const char *text, size_t size, char path[PETSC_MAX_PATH_LEN])
{
  FILE *stream;

  snprintf(path, PETSC_MAX_PATH_LEN, "%s/%s", folder, name);
  stream = fopen(path, "wb");
  assert_non_null(stream);
  assert_int_equal(fwrite(text, 1, size, stream), size);
  fclose(stream);
}

static char *ReadText(const char *path, size_t *size)
{
  static char text[1 << 16];
  FILE       *stream = fopen(path, "rb");

  assert_non_null(stream);
  *size = fread(text, 1, sizeof(text) - 1, stream);
  fclose(stream);
  text[*size] = '\0';
  return text;
}

static Scene MakeScene(const char *parameters)
{
  char  path[PETSC_MAX_PATH_LEN], text[1024];
  Scene scene;

  WriteText("size.geo", sizes, strlen(sizes), path);
  WriteText("block.geo", geometry, strlen(geometry), path);
  snprintf(text, sizeof(text),
           "mesh: {file: block.geo, order: 2, parameters: %s}\ngeometry: plane_strain\nbodies: [{volume: block one, "
           "material: {law: svk, E: 1, nu: 0.3}}]\n",
           parameters);
  WriteText("scene.yaml", text, strlen(text), path);
  assert_int_equal(SceneRead(PETSC_COMM_SELF, path, 0, NULL, &scene), 0);
  return scene;
}

/* Meshes in folder/out; returns the file, or the complaint if there is one. */
static PetscReal Generate(const char *parameters, char *file, Complaint *complaint)
{
  Scene     scene = MakeScene(parameters);
  char      directory[PETSC_MAX_PATH_LEN];
  PetscReal seconds;

  complaint->text[0] = '\0';
  snprintf(directory, sizeof(directory), "%s/out/meshes", folder);
  assert_int_equal(GmshGenerate(scene, directory, PETSC_FALSE, file, &seconds, complaint), 0);
  assert_int_equal(SceneDestroy(&scene), 0);
  return seconds;
}

static void test_meshed_once(void **state)
{
  char      first[PETSC_MAX_PATH_LEN], again[PETSC_MAX_PATH_LEN], other[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN];
  Complaint complaint;
  GmshMesh  mesh;
  PetscReal seconds;

  (void)state;
  seconds = Generate("{n: 3}", first, &complaint);
  assert_string_equal(complaint.text, "");
  assert_true(seconds > 0);
  seconds = Generate("{n: 3}", again, &complaint);
  assert_string_equal(first, again);
  assert_true(seconds == 0);
  Generate("{n: 4}", other, &complaint);
  assert_string_not_equal(first, other);
  assert_int_equal(GmshRead(PETSC_COMM_SELF, first, &mesh, &complaint), 0);
  assert_string_equal(complaint.text, "");
  assert_int_equal(mesh.n_nodes, 7 * 7);
  assert_int_equal(GmshReset(&mesh), 0);

  /* an included file counts: it is changed without a change of the scene */
  Scene scene = MakeScene("{n: 3}");

  WriteText("size.geo", longer, strlen(longer), path);
  snprintf(path, sizeof(path), "%s/out/meshes", folder);
  assert_int_equal(GmshGenerate(scene, path, PETSC_FALSE, other, &seconds, &complaint), 0);
  assert_string_equal(complaint.text, "");
  assert_string_not_equal(first, other);
  assert_int_equal(SceneDestroy(&scene), 0);
}

/* Two parameters change by one digit each. A sum of their plain FNV hashes would not change. */
static void test_names_differ(void **state)
{
  const char *const parameters[] = {"{n: 3, length: 2}", "{n: 2, length: 3}", "{length: 3, n: 2}"};
  char              file[3][PETSC_MAX_PATH_LEN];
  Complaint         complaint;

  (void)state;
  for (int i = 0; i < 3; i++) Generate(parameters[i], file[i], &complaint);
  assert_string_not_equal(file[0], file[1]);
  assert_string_equal(file[1], file[2]);
}

static void test_without_gmsh(void **state)
{
  char      made[PETSC_MAX_PATH_LEN], found[PETSC_MAX_PATH_LEN], *search = strdup(getenv("PATH"));
  Complaint complaint, missing;

  (void)state;
  Generate("{n: 3}", made, &complaint);
  setenv("PATH", "/nonexistent", 1);
  Generate("{n: 3}", found, &complaint);
  Generate("{n: 5}", found, &missing);
  setenv("PATH", search, 1);
  free(search);
  assert_string_equal(complaint.text, "");
  assert_non_null(strstr(missing.text, "gmsh is not installed here"));
  assert_non_null(strstr(missing.text, "-mesh"));
  Generate("{n: 3}", found, &complaint);
  assert_string_equal(made, found);
}

/* Puts a program named gmsh first on PATH and asks for its version. */
static char *VersionOf(const char *command)
{
  char search[8192], line[256], *before = strdup(getenv("PATH")), *version;

  snprintf(line, sizeof(line), command, folder);
  assert_int_equal(system(line), 0);
  snprintf(search, sizeof(search), "%s:%s", folder, before);
  setenv("PATH", search, 1);
  assert_int_equal(GmshVersion(folder, &version), 0);
  setenv("PATH", before, 1);
  free(before);
  return version;
}

/* The version of a binary is asked for once. One that was put there anew, and a script, are asked. */
static void test_version_is_kept(void **state)
{
  char *first = VersionOf("cp /bin/echo %s/gmsh"), *kept, *again, *script;

  (void)state;
  kept   = VersionOf("cd %s && sed -i 1q gmsh-version.txt && echo kept >>gmsh-version.txt");
  again  = VersionOf("cd %s && cp gmsh other && mv other gmsh");
  script = VersionOf("cd %s && printf '#!/bin/sh\\necho 9\\n' >other && chmod +x other && mv other gmsh");
  assert_string_equal(kept, "kept\n");
  assert_string_equal(again, first);
  assert_string_equal(script, "9\n");
  assert_int_equal(PetscFree(first), 0);
  assert_int_equal(PetscFree(kept), 0);
  assert_int_equal(PetscFree(again), 0);
  assert_int_equal(PetscFree(script), 0);
  script = VersionOf("rm %s/gmsh");
  assert_int_equal(PetscFree(script), 0);
}

/* A gmsh that does what a script says in place of meshing */
static void GenerateBy(const char *script, Complaint *complaint)
{
  static int number = 100;
  char       path[PETSC_MAX_PATH_LEN], search[8192], text[1024], file[PETSC_MAX_PATH_LEN], parameters[32],
    *before = strdup(getenv("PATH"));

  snprintf(text, sizeof(text), "#!/bin/sh\n[ \"$1\" = --version ] && { echo 4.8.4; exit 0; }\n%s\n", script);
  WriteText("gmsh", text, strlen(text), path);
  assert_int_equal(chmod(path, 0755), 0);
  snprintf(search, sizeof(search), "%s:%s", folder, before);
  setenv("PATH", search, 1);
  snprintf(parameters, sizeof(parameters), "{n: %d}", number++);
  Generate(parameters, file, complaint);
  setenv("PATH", before, 1);
  free(before);
  unlink(path);
  assert_int_equal(access(file, F_OK), -1);
}

/* A crash of gmsh is told as one, with its last lines, and so is a failure without an error line. */
static void test_crash(void **state)
{
  Complaint complaint;

  (void)state;
  GenerateBy("echo Info: one; echo Info: two; kill -SEGV $$", &complaint);
  assert_non_null(strstr(complaint.text, "scene.yaml:1: mesh.file: gmsh was ended on '"));
  assert_non_null(
    strstr(complaint.text, "by signal 11 (Segmentation fault), a crash of gmsh itself; allowed: another"));
  assert_non_null(strstr(complaint.text, "\n  gmsh: Info: one\n  gmsh: Info: two"));
  GenerateBy("exit 139", &complaint); /* by a script around gmsh */
  assert_non_null(strstr(complaint.text, "by signal 11 (Segmentation fault)"));
  assert_non_null(strstr(complaint.text, "its last lines: none"));
  GenerateBy("kill -KILL $$", &complaint);
  assert_non_null(strstr(complaint.text, "by signal 9 (Killed), mostly for lack of memory; allowed: a coarser mesh"));
  GenerateBy("for i in 1 2 3 4 5 6 7 8; do echo line $i; done; exit 3", &complaint);
  assert_non_null(strstr(complaint.text, "(exit status 3) and names no error; its last lines:\n  gmsh: line 3\n"));
  assert_non_null(strstr(complaint.text, "gmsh: line 8"));
  GenerateBy("echo 'Fatal   : no room'; exit 1", &complaint);
  assert_non_null(strstr(complaint.text, "(exit status 1)\n  gmsh: Fatal   : no room"));
}

static void test_mistakes_in_geo(void **state)
{
  char      file[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN], directory[PETSC_MAX_PATH_LEN];
  Complaint complaint;
  PetscReal seconds;
  Scene     scene;

  (void)state;
  Generate("{nn: 3}", file, &complaint);
  assert_non_null(strstr(complaint.text, "scene.yaml:1: mesh.parameters.nn: "));
  assert_non_null(strstr(complaint.text, "no parameter of this name; allowed: n, length"));
  Generate("{n: 3, width: 5}", file, &complaint);
  assert_non_null(strstr(complaint.text, "mesh.parameters.width: "));
  Generate("{n: 3, Mesh.Algorithm: 6}", file, &complaint);
  assert_string_equal(complaint.text, "");

  scene = MakeScene("{n: 3}");
  WriteText("block.geo", wrong, strlen(wrong), path);
  snprintf(directory, sizeof(directory), "%s/out/meshes", folder);
  complaint.text[0] = '\0';
  assert_int_equal(GmshGenerate(scene, directory, PETSC_FALSE, file, &seconds, &complaint), 0);
  assert_non_null(strstr(complaint.text, "gmsh failed on"));
  assert_non_null(strstr(complaint.text, "line 2"));
  assert_int_equal(access(file, F_OK), -1);

  unlink(path);
  complaint.text[0] = '\0';
  assert_int_equal(GmshGenerate(scene, directory, PETSC_FALSE, file, &seconds, &complaint), 0);
  assert_non_null(strstr(complaint.text, "there is no file"));
  assert_int_equal(SceneDestroy(&scene), 0);
}

static void ConvertBinary(const char *text, char *binary)
{
  char command[3 * PETSC_MAX_PATH_LEN];

  snprintf(binary, PETSC_MAX_PATH_LEN, "%s/binary.msh", folder);
  snprintf(command, sizeof(command), "gmsh %s -save -bin -v 1 -format msh41 -o %s", text, binary);
  assert_int_equal(system(command), 0);
}

static void test_binary_equals_text(void **state)
{
  char      file[PETSC_MAX_PATH_LEN], binary[PETSC_MAX_PATH_LEN];
  Complaint complaint;
  GmshMesh  a, b;

  (void)state;
  Generate("{n: 3}", file, &complaint);
  ConvertBinary(file, binary);
  assert_int_equal(GmshRead(PETSC_COMM_SELF, file, &a, &complaint), 0);
  assert_int_equal(GmshRead(PETSC_COMM_SELF, binary, &b, &complaint), 0);
  assert_string_equal(complaint.text, "");
  assert_int_equal(a.n_nodes, b.n_nodes);
  assert_memory_equal(a.node_tag, b.node_tag, (size_t)a.n_nodes * sizeof(PetscInt));
  assert_memory_equal(a.coords, b.coords, (size_t)a.n_nodes * 3 * sizeof(PetscReal));
  assert_int_equal(a.n_physicals, 4);
  assert_int_equal(b.n_physicals, 4);
  assert_string_equal(a.physicals[0].name, "block one");
  assert_string_equal(a.physicals[1].name, "3"); /* the number of a group without a name is its name */
  assert_string_equal(a.physicals[2].name, "left");
  assert_string_equal(a.physicals[3].name, "corner");
  assert_int_equal(a.n_blocks, b.n_blocks);
  for (int i = 0; i < a.n_blocks; i++) {
    const GmshBlock *p = &a.blocks[i], *q = &b.blocks[i];

    assert_int_equal(p->n, q->n);
    assert_ptr_equal(p->element, q->element);
    assert_memory_equal(p->tag, q->tag, (size_t)p->n * sizeof(PetscInt));
    assert_memory_equal(p->connectivity, q->connectivity, (size_t)(p->n * p->nodes) * sizeof(PetscInt));
    assert_int_equal(p->physical[0], q->physical[0]);
    assert_int_equal(p->sign[0], strcmp(a.physicals[p->physical[0]].name, "left") ? 1 : -1);
  }
  assert_int_equal(GmshReset(&a), 0);
  assert_int_equal(GmshReset(&b), 0);
}

/* A file that is cut off anywhere before the end of the elements is refused. A file with one byte changed anywhere is
   read or refused, without a crash. */
static void test_damaged(void **state)
{
  static char copy[1 << 16];
  char        file[PETSC_MAX_PATH_LEN], binary[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN], *text;
  size_t      size;
  Complaint   complaint;
  GmshMesh    mesh;

  (void)state;
  Generate("{n: 2}", file, &complaint);
  ConvertBinary(file, binary);
  for (int kind = 0; kind < 2; kind++) {
    text = ReadText(kind ? binary : file, &size);
    memcpy(copy, text, size);
    for (size_t cut = 0; cut + 2 < size; cut += 7) {
      WriteText("cut.msh", copy, cut, path);
      complaint.text[0] = '\0';
      assert_int_equal(GmshRead(PETSC_COMM_SELF, path, &mesh, &complaint), 0);
      assert_non_null(strstr(complaint.text, "cut.msh"));
      assert_int_equal(GmshReset(&mesh), 0);
    }
    for (size_t at = 0; at < size; at += 11) {
      const char kept = copy[at];

      copy[at] = (char)(kept ^ (1 << (at % 7)));
      WriteText("cut.msh", copy, size, path);
      copy[at]          = kept;
      complaint.text[0] = '\0';
      assert_int_equal(GmshRead(PETSC_COMM_SELF, path, &mesh, &complaint), 0);
      assert_int_equal(GmshReset(&mesh), 0);
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_meshed_once),
                                     cmocka_unit_test(test_names_differ),
                                     cmocka_unit_test(test_without_gmsh),
                                     cmocka_unit_test(test_version_is_kept),
                                     cmocka_unit_test(test_crash),
                                     cmocka_unit_test(test_mistakes_in_geo),
                                     cmocka_unit_test(test_binary_equals_text),
                                     cmocka_unit_test(test_damaged)};
  char                    command[128];
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  snprintf(folder, sizeof(folder), "/tmp/burnish_gmsh_XXXXXX");
  if (!mkdtemp(folder)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  snprintf(command, sizeof(command), "rm -r %s", folder);
  if (system(command)) failed++;
  if (PetscFinalize()) return 1;
  return failed;
}
