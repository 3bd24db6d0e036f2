#pragma once

#include <Trilinos_version.h>

#include "framework/plugin/Interface.hpp"

/// What a plugin and the Kiln that loads it must have in common: version, headers, compiler and Trilinos.
#define KILN_ABI \
  "Kiln " KILN_VERSION " (headers " KILN_INTERFACE ", compiler " __VERSION__ ", Trilinos " TRILINOS_VERSION_STRING ")"

/// Stands in front of the tag. It is looked for in the file's bytes: a library built against another Kiln must be
/// refused before any code of it runs, and the loader runs its initialisers.
#define KILN_ABI_MARK "kiln plugin for: "

/// Makes a shared library a plugin of Kiln; stands once in one of its .cpp files, outside all namespaces. The
/// components are registered with KILN_REGISTER, as built-in ones are.
#define KILN_PLUGIN()                                                     \
  extern "C" {                                                            \
  __attribute__((visibility("default"))) extern const char kiln_plugin[]; \
  const char kiln_plugin[] = KILN_ABI_MARK KILN_ABI;                      \
  }                                                                       \
  static_assert(true, "takes the semicolon")
