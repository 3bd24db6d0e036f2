#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "framework/base/Error.hpp"
#include "framework/files/Together.hpp"
#include "framework/model/MaskedModel.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/basis/AffineBasis.hpp"
#include "rom/projection/FullSize.hpp"

namespace kiln {
namespace {

/// Makes the models on the sample meshes: from the reduction file alone where the model's class can be rebuilt from it,
/// else by sampling the full model.
class SampledModels {
 public:
  SampledModels(const Method::Context& context, const ReductionFile& reduction)
      : block_(context.input.sublist("model")), context_{context.communicator}, reduction_(reduction) {
    if (!Registry<Model>::restorable(block_)) full_ = Registry<Model>::create(block_, context_);
  }

  std::shared_ptr<Model> model(std::size_t window, const SampleMesh& mesh) const {
    std::shared_ptr<Model> model;
    if (full_ == nullptr) {
      model = Registry<Model>::restore(block_, context_, reduction_.sample_model(window));
    } else {
      model = sampled_or_masked(full_, mesh.rows);
    }
    reduction_.require_components(model->fields().size());
    if (model->rows()->getGlobalNumElements() != mesh.rows.size()) {
      throw FileError(reduction_.root().file(), fmt::format("windows/{}", window),
                      fmt::format("its sampled model has {} rows", model->rows()->getGlobalNumElements()),
                      fmt::format("the {} of sample_mesh/rows", mesh.rows.size()));
    }
    return model;
  }

 private:
  const Teuchos::ParameterList& block_;
  Model::Context context_;
  const ReductionFile& reduction_;
  std::shared_ptr<const Model> full_;
};

/// The columns of A that belong to this rank's rows. Collective.
MatrixView local_columns(const SampleMesh& mesh, const Map& rows, std::size_t components, const std::string& file) {
  const std::size_t modes = mesh.gappy_operator.shape[0], width = mesh.gappy_operator.shape[1];
  const std::size_t count = rows.getMyGlobalIndices().extent(0);
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
  const std::size_t count = particles.getMyGlobalIndices().extent(0);
  PositionView positions("kiln::rom::positions", count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::ptrdiff_t row = table.find(particles.getGlobalElement(static_cast<LocalIndex>(i)));
    for (int d = 0; d < 3; ++d) positions(i, d) = table.positions[3 * row + d];
  }
  return positions;
}

std::unique_ptr<TrialSpace> trial_space(const ReductionFile::Rows& rows, const TimeWindow& window) {
  return std::make_unique<AffineBasis>(rows.reference, dense::leading_columns(rows.modes, window.first + window.size),
                                       window.first);
}

PetrovGalerkin::Parts sample_mesh_parts(const Method::Context& context, nlohmann::json& facts) {
  const ReductionFile reduction(context.input, context.communicator);
  reduction.require_time(context.input);
  const std::string& file = reduction.root().file();
  const SampledModels models(context, reduction);
  const ParticleTable table = reduction.held_particles();

  PetrovGalerkin::Parts parts;
  parts.particles = dealt(table, context.communicator);
  parts.positions = positions_at(*parts.particles, table);
  const ReductionFile::Rows held = rows_at(*parts.particles, table, reduction.coordinates(), file);
  // The hardest window speaks for all.
  std::size_t residual_rank = 0, sampled = 0, sources = 0;
  double sigma_min = std::numeric_limits<double>::infinity(), condition = 1.0;
  for (std::size_t w = 0; w < reduction.windows().size(); ++w) {
    const TimeWindow& window = reduction.windows()[w];
    const SampleMesh mesh = reduction.sample_mesh(w);
    const std::shared_ptr<Model> model = models.model(w, mesh);
    auto test = std::make_unique<GnatTestBasis>(local_columns(mesh, *model->rows(), reduction.components(), file));
    parts.windows.push_back(
        {window.end,
         {model, trial_space(rows_at(*model->sources(), table, window.first + window.size, file), window),
          std::move(test)},
         trial_space(held, window)});
    residual_rank = std::max(residual_rank, mesh.gappy_operator.shape[0]);
    sampled = std::max(sampled, mesh.rows.size());
    sources = std::max(sources, mesh.sources.size());
    sigma_min = std::min(sigma_min, mesh.sigma_min);
    condition = std::max(condition, mesh.condition);
  }
  facts["residual_rank"] = residual_rank;
  facts["sampled"] = sampled;
  facts["sources"] = sources;
  facts["held"] = table.ids.size();
  facts["queried"] = reduction.queries().size();
  facts["full_order_particles"] = reduction.particles();
  facts["sigma_min"] = sigma_min;
  facts["gappy_condition"] = condition;
  facts["reduction_file"] = file;
  return parts;
}

/// Algorithm 1: LSPG with GNAT's hyper-reduction, on the sample mesh alone.
class Gnat : public PetrovGalerkin {
 public:
  static Specification specification() { return reduced_specification(); }
  Gnat(const Teuchos::ParameterList& block, const Context& context) : Gnat(block, context, nlohmann::json::object()) {}

  void report(nlohmann::json& section) const override {
    PetrovGalerkin::report(section);
    section.update(facts_);
  }

 private:
  Gnat(const Teuchos::ParameterList& block, const Context& context, nlohmann::json facts)
      : PetrovGalerkin(sample_mesh_parts(context, facts),
                       NewtonSettings(context.input.sublist("time").sublist("newton")), factors_of(block)),
        facts_(std::move(facts)) {}

  nlohmann::json facts_;
};

KILN_REGISTER(Method, Gnat, "gnat", "LSPG hyper-reduced by gappy POD on a sample mesh: touches nothing of full size");

}  // namespace
}  // namespace kiln
