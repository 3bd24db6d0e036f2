#pragma once

#include "Chain.hpp"
#include "framework/method/FullOrder.hpp"
#include "framework/time/TimeScheme.hpp"
#include "rom/projection/PetrovGalerkin.hpp"

namespace kiln::test {

/// Entries of the particles of `map`, × components, of the first M vectors of the orthonormal cosine basis of all
/// entries.
MatrixView cosines(const Map& map, int components, int all_entries, int modes);

std::shared_ptr<Model> model_of(const Case& values, const Teuchos::RCP<const Communicator>& communicator);
NewtonSettings newton_of(const Case& values);

/// A projection of `model` on the first M cosines about the model's initial state.
std::unique_ptr<PetrovGalerkin> projection(std::shared_ptr<Model> model, const Case& values, int modes,
                                           std::unique_ptr<TestBasis> test);
/// The same with GNAT's test basis, whose residual modes are the first n_r cosines. `model` may be sampled.
std::unique_ptr<PetrovGalerkin> gnat_projection(std::shared_ptr<Model> model, const Case& values, int modes,
                                                int residual_modes);

/// Marches through the case's steps and returns the state of all the method's particles at the end, by id, on every
/// rank.
std::vector<double> march(Method& method, const Case& values);
std::vector<double> gathered_state(const Method& method, ConstVectorView x);

double largest_difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace kiln::test
