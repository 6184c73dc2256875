// Preloaded by two_runs.sh: renames after a while, so that what lies ready under a temporary name does so for
// long; with NO_TMPFILE set, as on a file system without files that have no name. Folders that are flushed are
// noted in the file that SYNCED names.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

int rename(const char* from, const char* to) {
  int (*next)(const char*, const char*) = dlsym(RTLD_NEXT, "rename");
  usleep(300000);
  return next(from, to);
}

static int opened(const char* name, const char* path, int flags, mode_t mode) {
  int (*next)(const char*, int, ...) = dlsym(RTLD_NEXT, name);
  if ((flags & O_TMPFILE) == O_TMPFILE && getenv("NO_TMPFILE") != NULL) {
    errno = EOPNOTSUPP;
    return -1;
  }
  return next(path, flags, mode);
}

static mode_t modeOf(int flags, va_list rest) {
  return (flags & (O_CREAT | __O_TMPFILE)) != 0 ? (mode_t)va_arg(rest, int) : 0;
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = modeOf(flags, rest);
  va_end(rest);
  return opened("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = modeOf(flags, rest);
  va_end(rest);
  return opened("open64", path, flags, mode);
}

int fsync(int fd) {
  int (*next)(int) = dlsym(RTLD_NEXT, "fsync");
  struct stat s;
  const char* const log = getenv("SYNCED");
  if (log != NULL && fstat(fd, &s) == 0 && S_ISDIR(s.st_mode)) {
    FILE* const file = fopen(log, "a");
    if (file != NULL) {
      fputs("folder\n", file);
      fclose(file);
    }
  }
  return next(fd);
}
