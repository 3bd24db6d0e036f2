#pragma once

#include <functional>

#include "Chain.hpp"
#include "framework/method/FullOrder.hpp"
#include "framework/report/RunReport.hpp"
#include "framework/time/StepListener.hpp"
#include "framework/time/TimeScheme.hpp"
#include "rom/basis/TimeWindow.hpp"
#include "rom/projection/PetrovGalerkin.hpp"

namespace kiln::test {

/// Entries of the particles of `map`, × components, of the first M vectors of the orthonormal cosine basis of all
/// entries.
MatrixView cosines(const Map& map, int components, int all_entries, int modes);

std::shared_ptr<Model> model_of(const Case& values, const Teuchos::RCP<const Communicator>& communicator);
NewtonSettings newton_of(const Case& values);

std::unique_ptr<TestBasis> galerkin_test();
std::unique_ptr<TestBasis> lspg_test();
/// GNAT's test basis on a model's rows, whose residual modes are the first n_r cosines.
std::function<std::unique_ptr<TestBasis>()> gnat_test(const Model& model, const Case& values, int residual_modes);

/// Projections of `model`, which may be sampled, about its initial state; `on_sources`: the modes of all windows.
PetrovGalerkin::Parts parts_of(const std::shared_ptr<Model>& model, const Case& values, const MatrixView& on_sources,
                               const std::vector<TimeWindow>& windows,
                               const std::function<std::unique_ptr<TestBasis>()>& test);
/// One on the first M cosines.
std::unique_ptr<PetrovGalerkin> projection(const std::shared_ptr<Model>& model, const Case& values, int modes,
                                           const std::function<std::unique_ptr<TestBasis>()>& test);
std::unique_ptr<PetrovGalerkin> gnat_projection(const std::shared_ptr<Model>& model, const Case& values, int modes,
                                                int residual_modes);

/// Trains as the input of a case asks for: `reduction.h5` in its folder.
RunReport train(const Case& values, const Teuchos::RCP<const Communicator>& communicator);
/// What `kiln check` asks of such a training.
void check_training(const Case& values, const Teuchos::RCP<const Communicator>& communicator);
/// A registered method on the case.
std::unique_ptr<Method> method_of(Case values, const std::string& type,
                                  const Teuchos::RCP<const Communicator>& communicator);

/// Marches through the case's steps and returns the state of all the method's particles at the end, by id, on every
/// rank.
std::vector<double> march(Method& method, const Case& values, const std::vector<StepListener*>& listeners = {});
std::vector<double> gathered_state(const Method& method, ConstVectorView x);

double largest_difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace kiln::test
