/* Preloaded into a run, kills it the moment it is about to put its checkpoint of number KILN_KILL_AT_CHECKPOINT (1 is the
   first) in place: a kill that always comes at the same step, however fast the run is. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

int rename(const char* from, const char* to) {
  static const char name[] = "/checkpoint.h5";
  static int count = 0;
  const size_t length = strlen(to);
  const char* last = getenv("KILN_KILL_AT_CHECKPOINT");
  if (last != NULL && length >= strlen(name) && strcmp(to + length - strlen(name), name) == 0 && ++count == atoi(last)) {
    raise(SIGKILL);
  }
  int (*system_rename)(const char*, const char*) = (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
  return system_rename(from, to);
}
