/* Preloaded, makes reading or writing of one file fail from a byte on.
 *
 *   SPOOLWATCH_FAULT=KIND:TEXT:AT   for files whose path contains TEXT, from byte AT
 *
 * KIND: read_eio, read_short (at most seven bytes at a time), read_shrunk (the file is cut off there
 * when it has been read so far), write_enospc, write_eio, write_short; sync_eio (fsync and fdatasync),
 * sync_folder_eio (the same of folders alone), rename_eio (onto such a path).
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

static char kind[32];
static char wanted[256];
static long long at = -1;

__attribute__((constructor)) static void begin(void) {
  const char* fault = getenv("SPOOLWATCH_FAULT");
  if (fault == NULL || sscanf(fault, "%31[^:]:%255[^:]:%lld", kind, wanted, &at) != 3) at = -1;
}

/* Whether this is the file that is wanted. */
static int is_it(int file) {
  char link[64];
  char path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t n = readlink(link, path, sizeof path - 1);
  if (n <= 0) return 0;
  path[n] = 0;
  return strstr(path, wanted) != NULL;
}

/* Bytes until the fault, -1: none here. */
static long long until_fault(int file, const char* which) {
  if (at < 0 || strncmp(kind, which, strlen(which)) != 0 || !is_it(file)) return -1;
  const off_t offset = lseek(file, 0, SEEK_CUR);
  if (offset < 0) return -1;
  return offset >= at ? 0 : at - offset;
}

ssize_t read(int file, void* bytes, size_t count) {
  static ssize_t (*real)(int, void*, size_t);
  if (real == NULL) real = (ssize_t(*)(int, void*, size_t))dlsym(RTLD_NEXT, "read");
  const long long left = until_fault(file, "read");
  if (left >= 0 && strcmp(kind, "read_short") == 0) {
    if (left == 0 && count > 7) count = 7;
  } else if (left == 0 && strcmp(kind, "read_shrunk") == 0) {
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    if (truncate(link, at) != 0) abort();
  } else if (left == 0) {
    errno = EIO;
    return -1;
  } else if (left > 0 && (unsigned long long)left < count) {
    count = (size_t)left;
  }
  return real(file, bytes, count);
}

size_t fread(void* bytes, size_t size, size_t count, FILE* stream) {
  static size_t (*real)(void*, size_t, size_t, FILE*);
  if (real == NULL) real = (size_t(*)(void*, size_t, size_t, FILE*))dlsym(RTLD_NEXT, "fread");
  if (at >= 0 && strcmp(kind, "read_eio") == 0 && until_fault(fileno(stream), "read") >= 0 &&
      ftell(stream) + (long)(size * count) > at) {
    errno = EIO;
    return 0;
  }
  return real(bytes, size, count, stream);
}

/* Fails at once for all that goes through a stream: the C library's own write() is out of reach. */
size_t fwrite(const void* bytes, size_t size, size_t count, FILE* stream) {
  static size_t (*real)(const void*, size_t, size_t, FILE*);
  if (real == NULL) {
    real = (size_t(*)(const void*, size_t, size_t, FILE*))dlsym(RTLD_NEXT, "fwrite");
  }
  if (strcmp(kind, "write_short") != 0 && until_fault(fileno(stream), "write") >= 0 &&
      ftell(stream) + (long)(size * count) > at) {
    errno = strcmp(kind, "write_eio") == 0 ? EIO : ENOSPC;
    return 0;
  }
  return real(bytes, size, count, stream);
}

ssize_t write(int file, const void* bytes, size_t count) {
  static ssize_t (*real)(int, const void*, size_t);
  if (real == NULL) real = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
  const long long left = until_fault(file, "write");
  if (left == 0 && strcmp(kind, "write_short") != 0) {
    errno = strcmp(kind, "write_eio") == 0 ? EIO : ENOSPC;
    return -1;
  }
  if (left == 0 && count > 7) count = 7;
  if (left > 0 && (unsigned long long)left < count) count = (size_t)left;
  return real(file, bytes, count);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  static ssize_t (*real)(int, const struct iovec*, int);
  if (real == NULL) real = (ssize_t(*)(int, const struct iovec*, int))dlsym(RTLD_NEXT, "writev");
  if (until_fault(file, "write") < 0) return real(file, parts, count);
  for (int i = 0; i < count; ++i) {
    if (parts[i].iov_len > 0) return write(file, parts[i].iov_base, parts[i].iov_len);
  }
  return 0;
}

static int synced(int file, const char* name) {
  struct stat found;
  const int folder = fstat(file, &found) == 0 && S_ISDIR(found.st_mode);
  const int wrong = strcmp(kind, "sync_eio") == 0 || (folder && strcmp(kind, "sync_folder_eio") == 0);
  if (at >= 0 && wrong && is_it(file)) {
    errno = EIO;
    return -1;
  }
  int (*real)(int) = (int (*)(int))dlsym(RTLD_NEXT, name);
  return real(file);
}

int fsync(int file) { return synced(file, "fsync"); }
int fdatasync(int file) { return synced(file, "fdatasync"); }

int rename(const char* from, const char* to) {
  if (at >= 0 && strcmp(kind, "rename_eio") == 0 && strstr(to, wanted) != NULL) {
    errno = EIO;
    return -1;
  }
  int (*real)(const char*, const char*) =
      (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
  return real(from, to);
}
