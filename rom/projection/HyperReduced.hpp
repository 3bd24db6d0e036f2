#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "rom/files/ReductionFile.hpp"
#include "rom/projection/PetrovGalerkin.hpp"

namespace kiln {

/// What the methods on sample meshes share: Algorithm 1 with GNAT's test basis. They differ in the model on the sampled
/// rows and its sources.
class HyperReduced : public PetrovGalerkin {
 public:
  void report(nlohmann::json& section) const override;

 protected:
  /// Entries of a window's sources up to which each rank evaluates all of them: sharing so few among ranks would save
  /// less time than adding up their parts takes.
  static constexpr std::size_t most_replicated = 2000;

  /// A reduction file opened for an online run, and what is read of it whatever the window.
  struct Opened {
    explicit Opened(const Context& run);
    const Context& context;
    ReductionFile file;
    ParticleTable held;                      ///< the particles whose state the method tells; for the method to fill
    Teuchos::RCP<const Communicator> alone;  ///< this rank only
    const std::string& name() const { return file.root().file(); }
    /// The ranks that share the evaluation of a window with so many sources: all, or each alone.
    Teuchos::RCP<const Communicator> sharing(std::size_t sources) const;
    /// Hands on a window's model. Throws FileError where its rows are not as many as the sample mesh's.
    std::shared_ptr<Model> checked(std::shared_ptr<Model> model, std::size_t window, const SampleMesh& mesh) const;
  };

  /// What a method evaluates in a window.
  struct Mesh {
    std::shared_ptr<Model> model;  ///< its rows are the sample mesh's
    BasisRows basis;               ///< on the model's sources, of this window and those before it
    std::size_t sources;           ///< over all ranks
  };
  using Meshes = std::function<Mesh(std::size_t window, const SampleMesh& mesh)>;

  struct Made {
    Parts parts;
    nlohmann::json facts;
  };
  /// The parts of a method on these meshes.
  static Made made_of(const Opened& opened, const Meshes& meshes);

  HyperReduced(const Teuchos::ParameterList& block, const Context& context, Made made);

 private:
  nlohmann::json facts_;
};

}  // namespace kiln
