#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Where results come from: Kiln's version, commit, compiler and flags; the versions of Trilinos, Kokkos, HDF5 and MPI;
/// the BLAS that is loaded now (not the one that was linked) and its threads; processor, kernel, ranks and date (UTC).
/// A flat object of texts and integers, the same on every rank. Collective.
nlohmann::json provenance(const Communicator& communicator);

/// "kiln VERSION (COMMIT, BUILD TYPE)", for --version.
std::string version_line();

}  // namespace kiln
