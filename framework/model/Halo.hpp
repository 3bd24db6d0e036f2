#pragma once

#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/Model.hpp"

namespace kiln {

/// Brings the state of a distributed model's rows to its sources on every rank: who evaluates a full-order model owns
/// one. Maps are over particles × components.
class Halo {
 public:
  /// Collective over the model's communicator.
  explicit Halo(const Model& model);

  const Teuchos::RCP<const Map>& rows() const { return rows_; }
  const Teuchos::RCP<const Map>& sources() const { return sources_; }
  LocalIndex row_size() const { return local_size(*rows_); }
  LocalIndex source_size() const { return local_size(*sources_); }

  /// An array over the sources whose leading part is the rows'; `fill` completes it from the other ranks.
  class State {
   public:
    explicit State(const Halo& halo);
    /// rows × components: the owned, leading part of sources().
    const VectorView& rows() const { return rows_; }
    const VectorView& sources() const { return sources_; }
    /// Collective.
    void fill();

   private:
    Teuchos::RCP<const Import> import_;
    VectorView sources_, rows_;
    Teuchos::RCP<MultiVector> source_column_, row_column_;
  };

  /// Copies a multivector over rows() into one over sources(). Collective.
  void bring(const MultiVector& rows, MultiVector& sources) const;

 private:
  Teuchos::RCP<const Map> rows_, sources_;
  Teuchos::RCP<const Import> import_;
};

}  // namespace kiln
