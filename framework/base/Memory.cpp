#include "framework/base/Memory.hpp"

#include <unistd.h>

namespace kiln {

double machine_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace kiln
