#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

/// What the fuzzers share. Each runs in a folder of its own, made once, where KILN_FUZZ_SOUND names a folder with sound
/// files (fuzz.py makes both).
namespace kiln::fuzz {

/// Starts MPI and Kokkos, once.
void initialise();
Teuchos::RCP<const Communicator> alone();
/// A sound file's path.
std::string sound(const std::string& name);
/// A path in the folder of this process, which goes when it ends.
std::string scratch(const std::string& name);
void write(const std::string& path, const std::uint8_t* data, std::size_t size);
std::string read(const std::string& path);

/// Does what may end in one of Kiln's own errors, with a message; any other end is a finding.
void refuses_or_does(const std::function<void()>& work);
/// Ends the process with a finding.
[[noreturn]] void found(const std::string& what);

}  // namespace kiln::fuzz
