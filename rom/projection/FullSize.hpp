#pragma once

#include <functional>

#include "framework/registry/Specification.hpp"
#include "rom/basis/TimeWindow.hpp"
#include "rom/files/ReductionFile.hpp"
#include "rom/projection/PetrovGalerkin.hpp"

namespace kiln {

/// Keys that all reduced methods share.
Specification reduced_specification();
/// The key `factors` of a reduced method's block.
Projection::Factors factors_of(const Teuchos::ParameterList& method);

/// The parts of reduced methods on all rows of a full-order model: state, positions and test space are of size N.
/// `reference` and `modes`, [Φ_0 Φ_1 …], stand on the model's sources.
PetrovGalerkin::Parts full_size_parts(const std::shared_ptr<Model>& model, const std::vector<TimeWindow>& windows,
                                      ConstVectorView reference, ConstMatrixView modes,
                                      const std::function<std::unique_ptr<TestBasis>()>& test_basis);

/// The same for the input's model and the bases of its reduction file.
PetrovGalerkin::Parts full_size_parts(const Method::Context& context,
                                      const std::function<std::unique_ptr<TestBasis>()>& test_basis);

}  // namespace kiln
