#include <Tpetra_Map.hpp>

#include "framework/model/MaskedModel.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/projection/FullSize.hpp"
#include "rom/projection/HyperReduced.hpp"

namespace kiln {
namespace {

/// Algorithm 1: LSPG with GNAT's hyper-reduction, on the sample mesh alone.
class Gnat : public HyperReduced {
 public:
  static Specification specification() { return reduced_specification(); }
  Gnat(const Teuchos::ParameterList& block, const Context& context) : HyperReduced(block, context, made_in(context)) {}

 private:
  /// The models come from the reduction file alone where their class can be rebuilt from it, else by sampling the full
  /// one.
  static Made made_in(const Context& context) {
    Opened opened(context);
    opened.held = opened.file.held_particles();
    const Teuchos::ParameterList& block = context.input.sublist("model");
    std::shared_ptr<const Model> full;
    if (!Registry<Model>::restorable(block)) full = Registry<Model>::create(block, {context.communicator});
    return made_of(opened, [&](std::size_t window, const SampleMesh& mesh) -> Mesh {
      const std::shared_ptr<Model> model = opened.checked(
          full == nullptr
              ? Registry<Model>::restore(block, {opened.sharing(mesh.sources.size())}, opened.file.sample_model(window))
              : sampled_or_masked(full, mesh.rows),
          window, mesh);
      const TimeWindow& time = opened.file.windows()[window];
      return {model, rows_at(*model->sources(), {&opened.held}, time.first + time.size, opened.name()),
              mesh.sources.size()};
    });
  }
};

KILN_REGISTER(Method, Gnat, "gnat", "LSPG hyper-reduced by gappy POD on a sample mesh: touches nothing of full size");

}  // namespace
}  // namespace kiln
