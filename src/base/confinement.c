/* Limits of a child process by seccomp and Landlock of Linux, see confinement.h. */
#define _GNU_SOURCE 1 /* O_PATH, syscall */
#include "base/confinement.h"
#ifdef __linux__
  #include <errno.h>
  #include <fcntl.h>
  #include <linux/audit.h>
  #include <linux/filter.h>
  #if __has_include(<linux/landlock.h>)
    #include <linux/landlock.h>
  #endif
  #include <linux/seccomp.h>
  #include <sched.h>
  #include <stddef.h>
  #include <sys/prctl.h>
  #include <sys/syscall.h>
  #include <unistd.h>

  #if defined(SYS_landlock_create_ruleset) && defined(LANDLOCK_ACCESS_FS_WRITE_FILE)
  /* Everything that changes files. */
    #define WRITES                                                                                      \
      (LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE | \
       LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |       \
       LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK |    \
       LANDLOCK_ACCESS_FS_MAKE_SYM)

/* Allows to write below a path, as far as `access` says. */
static void AllowBelow(int rules, const char *path, unsigned long long access)
{
  struct landlock_path_beneath_attr below = {.allowed_access = access, .parent_fd = open(path, O_PATH | O_CLOEXEC)};

  if (below.parent_fd < 0) return;
  (void)syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &below, 0);
  close(below.parent_fd);
}

static void ForbidWriting(const char *folder)
{
  const struct landlock_ruleset_attr handled = {.handled_access_fs = WRITES};
  const int                          rules   = (int)syscall(SYS_landlock_create_ruleset, &handled, sizeof handled, 0);

  if (rules < 0) return;
  AllowBelow(rules, folder, WRITES);
  AllowBelow(rules, "/dev/null", LANDLOCK_ACCESS_FS_WRITE_FILE);
  (void)syscall(SYS_landlock_restrict_self, rules, 0);
  close(rules);
}
  #else
static void ForbidWriting(const char *folder)
{
  (void)folder;
}
  #endif

  #if defined(__x86_64__)
    #define THIS_PROCESSOR AUDIT_ARCH_X86_64
  #elif defined(__aarch64__)
    #define THIS_PROCESSOR AUDIT_ARCH_AARCH64
  #endif

  #ifdef THIS_PROCESSOR
    #define LOAD(field) BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, field))
    /* Goes `yes` instructions further if the loaded value is `value`, else `no`. */
    #define IF_EQUAL(value, yes, no)    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, yes, no)
    #define IF_AT_LEAST(value, yes, no) BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, value, yes, no)
    #define IF_BIT(value, yes, no)      BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, value, yes, no)
    #define ANSWER(value)               BPF_STMT(BPF_RET | BPF_K, value)
    /* Numbers of calls from here on belong to the x32 interface of x86-64 processors. */
    #define X32_CALLS 0x40000000u

/* Forbids new processes. Threads stay allowed. The C library falls back to clone() where there is no clone3(), whose
   arguments a filter cannot read. */
static void ForbidProcesses(void)
{
  struct sock_filter filter[] = {
    LOAD(arch),
    IF_EQUAL(THIS_PROCESSOR, 1, 0),
    ANSWER(SECCOMP_RET_ERRNO | EPERM),
    LOAD(nr),
    #ifdef SYS_fork
    IF_AT_LEAST(X32_CALLS, 2, 0),
    IF_EQUAL(SYS_fork, 1, 0),
    IF_EQUAL(SYS_vfork, 0, 1),
    ANSWER(SECCOMP_RET_ERRNO | EPERM),
    #endif
    #ifdef SYS_clone3
    IF_EQUAL(SYS_clone3, 0, 1),
    ANSWER(SECCOMP_RET_ERRNO | ENOSYS),
    #endif
    IF_EQUAL(SYS_clone, 0, 3),
    LOAD(args[0]),
    IF_BIT(CLONE_THREAD, 1, 0),
    ANSWER(SECCOMP_RET_ERRNO | EPERM),
    ANSWER(SECCOMP_RET_ALLOW),
  };
  const struct sock_fprog program = {.len = sizeof filter / sizeof *filter, .filter = filter};

  (void)prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}
  #endif
#endif

/*@
  ConfineProcess - forbids this process, and the program that it becomes, to start programs and to write files outside
  a folder.

  Not collective

  Input Parameter:
. folder - folder below which the process may write

  Note:
  For a child process between fork() and exec(). Where the system lacks Landlock (Linux before 5.13) files are not
  guarded, where it lacks seccomp or the processor is neither x86-64 nor ARM with 64 bits, programs are not.
  Source: Linux manual pages landlock(7), seccomp(2).
@*/
void ConfineProcess(const char *folder)
{
#ifdef __linux__
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)) return;
  ForbidWriting(folder);
  #ifdef THIS_PROCESSOR
  ForbidProcesses();
  #endif
#else
  (void)folder;
#endif
}
