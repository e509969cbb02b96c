// Preloaded into a run, fails one of the calls that write below a folder, and counts them all.
//
// FAILING_FOLDER: absolute, where calls count. FAILING_CALL: which of them fails, from 1 on; 0 or nothing: none.
// FAILING_WITH: the error, ENOSPC or EIO; SHORT: every write takes half of what it is given, and nothing fails.
// FAILING_REPORT: a file that gets "failed CALL PATH" and at the end "calls N".
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

static const char *folder, *report;
static long failing, calls;
static int with_error, short_writes;

__attribute__((constructor)) static void begin(void) {
  const char *call = getenv("FAILING_CALL"), *with = getenv("FAILING_WITH");
  folder = getenv("FAILING_FOLDER");
  report = getenv("FAILING_REPORT");
  failing = call != NULL ? atol(call) : 0;
  with_error = with != NULL && strcmp(with, "ENOSPC") == 0 ? ENOSPC : EIO;
  short_writes = with != NULL && strcmp(with, "SHORT") == 0;
}

// By system calls: those of the library are the ones that fail.
static void say(const char* text) {
  if (report == NULL) return;
  const long file = syscall(SYS_openat, AT_FDCWD, report, O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (file < 0) return;
  syscall(SYS_write, file, text, strlen(text));
  syscall(SYS_close, file);
}

__attribute__((destructor)) static void end(void) {
  char text[40];
  snprintf(text, sizeof text, "calls %ld\n", calls);
  say(text);
}

static int below(const char* path) {
  const size_t length = folder != NULL ? strlen(folder) : 0;
  return length > 0 && strncmp(path, folder, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

static int path_of(int file, char* path, size_t size) {
  char link[40];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, size - 1);
  if (length < 0) return 0;
  path[length] = '\0';
  return 1;
}

static int fails(const char* call, const char* path) {
  if (!below(path) || __sync_add_and_fetch(&calls, 1) != failing) return 0;
  char text[4400];
  snprintf(text, sizeof text, "failed %s %s\n", call, path + strlen(folder));
  say(text);
  errno = with_error;
  return 1;
}

static int file_fails(const char* call, int file) {
  char path[4096];
  const int kept = errno;
  const int fail = path_of(file, path, sizeof path) && fails(call, path);
  if (!fail) errno = kept;
  return fail;
}

static size_t taken(int file, size_t size) {
  char path[4096];
  return short_writes && size > 1 && path_of(file, path, sizeof path) && below(path) ? size / 2 : size;
}

#define NEXT(type, name, ...)               \
  static type (*next)(__VA_ARGS__) = NULL; \
  if (next == NULL) next = (type(*)(__VA_ARGS__))dlsym(RTLD_NEXT, #name)

ssize_t write(int file, const void* bytes, size_t size) {
  NEXT(ssize_t, write, int, const void*, size_t);
  return file_fails("write", file) ? -1 : next(file, bytes, taken(file, size));
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  NEXT(ssize_t, pwrite, int, const void*, size_t, off_t);
  return file_fails("pwrite", file) ? -1 : next(file, bytes, taken(file, size), at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  NEXT(ssize_t, pwrite64, int, const void*, size_t, off64_t);
  return file_fails("pwrite", file) ? -1 : next(file, bytes, taken(file, size), at);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  NEXT(ssize_t, writev, int, const struct iovec*, int);
  return file_fails("writev", file) ? -1 : next(file, parts, count);
}

ssize_t pwritev(int file, const struct iovec* parts, int count, off_t at) {
  NEXT(ssize_t, pwritev, int, const struct iovec*, int, off_t);
  return file_fails("pwritev", file) ? -1 : next(file, parts, count, at);
}

int fsync(int file) {
  NEXT(int, fsync, int);
  return file_fails("fsync", file) ? -1 : next(file);
}

int fdatasync(int file) {
  NEXT(int, fdatasync, int);
  return file_fails("fdatasync", file) ? -1 : next(file);
}

int ftruncate(int file, off_t size) {
  NEXT(int, ftruncate, int, off_t);
  return file_fails("ftruncate", file) ? -1 : next(file, size);
}

int ftruncate64(int file, off64_t size) {
  NEXT(int, ftruncate64, int, off64_t);
  return file_fails("ftruncate", file) ? -1 : next(file, size);
}

// Of what was open for writing; it is closed whatever is said of it.
int close(int file) {
  NEXT(int, close, int);
  const int flags = fcntl(file, F_GETFL);
  const int fail = flags >= 0 && (flags & O_ACCMODE) != O_RDONLY && file_fails("close", file);
  const int result = next(file);
  if (!fail) return result;
  errno = with_error;
  return -1;
}

int rename(const char* from, const char* to) {
  NEXT(int, rename, const char*, const char*);
  return fails("rename", to) ? -1 : next(from, to);
}

int mkdir(const char* path, mode_t mode) {
  NEXT(int, mkdir, const char*, mode_t);
  return fails("mkdir", path) ? -1 : next(path, mode);
}

static int writes(int flags) { return (flags & O_ACCMODE) != O_RDONLY; }

#define MODE(flags, last)                        \
  mode_t mode = 0;                               \
  if ((flags & O_CREAT) != 0) {                  \
    va_list list;                                \
    va_start(list, last);                        \
    mode = (mode_t)va_arg(list, int);            \
    va_end(list);                                \
  }

int open(const char* path, int flags, ...) {
  NEXT(int, open, const char*, int, ...);
  MODE(flags, flags)
  return writes(flags) && fails("open", path) ? -1 : next(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  NEXT(int, open64, const char*, int, ...);
  MODE(flags, flags)
  return writes(flags) && fails("open", path) ? -1 : next(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  NEXT(FILE*, fopen, const char*, const char*);
  return strpbrk(mode, "wa+") != NULL && fails("open", path) ? NULL : next(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  NEXT(FILE*, fopen64, const char*, const char*);
  return strpbrk(mode, "wa+") != NULL && fails("open", path) ? NULL : next(path, mode);
}
