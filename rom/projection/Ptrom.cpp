#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>

#include "framework/base/Error.hpp"
#include "framework/model/PairwiseModel.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/files/ClusteredMesh.hpp"
#include "rom/projection/FullSize.hpp"
#include "rom/projection/HyperReduced.hpp"

namespace kiln {
namespace {

/// The projection-tree reduced-order model (Appendix A of NRL/6390/MR--2022/1): GNAT on a sample mesh whose rows sum
/// over clusters of their sources. Rows of a cluster's basis are means of its members', so that its state is one more
/// row of the trial space.
class Ptrom : public HyperReduced {
 public:
  static Specification specification() { return reduced_specification(); }
  Ptrom(const Teuchos::ParameterList& block, const Context& context)
      : HyperReduced(block, context, made_in(context, block.name())) {}

 private:
  static Made made_in(const Context& context, const std::string& path) {
    Opened opened(context);
    if (!opened.file.clustered()) {
      throw InputError(path + ".type", fmt::format("'ptrom' needs clusters of sources, and {} has none", opened.name()),
                       "a file trained with reduction.clustering, such as {type: per row, clusters: 8}; or 'gnat'");
    }
    opened.held = opened.file.target_particles();
    const Teuchos::ParameterList& block = context.input.sublist("model");
    std::unique_ptr<const Model> full;
    if (!Registry<Model>::restorable(block)) full = Registry<Model>::create(block, {context.communicator});
    long long pairs = 0, gnat_pairs = 0;
    std::size_t gnat_sources = 0;
    Made made = made_of(opened, [&](std::size_t window, const SampleMesh& mesh) -> Mesh {
      const hdf5::Group group = opened.file.clusters(window);
      const TimeWindow& time = opened.file.windows()[window];
      const int columns = time.first + time.size;
      const ParticleTable clusters = opened.file.cluster_table(window);
      const auto sources = static_cast<std::size_t>(count_of_sources(group, mesh.rows.size(), clusters.ids.size()));
      const std::shared_ptr<Model> model = opened.checked(
          full == nullptr ? Registry<Model>::restore(block, {opened.sharing(sources)}, group.group("model"))
                          : built(*full, group),
          window, mesh);
      pairs += group.integer("pairs");
      gnat_pairs += group.integer("unclustered_pairs");
      gnat_sources = std::max(gnat_sources, mesh.sources.size());
      return {model, rows_at(*model->sources(), {&opened.held, &clusters}, columns, opened.name()), sources};
    });
    if (nlohmann::json trial = opened.file.trial(true); !trial.is_null()) made.facts["trial"] = std::move(trial);
    made.facts["pairs"] = pairs;
    made.facts["gnat_pairs"] = gnat_pairs;
    made.facts["pairs_ratio"] = static_cast<double>(pairs) / static_cast<double>(gnat_pairs);
    made.facts["gnat_sources"] = gnat_sources;
    made.facts["sources_ratio"] = made.facts["sources"].get<double>() / static_cast<double>(gnat_sources);
    made.facts["source_clustering"] = opened.file.clusters(0).text("type");
    return made;
  }

  static long long count_of_sources(const hdf5::Group& group, std::size_t rows, std::size_t clusters) {
    const long long count = group.integer("sources");
    const auto least = static_cast<long long>(rows), most = static_cast<long long>(rows + clusters);
    if (count >= least && count <= most) return count;
    throw FileError(group.file(), group.path() + ", attribute sources", fmt::format("{}", count),
                    fmt::format("{} to {}: the rows, and clusters beside them", least, most));
  }

  /// For a model that cannot be rebuilt from a file.
  static std::unique_ptr<Model> built(const Model& full, const hdf5::Group& group) {
    const auto* pairwise = dynamic_cast<const PairwiseModel*>(&full);
    if (pairwise != nullptr) return pairwise->clustered(read_clusters(group));
    throw FileError(group.file(), group.path(), "is of a model that tells its pairs, as this one does not");
  }
};

KILN_REGISTER(Method, Ptrom, "ptrom",
              "GNAT on a sample mesh of clustered sources (projection-tree reduced-order model)");

}  // namespace
}  // namespace kiln
