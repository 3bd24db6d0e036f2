#include <fstream>

#include "framework/driver/RunSpecification.hpp"
#include "framework/input/Input.hpp"
#include "framework/plugin/Plugins.hpp"
#include "unit_tests/fuzz/Harness.hpp"

// Input files: includes, YAML, the checker. What was accepted must come back from its own printed form.

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  kiln::fuzz::initialise();
  // A plugin is code.
  kiln::plugins::forbid();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kiln;
  static const Specification specification = run_specification();
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Whatever lies elsewhere on this machine is no part of the case; a terminal would even wait for its user.
  if (text.find("/dev") != std::string::npos || text.find("/proc") != std::string::npos) return -1;
  const std::string file = fuzz::scratch("input.yaml"), printed = fuzz::scratch("printed.yaml");
  fuzz::write(file, data, size);
  fuzz::refuses_or_does([&] {
    const std::string merged = Input::read(file, {}, specification, *fuzz::alone()).merged();
    std::ofstream(printed) << merged;
    try {
      const std::string again = Input::read(printed, {}, specification, *fuzz::alone()).merged();
      if (again != merged) fuzz::found("the checked input comes back otherwise:\n" + merged + "---\n" + again);
    } catch (const InputError& error) {
      fuzz::found("the checked input is refused:\n" + merged + "---\n" + error.what());
    }
  });
  return 0;
}
