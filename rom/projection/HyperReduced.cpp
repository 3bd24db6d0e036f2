#include "rom/projection/HyperReduced.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <limits>
#include <optional>

#include "framework/base/Error.hpp"
#include "framework/files/Together.hpp"
#include "rom/basis/AffineBasis.hpp"
#include "rom/projection/FullSize.hpp"

namespace kiln {
namespace {

/// The columns of A that belong to this rank's rows. Collective.
MatrixView local_columns(const SampleMesh& mesh, const Map& rows, std::size_t components, const std::string& file) {
  const std::size_t modes = mesh.gappy_operator.shape[0], width = mesh.gappy_operator.shape[1];
  const std::size_t count = local_size(rows);
  MatrixView result("kiln::rom::gappy operator", modes, count * components);
  std::optional<Fault> fault;
  for (std::size_t i = 0; i < count; ++i) {
    const GlobalIndex id = rows.getGlobalElement(static_cast<LocalIndex>(i));
    const auto place = std::lower_bound(mesh.rows.begin(), mesh.rows.end(), id);
    if (place == mesh.rows.end() || *place != id) {
      fault = Fault{"", fmt::format("its sampled model has particle {}, which sample_mesh/rows lacks", id), {}};
      break;
    }
    for (std::size_t c = 0; c < components; ++c) {
      const std::size_t column = (place - mesh.rows.begin()) * components + c;
      for (std::size_t k = 0; k < modes; ++k) {
        result(k, i * components + c) = mesh.gappy_operator.values[k * width + column];
      }
    }
  }
  throw_together(*rows.getComm(), file, fault);
  return result;
}

/// A table's particles, dealt out to the ranks in equal blocks.
Teuchos::RCP<const Map> dealt(const ParticleTable& table, const Teuchos::RCP<const Communicator>& communicator) {
  const std::size_t rank = communicator->getRank(), ranks = communicator->getSize(), count = table.ids.size();
  const std::size_t first = count * rank / ranks, last = count * (rank + 1) / ranks;
  return Teuchos::rcp(
      new Map(count, Teuchos::ArrayView<const GlobalIndex>(table.ids.data() + first, last - first), 0, communicator));
}

PositionView positions_at(const Map& particles, const ParticleTable& table) {
  const std::size_t count = local_size(particles);
  PositionView positions("kiln::rom::positions", count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::ptrdiff_t row = table.find(particles.getGlobalElement(static_cast<LocalIndex>(i)));
    for (int d = 0; d < 3; ++d) positions(i, d) = table.positions[3 * row + d];
  }
  return positions;
}

std::shared_ptr<const TrialSpace> trial_space(const BasisRows& rows, const TimeWindow& window,
                                              const std::shared_ptr<const TrialSpace>& previous = nullptr) {
  return std::make_shared<AffineBasis>(rows.reference, dense::leading_columns(rows.modes, window.first + window.size),
                                       window.first, previous);
}

}  // namespace

HyperReduced::Opened::Opened(const Context& run)
    : context(run),
      file(run.input, run.communicator),
      held(),
      alone(run.communicator->split(run.communicator->getRank(), 0)) {
  file.require_time(run.input);
  file.require_end(run.input);
}

Teuchos::RCP<const Communicator> HyperReduced::Opened::sharing(std::size_t sources) const {
  return sources * file.components() <= most_replicated ? alone : context.communicator;
}

std::shared_ptr<Model> HyperReduced::Opened::checked(std::shared_ptr<Model> model, std::size_t window,
                                                     const SampleMesh& mesh) const {
  file.require_components(model->fields().size());
  if (model->rows()->getGlobalNumElements() == mesh.rows.size()) return model;
  throw FileError(name(), fmt::format("windows/{}", window),
                  fmt::format("its sampled model has {} rows", model->rows()->getGlobalNumElements()),
                  fmt::format("the {} of sample_mesh/rows", mesh.rows.size()));
}

HyperReduced::Made HyperReduced::made_of(const Opened& opened, const Meshes& meshes) {
  const ReductionFile& reduction = opened.file;
  Made made;
  made.parts.particles = dealt(opened.held, opened.context.communicator);
  made.parts.positions = positions_at(*made.parts.particles, opened.held);
  made.parts.reduction = reduction.fingerprint();
  made.parts.trained = reduction.trained_ranges();
  made.parts.questions = reduction.questions();
  const BasisRows held = rows_at(*made.parts.particles, {&opened.held}, reduction.coordinates(), opened.name());
  std::shared_ptr<const TrialSpace> held_before;
  // The hardest window speaks for all.
  std::size_t residual_rank = 0, sampled = 0, sources = 0;
  double sigma_min = std::numeric_limits<double>::infinity(), condition = 1.0;
  for (std::size_t w = 0; w < reduction.windows().size(); ++w) {
    const TimeWindow& window = reduction.windows()[w];
    const SampleMesh sample = reduction.sample_mesh(w);
    const Mesh mesh = meshes(w, sample);
    auto test = std::make_unique<GnatTestBasis>(
        local_columns(sample, *mesh.model->rows(), reduction.components(), opened.name()));
    made.parts.windows.push_back({window.end,
                                  {mesh.model, trial_space(mesh.basis, window), std::move(test)},
                                  trial_space(held, window, held_before)});
    held_before = made.parts.windows.back().held;
    residual_rank = std::max(residual_rank, sample.gappy_operator.shape[0]);
    sampled = std::max(sampled, sample.rows.size());
    sources = std::max(sources, mesh.sources);
    sigma_min = std::min(sigma_min, sample.sigma_min);
    condition = std::max(condition, sample.condition);
  }
  made.facts["residual_rank"] = residual_rank;
  made.facts["sampled"] = sampled;
  made.facts["sources"] = sources;
  made.facts["held"] = opened.held.ids.size();
  made.facts["queried"] = made.parts.questions->particles().size();
  made.facts["full_order_particles"] = reduction.particles();
  made.facts["sigma_min"] = sigma_min;
  made.facts["gappy_condition"] = condition;
  made.facts["reduction_file"] = opened.name();
  if (nlohmann::json trial = reduction.trial(false); !trial.is_null()) made.facts["trial"] = std::move(trial);
  return made;
}

HyperReduced::HyperReduced(const Teuchos::ParameterList& block, const Context& context, Made made)
    : PetrovGalerkin(std::move(made.parts), NewtonSettings(context.input.sublist("time").sublist("newton")),
                     factors_of(block)),
      facts_(std::move(made.facts)) {}

void HyperReduced::report(nlohmann::json& section) const {
  PetrovGalerkin::report(section);
  section.update(facts_);
}

}  // namespace kiln
