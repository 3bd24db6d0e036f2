#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "framework/base/Error.hpp"
#include "framework/files/Together.hpp"
#include "framework/model/MaskedModel.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/projection/FullSize.hpp"

namespace kiln {
namespace {

/// The model on the sample mesh: from the reduction file alone where the model's class can be rebuilt from it, else by
/// sampling the full model.
std::shared_ptr<Model> sample_mesh_model(const Method::Context& context, const ReductionFile& reduction,
                                         const SampleMesh& mesh) {
  const Teuchos::ParameterList& block = context.input.sublist("model");
  const Model::Context model_context{context.communicator};
  if (Registry<Model>::restorable(block)) {
    return Registry<Model>::restore(block, model_context, reduction.sample_model());
  }
  return sampled_or_masked(std::shared_ptr<const Model>(Registry<Model>::create(block, model_context)), mesh.rows);
}

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

/// Sources and queried particles, dealt out to the ranks in equal blocks.
PetrovGalerkin::Held held_particles(const SampleMesh& mesh, const Teuchos::RCP<const Communicator>& communicator,
                                    const std::string& file) {
  std::vector<GlobalIndex> ids;
  std::set_union(mesh.sources.ids.begin(), mesh.sources.ids.end(), mesh.queries.ids.begin(), mesh.queries.ids.end(),
                 std::back_inserter(ids));
  const std::size_t rank = communicator->getRank(), ranks = communicator->getSize();
  const std::size_t first = ids.size() * rank / ranks, last = ids.size() * (rank + 1) / ranks;
  const std::vector<GlobalIndex> mine(ids.begin() + first, ids.begin() + last);
  const Teuchos::RCP<const Map> map =
      Teuchos::rcp(new Map(ids.size(), Teuchos::arrayViewFromVector(mine), 0, communicator));
  PositionView positions("kiln::rom::positions", last - first);
  for (std::size_t i = first; i < last; ++i) {
    const ParticleTable& table = mesh.sources.find(ids[i]) >= 0 ? mesh.sources : mesh.queries;
    for (int d = 0; d < 3; ++d) positions(i - first, d) = table.positions[3 * table.find(ids[i]) + d];
  }
  return {map, positions, basis_at(*map, {&mesh.sources, &mesh.queries}, file)};
}

PetrovGalerkin::Parts sample_mesh_parts(const Method::Context& context, nlohmann::json& facts) {
  const ReductionFile reduction(context.input, context.communicator);
  reduction.require_time(context.input);
  const SampleMesh mesh = reduction.sample_mesh();
  const std::string& file = reduction.root().file();
  const std::shared_ptr<Model> model = sample_mesh_model(context, reduction, mesh);
  if (model->rows()->getGlobalNumElements() != mesh.rows.size()) {
    throw FileError(file, "", fmt::format("its sampled model has {} rows", model->rows()->getGlobalNumElements()),
                    fmt::format("the {} of sample_mesh/rows", mesh.rows.size()));
  }
  facts["residual_rank"] = mesh.gappy_operator.shape[0];
  facts["sampled"] = mesh.rows.size();
  facts["sources"] = mesh.sources.ids.size();
  facts["queried"] = mesh.queries.ids.size();
  facts["full_order_particles"] = reduction.particles();
  facts["sigma_min"] = mesh.sigma_min;
  facts["gappy_condition"] = mesh.condition;
  facts["reduction_file"] = file;
  auto test = std::make_unique<GnatTestBasis>(local_columns(mesh, *model->rows(), reduction.components(), file));
  return {model, basis_at(*model->sources(), {&mesh.sources}, file), std::move(test),
          held_particles(mesh, context.communicator, file)};
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
  Gnat(const Teuchos::ParameterList&, const Context& context, nlohmann::json facts)
      : PetrovGalerkin(sample_mesh_parts(context, facts),
                       NewtonSettings(context.input.sublist("time").sublist("newton"))),
        facts_(std::move(facts)) {}

  nlohmann::json facts_;
};

KILN_REGISTER(Method, Gnat, "gnat", "LSPG hyper-reduced by gappy POD on a sample mesh: touches nothing of full size");

}  // namespace
}  // namespace kiln
