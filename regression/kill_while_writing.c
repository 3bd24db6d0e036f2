/* Preloaded into a run, kills it at a moment of the test's choice, however fast the run is:
   KILN_KILL_AT=checkpoint.h5:N  when it is about to put its Nth file of that name in place (1 is the first);
   KILN_KILL_IN=checkpoint.h5:N  in the middle of the Nth piece that it writes into such files.
   KILN_STOP_AT=checkpoint.h5:N  sends it KILN_STOP_SIGNAL, a number, as KILN_KILL_AT would kill it. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static int ends_with(const char* text, const char* end) {
  const size_t length = strlen(text), end_length = strlen(end);
  return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

/* Whether this is the Nth call for a path that ends in /NAME and `suffix`, where `variable` holds NAME:N. */
static int is_due(const char* variable, const char* path, const char* suffix, int* count) {
  const char* wanted = getenv(variable);
  const char* colon = wanted == NULL ? NULL : strchr(wanted, ':');
  char end[256];
  if (colon == NULL) return 0;
  snprintf(end, sizeof end, "/%.*s%s", (int)(colon - wanted), wanted, suffix);
  return ends_with(path, end) && ++*count == atoi(colon + 1);
}

int rename(const char* from, const char* to) {
  static int kill_count = 0, stop_count = 0;
  if (is_due("KILN_KILL_AT", to, "", &kill_count)) raise(SIGKILL);
  if (is_due("KILN_STOP_AT", to, "", &stop_count)) raise(atoi(getenv("KILN_STOP_SIGNAL")));
  int (*system_rename)(const char*, const char*) = (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
  return system_rename(from, to);
}

static int is_the_piece(int descriptor) {
  static int count = 0;
  char link[64], name[4096];
  if (getenv("KILN_KILL_IN") == NULL) return 0;
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, name, sizeof name - 1);
  if (length <= 0) return 0;
  name[length] = '\0';
  return is_due("KILN_KILL_IN", name, ".partial", &count);
}

typedef ssize_t (*Pwrite)(int, const void*, size_t, off64_t);

static ssize_t write_at(const char* function, int descriptor, const void* data, size_t size, off64_t offset) {
  const Pwrite system_pwrite = (Pwrite)dlsym(RTLD_NEXT, function);
  if (is_the_piece(descriptor)) {
    system_pwrite(descriptor, data, size / 2, offset);
    raise(SIGKILL);
  }
  return system_pwrite(descriptor, data, size, offset);
}

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t offset) {
  return write_at("pwrite", descriptor, data, size, offset);
}

ssize_t pwrite64(int descriptor, const void* data, size_t size, off64_t offset) {
  return write_at("pwrite64", descriptor, data, size, offset);
}
