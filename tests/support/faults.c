/* To be preloaded: a system with the faults that FLAUNAY_FAULTS lists, separated by commas:
   no-unnamed-files       as on network file systems
   no-links               no hard links
   ignore-case            names in upper case are those in lower case
   no-threads             none can be made
   full-at-sync           fsync finds that the disk is full
   end-at-sync=N          fsync and syncfs send this signal, and wait until it takes effect
   fail-renames-to=PATH   renames to paths that end so fail
   fail-renames-from=N    the Nth rename fails, and all later ones */
#define _GNU_SOURCE
#include <ctype.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Declares `real`, the function that the one of this name hides. ISO C has no cast from what dlsym returns to
   a function. */
#define REAL(name, parameters)            \
  int(*real) parameters = NULL;           \
  {                                       \
    void* found = dlsym(RTLD_NEXT, name); \
    memcpy(&real, &found, sizeof real);   \
  }

/* What is behind the = of a fault; empty if there is none, null if the fault is not listed. */
static const char* value_of(const char* name) {
  const char* list = getenv("FLAUNAY_FAULTS");
  const size_t length = strlen(name);
  while (list != NULL && *list != '\0') {
    if (strncmp(list, name, length) == 0 && strchr("=,", list[length]) != NULL) {
      return list[length] == '=' ? list + length + 1 : "";
    }
    list = strchr(list, ',');
    if (list != NULL) ++list;
  }
  return NULL;
}

static int is_listed(const char* name) { return value_of(name) != NULL; }

/* The path with which the system is called. */
struct path {
  char text[PATH_MAX];
};
static const char* actual(const char* path, struct path* lower) {
  if (!is_listed("ignore-case") || strlen(path) >= PATH_MAX) return path;
  strcpy(lower->text, path);
  char* name = strrchr(lower->text, '/');
  for (char* c = name != NULL ? name : lower->text; *c != '\0'; ++c) *c = (char)tolower((unsigned char)*c);
  return lower->text;
}

static int refuse(int error) {
  errno = error;
  return -1;
}

static int rename_fails(const char* to) {
  static int renames = 0;
  ++renames;
  const char* first = value_of("fail-renames-from");
  if (first != NULL && renames >= atoi(first)) return 1;
  const char* path = value_of("fail-renames-to");
  if (path == NULL) return 0;
  const size_t length = strcspn(path, ","), to_length = strlen(to);
  return to_length >= length && strncmp(to + to_length - length, path, length) == 0;
}

static int open_path(const char* name, const char* path, int flags, mode_t mode) {
  REAL(name, (const char*, int, ...))
  if ((flags & O_TMPFILE) == O_TMPFILE && is_listed("no-unnamed-files")) return refuse(EOPNOTSUPP);
  struct path lower;
  return real((flags & O_TMPFILE) == O_TMPFILE ? path : actual(path, &lower), flags, mode);
}

#define DEFINE_OPEN(name)                       \
  int name(const char* path, int flags, ...) {  \
    va_list arguments;                          \
    va_start(arguments, flags);                 \
    const mode_t mode = va_arg(arguments, int); \
    va_end(arguments);                          \
    return open_path(#name, path, flags, mode); \
  }
DEFINE_OPEN(open)
DEFINE_OPEN(open64)

#define DEFINE_STAT(name)                                             \
  int name(const char* restrict path, struct stat* restrict status) { \
    REAL(#name, (const char*, struct stat*))                          \
    struct path lower;                                                \
    return real(actual(path, &lower), status);                        \
  }
DEFINE_STAT(stat)

int faccessat(int folder, const char* path, int mode, int flags) {
  REAL("faccessat", (int, const char*, int, int))
  struct path lower;
  return real(folder, actual(path, &lower), mode, flags);
}

int rename(const char* from, const char* to) {
  REAL("rename", (const char*, const char*))
  if (rename_fails(to)) return refuse(EIO);
  struct path lower_from, lower_to;
  return real(actual(from, &lower_from), actual(to, &lower_to));
}

int link(const char* from, const char* to) {
  REAL("link", (const char*, const char*))
  return is_listed("no-links") ? refuse(EPERM) : real(from, to);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                   void* argument) {
  REAL("pthread_create", (pthread_t*, const pthread_attr_t*, void* (*)(void*), void*))
  return is_listed("no-threads") ? EAGAIN : real(thread, attributes, work, argument);
}

static void end_at_sync(void) {
  const char* number = value_of("end-at-sync");
  if (number == NULL) return;
  struct sigaction action;
  sigaction(atoi(number), NULL, &action);
  kill(getpid(), atoi(number));
  if (action.sa_handler != SIG_IGN) sleep(60);
}

int fsync(int descriptor) {
  REAL("fsync", (int))
  end_at_sync();
  return is_listed("full-at-sync") ? refuse(ENOSPC) : real(descriptor);
}

int syncfs(int descriptor) {
  REAL("syncfs", (int))
  end_at_sync();
  return real(descriptor);
}
