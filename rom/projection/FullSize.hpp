#pragma once

#include "framework/registry/Specification.hpp"
#include "rom/files/ReductionFile.hpp"
#include "rom/projection/PetrovGalerkin.hpp"

namespace kiln {

/// Keys that galerkin, lspg and gnat share.
Specification reduced_specification();

/// Parts of a projection on all rows of a full-order model: state, positions and test space are of size N.
PetrovGalerkin::Parts full_size_parts(std::shared_ptr<Model> model, std::unique_ptr<TrialSpace> on_sources,
                                      std::unique_ptr<TrialSpace> on_rows, std::unique_ptr<TestBasis> test);

/// The same for the input's model and the basis of its reduction file.
PetrovGalerkin::Parts full_size_parts(const Method::Context& context, std::unique_ptr<TestBasis> test);

}  // namespace kiln
