#pragma once

#include "framework/registry/Registry.hpp"

namespace kiln::test {

/// Component kinds of this test program alone.
struct Kernel {
  using Context = NoContext;
  static constexpr const char* category = "test kernel";
  virtual ~Kernel() = default;
  virtual double radius() const = 0;
};

struct Source {
  using Context = NoContext;
  static constexpr const char* category = "test source";
  virtual ~Source() = default;
};

struct Watcher {
  using Context = NoContext;
  static constexpr const char* category = "test watcher";
  virtual ~Watcher() = default;
};

/// A run file that uses every kind of entry.
Specification run_specification();

}  // namespace kiln::test
