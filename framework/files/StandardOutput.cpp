#include "framework/files/StandardOutput.hpp"

#include <cerrno>
#include <cstdio>

#include "framework/files/Together.hpp"

namespace kiln {

void print(const Communicator& communicator, const std::string& text) {
  on_root(communicator, "standard output", [&text]() -> std::optional<Fault> {
    errno = 0;
    if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) return system_fault("written", errno);
    return std::nullopt;
  });
}

}  // namespace kiln
